#include "analysis/action/refine.hpp"

#include <algorithm>
#include <cmath>

/// A path is resolved where the last Legendre coefficients of each element are at rounding.
namespace maupertuis::action {
namespace {

constexpr double resolved = 1e-12;  // of the last coefficients, relative to the size of the coordinate
constexpr double smooth = 1e-6;     // of them: above it a layer is narrower than the element, which halving shows late
constexpr double worst_error = 1e-6;  // of the terms of L: a path that finer elements change by more is none
constexpr double nearly = 1e-3;       // of the size: a correction on the way, with which finer elements may begin
constexpr Index most_layers = 4;      // elements with one
constexpr int most_rounds = 12;
constexpr Index most_elements = 400;
constexpr Index most_about_layers = 100;  // a layer that so many do not resolve is a jump: no path has it

/// The last two coefficients of an element, the largest relative one.
double tail(const Trial& trial, Index e, const Matrix& scale) {
  const Rule& rule = *trial.mesh.rule;
  const Matrix coefficients = trial.element(e) * rule.legendre.transpose();
  double out = 0;
  for (Index i = 0; i < coefficients.rows(); ++i)
    out = std::max(out, coefficients.row(i).tail(2).cwiseAbs().maxCoeff() / scale(i, trial.mesh.node(e, 0)));
  return out;
}

class Refiner {
 public:
  Refiner(Functional& functional, Trial trial, const FixedEnds& fixed, const Vector& least,
          const NewtonOptions& options, bool may_have_layers)
      : functional_(functional),
        trial_(std::move(trial)),
        fixed_(fixed),
        least_(least),
        options_(options),
        may_have_layers_(may_have_layers) {}

  std::optional<Refined> run() {
    if (!resolve()) return std::nullopt;
    Refined out;
    out.coarse = trial_;
    const double coarse = assemble(functional_, trial_, 0).action;
    trial_ = halved(trial_, std::vector<bool>(static_cast<std::size_t>(trial_.mesh.elements()), true));
    const Trial guess = trial_;
    if (!solve()) return std::nullopt;
    const Assembly fine = assemble(functional_, trial_, 0);
    out.action = fine.action;
    out.action_error = std::abs(fine.action - coarse) + rounding_of_action(functional_, trial_);
    out.path_error = ((trial_.q - guess.q).cwiseQuotient(scale_of_found(trial_, least_, functional_.orders())))
                         .lpNorm<Eigen::Infinity>();
    out.correction = correction_;
    if (!(out.action_error <= worst_error * size_of_action(functional_, trial_))) return std::nullopt;
    out.fine = std::move(trial_);
    return out;
  }

 private:
  bool solve() {
    const NewtonResult found = solve_stationarity(functional_, trial_, fixed_, path_scale(trial_, least_), options_);
    correction_ = found.correction;
    return found.converged;
  }

  bool resolve() {
    double before = HUGE_VAL;
    for (int round = 0; round < most_rounds; ++round) {
      std::vector<bool> which(static_cast<std::size_t>(trial_.mesh.elements()), false);
      const Matrix size = scale_of_found(trial_, least_, functional_.orders());
      double worst = 0;
      Index rough = 0;
      for (Index e = 0; e < trial_.mesh.elements(); ++e) {
        const double here = tail(trial_, e, size);
        worst = std::max(worst, here);
        if (here > smooth) ++rough;
        which[static_cast<std::size_t>(e)] = here > resolved;
      }
      const bool is_layer =
          may_have_layers_ && rough > 0 && rough <= most_layers && trial_.mesh.elements() < most_about_layers;
      if (worst <= resolved || (worst > 0.7 * before && !is_layer) || trial_.mesh.elements() > most_elements)
        return true;
      before = worst;
      trial_ = halved(trial_, which);
      // A path that S barely holds in its place, as a kink far from both ends, may come to rest on finer elements only.
      if (!solve() && !(correction_ <= nearly)) return false;
    }
    return true;
  }

  Functional& functional_;
  Trial trial_;
  const FixedEnds& fixed_;
  const Vector& least_;
  const NewtonOptions& options_;
  bool may_have_layers_;
  double correction_ = 0;
};

}  // namespace

std::optional<Refined> refine(Functional& functional, Trial trial, const FixedEnds& fixed, const Vector& least,
                              const NewtonOptions& options, bool may_have_layers) {
  return Refiner(functional, std::move(trial), fixed, least, options, may_have_layers).run();
}

}  // namespace maupertuis::action
