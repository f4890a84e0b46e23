#include "comparison/parametrization.hpp"

#include "comparison/closed_forms.hpp"

#include <maupertuis/print.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis::comparison {
namespace {

/// At a smaller sine of the polar angle the start lies on the axis: another axis is taken.
constexpr double on_the_axis = 0.05;

class Parametrizer {
 public:
  Parametrizer(const Model& model, const EquationsOfMotion& equations, const MotionState& start,
               const std::set<std::string>& keep, bool numbered)
      : model_(model),
        shown_(*equations.shown().system),
        order_(equations.shown().order),
        keep_(keep),
        numbered_(numbered),
        context_(*model.system.context),
        at_(parameter_bindings(model.system)),
        mass_(equations) {
    for (std::size_t i = 0; i < model.system.coordinates.size(); ++i) {
      at_[model.system.coordinates[i].q] = start.q[i];
      at_[model.system.coordinates[i].velocity] = start.v[i];
    }
    at_[context_.time()] = start.t;
    const std::vector<double> m = mass_.mass(start);
    for (std::size_t i = 0, n = start.q.size(); i < n; ++i)
      weight_.push_back(m[i * n + i] > 0 ? std::sqrt(m[i * n + i]) : 1);
  }

  Parametrization run() {
    std::vector<std::size_t> pending;
    for (std::size_t k = 0; k < shown_.constraints.size(); ++k)
      if (shown_.constraints[k].level == Constraint::Level::Position && shown_.constraints[k].body.empty())
        pending.push_back(k);
    while (!pending.empty()) {
      std::stable_sort(pending.begin(), pending.end(),
                       [&](std::size_t a, std::size_t b) { return open_in(a).size() < open_in(b).size(); });
      const auto done = std::find_if(pending.begin(), pending.end(), [&](std::size_t k) {
        return repeated(k) || linear(k) || ellipsoid(k) || line(k);
      });
      if (done == pending.end()) {
        out_.unsolved = pending.front();
        return out_;
      }
      pending.erase(done);
    }
    return out_;
  }

 private:
  double number(Expr e) const { return evaluate(in_terms_of_motion(model_.system, {&e, 1}).front(), at_); }
  AtStart at_start() const {
    return [this](Expr e) { return number(e); };
  }

  Expr relation(std::size_t k) const { return substitute(without_root(shown_.constraints[k].value), out_.values); }

  /// The coordinates of the model that stand in a constraint and are not solved for.
  std::vector<std::size_t> open_in(std::size_t k) const {
    const Expr e = relation(k);
    const std::vector<Expr> symbols = symbols_of({&e, 1});
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < shown_.coordinates.size(); ++i)
      if (std::find(symbols.begin(), symbols.end(), shown_.coordinates[i].q) != symbols.end()) open.push_back(i);
    return open;
  }

  bool depends_on(Expr e, Expr symbol) const {
    const std::vector<Expr> symbols = symbols_of({&e, 1});
    return std::find(symbols.begin(), symbols.end(), symbol) != symbols.end();
  }

  /// The relation for the text: solved coordinates stay as names where they are free of those to be solved for and
  /// move.
  Expr written_relation(std::size_t k, const ExprVector& to_solve) const {
    ExprMap put_in;
    for (const auto& entry : out_.values) {
      const Expr value = entry.second;
      const bool moves = holds_coordinates(value) || holds_time(value);
      const auto is_in_it = [&](Expr x) { return depends_on(value, x); };
      if (!moves || std::any_of(to_solve.begin(), to_solve.end(), is_in_it)) put_in.insert(entry);
    }
    return substitute(without_root(shown_.constraints[k].value), put_in);
  }

  /// The readable form where it is shorter than the formula as it stands.
  Expr in_short(Expr e) const {
    const ReadableForm form = readable(e, order_);
    const bool shorter =
        form.intermediates.empty() && to_plain(form.value, order_).size() <= to_plain(e, order_).size();
    return shorter ? form.value : e;
  }

  std::string label(std::size_t k) const { return model_.system.constraint_label(k); }

  bool repeated(std::size_t k) {
    const Expr e = relation(k);
    if (zero_test(e).verdict != Verdict::Zero) return false;
    out_.repeated.push_back(k);
    return true;
  }

  bool linear(std::size_t k) {
    const Expr e = relation(k);
    std::optional<LinearSolution> best;
    std::size_t best_coordinate = 0;
    double best_merit = 0;
    for (const std::size_t i : open_in(k)) {
      const Coordinate& c = shown_.coordinates[i];
      const auto solution = solve_linear(e, c.q, at_start());
      if (!solution) continue;
      const double merit = std::abs(solution->pivot) / weight_[i] * (keep_.count(c.name) ? 1e-12 : 1);
      if (merit <= best_merit) continue;
      best = solution, best_coordinate = i, best_merit = merit;
    }
    if (!best) return false;
    Solved solved;
    solved.constraint = k;
    solved.dependent = {best_coordinate};
    const auto for_text = solve_linear(written_relation(k, {best->coordinate}), best->coordinate, at_start());
    solved.written = {in_short(for_text ? for_text->value : best->value)};
    solved.sentence = fmt::format("{} is solved for {}", label(k), shown_.coordinates[best_coordinate].name);
    accept(std::move(solved), {best->value});
    return true;
  }

  bool ellipsoid(std::size_t k) {
    ExprVector candidates;
    for (const std::size_t i : open_in(k)) candidates.push_back(shown_.coordinates[i].q);
    constexpr std::size_t most = 8;
    if (candidates.size() > most) return false;
    const auto found = find_ellipsoid(relation(k), candidates, at_start());
    if (!found) return false;
    Ellipsoid for_text = *found;
    if (const auto shorter = find_ellipsoid(written_relation(k, found->coordinates), found->coordinates, at_start()))
      if (shorter->coordinates == found->coordinates) for_text = *shorter;
    Solved solved;
    solved.constraint = k;
    const ExprVector directions = angles(*found, solved);
    ExprVector values;
    std::string names;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const Expr radius = in_short(for_text.radii[i]);
      const Expr centre = in_short(for_text.centre[i]);
      solved.written.push_back(centre + radius * directions[i]);
      values.push_back(found->centre[i] + found->radii[i] * directions[i]);
      solved.dependent.push_back(index_of(found->coordinates[i]));
      names += (i ? ", " : "") + found->coordinates[i].name();
    }
    if (found->round) solved.radius = for_text.radii.front();
    std::string fresh;
    for (const NewCoordinate& c : solved.fresh) fresh += (fresh.empty() ? "" : ", ") + c.name;
    const char* shape = directions.size() == 3 ? (found->round ? "a sphere" : "an ellipsoid")
                        : found->round         ? "a circle"
                                               : "an ellipse";
    solved.sentence = fmt::format("{} is {} in {}: {} in their place", label(k), shape, names, fresh);
    accept(std::move(solved), values);
    return true;
  }

  std::size_t index_of(Expr q) const {
    const auto found = std::find_if(shown_.coordinates.begin(), shown_.coordinates.end(),
                                    [&](const Coordinate& c) { return c.q == q; });
    return static_cast<std::size_t>(found - shown_.coordinates.begin());
  }

  /// A line that turns: the distance along it, from the point nearest to the origin.
  bool line(std::size_t k) {
    ExprVector candidates;
    for (const std::size_t i : open_in(k)) candidates.push_back(shown_.coordinates[i].q);
    const auto found = find_line(relation(k), candidates, at_start());
    if (!found) return false;
    Solved solved;
    solved.constraint = k;
    solved.dependent = {index_of(found->coordinates[0]), index_of(found->coordinates[1])};
    const Coordinate& first = shown_.coordinates[solved.dependent[0]];
    if (!first.dimension.same_as(shown_.coordinates[solved.dependent[1]].dimension)) return false;
    double along = 0;
    for (std::size_t i = 0; i < 2; ++i)
      along += (number(found->coordinates[i]) - number(found->foot[i])) * number(found->direction[i]);
    const std::string kind = first.kind.empty() ? "[" + to_string(first.dimension) + "]" : first.kind;
    const Expr s = add(solved, {free_name("s"), kind, {}, first.dimension, along});
    ExprVector values;
    for (std::size_t i = 0; i < 2; ++i) {
      values.push_back(found->foot[i] + s * found->direction[i]);
      solved.written.push_back(in_short(found->foot[i]) + s * in_short(found->direction[i]));
    }
    solved.sentence = fmt::format("{} is a moving line in {}, {}: {} along it in their place", label(k), first.name,
                                  found->coordinates[1].name(), s.name());
    accept(std::move(solved), values);
    return true;
  }

  /// The unit vector of the direction: (sin θ, −cos θ), θ from the downward vertical, or (sin θ cos φ, sin θ sin φ,
  /// −cos θ) about an axis that the start is away from.
  ExprVector angles(const Ellipsoid& e, Solved& solved) {
    std::vector<double> u;
    for (std::size_t i = 0; i < e.coordinates.size(); ++i)
      u.push_back((number(e.coordinates[i]) - number(e.centre[i])) / number(e.radii[i]));
    if (u.size() == 2) {
      const Expr theta = add_angle(solved, "θ", std::atan2(u[0], -u[1]));
      return {sin(theta), -cos(theta)};
    }
    std::size_t axis = 2;
    if (std::hypot(u[0], u[1]) < on_the_axis) axis = 0;
    const std::size_t first = (axis + 1) % 3, second = (axis + 2) % 3;
    const Expr theta = add_angle(solved, "θ", std::atan2(std::hypot(u[first], u[second]), -u[axis]));
    const Expr phi = add_angle(solved, "φ", std::atan2(u[second], u[first]));
    ExprVector out(3);
    out[first] = sin(theta) * cos(phi);
    out[second] = sin(theta) * sin(phi);
    out[axis] = -cos(theta);
    return out;
  }

  Expr add_angle(Solved& solved, const std::string& letter, double start) {
    const bool pure = model_.system.dimensionless;
    return add(solved,
               {free_name(letter), pure ? "number" : "angle", {}, pure ? Dimension{} : dimensions::angle(), start});
  }

  Expr add(Solved& solved, NewCoordinate c) {
    c.q = context_.symbol(c.name, Role::Coordinate);
    at_[c.q] = c.start;
    solved.fresh.push_back(c);
    out_.fresh.push_back(c);
    return c.q;
  }

  std::string free_name(const std::string& letter) const {
    const auto taken = [&](const std::string& name) {
      const MechanicalSystem& s = model_.system;
      const auto among = [&](const auto& list) {
        return std::any_of(list.begin(), list.end(), [&](const auto& one) { return one.name == name; });
      };
      return among(s.coordinates) || among(s.parameters) || among(s.inputs) || among(s.definitions) ||
             among(s.frames) || among(s.points) || among(s.bodies) || among(s.constraints) || among(s.releases) ||
             among(out_.fresh);
    };
    for (const std::string& stem : {letter, std::string("α"), std::string("β"), std::string("γ"), std::string("ψ")}) {
      if (!numbered_ && !taken(stem)) return stem;
      for (int k = 1; numbered_ && k < 1000; ++k)
        if (const std::string name = stem + std::to_string(k); !taken(name)) return name;
    }
    for (int k = 1;; ++k)
      if (const std::string name = fmt::format("{}_new{}", letter, k); !taken(name)) return name;
  }

  /// The values of all solved coordinates, by the independent ones alone.
  void accept(Solved solved, const ExprVector& values) {
    ExprMap step;
    for (std::size_t i = 0; i < values.size(); ++i) step.emplace(shown_.coordinates[solved.dependent[i]].q, values[i]);
    for (auto& [q, value] : out_.values) value = substitute(value, step);
    out_.values.insert(step.begin(), step.end());
    out_.solved.push_back(std::move(solved));
  }

  const Model& model_;
  const MechanicalSystem& shown_;
  const ReadingOrder& order_;
  const std::set<std::string>& keep_;
  const bool numbered_;
  Context& context_;
  Bindings at_;
  ConstraintManifold mass_;
  std::vector<double> weight_;  // √M_ii
  Parametrization out_;
};

}  // namespace

Parametrization parametrize(const Model& model, const EquationsOfMotion& equations, const MotionState& start,
                            const std::set<std::string>& keep) {
  Parametrization plain = Parametrizer(model, equations, start, keep, false).run();
  const auto rods =
      std::count_if(plain.solved.begin(), plain.solved.end(), [](const Solved& s) { return !s.fresh.empty(); });
  return rods > 1 ? Parametrizer(model, equations, start, keep, true).run() : plain;
}

}  // namespace maupertuis::comparison
