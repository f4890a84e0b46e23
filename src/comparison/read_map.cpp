#include <maupertuis/comparison.hpp>
#include <maupertuis/kinds.hpp>

#include <fmt/format.h>

#include <algorithm>

/// A map is read by the model language itself: its right sides become `let` lines at the end of B's text, so that all
/// that may stand in a formula of B may stand in them.
namespace maupertuis {
namespace {

struct Assignment {
  std::string name;
  Span name_span, value_span;  // in the map
};

/// A part of the map that was copied into another text.
struct Copied {
  std::uint32_t begin, length, origin;
};

/// Keeps what concerns the copied parts, at their places in the map.
void take_over(const Diagnostics& found, const std::vector<Copied>& parts, Diagnostics& diagnostics) {
  Diagnostics moved;
  for (Diagnostic d : found.items()) {
    if (!d.span) continue;
    for (const Copied& part : parts) {
      if (d.span->begin < part.begin || d.span->begin > part.begin + part.length) continue;
      const std::uint32_t end = std::min(d.span->end, part.begin + part.length);
      d.span = Span{d.span->begin - part.begin + part.origin, std::max(end, d.span->begin) - part.begin + part.origin};
      Diagnostic& copy = d.severity == Severity::Error     ? moved.error(d.code, d.span, d.message, d.reason, d.help)
                         : d.severity == Severity::Warning ? moved.warning(d.code, d.span, d.message, d.reason, d.help)
                                                           : moved.note(d.code, d.span, d.message, d.reason, d.help);
      (void)copy;
      break;
    }
  }
  diagnostics.append(moved);
}

/// A function with a jump or a kink in coordinates or time.
bool switches_with_motion(Expr e) {
  const std::vector<Expr> nodes = topological_order({&e, 1});
  return std::any_of(nodes.begin(), nodes.end(), [](const Expr& node) {
    return has_switch(node.kind()) && node.context().depends_on_time(node.id());
  });
}

/// The blanks before the first statement: a line that is indented more would continue it.
std::string indentation(const SourceText& source) {
  Diagnostics silent;
  const syntax::SyntaxTree tree = syntax::parse(source, silent);
  if (tree.statements.empty()) return {};
  const std::uint32_t begin = tree.statements.front().span.begin;
  const LineColumn place = source.locate(begin);
  return std::string(source.text().substr(begin - (place.column - 1), place.column - 1));
}

class MapReader {
 public:
  MapReader(const Model& a, const SourceText& b, const SourceText& map, Diagnostics& diagnostics)
      : a_(a), b_(b), map_(map), diagnostics_(diagnostics), start_(std::string(b.text()) + "\n" + indentation(b)) {}

  std::optional<CoordinateMap> read() {
    assignments();
    names();
    if (diagnostics_.has_errors()) return std::nullopt;
    return formulas();
  }

 private:
  /// Left sides and the extent of right sides, as the grammar of `start` finds them.
  void assignments() {
    std::string text(map_.text());
    for (char& c : text)
      if (c == '\n' || c == '\r') c = ' ';
    if (text.find_first_not_of(" \t") == std::string::npos) return;
    const std::string head = start_ + "start ";
    const SourceText whole("map", head + text + "\n");
    Diagnostics found;
    const syntax::SyntaxTree tree = syntax::parse(whole, found);
    const auto begin = static_cast<std::uint32_t>(head.size());
    take_over(found, {{begin, static_cast<std::uint32_t>(text.size()), 0}}, diagnostics_);
    const auto* statement =
        tree.statements.empty() ? nullptr : std::get_if<syntax::StartStatement>(&tree.statements.back().body);
    if (!statement || tree.statements.back().span.end <= begin) {
      if (!diagnostics_.has_errors()) refuse_form({0, static_cast<std::uint32_t>(text.size())});
      return;
    }
    if (statement->at || statement->exactly) refuse_form({0, static_cast<std::uint32_t>(text.size())});
    for (const auto& item : statement->items) {
      const Span name{item.variable->span.begin - begin, item.variable->span.end - begin};
      const Span value{item.value->span.begin - begin, item.value->span.end - begin};
      const bool member = item.variable->kind == syntax::Expression::Kind::Member;
      if (item.variable->primes) {
        diagnostics_.error("E0824", name, fmt::format("`{}` is a velocity", map_.slice(name)),
                           "A map gives positions; the velocities follow from it by the chain rule.", "Leave it out.");
        continue;
      }
      read_.push_back({member ? syntax::to_string(*item.variable) : item.variable->text, name, value});
    }
  }

  void refuse_form(Span span) {
    diagnostics_.error("E0821", span, "this is no map of coordinates",
                       "A map is a list of coordinates of the first model, each with its value in the second.",
                       "Write for example --map \"x = l sin θ, y = -l cos θ\".");
  }

  void names() {
    std::vector<std::string> known;
    for (const Coordinate& c : a_.system.coordinates) known.push_back(c.name);
    for (const Parameter& p : a_.system.parameters)
      if (p.symbol.role() == Role::Parameter) known.push_back(p.name);
    for (std::size_t i = 0; i < read_.size(); ++i) {
      const Assignment& one = read_[i];
      const std::string first =
          a_.system.name.empty() ? "the first model" : fmt::format("the first model ({})", a_.system.name);
      if (std::find(known.begin(), known.end(), one.name) == known.end()) {
        const std::string near = did_you_mean(one.name, known);
        diagnostics_.error(
            "E0821", one.name_span, fmt::format("`{}` is no coordinate of {}", one.name, first),
            "The left sides are coordinates or parameters of the first model, the right sides formulas of the second.",
            near.empty() ? "If the map goes the other way, exchange the two models."
                         : fmt::format("Did you mean `{}`?", near));
      }
      for (std::size_t k = 0; k < i; ++k)
        if (read_[k].name == one.name)
          diagnostics_.error("E0823", one.name_span, fmt::format("`{}` is mapped twice", one.name),
                             "A coordinate has one value in each configuration.", "Keep one of the two.");
    }
  }

  /// A word that stands nowhere in B, to name the new lets by.
  std::string fresh_word() const {
    std::string word = "mapped";
    while (b_.text().find(word) != std::string_view::npos) word += "x";
    return word;
  }

  std::optional<CoordinateMap> formulas() {
    const std::string word = fresh_word(), indent = start_.substr(b_.text().size() + 1);
    std::string text = std::string(b_.text()) + "\n";
    std::vector<Copied> parts;
    for (std::size_t i = 0; i < read_.size(); ++i) {
      const Span value = read_[i].value_span;
      text += fmt::format("{}let {}{} = ", indent, word, i + 1);
      parts.push_back({static_cast<std::uint32_t>(text.size()), value.end - value.begin, value.begin});
      std::string formula(map_.slice(value));
      for (char& c : formula)
        if (c == '\n' || c == '\r') c = ' ';
      text += formula + "\n";
    }
    const SourceText whole(b_.name(), text);
    Diagnostics found;
    const syntax::SyntaxTree tree = syntax::parse(whole, found);
    auto model = found.has_errors() ? std::nullopt : elaborate(tree, whole, found);
    take_over(found, parts, diagnostics_);
    if (!model || diagnostics_.has_errors()) {
      if (!diagnostics_.has_errors()) refuse_form({0, static_cast<std::uint32_t>(map_.text().size())});
      return std::nullopt;
    }
    CoordinateMap map;
    map.b = std::make_shared<const Model>(std::move(*model));
    for (std::size_t i = 0; i < a_.system.coordinates.size(); ++i) coordinate(map, word, a_.system.coordinates[i]);
    for (const Parameter& p : a_.system.parameters) map.parameters.push_back(parameter(map, word, p));
    return diagnostics_.has_errors() ? std::nullopt : std::optional(std::move(map));
  }

  const Assignment* assignment_of(const std::string& name, std::size_t* index) const {
    for (*index = 0; *index < read_.size(); ++*index)
      if (read_[*index].name == name) return &read_[*index];
    return nullptr;
  }

  static const Definition* definition(const MechanicalSystem& system, const std::string& name) {
    for (const Definition& d : system.definitions)
      if (d.name == name) return &d;
    return nullptr;
  }

  void coordinate(CoordinateMap& map, const std::string& word, const Coordinate& c) {
    const MechanicalSystem& b = map.b->system;
    std::size_t index = 0;
    if (const Assignment* one = assignment_of(c.name, &index)) {
      const Definition* d = definition(b, fmt::format("{}{}", word, index + 1));
      if (!d) throw std::logic_error("a formula of the map was lost; please report");
      map.written.emplace_back(map_.slice(one->value_span));
      map.values.push_back(checked(*d, c, *one));
    } else if (const Coordinate* same = b.find_coordinate(c.name)) {
      map.written.push_back(c.name);
      map.values.push_back(same->q);
    } else if (const Definition* same_let = definition(b, c.name); same_let && !same_let->is_vector) {
      map.written.push_back(c.name);
      map.values.push_back(same_let->value);
    } else {
      diagnostics_.error(
          "E0820", {}, fmt::format("the map does not say what `{}` is", c.name),
          fmt::format("`{}` is a coordinate of the first model, and {} has nothing of that name.", c.name, b.name),
          fmt::format("Add `{} = …` to the map.", c.name));
      map.written.emplace_back();
      map.values.emplace_back();
    }
  }

  Expr checked(const Definition& d, const Coordinate& c, const Assignment& one) {
    if (d.is_vector) {
      diagnostics_.error("E0824", one.value_span, fmt::format("`{}` is mapped to a vector", c.name),
                         "A coordinate is one number.", "Write one component: P.x, P.y.");
      return {};
    }
    for (const Expr& s : symbols_of({&d.value, 1})) {
      if (s.role() != Role::Coordinate || s.order() == 0) continue;
      diagnostics_.error("E0824", one.value_span,
                         fmt::format("`{}` is mapped to something with a velocity in it", c.name),
                         "Two descriptions of one configuration are related by positions and time alone.",
                         "Write the coordinate by coordinates, parameters and t.");
      return {};
    }
    if (switches_with_motion(d.value)) {
      diagnostics_.error(
          "E0824", one.value_span, fmt::format("the map of `{}` has a jump or a kink", c.name),
          "Velocities and accelerations follow from a map by differentiation, so that it has to be smooth.",
          "Write a smooth formula; √(x²) is |x|.");
      return {};
    }
    const bool units = !a_.system.dimensionless && !d.value.is_zero();
    if (units && !d.dimension.same_as(c.dimension)) {
      diagnostics_.error(
          "E0822", one.value_span,
          fmt::format("`{}` is mapped to a quantity of another dimension: {}", c.name, to_string(d.dimension)),
          fmt::format("In the first model `{}` is in {}.", c.name, to_string(c.dimension)),
          "Check the formula: a factor is missing or too much.");
      return {};
    }
    return d.value;
  }

  Expr parameter(const CoordinateMap& map, const std::string& word, const Parameter& p) const {
    if (p.symbol.role() != Role::Parameter) return {};
    std::size_t index = 0;
    if (assignment_of(p.name, &index)) return definition(map.b->system, fmt::format("{}{}", word, index + 1))->value;
    if (const Parameter* same = map.b->system.find_parameter(p.name)) return same->symbol;
    const Definition* d = definition(map.b->system, p.name);
    return d && !d->is_vector && !map.b->system.context->depends_on_time(d->value.id()) ? d->value : Expr();
  }

  const Model& a_;
  const SourceText& b_;
  const SourceText& map_;
  Diagnostics& diagnostics_;
  std::string start_;  // B's text and the indentation of the line that follows it
  std::vector<Assignment> read_;
};

}  // namespace

std::optional<CoordinateMap> read_map(const Model& a, const SourceText& b, const SourceText& map,
                                      Diagnostics& diagnostics) {
  return MapReader(a, b, map, diagnostics).read();
}

}  // namespace maupertuis
