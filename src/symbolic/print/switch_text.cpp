#include <maupertuis/switch_text.hpp>

#include <maupertuis/print.hpp>

namespace maupertuis {
namespace {

constexpr std::size_t longest = 60, terms_at_most = 12;

bool changes(Expr e) {
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() == Role::Coordinate || s.role() == Role::Input || s.role() == Role::Time) return true;
  return false;
}

std::string text_of(Expr e, const ReadingOrder& order) {
  const ReadableForm form = readable(e, order);
  return form.intermediates.empty() ? to_plain(form.value, order) : std::string();
}

struct Relation {
  std::string left, right;  // empty: too long
  bool turned = false;      // left − right is −g
};

Relation relation_of(Expr difference, const ReadingOrder& order) {
  Context& context = difference.context();
  const Expr expanded = expand(difference, terms_at_most);
  const Expr e = expanded ? expanded : difference;
  Expr left = context.number(0), right = left;
  for (std::size_t i = 0; i < (e.is(Kind::Sum) ? e.size() : 1); ++i) {
    const Expr term = e.is(Kind::Sum) ? e[i] : e;
    (changes(term) ? left : right) = changes(term) ? left + term : right - term;
  }
  const Expr first = left.is(Kind::Sum) ? left[0] : left;
  const bool turned = split_coefficient(first).coefficient.sign() < 0;
  if (turned) left = expand(-left), right = expand(-right);
  const std::string a = text_of(left, order), b = text_of(right, order);
  return a.empty() || b.empty() || a.size() + b.size() > longest ? Relation{} : Relation{a, b, turned};
}

std::string text_with(const Relation& relation, const char* sign) {
  return relation.left.empty() ? std::string() : relation.left + sign + relation.right;
}

}  // namespace

std::string switch_text(Expr difference, const ReadingOrder& order) {
  return text_with(relation_of(difference, order), " = ");
}

std::string side_text(Expr difference, bool above, const ReadingOrder& order) {
  const Relation relation = relation_of(difference, order);
  return text_with(relation, above != relation.turned ? " > " : " < ");
}

}  // namespace maupertuis
