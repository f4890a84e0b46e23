#include "comparison/cross_check.hpp"
#include "comparison/differences.hpp"
#include "comparison/domains.hpp"
#include "comparison/freedoms.hpp"

#include <fmt/format.h>

#include <cmath>
#include <tuple>

/// The proof in its order: constraints of A, equations of A, freedoms; then energies and runs.
namespace maupertuis {
namespace {

using comparison::Differences;
using comparison::Motions;
using comparison::PullBack;

class Comparer {
 public:
  Comparer(const Model& a, const EquationsOfMotion& a_equations, const CoordinateMap& map,
           const EquationsOfMotion& b_equations, const ComparisonOptions& options, const PullBack& pull_back)
      : a_(a),
        b_(*map.b),
        a_equations_(a_equations),
        b_equations_(b_equations),
        options_(options),
        pull_back_(pull_back),
        motions_(b_, b_equations),
        runs_(a, a_equations, b_, b_equations, pull_back, motions_, options.simulation) {
    std::tie(out_.name_a, out_.name_b) = comparison::names_of(a.system, b_.system);
  }

  Comparison carry_out() {
    if (motions_.states().empty()) {
      out_.reason = fmt::format("{} has no consistent start to look at", out_.name_b);
      return out_;
    }
    comparison::count_freedoms(a_equations_, b_equations_, pull_back_, motions_, out_);
    if (constraints_hold() && equations_hold()) compare_freedoms();
    if (out_.verdict == Sameness::Same) compare_domains();
    out_.energies = compare_energies();
    if (off_constraints_) {
      out_.run.reason = "the mapped start does not obey the constraints of " + out_.name_a;
      return out_;
    }
    if (out_.verdict == Sameness::Different)
      out_.disagreement = runs_.disagreement(motions_.states_in_branches(differing_));
    if (options_.run) out_.run = runs_.run();
    doubt_what_runs_contradict();
    return out_;
  }

 private:
  /// States near the start do not see a branch of an inverse function that is left later.
  void doubt_what_runs_contradict() {
    constexpr double apart = 1e-3;
    if (out_.verdict != Sameness::Same || out_.ground.error_bound < 1 || !(out_.run.difference > apart)) return;
    out_.verdict = Sameness::Undecided;
    out_.reason = fmt::format("near the start the equations agree to 60 digits, but the runs are apart at t = {:.6g} s",
                              out_.run.time);
  }

  /// True and the ground where the functions vanish along B; else the verdict with its reason. `what(k)` names function
  /// k.
  template <class What>
  bool hold(const ExprVector& functions, ZeroTest test, What what) {
    if (test.verdict == Verdict::Nonzero) {
      const ZeroTest at_values = motions_.vanish_at_these_values(functions);
      if (at_values.verdict == Verdict::Zero) {
        test = at_values;
        out_.parameters = motions_.at_points(functions).verdict == Verdict::Zero ? Comparison::Parameters::NearThese
                                                                                 : Comparison::Parameters::TheseAlone;
      }
    }
    merge(test);
    if (test.verdict == Verdict::Zero) return true;
    out_.verdict = test.verdict == Verdict::Nonzero ? Sameness::Different : Sameness::Undecided;
    differing_ = functions;
    if (test.verdict == Verdict::Undecided) {
      out_.reason = test.reason.empty() ? "the zero test came to no answer" : test.reason;
      return false;
    }
    for (std::size_t k = 0; k < functions.size(); ++k)
      if (motions_.vanish({&functions[k], 1}).verdict == Verdict::Nonzero) {
        out_.reason = what(k);
        return false;
      }
    out_.reason = what(0);
    return false;
  }

  /// Both grounds together: the weaker bound; points only where some were needed.
  void merge(const ZeroTest& test) {
    const ZeroTest before = out_.ground;
    out_.ground = test;
    if (!merged_) {
      merged_ = true;
      return;
    }
    out_.ground.error_bound = std::max(before.error_bound, test.error_bound);
    out_.ground.points = before.points == 0 || test.points == 0 ? std::max(before.points, test.points)
                                                                : std::min(before.points, test.points);
  }

  bool constraints_hold() {
    const ExprVector mapped = comparison::mapped_constraints(a_.system, pull_back_);
    return mapped.empty() || hold(mapped, motions_.constraints_vanish(mapped), [&](std::size_t k) {
             off_constraints_ = true;
             return fmt::format("the motions of {} do not obey {} of {}: {}", out_.name_b,
                                a_.system.constraint_label(k), out_.name_a, violation(mapped[k]));
           });
  }

  /// The state at which left − right is largest.
  std::string violation(Expr value) const {
    double worst = 0;
    const MotionState* where = &motions_.states().front();
    for (const MotionState& state : motions_.states())
      if (const double here = evaluate(value, motions_.at(state)); std::abs(here) > std::abs(worst))
        worst = here, where = &state;
    return fmt::format("left - right = {:.6g} (SI units) at {}", worst, comparison::describe(*where, b_.system));
  }

  bool equations_hold() {
    if (same_freedoms()) {
      const ExprVector work = comparison::work_differences(a_equations_, b_equations_, pull_back_);
      if (const ZeroTest test = zero_test(work); test.verdict == Verdict::Zero) {
        merge(test);
        return true;
      }
    }
    const Differences rest =
        comparison::without_multipliers(a_equations_, pull_back_, motions_.at(motions_.states().back()));
    return rest.values.empty() || hold(rest.values, motions_.vanish(rest.values), [&](std::size_t k) {
             return fmt::format("the equation of {} of {} does not hold along the motions of {}",
                                a_.system.coordinates[rest.coordinates[k]].name, out_.name_a, out_.name_b);
           });
  }

  /// Both have the same freedoms and the map passes all of them on: then ker A_A is the image of ker A_B.
  bool same_freedoms() const {
    return out_.freedoms_a == out_.freedoms_b && out_.instantaneous_freedoms_a == out_.instantaneous_freedoms_b &&
           out_.rank == out_.instantaneous_freedoms_b;
  }

  void compare_freedoms() {
    out_.verdict = Sameness::Part;
    if (out_.instantaneous_freedoms_a > out_.instantaneous_freedoms_b || out_.freedoms_a > out_.freedoms_b)
      out_.reason = fmt::format("{} has motions that {} does not reach", out_.name_a, out_.name_b);
    else if (!same_freedoms())
      out_.reason = fmt::format("several motions of {} are mapped to one of {}", out_.name_b, out_.name_a);
    else
      out_.verdict = Sameness::Same;
  }

  void compare_domains() {
    const auto gap = comparison::domain_gap(a_.system, pull_back_, b_, b_equations_, motions_);
    if (!gap) return;
    out_.verdict = Sameness::Part;
    out_.reason = fmt::format("{} is defined at {} and {} is not: they agree where both are",
                              gap->of_a ? out_.name_a : out_.name_b, comparison::describe(gap->state, b_.system),
                              gap->of_a ? out_.name_b : out_.name_a);
  }

  EnergyRelation compare_energies() const {
    const MechanicalSystem& b = b_.system;
    const Expr own = with_constants_as_numbers(
                         b, expand_time_derivatives(in_terms_of_motion(b, {&b_equations_.energy_function, 1})))
                         .front();
    const Expr difference = pull_back_(a_equations_.energy_function) - own;
    const ZeroTest equal = motions_.vanish_for_given_signs({&difference, 1});
    if (equal.verdict != Verdict::Nonzero)
      return equal.verdict == Verdict::Zero ? EnergyRelation::Equal : EnergyRelation::Undecided;
    ExprVector derivatives{differentiate(difference, b.context->time())};
    for (const Coordinate& c : b.coordinates)
      for (const Expr& s : {c.q, c.velocity}) derivatives.push_back(differentiate(difference, s));
    return zero_test(derivatives).verdict == Verdict::Zero ? EnergyRelation::EqualButConstant
                                                           : EnergyRelation::Different;
  }

  const Model& a_;
  const Model& b_;
  const EquationsOfMotion& a_equations_;
  const EquationsOfMotion& b_equations_;
  const ComparisonOptions& options_;
  const PullBack& pull_back_;
  const Motions motions_;
  const comparison::CrossCheck runs_;
  Comparison out_;
  ExprVector differing_;  // what does not vanish along the motions of B
  bool off_constraints_ = false, merged_ = false;
};

}  // namespace

Comparison compare(const Model& a, const EquationsOfMotion& a_equations, const CoordinateMap& map,
                   const EquationsOfMotion& b_equations, const ComparisonOptions& options, Diagnostics& diagnostics) {
  const PullBack pull_back(a.system, map, diagnostics);
  if (diagnostics.has_errors()) return {};
  return Comparer(a, a_equations, map, b_equations, options, pull_back).carry_out();
}

}  // namespace maupertuis
