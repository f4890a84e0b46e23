#include "analysis/action/problem.hpp"
#include "analysis/action/shots.hpp"
#include "analysis/action/starts.hpp"
#include "linear_algebra/dense.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/size_of_terms.hpp>
#include <maupertuis/switch_text.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace maupertuis {
namespace {

using namespace action;

constexpr double same_path = 1e-6;   // of the size of the coordinates
constexpr int compared_places = 33;  // places at which paths are compared
/// What a search may cost: iterations of Newton's method times their work, about the number of operations.
constexpr double budget = 2e9;
constexpr std::size_t starts_at_infinity =
    3;  // where L is infinite at an end: what the first do not reach the others do not

bool same(const Trial& a, const Trial& b, const Vector& least, const OrderOfCoordinates& orders) {
  const ActionPath p = to_path(a), q = to_path(b);
  const double begin = p.start, whole = p.end - p.start;
  for (int k = 0; k < compared_places; ++k) {
    const double t = begin + whole * (k + 0.5) / compared_places;
    const MotionState s = p.at(t), r = q.at(t);
    for (const Index i : orders.configurations) {
      const auto at = static_cast<std::size_t>(i);
      if (std::abs(s.q[at] - r.q[at]) > same_path * std::max(least[i], std::abs(s.q[at]))) return false;
    }
  }
  return true;
}

bool check_ends(Problem& problem, const ActionEnds& ends, Diagnostics& diagnostics) {
  const MechanicalSystem& system = problem.model.system;
  const auto span = problem.model.experiment.path ? std::optional(problem.model.experiment.path->span) : std::nullopt;
  if (!check_order(ends.start, ends.end, system, span, diagnostics)) return false;
  if (!system.constrained()) return true;
  const ConstraintManifold manifold(problem.equations);
  for (const bool first : {true, false}) {
    MotionState s{first ? ends.start : ends.end, {}, std::vector<double>(system.coordinates.size())};
    const auto& at = first ? ends.from : ends.to;
    for (const auto& value : at) s.q.push_back(value.value_or(0));
    if (std::any_of(at.begin(), at.end(), [](const auto& x) { return !x; })) continue;
    const std::vector<double> off = manifold.relative_values(s);
    for (std::size_t i = 0; i < off.size(); ++i) {
      if (off[i] < 1e-9) continue;
      diagnostics.error(
          "E1202", span,
          fmt::format("the {} of the path is off {}, by {:.2g} times the size of its terms",
                      first ? "beginning" : "end", system.constraint_label(i), off[i]),
          "Every point of a path has to satisfy the constraints, its ends included.",
          "Move the end onto the constraint, or leave a component `free` that the constraint then fixes.");
      return false;
    }
  }
  return true;
}

class Search {
 public:
  Search(Problem& problem, const ActionEnds& ends, const ActionOptions& options)
      : problem_(problem),
        ends_(ends),
        options_(options),
        fixed_(fixed_of(ends)),
        least_(problem.least(&ends)),
        singular_(problem.singular_ends(ends)) {}

  void run() {
    const bool one = problem_.n() == 1 && ends_.from[0] && ends_.to[0] && problem_.functional.constraints() == 0 &&
                     problem_.functional.integrals() == 0 && !singular_.any();
    if (one)
      from_shots();
    else
      from_bent_lines();
    if (found_.empty()) by_continuation();
  }

  std::vector<std::pair<Refined, std::string>> found_;
  std::size_t starts_ = 0, failed_ = 0;
  std::string bound_;
  const SingularEnds& singular() const { return singular_; }
  const Vector& least() const { return least_; }

 private:
  bool stopped() const { return options_.interrupt && options_.interrupt->load(); }

  /// One start; false where it leads nowhere.
  void attempt(Trial trial, const std::string& name) {
    ++starts_;
    const auto count_failure = [this] { ++failed_; };
    if (!move_onto_constraints(problem_.functional, trial, fixed_, even_scale(trial, least_))) return count_failure();
    guess_multipliers(trial);
    const NewtonOptions newton{40, options_.interrupt};
    const NewtonResult first =
        solve_stationarity(problem_.functional, trial, fixed_, path_scale(trial, least_), newton);
    const auto d = static_cast<double>(problem_.n());
    work_ += first.iterations * static_cast<double>(trial.q.cols()) * (400 + 40 * d * d * d + 60 * d * d);
    if (!first.converged) return count_failure();
    if (known(trial)) return;
    auto refined = refine(problem_.functional, std::move(trial), fixed_, least_, {40, options_.interrupt},
                          !problem_.equations.degenerate);
    if (!refined) return count_failure();
    if (!known(refined->coarse)) found_.emplace_back(std::move(*refined), name);
  }

  /// λ of the integral constraints that balances the gradient best where the nodes are free to move.
  void guess_multipliers(Trial& trial) const {
    const Index k = problem_.functional.integrals(), n = trial.q.rows();
    if (k == 0) return;
    const Assembly a = assemble(problem_.functional, trial, 1);
    if (!a.finite) return;
    const Index inner = a.gradient.size() - 2 * n;
    const Matrix c = a.integral_gradients.middleRows(n, inner);
    const Vector lambda = trial.multipliers - c.colPivHouseholderQr().solve(Vector(a.gradient.segment(n, inner)));
    if (lambda.allFinite()) trial.multipliers = lambda;
  }

  bool known(const Trial& trial) const {
    return std::any_of(found_.begin(), found_.end(), [&](const auto& f) {
      return same(f.first.coarse, trial, least_, problem_.functional.orders());
    });
  }

  void from_bent_lines() {
    std::size_t tried = 0;
    const auto all = starts_between(problem_, ends_);
    for (const Start& s : all) {
      if (stopped() || found_.size() >= options_.paths || work_ > budget ||
          (singular_.any() && tried == starts_at_infinity))
        break;
      attempt(s.trial, s.name);
      ++tried;
    }
    bound_ = fmt::format("Newton's method began from {} of {} lines, straight and bent; others may exist.", tried,
                         all.size());
  }

  void from_shots() {
    const Shots shots = shoot_all(problem_, ends_, options_.interrupt);
    attempt(starts_between(problem_, ends_).front().trial, "the straight line");
    for (const Trial& t : shots.arrivals)
      if (!stopped()) attempt(t, "a shot");
    const MechanicalSystem& system = problem_.model.system;
    bound_ =
        fmt::format("{} shots with |{}'({:g})| up to {:.4g} tell apart no more than these; faster paths may exist.",
                    shots.count, system.coordinates[0].name, ends_.start, shots.fastest);
  }

  /// From a short duration, where the line is nearly stationary, to the whole one.
  void by_continuation() {
    auto all = starts_between(problem_, ends_);
    Trial trial = all.front().trial;
    const double whole = trial.mesh.whole;
    double part = 1.0 / 64, step = part;
    bool any = false;
    for (int turn = 0; turn < 60 && !stopped(); ++turn) {
      Trial next = trial;
      next.mesh.whole = part * whole;
      if (move_onto_constraints(problem_.functional, next, fixed_, even_scale(next, least_)) &&
          solve_stationarity(problem_.functional, next, fixed_, path_scale(next, least_), {25, options_.interrupt})
              .converged) {
        trial = next;
        any = true;
        if (part == 1) break;
        step *= 1.7;
      } else {
        if (!any || step < 1e-3) break;
        part -= step;
        step /= 2;
      }
      part = std::min(1.0, part + step);
    }
    if (trial.mesh.whole == whole)
      attempt(trial, "continuation from a short duration");
    else
      reached_ = any ? part : 0;
  }

  Problem& problem_;
  const ActionEnds& ends_;
  const ActionOptions& options_;
  FixedEnds fixed_;
  Vector least_;
  SingularEnds singular_;
  double work_ = 0;

 public:
  double reached_ = 1;  // of the duration, by continuation
};

constexpr double headroom = 1e4;  // slopes of polynomials at the ends of short elements, over that of a line

/// The ends ask for a speed at which L is no double any more; not where L itself is infinite or has no value.
std::optional<double> speed_beyond_numbers(Problem& problem, const ActionEnds& ends) {
  Vector q(problem.n()), v(problem.n());
  for (Index i = 0; i < problem.n(); ++i) {
    const auto &a = ends.from[static_cast<std::size_t>(i)], &b = ends.to[static_cast<std::size_t>(i)];
    q[i] = a && b ? *a + (*b - *a) / 2 : a.value_or(b.value_or(0));
    v[i] = a && b ? (*b - *a) / (ends.end - ends.start) : 0;
  }
  const Vector none = Vector::Zero(problem.functional.integrals()), fast = headroom * v,
               rest = Vector::Zero(problem.n());
  const double middle = ends.start + (ends.end - ends.start) / 2;
  Density density;
  problem.functional.evaluate(middle, q.data(), rest.data(), none, 0, density);
  if (!density.finite) return std::nullopt;
  problem.functional.evaluate(middle, q.data(), fast.data(), none, 0, density);
  const bool beyond = std::isinf(density.lagrangian) || !std::isfinite(fast.squaredNorm());
  return beyond ? std::optional(v.lpNorm<Eigen::Infinity>()) : std::nullopt;
}

void refuse_beyond_numbers(double speed, const Problem& problem, const ActionEnds& ends, Diagnostics& diagnostics) {
  const MechanicalSystem& system = problem.model.system;
  const auto span = problem.model.experiment.path ? std::optional(problem.model.experiment.path->span) : std::nullopt;
  const Coordinate& first = system.coordinates.front();
  const std::string unit = system.dimensionless ? "" : to_string(first.dimension / system.independent_dimension);
  const std::string needed =
      std::isfinite(speed) ? "about " + with_unit(speed, system.coordinates.size() == 1 && unit != "1" ? unit : "")
                           : "more than 1e308";
  diagnostics.error("E1209", span,
                    fmt::format("from {} to {} the ends ask for rates beyond the range of numbers",
                                place(ends.start, system), place(ends.end, system)),
                    fmt::format("A straight line between them has rates of {}; products of such rates, of which L is "
                                "made, exceed the largest number, 1.8e308.",
                                needed),
                    "Give ends that are further apart in " + system.independent +
                        ", or nearer in the coordinates, or choose units in which the numbers are moderate.");
}

/// A free end asks for p = ∂L/∂q' = 0 there, in vain where p is the same along all paths, and not 0.
bool refuse_given_momentum(const Problem& problem, const ActionEnds& ends, Diagnostics& diagnostics) {
  const MechanicalSystem& system = problem.model.system;
  if (system.constrained() || problem.functional.integrals() > 0 || problem.functional.orders().higher()) return false;
  constexpr double rounding = 1e-12;  // of the terms of p
  Bindings at = parameter_bindings(system);
  for (const bool first : {true, false})
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
      if ((first ? ends.from : ends.to)[i]) continue;
      const Coordinate& c = system.coordinates[i];
      const Expr p = differentiate(problem.equations.lagrangian_expanded, c.velocity);
      const std::vector<Expr> symbols = symbols_of({&p, 1});
      at[system.context->time()] = first ? ends.start : ends.end;
      if (!std::all_of(symbols.begin(), symbols.end(), [&](const Expr& s) { return at.count(s) > 0; })) continue;
      const double value = evaluate(p, at);
      if (!(std::abs(value) > rounding * evaluate(size_of_terms(p), at)) || !std::isfinite(value)) continue;
      const auto span =
          problem.model.experiment.path ? std::optional(problem.model.experiment.path->span) : std::nullopt;
      diagnostics.error("E1204", span,
                        fmt::format("no path is stationary: {} is free at the {}, and ∂L/∂{}' = {:.6g} there on all of "
                                    "them",
                                    c.name, first ? "beginning" : "end", c.name, value),
                        fmt::format("A shift of that end changes S by p·δq, so that p = ∂L/∂{}' has to vanish at it; "
                                    "here it does not depend on the path.",
                                    c.name),
                        "Fix the end, or leave out of L what is linear in this rate: a total derivative by " +
                            system.independent + " changes no motion.");
      return true;
    }
  return false;
}

/// What was tried in vain.
struct Vain {
  std::size_t starts = 0, left_out = 0;
  double reached = 1;  // of the duration, by continuation
  SingularEnds singular;
};

void refuse_no_path(const Vain& search, Problem& problem, const ActionEnds& ends, Diagnostics& diagnostics) {
  if (const auto speed = speed_beyond_numbers(problem, ends))
    return refuse_beyond_numbers(*speed, problem, ends, diagnostics);
  const auto span = problem.model.experiment.path ? std::optional(problem.model.experiment.path->span) : std::nullopt;
  std::string reason =
      fmt::format("Newton's method on the stationarity of S began from {} line{} between the ends and found no path.",
                  search.starts, search.starts == 1 ? "" : "s");
  if (search.left_out > 0)
    reason += fmt::format(" {} that it led to no motion follows from its own states.",
                          search.left_out == 1 ? "One" : std::to_string(search.left_out));
  if (problem.equations.degenerate)
    reason += " L is degenerate: only ends that fulfil its constraints between states can be joined.";
  if (search.reached > 0 && search.reached < 1)
    reason +=
        fmt::format(" From the path of a short duration it could be followed to {:.3g} of this one.", search.reached);
  const auto is_free = [](const std::optional<double>& x) { return !x; };
  if (std::any_of(ends.from.begin(), ends.from.end(), is_free) || std::any_of(ends.to.begin(), ends.to.end(), is_free))
    reason += " Where an end is free ∂L/∂q' has to vanish as well, which L may not allow.";
  if (search.singular.any()) reason += " L is infinite at an end: an end just beside it may be reached.";
  diagnostics.error("E1204", span,
                    fmt::format("no stationary path from {} to {} was found", place(ends.start, problem.model.system),
                                place(ends.end, problem.model.system)),
                    reason,
                    "The end may not be reachable: beyond what the energy or the constraints allow, where L has no "
                    "value, or conjugate to "
                    "the start, as after half a period of a harmonic oscillator. Try other ends, or another duration.");
}

void warn_of_kinks(const Problem& problem, Diagnostics& diagnostics) {
  if (problem.kinks.empty()) return;
  const std::string where = switch_text(problem.kinks.front(), problem.equations.order);
  diagnostics.warning(
      "W1202", {},
      fmt::format("L has a kink{}: paths through it may be missing", where.empty() ? "" : " where " + where),
      "The search follows L by its derivatives, which jump there, so that it does not reach all paths that pass the "
      "kink: one of a smaller action may be among them.",
      "A smooth function, as sqrt(x^2 + d^2) for abs(x), has all its paths found as others have.");
}

/// The same ends with each angle that is fixed at both some whole turns further.
std::vector<std::pair<ActionEnds, std::vector<int>>> with_turns(const ActionEnds& ends, const MechanicalSystem& system,
                                                                std::size_t turns) {
  std::vector<std::pair<ActionEnds, std::vector<int>>> out{{ends, std::vector<int>(ends.to.size(), 0)}};
  for (std::size_t i = 0; i < ends.to.size(); ++i) {
    if (system.coordinates[i].kind != "angle" || !ends.to[i]) continue;
    for (int k = 1; k <= static_cast<int>(turns); ++k)
      for (const int s : {k, -k}) {
        auto next = out.front();
        *next.first.to[i] += 2 * std::numbers::pi * s;
        next.second[i] = s;
        out.push_back(std::move(next));
      }
  }
  return out;
}

/// The paths that leave S as it is along a variation, and share S with another such path: as members of one family do.
std::size_t members_of_families(const std::vector<StationaryPath>& paths) {
  const auto shares = [](const StationaryPath& a, const StationaryPath& b) {
    return &a != &b && a.second.nullity > 0 && b.second.nullity > 0 &&
           std::abs(a.action - b.action) <= a.action_error + b.action_error;
  };
  return static_cast<std::size_t>(std::count_if(paths.begin(), paths.end(), [&](const StationaryPath& a) {
    return std::any_of(paths.begin(), paths.end(), [&](const StationaryPath& b) { return shares(a, b); });
  }));
}

}  // namespace

std::optional<PathSearch> stationary_paths(const Model& model, const EquationsOfMotion& equations,
                                           const ActionEnds& ends, const ActionOptions& options,
                                           Diagnostics& diagnostics) {
  if (!has_action(equations, diagnostics)) return std::nullopt;
  Problem problem(model, equations);
  if (!check_ends(problem, ends, diagnostics)) return std::nullopt;
  if (refuse_given_momentum(problem, ends, diagnostics)) return std::nullopt;
  PathSearch out;
  out.ends = ends;
  std::size_t left_out = 0;
  for (const auto& [aim, turns] : with_turns(ends, model.system, options.turns)) {
    Search search(problem, aim, options);
    search.run();
    if (interrupted(options, diagnostics)) return std::nullopt;
    out.starts += search.starts_;
    out.failed += search.failed_;
    out.bound = search.bound_;
    if (search.found_.empty() && options.turns == 0) {
      refuse_no_path({search.starts_, 0, search.reached_, search.singular()}, problem, ends, diagnostics);
      return std::nullopt;
    }
    std::sort(search.found_.begin(), search.found_.end(),
              [](const auto& a, const auto& b) { return a.first.action < b.first.action; });
    if (search.found_.size() > options.paths) {
      out.bound = fmt::format("{} paths were found, of which the {} with the smallest action are shown. {}",
                              search.found_.size(), options.paths, search.bound_);
      search.found_.resize(options.paths);
    }
    for (const auto& [refined, name] : search.found_) {
      StationaryPath path = describe(problem, refined, aim, search.singular(), options, diagnostics);
      if (interrupted(options, diagnostics)) return std::nullopt;
      if (path.check.done && path.check.missed > largest_miss) {
        ++left_out;
        continue;
      }
      path.found_from = name;
      path.turns = turns;
      out.paths.push_back(std::move(path));
    }
  }
  if (const std::size_t members = members_of_families(out.paths); members > 0)
    out.bound += fmt::format(
        " {} of them have a variation that leaves S as it is, and the same S as another one: members of a family of "
        "stationary paths, whose number says nothing.",
        members);
  if (left_out > 0)
    out.bound +=
        fmt::format(" {} more {} left out: the motion, carried from {} own states, does not follow {}.", left_out,
                    left_out == 1 ? "was" : "were", left_out == 1 ? "its" : "their", left_out == 1 ? "it" : "them");
  if (out.paths.empty()) {
    refuse_no_path({out.starts, left_out, 1, problem.singular_ends(ends)}, problem, ends, diagnostics);
    return std::nullopt;
  }
  std::stable_sort(out.paths.begin(), out.paths.end(),
                   [](const auto& a, const auto& b) { return a.action < b.action; });
  warn_of_kinks(problem, diagnostics);
  return out;
}

}  // namespace maupertuis
