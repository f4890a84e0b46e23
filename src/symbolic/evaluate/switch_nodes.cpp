#include "symbolic/evaluate/switch_nodes.hpp"

#include "symbolic/evaluate/real_numbers.hpp"
#include "symbolic/transform/rebuild.hpp"

#include <maupertuis/kinds.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <unordered_map>

namespace maupertuis::evaluation {

Expr difference_of(Expr node) {
  if (node.is(Kind::Abs) || node.is(Kind::Sign) || node.is(Kind::Step)) return node[0];
  const bool compares = node.is(Kind::Min) || node.is(Kind::Max) || node.is(Kind::Less) || node.is(Kind::LessEqual);
  return compares ? node[1] - node[0] : Expr();
}

Expr opposite(Expr g) {
  if (!g.is(Kind::Sum)) return -g;
  std::vector<Expr> terms;
  for (std::size_t i = 0; i < g.size(); ++i) terms.push_back(-g[i]);
  return g.context().sum(terms);
}

namespace {

constexpr double on_the_switch = 1e-9;

/// The nodes of a tape at a point, each when it is asked for: of a long table the conditions up to the piece in force.
class ValuesAt {
 public:
  explicit ValuesAt(const Tape& tape)
      : tape_(tape),
        numbers_([this](Expr symbol) { return point_->at(symbol); }),
        values_(tape.size(), 0.0),
        known_(tape.size(), false) {}
  ValuesAt(const ValuesAt&) = delete;

  /// Numbers keep their values.
  void move_to(const Bindings& point) {
    point_ = &point;
    for (const Position at : found_) known_[at] = false;
    found_.clear();
  }
  double operator[](Position at) {
    if (!known_[at]) find(at);
    return values_[at];
  }

 private:
  /// Arguments first, whose positions are smaller.
  void find(Position root) {
    needed_.assign(1, root);
    known_[root] = true;
    for (std::size_t k = 0; k < needed_.size(); ++k)
      for (const Position argument : tape_.arguments(needed_[k])) {
        if (known_[argument]) continue;
        known_[argument] = true;
        needed_.push_back(argument);
      }
    std::sort(needed_.begin(), needed_.end());
    for (const Position at : needed_) {
      run_node(tape_, numbers_, at, values_);
      if (tape_.kind(at) != Kind::Number) found_.push_back(at);
    }
  }

  const Tape& tape_;
  const Bindings* point_ = nullptr;
  RealNumbers<double> numbers_;
  std::vector<double> values_;
  std::vector<bool> known_;
  std::vector<Position> found_, needed_;
};

/// What the values of a tape at two points decide, and what is left of its nodes.
class Decisions {
 public:
  Decisions(const Tape& tape, const std::vector<bool>& switching, ValuesAt& from, ValuesAt& to)
      : tape_(tape), switching_(switching), from_(from), to_(to) {}

  Expr in_force(Position at) {
    const Expr e = tape_.expression(at);
    if (!switching_[at]) return e;
    if (const auto known = built_.find(at); known != built_.end()) return known->second;
    const Expr out = build(at, e);
    built_.emplace(at, out);
    return out;
  }

 private:
  Expr build(Position at, Expr e) {
    switch (family_of(tape_.kind(at))) {
      case Family::Switch:
        return of_one_argument(at, e);
      case Family::Extremum:
        if (const auto side = sign(tape_.argument(at, 1), tape_.argument(at, 0)))
          return in_force(tape_.argument(at, (*side > 0) == e.is(Kind::Min) ? 0 : 1));
        break;
      case Family::Piecewise:
        return piecewise(at, e);
      case Family::Leaf:
      case Family::Algebra:
      case Family::Function:
      case Family::Angle:
      case Family::Comparison:
      case Family::Logic:
      case Family::TimeDerivative:
        break;
    }
    return with_arguments_in_force(at, e);
  }

  Expr with_arguments_in_force(Position at, Expr e) {
    std::unordered_map<NodeId, Expr> arguments;
    for (const Position argument : tape_.arguments(at))
      arguments.emplace(tape_.expression(argument).id(), in_force(argument));
    return rebuild(e, [&](Expr argument) { return arguments.at(argument.id()); });
  }

  Expr of_one_argument(Position at, Expr e) {
    const Position x = tape_.argument(at, 0);
    const int side = sign_at(x, from_);
    if (side == 0 || side != sign_at(x, to_)) return with_arguments_in_force(at, e);
    const Expr argument = in_force(x);
    const bool above = side > 0;
    if (e.is(Kind::Abs)) return above ? argument : -argument;
    return e.context().number(above ? 1 : e.is(Kind::Sign) ? -1 : 0);
  }

  Expr piecewise(Position at, Expr e) {
    std::vector<Expr> kept;
    std::size_t i = 0;
    for (; i + 1 < e.size(); i += 2) {
      const auto condition = holds(tape_.argument(at, i));
      if (condition && *condition) break;
      if (!condition)
        kept.push_back(in_force(tape_.argument(at, i))), kept.push_back(in_force(tape_.argument(at, i + 1)));
    }
    kept.push_back(in_force(tape_.argument(at, i + 1 < e.size() ? i + 1 : i)));
    return kept.size() == 1 ? kept.front() : e.context().function(Kind::Piecewise, kept);
  }

  /// What a sum came from: rounding is measured by that.
  double size(Position at, ValuesAt& values) const {
    if (tape_.kind(at) != Kind::Sum) return std::abs(values[at]);
    double sum = 0;
    for (const Position term : tape_.arguments(at)) sum += std::abs(values[term]);
    return sum;
  }

  /// 0: none that is certain.
  static int certain_sign(double x, double size) { return std::abs(x) > on_the_switch * size ? (x > 0 ? 1 : -1) : 0; }
  int sign_at(Position x, ValuesAt& values) const { return certain_sign(values[x], size(x, values)); }

  std::optional<int> sign(Position a, Position b) {
    const auto at = [&](ValuesAt& v) { return certain_sign(v[a] - v[b], size(a, v) + size(b, v)); };
    const int side = at(from_);
    return side != 0 && side == at(to_) ? std::optional<int>(side) : std::nullopt;
  }

  std::optional<bool> holds(Position condition) {
    const Position a = tape_.argument(condition, 0), b = tape_.argument(condition, 1);
    if (family_of(tape_.kind(condition)) == Family::Comparison) {
      const auto side = sign(a, b);
      return side ? std::optional<bool>(*side < 0) : std::nullopt;
    }
    const auto first = holds(a), second = holds(b);
    const bool decisive = tape_.kind(condition) == Kind::Or;  // `true` decides an or, `false` an and
    if ((first && *first == decisive) || (second && *second == decisive)) return decisive;
    return first && second ? std::optional<bool>(!decisive) : std::nullopt;
  }

  const Tape& tape_;
  const std::vector<bool>& switching_;
  ValuesAt &from_, &to_;
  std::unordered_map<Position, Expr> built_;
};

}  // namespace

struct Branches::Points {
  explicit Points(const Tape& tape) : from(tape), to(tape) {}
  ValuesAt from, to;
};

Branches::Branches(std::vector<Expr> functions)
    : functions_(std::move(functions)),
      tape_(std::make_unique<const Tape>(functions_)),
      switching_(tape_->size()),
      points_(std::make_unique<Points>(*tape_)) {
  for (Position at = 0; at < tape_->size(); ++at) {
    const auto arguments = tape_->arguments(at);
    switching_[at] = has_switch(tape_->kind(at)) ||
                     std::any_of(arguments.begin(), arguments.end(), [&](Position below) { return switching_[below]; });
  }
}

Branches::~Branches() = default;
Branches::Branches(Branches&&) noexcept = default;
Branches& Branches::operator=(Branches&&) noexcept = default;

std::vector<Expr> Branches::in_force(const Bindings& from, const Bindings& to) {
  points_->from.move_to(from), points_->to.move_to(to);
  Decisions decisions(*tape_, switching_, points_->from, points_->to);
  std::vector<Expr> out;
  for (const Position root : tape_->roots()) out.push_back(decisions.in_force(root));
  return out;
}

}  // namespace maupertuis::evaluation
