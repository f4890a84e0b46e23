#include "comparison/rewrite.hpp"

#include "comparison/text_edits.hpp"

#include <maupertuis/print.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis::comparison {
namespace {

using namespace syntax;

/// A call of reaction or multiplier about one of the names.
bool asks_for(const ExpressionPtr& e, const char* function, const std::set<std::string>& about) {
  if (!e) return false;
  if (e->kind == syntax::Expression::Kind::Call && e->text == function && !e->arguments.empty() &&
      about.count(e->arguments[0]->text))
    return true;
  return std::any_of(e->arguments.begin(), e->arguments.end(),
                     [&](const ExpressionPtr& a) { return asks_for(a, function, about); });
}

class Rewriter {
 public:
  Rewriter(const Model& model, const EquationsOfMotion& equations, const SyntaxTree& tree, const SourceText& source,
           const Parametrization& parametrization, const std::vector<StartLine>& start)
      : model_(model),
        order_(equations.shown().order),
        tree_(tree),
        source_(source),
        p_(parametrization),
        start_(start),
        text_(source) {
    for (const Solved& s : p_.solved)
      for (const std::size_t i : s.dependent) gone_.insert(model.system.coordinates[i].name);
  }

  Rewritten run() {
    constraints();
    for (const Statement& s : tree_.statements) statement(s);
    if (!start_written_ && !start_.empty()) text_.append("start " + start_items());
    return {text_.applied(), left_out_};
  }

 private:
  std::string slice(Span span) const { return std::string(source_.slice(span)); }
  std::string plain(Expr e) const { return to_plain(e, order_); }
  /// As it is written in a formula, where the unit of a quantity stands in brackets: `1 N` as `1 [N]`.
  std::string in_formula(const Expression& x) const {
    if (x.kind == Expression::Kind::Unary) return "-" + in_formula(*x.arguments[0]);
    if (x.kind != Expression::Kind::Quantity || x.unit_bracketed) return slice(x.span);
    const Span number = x.arguments[0]->span;
    std::string unit = slice({number.end, x.span.end, x.span.source});
    unit.erase(0, unit.find_first_not_of(' '));
    return fmt::format("{} [{}]", slice(number), unit);
  }

  // ---------------------------------------------------------------------------------------- statements
  void statement(const Statement& s) {
    if (const auto* coord = std::get_if<CoordStatement>(&s.body)) coordinates(s.span, *coord);
    if (const auto* force = std::get_if<ForceStatement>(&s.body)) force_on_coordinate(s.span, *force);
    if (const auto* spring = std::get_if<TorsionSpringStatement>(&s.body)) torsion(s.span, *spring);
    if (const auto* start = std::get_if<StartStatement>(&s.body)) starts(s.span, *start);
    if (const auto* expect = std::get_if<ExpectStatement>(&s.body)) expectation(s.span, *expect);
    if (const auto* draw = std::get_if<DrawStatement>(&s.body)) drawing(s.span, *draw);
    if (std::holds_alternative<PathStatement>(s.body) && !gone_.empty())
      leave_out(s.span);  // its ends are given in other coordinates
  }

  void leave_out(Span span) {
    left_out_.push_back(slice(span));
    text_.remove_line(span);
  }

  /// `coord x, y : length` → `coord θ : angle` and `let x = …, y = …` below it.
  void coordinates(Span span, const CoordStatement& s) {
    const auto is_gone = [&](const CoordStatement::Item& item) { return gone_.count(item.name.text) != 0; };
    if (std::none_of(s.items.begin(), s.items.end(), is_gone)) return;
    std::vector<std::pair<std::string, std::string>> kept;  // name, kind
    for (const CoordStatement::Item& item : s.items)
      if (!is_gone(item)) kept.emplace_back(item.name.text, item.unit ? unit_text(*item.unit) : item.kind.text);
    for (const Solved& solved : p_.solved)
      if (!solved.fresh.empty() && std::any_of(s.items.begin(), s.items.end(),
                                               [&](const auto& item) { return item.name.text == first_name(solved); }))
        for (const NewCoordinate& c : solved.fresh) kept.emplace_back(c.name, c.kind);
    std::string text;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      text += (i ? ", " : "coord ") + kept[i].first;
      if (i + 1 == kept.size() || kept[i + 1].second != kept[i].second) text += " : " + kept[i].second;
    }
    std::string lets;
    for (const Solved& solved : p_.solved)
      if (std::any_of(s.items.begin(), s.items.end(),
                      [&](const auto& item) { return item.name.text == first_name(solved); }))
        lets += (lets.empty() ? "let " : "\nlet ") + definitions(solved);
    if (text.empty()) {
      text_.replace(span, lets);
      return;
    }
    text_.replace(span, text);
    if (!lets.empty()) text_.insert_below(span, lets);
  }

  const std::string& first_name(const Solved& s) const { return model_.system.coordinates[s.dependent.front()].name; }

  std::string unit_text(const UnitExpression& unit) const {
    const std::string text = slice(unit.span);  // with or without its brackets
    return !text.empty() && text.front() == '[' ? text : "[" + text + "]";
  }

  std::string definitions(const Solved& solved) const {
    std::string out;
    for (std::size_t i = 0; i < solved.dependent.size(); ++i)
      out += fmt::format("{}{} = {}", i ? ", " : "", model_.system.coordinates[solved.dependent[i]].name,
                         plain(solved.written[i]));
    return out;
  }

  /// Rods of a parameter's length live on as releases where the energies come from points.
  void constraints() {
    std::vector<const Statement*> statements;
    for (const Statement& s : tree_.statements)
      if (std::holds_alternative<ConstraintStatement>(s.body)) statements.push_back(&s);
    const auto statement_of = [&](std::size_t k) {
      const Span span = model_.system.constraints[k].span;
      const auto found =
          std::find_if(statements.begin(), statements.end(), [&](const Statement* s) { return s->span == span; });
      if (found == statements.end()) throw std::logic_error("a constraint without its line; please report");
      return *found;
    };
    for (const std::size_t k : p_.repeated) drop(*statement_of(k), k);
    for (const Solved& solved : p_.solved) {
      const Statement& s = *statement_of(solved.constraint);
      const std::string& name = model_.system.constraints[solved.constraint].name;
      if (!name.empty()) no_multiplier_.insert(name);
      if (!name.empty() && can_be_released(solved.radius, s))
        text_.replace(s.span, fmt::format("reaction {} = release {}", name, solved.radius.name()));
      else
        drop(s, solved.constraint);
    }
  }

  void drop(const Statement& s, std::size_t k) {
    const std::string& name = model_.system.constraints[k].name;
    if (!name.empty()) no_reaction_.insert(name), no_multiplier_.insert(name);
    text_.remove_line(s.span);
  }

  bool can_be_released(Expr radius, const Statement& own) const {
    if (!radius || !radius.is_symbol() || radius.role() != Role::Parameter) return false;
    for (const EnergyTerm& term : model_.system.kinetic)
      if (term.origin == "T") return false;  // the given T does not say how it grows with the length's velocity
    if (model_.system.lagrangian_given) return false;
    for (const AppliedForce& force : model_.system.forces)
      if (force.kind == AppliedForce::Kind::Generalized) return false;  // its work on the length would be lost
    const Parameter* p = model_.system.find_parameter(radius.name());
    if (!p) return false;
    // Elsewhere the length would be released too.
    for (const Constraint& c : model_.system.constraints)
      if (!(c.span == own.span) && stands_in(radius, c.value)) return false;
    for (const Point& point : model_.system.points)
      for (const Expr& x : point.position)
        if (stands_in(radius, x)) return false;
    for (const EnergyTerm& term : model_.system.potential)
      if (stands_in(radius, term.value)) return false;
    return true;
  }

  static bool stands_in(Expr symbol, Expr e) {
    const std::vector<Expr> symbols = symbols_of({&e, 1});
    return std::find(symbols.begin(), symbols.end(), symbol) != symbols.end();
  }

  /// Q_x x' = Σ Q_x ∂x/∂q q'.
  void force_on_coordinate(Span span, const ForceStatement& s) {
    if (s.target != ForceStatement::Target::Coordinate || !gone_.count(s.on.text)) return;
    const Expr value = p_.values.at(model_.system.find_coordinate(s.on.text)->q);
    std::string lines;
    for (const Expr& q : symbols_of({&value, 1})) {
      if (q.role() != Role::Coordinate) continue;
      const ReadableForm slope = readable(differentiate(value, q), order_);
      const Expr shown = slope.intermediates.empty() ? slope.value : differentiate(value, q);
      lines += fmt::format("{}force {} = ({}) ({})", lines.empty() ? "" : "\n", q.name(), in_formula(*s.value),
                           plain(shown));
    }
    if (lines.empty())
      text_.remove_line(span);
    else
      text_.replace(span, lines);
  }

  void torsion(Span span, const TorsionSpringStatement& s) {
    if (!gone_.count(s.coordinate.text)) return;
    const std::string stretch =
        s.rest ? fmt::format("({} - ({}))", s.coordinate.text, in_formula(*s.rest)) : s.coordinate.text;
    text_.replace(span, fmt::format("V += 1/2 ({}) {}^2", in_formula(*s.stiffness), stretch));
  }

  // --------------------------------------------------------------------------------------------- start
  void starts(Span span, const StartStatement& s) {
    std::string items;
    if (s.at) items = "at " + slice(s.at->span);
    for (const StartStatement::Item& item : s.items) {
      if (gone_.count(to_string_without_primes(*item.variable))) continue;
      items += (items.empty() ? "" : ", ") + slice(item.variable->span) + " = " + slice(item.value->span);
    }
    if (!start_written_ && !start_.empty()) items += (items.empty() ? "" : ", ") + start_items();
    start_written_ = true;
    if (items.empty())
      text_.remove_line(span);
    else
      text_.replace(span, fmt::format("start {}{}", s.exactly ? "exactly " : "", items));
  }

  static std::string to_string_without_primes(const syntax::Expression& e) {
    return e.kind == syntax::Expression::Kind::Name ? e.text : syntax::to_string(e);
  }

  std::string start_items() const {
    std::string out;
    for (const StartLine& line : start_)
      out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", line.name, quantity(line));
    return out;
  }

  /// Angles in degrees where that is a short number; all else in SI, all digits.
  std::string quantity(const StartLine& line) const {
    if (model_.system.dimensionless || line.value == 0) return fmt::format("{}", line.value);
    if (line.dimension == dimensions::angle()) {
      const double degrees = line.value * 180 / std::acos(-1.0), shorter = std::round(degrees * 1e8) / 1e8;
      if (std::abs(degrees - shorter) <= 1e-13 * std::abs(degrees)) return fmt::format("{} deg", shorter);
    }
    const std::string unit = maupertuis::to_string(line.dimension);
    return unit == "1" ? fmt::format("{}", line.value) : fmt::format("{} {}", line.value, unit);
  }

  // ------------------------------------------------------------------------------ expectations, drawing
  bool asks_for_lost_force(const ExpressionPtr& e) const {
    return asks_for(e, "reaction", no_reaction_) || asks_for(e, "multiplier", no_multiplier_);
  }

  /// Points are given in the coordinates that there were.
  bool names_gone(const syntax::expectation::Point& point) const {
    return std::any_of(point.begin(), point.end(), [&](const StartStatement::Item& item) {
      return gone_.count(to_string_without_primes(*item.variable)) != 0;
    });
  }

  bool is_lost(const syntax::expectation::ValueAt& x) const { return asks_for_lost_force(x.subject); }
  bool is_lost(const syntax::expectation::ValueAtUntil& x) const { return asks_for_lost_force(x.subject); }
  bool is_lost(const syntax::expectation::ConservedAlongRun& x) const { return asks_for_lost_force(x.subject); }
  bool is_lost(const syntax::expectation::Conserved& x) const {
    return asks_for_lost_force(x.subject) || (!x.where.empty() && !gone_.empty());
  }
  bool is_lost(const syntax::expectation::NotConserved& x) const { return asks_for_lost_force(x.subject); }
  bool is_lost(const syntax::expectation::Integral& x) const { return asks_for_lost_force(x.subject); }
  bool is_lost(const syntax::expectation::Equation& x) const {
    return asks_for_lost_force(x.left) || asks_for_lost_force(x.right);
  }
  bool is_lost(const syntax::expectation::ConstraintClass& x) const {
    return no_multiplier_.count(x.constraint.text) || no_reaction_.count(x.constraint.text);
  }
  // Other coordinates have other momenta, matrices and paths.
  bool is_lost(const syntax::expectation::Hamiltonian&) const { return true; }
  bool is_lost(const syntax::expectation::Routhian&) const { return true; }
  bool is_lost(const syntax::expectation::Bracket&) const { return true; }
  bool is_lost(const syntax::expectation::PhaseConstraints&) const { return true; }
  bool is_lost(const syntax::expectation::ClassCount&) const { return true; }
  bool is_lost(const syntax::expectation::Matrix&) const { return !gone_.empty(); }
  bool is_lost(const syntax::expectation::Action&) const { return !gone_.empty(); }
  bool is_lost(const syntax::expectation::ActionAlong&) const { return !gone_.empty(); }
  bool is_lost(const syntax::expectation::MorseIndex&) const { return !gone_.empty(); }
  bool is_lost(const syntax::expectation::PathAt& x) const { return !gone_.empty() || asks_for_lost_force(x.subject); }
  bool is_lost(const syntax::expectation::Frequencies& x) const { return names_gone(x.at); }
  bool is_lost(const syntax::expectation::Eigenvalues& x) const { return names_gone(x.at); }
  bool is_lost(const syntax::expectation::Stable& x) const { return names_gone(x.at); }
  bool is_lost(const syntax::expectation::Equilibrium& x) const {
    return std::any_of(x.at.begin(), x.at.end(),
                       [&](const syntax::expectation::Place& place) { return names_gone({place.value}); });
  }
  bool is_lost(const syntax::expectation::UntilAt&) const { return false; }
  bool is_lost(const syntax::expectation::EnergyConserved&) const { return false; }
  bool is_lost(const syntax::expectation::Freedoms&) const { return false; }
  bool is_lost(const syntax::expectation::Multipliers&) const { return false; }
  bool is_lost(const syntax::expectation::Trace&) const { return false; }
  bool is_lost(const syntax::expectation::Period&) const { return false; }
  bool is_lost(const syntax::expectation::Event&) const { return false; }
  bool is_lost(const syntax::expectation::EventCount&) const { return false; }
  bool is_lost(const syntax::expectation::Error&) const { return false; }
  bool is_lost(const syntax::expectation::OfField&) const { return true; }

  void expectation(Span span, const ExpectStatement& s) {
    if (std::visit([&](const auto& x) { return is_lost(x); }, s.kind)) leave_out(span);
  }

  void drawing(Span span, const DrawStatement& s) {
    std::string items;
    bool lost = false;
    for (const DrawItem& item : s.items) {
      const bool asks = std::any_of(item.path.begin(), item.path.end(),
                                    [&](const ExpressionPtr& e) { return asks_for(e, "reaction", no_reaction_); });
      lost = lost || asks;
      if (!asks) items += (items.empty() ? "" : ", ") + slice(item.span);
    }
    if (!lost) return;
    if (items.empty())
      text_.remove_line(span);
    else
      text_.replace(span, "draw " + items);
  }

  const Model& model_;
  const ReadingOrder& order_;
  const SyntaxTree& tree_;
  const SourceText& source_;
  const Parametrization& p_;
  const std::vector<StartLine>& start_;
  std::set<std::string> gone_, no_reaction_, no_multiplier_;
  TextEdits text_;
  std::vector<std::string> left_out_;
  bool start_written_ = false;
};

}  // namespace

Rewritten rewrite(const Model& model, const EquationsOfMotion& equations, const syntax::SyntaxTree& tree,
                  const SourceText& source, const Parametrization& parametrization,
                  const std::vector<StartLine>& start) {
  return Rewriter(model, equations, tree, source, parametrization, start).run();
}

std::set<std::string> driven_coordinates(const syntax::SyntaxTree& tree) {
  std::set<std::string> out;
  for (const Statement& s : tree.statements) {
    if (const auto* force = std::get_if<ForceStatement>(&s.body))
      if (force->target == ForceStatement::Target::Coordinate) out.insert(force->on.text);
    if (const auto* spring = std::get_if<TorsionSpringStatement>(&s.body)) out.insert(spring->coordinate.text);
    if (const auto* start = std::get_if<StartStatement>(&s.body))
      for (const StartStatement::Item& item : start->items) out.insert(item.variable->text);
  }
  return out;
}

}  // namespace maupertuis::comparison
