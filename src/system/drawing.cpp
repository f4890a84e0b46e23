#include "system/elaboration.hpp"

/// What is drawn: lines through points, trails, solids, springs, what stands still, labels.
namespace maupertuis::elaboration {

void elaborate_drawing(Elaboration& e, const syntax::DrawStatement& s) {
  for (const syntax::DrawItem& item : s.items) {
    DrawElement element;
    element.kind = item.kind;
    if (item.kind == syntax::DrawItem::Kind::Reaction) {
      const syntax::Expression& name = *item.path[0]->arguments[0];
      element.names = {name.text};
      if (names_a_reaction(e, {name.text, name.span})) e.experiment().drawing.push_back(std::move(element));
      continue;
    }
    bool poisoned = false;
    for (const syntax::ExpressionPtr& x : item.path) {
      const Value v = position_of(e, *x, nullptr);
      poisoned = poisoned || v.poisoned;
      element.path.push_back(v.parts);
      element.names.push_back(x->kind == syntax::Expression::Kind::Name ? x->text : "");
    }
    for (const syntax::ExpressionPtr& x : item.sizes) {
      const Value v = constant_of(e, *x, dimensions::length(), "a size");
      poisoned = poisoned || v.poisoned;
      if (!v.poisoned) element.sizes.push_back(v.scalar());
    }
    if (item.direction) {
      const Value v = vector_of(e, *item.direction, Dimension{}, "a direction");
      poisoned = poisoned || v.poisoned;
      element.direction = v.parts;
    }
    element.text = item.text;
    if (!poisoned) e.experiment().drawing.push_back(std::move(element));
  }
}

}  // namespace maupertuis::elaboration
