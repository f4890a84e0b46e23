#include "analysis/linearization/stability.hpp"

#include "analysis/linearization/dense.hpp"
#include "analysis/linearization/folds.hpp"
#include "analysis/linearization/friction_sign.hpp"
#include "analysis/linearization/linear_motion.hpp"
#include "analysis/linearization/point_equations.hpp"
#include "linear_algebra/products.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace maupertuis {
namespace {

/// A matrix by its directions in y: Bᵀ K B with orthonormal columns of B [f × …].
struct Stiffness {
  Matrix k, basis;
};

/// The Hessian of the effective potential, in y: along translations that are symmetries nothing is at stake, and where
/// their momenta are kept, δp = ẏ_s + Ĉ_sr y_r = 0 turns the rates ẏ_s into positions:
///     K_eff = K̂_rr − Ĉ_rs Ĉ_sr
/// Not where the momenta of two of them hold y_s as well, Ĉ_ss ≠ 0, as in a magnetic field.
Stiffness effective_stiffness(const MassNormalForm& form, bool keeps_momenta) {
  const Index f = form.k.rows(), s = form.translations.cols();
  if (s == 0) return {form.k, Matrix::Identity(f, f)};
  const Matrix q = orthogonal_factor(form.translations);
  const Matrix along = q.leftCols(s), rest = q.rightCols(f - s);
  Matrix k = quadratic_form(rest, form.k);
  constexpr double rounding = 1e-9;
  if (keeps_momenta && quadratic_form(along, form.c).norm() <= rounding * form.c.stableNorm())
    k -= product(product(transposed_product(rest, form.c), along), product(transposed_product(along, form.c), rest));
  return {k, rest};
}

struct Verdicts {
  const PointEquations& equations;
  const Linearization& linearization;
  const MassNormalForm& form;
  const std::vector<Translation>& translations;
  const ModalAnalysis& modes;
  const Equilibrium& equilibrium;

  bool all_conserved() const {
    return std::all_of(translations.begin(), translations.end(), [](const Translation& t) { return t.conserved; });
  }

  /// Eigenvalues of the Hessian with their directions in y; none where the energy says nothing.
  SymmetricEigen hessian() const {
    if (!form.valid || !form.potential || !equations.energy_never_grows_near(equilibrium.point)) return {};
    if (!equilibrium.at_rest && !all_conserved()) return {};
    const Stiffness stiffness = effective_stiffness(form, all_conserved());
    if (stiffness.k.size() == 0) return {};
    SymmetricEigen out = symmetric_eigen(symmetric_part(stiffness.k));
    out.vectors = product(stiffness.basis, out.vectors);
    return out;
  }

  /// Whether the soft ones among these eigenvalues have signs that the error of the place leaves, or one is negative
  /// beyond it. What vanishes to rounding anyway is judged elsewhere.
  bool has_certain_signs(const SymmetricEigen& hessian) const {
    constexpr double soft = 1e-4;  // of the largest
    const std::vector<Index> across = across_family(hessian.values);
    if (!equilibrium.at_rest || across.empty()) return true;
    const double largest = hessian.values.cwiseAbs().maxCoeff();
    const Vector none = hessian_tolerances(hessian);
    bool certain = true;
    for (const Index i : across) {
      const double value = hessian.values[i];
      if (i != across.front() && std::abs(value) > soft * largest) continue;
      if (std::abs(value) <= none[i]) continue;
      const Vector direction =
          product(to_eigen(linearization.positions), product(form.to_independent, hessian.vectors.col(i)));
      const Curvature found = curvature_at_rest(equations.impl(), equilibrium.point, direction);
      if (found == Curvature::Negative) return true;
      certain = certain && found != Curvature::Undecided;
    }
    return certain || (hessian.values[0] < -soft * largest && across.front() != 0);
  }

  /// The eigenvalues but those that vanish along the family, the softest first.
  std::vector<Index> across_family(const Vector& values) const {
    std::vector<Index> out(static_cast<std::size_t>(values.size()));
    std::iota(out.begin(), out.end(), Index{0});
    std::sort(out.begin(), out.end(), [&](Index i, Index j) { return std::abs(values[i]) < std::abs(values[j]); });
    out.erase(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(std::min(out.size(), equilibrium.family)));
    return out;
  }

  /// [eigenvalues of the Hessian] what rounding leaves of each. Rates belong to effective potentials alone.
  Vector hessian_tolerances(const SymmetricEigen& hessian) const {
    const double unit = 16 * static_cast<double>(form.k.rows()) * std::numeric_limits<double>::epsilon();
    const double rates = translations.empty() ? 0 : form.c.squaredNorm();
    return unit * (hessian.norms.array() + rates).matrix();
  }

  /// Without first-order terms the Hessian has the squares of the frequencies: these may be known in more digits.
  bool oscillates_in_all_ways() const {
    return modes.symmetric && translations.empty() &&
           std::all_of(modes.modes.begin(), modes.modes.end(),
                       [](const Mode& m) { return m.kind == Mode::Kind::Oscillation && m.frequency() > 4 * m.error; });
  }

  /// The oscillation that neither grows nor decays by itself, and whose neighbours grow like t: a Jordan chain.
  const Mode* chain_on_axis() const {
    for (const Mode& m : modes.modes)
      if (m.kind == Mode::Kind::Oscillation && m.chain > 1 && std::abs(m.eigenvalue.real()) <= 4 * m.error) return &m;
    return nullptr;
  }
  /// In 100 digits.
  static bool is_proved(const Mode& chain) { return chain.error <= 1e-12 * chain.frequency(); }
  /// Of a linear system nothing of higher order is left.
  bool grows_for_certain(const Mode& chain) const { return is_proved(chain) && is_linear(equations.impl()); }

  /// At rest on a family of equilibria the Hessian vanishes along it, and V is the same on all of it: where it is
  /// positive across, motions of little energy stay near the family (as near a minimum, with the family in the place of
  /// a point).
  bool is_minimum_across_family(const std::vector<double>& hessian) const {
    constexpr double none = 1e-9;  // of the largest, along the family: the equilibrium is known to rounding
    const std::size_t along = equilibrium.family;
    if (!equilibrium.at_rest || along == 0 || hessian.size() <= along) return false;
    const double size = form.k.stableNorm();
    return std::abs(hessian.front()) <= none * size && std::abs(hessian[along - 1]) <= none * size &&
           hessian[along] > 1e3 * none * size;
  }

  /// Of a linear system nothing of higher order is left: its eigenvalues decide, with their chains.
  bool is_linear_and_bounded() const {
    return zeros() <= explained_zeros() && is_linear(equations.impl()) &&
           oscillates_for_certain(equations.impl(), linearization, modes.modes);
  }

  /// 1: h_E, which a Lagrangian of the first order keeps, has a strict minimum here; −1: a strict maximum; 0: neither
  /// is known. Motions near it stay on levels of h_E that close around it (Dirichlet).
  int extremum_of_kept_energy() const {
    PointEquations::Impl& e = equations.impl();
    const RowsAtPoint slopes = e.at(e.energy_slopes, equilibrium.point);
    if (slopes.value.size() == 0 || !slopes.by_q.allFinite()) return 0;
    const Vector values = symmetric_eigen(symmetric_part(slopes.by_q)).values;
    const double rounding =
        16 * static_cast<double>(values.size()) * std::numeric_limits<double>::epsilon() * slopes.by_q.norm();
    return values.minCoeff() > rounding ? 1 : values.maxCoeff() < -rounding ? -1 : 0;
  }

  std::size_t zeros() const {
    std::size_t out = 0;
    for (const Mode& m : modes.modes) out += m.zeros;
    return out;
  }
  /// A translation is a zero eigenvalue; a conserved one a second, the change of its momentum. So is each further way
  /// to move.
  std::size_t explained_zeros() const {
    std::size_t out = translations.size() + equilibrium.family;
    for (const Translation& t : translations) out += t.conserved;
    return out;
  }

  bool is_strict_minimum(const SymmetricEigen& hessian) const {
    if (hessian.values.size() > 0)
      return (hessian.values.array() > hessian_tolerances(hessian).array()).all() || oscillates_in_all_ways();
    return form.valid && form.potential && equations.energy_never_grows_near(equilibrium.point) && all_conserved() &&
           form.translations.cols() == form.k.rows();
  }

  std::string why_undecided(const SymmetricEigen& hessian, const Vector& none, std::string_view potential) const {
    const bool has_hessian = hessian.values.size() > 0;
    if (has_hessian && (hessian.values.array() < -none.array()).any())
      return fmt::format(
          "no eigenvalue has a positive real part, but the Hessian of the {} is not positive: gyroscopic forces hold "
          "it",
          potential);
    if (has_hessian || zeros() > explained_zeros())
      return "an eigenvalue vanishes, or is rounding beside the largest, and no symmetry explains it: smaller terms "
             "decide, or those of higher order";
    return "eigenvalues lie on the imaginary axis, and no energy decides";
  }
};

std::string_view up_to_translations(const std::vector<Translation>& translations) {
  return translations.empty() ? "" : ", up to the translations that are symmetries";
}

/// Real parts of eigenvalues, without zeros.
struct RealParts {
  double growth = 0;        // the largest
  double margin = 0;        // the largest beyond its error
  double decay = HUGE_VAL;  // the smallest decay beyond its error
};

RealParts real_parts_of(const ModalAnalysis& modes) {
  RealParts out;
  for (const Mode& m : modes.modes) {
    if (m.kind == Mode::Kind::Zero) continue;
    out.growth = std::max(out.growth, m.eigenvalue.real());
    out.margin = std::max(out.margin, m.eigenvalue.real() - 4 * m.error);
    out.decay = std::min(out.decay, -m.eigenvalue.real() - 4 * m.error);
  }
  return out;
}

/// Why nothing can be judged here; empty where it can.
std::string_view why_not_judged(const PointEquations& equations, const Linearization& linearization,
                                const Equilibrium* equilibrium) {
  if (!equilibrium)
    return "a point of a motion is no state of rest: these are the eigenvalues of the coefficients at that instant";
  if (linearization.independent.empty() && linearization.independent_velocities.empty())
    return "the constraints leave nothing that could move, to first order";
  if (!equations.autonomous())
    return "the coefficients change with time: Floquet multipliers decide where they are periodic";
  return {};
}

/// The first rule that applies, in the order of docs/theory/linearization.md, Stability.
void apply_rules(const Verdicts& v, const RealParts& real_parts, StabilityReport& out) {
  const SymmetricEigen hessian = v.hessian();
  out.hessian = to_list(hessian.values);
  out.effective = !v.translations.empty();
  const bool has_hessian = !out.hessian.empty();
  const Vector none = v.hessian_tolerances(hessian);
  const std::string_view potential =
      v.equilibrium.at_rest && v.translations.empty() ? "potential" : "effective potential";
  const std::string_view other = v.zeros() > 0 ? "other " : "", up_to = up_to_translations(v.translations);
  if (!v.has_certain_signs(hessian)) {
    out.reason = fmt::format(
        "the Hessian of the {} vanishes within the error of the place, as where equilibria "
        "come together: terms of higher order decide",
        potential);
  } else if (real_parts.margin > 0) {
    out.verdict = Stability::Unstable;
    out.reason = "an eigenvalue has a positive real part";
  } else if (real_parts.decay > 0 && real_parts.decay < HUGE_VAL && v.zeros() <= v.explained_zeros()) {
    out.verdict = Stability::Asymptotic;
    out.reason = fmt::format("all {}eigenvalues have negative real parts{}", other, up_to);
  } else if (v.is_strict_minimum(hessian)) {
    out.verdict = Stability::Energetic;
    out.reason = has_hessian ? fmt::format("the Hessian of the {} is positive definite", potential)
                             : "only translations are left";
  } else if (has_hessian && v.is_minimum_across_family(out.hessian)) {
    out.verdict = Stability::Energetic;
    out.reason =
        fmt::format("the Hessian of the {} is positive definite across the family; along it nothing holds", potential);
  } else if (const int extremum = v.extremum_of_kept_energy(); extremum != 0) {
    out.verdict = Stability::Energetic;
    out.reason = fmt::format("h_E is conserved and has a strict {} here", extremum > 0 ? "minimum" : "maximum");
  } else if (v.is_linear_and_bounded()) {
    out.verdict = Stability::Linear;
    out.reason = fmt::format(
        "the equations are linear, and all {}eigenvalues are on the imaginary axis, each simple or "
        "of modes with energies of one sign{}",
        other, up_to);
  } else if (const Mode* chain = v.chain_on_axis()) {
    const bool grows = v.grows_for_certain(*chain);
    if (grows) out.verdict = Stability::Unstable;
    out.reason =
        fmt::format("{} oscillations have one frequency and one shape{}: their neighbours grow like t{}", chain->chain,
                    v.is_proved(*chain) ? "" : " within rounding", grows ? "" : " to first order");
  } else {
    out.reason = v.why_undecided(hessian, none, potential);
  }
}

}  // namespace

StabilityReport judge_stability(const PointEquations& equations, const Linearization& linearization,
                                const MassNormalForm& form, const std::vector<Translation>& translations,
                                const ModalAnalysis& modes, const Equilibrium* equilibrium) {
  StabilityReport out;
  const RealParts real_parts = real_parts_of(modes);
  out.growth_rate = real_parts.growth;
  out.reason = why_not_judged(equations, linearization, equilibrium);
  if (!out.reason.empty()) return out;
  apply_rules({equations, linearization, form, translations, modes, *equilibrium}, real_parts, out);
  if (out.verdict == Stability::Energetic && !friction_never_gives(equations.impl()))
    out.reason += ", as far as looked at: that friction nowhere gives energy is not proved";
  return out;
}

}  // namespace maupertuis
