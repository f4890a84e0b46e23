#include "analysis/orbits/closing.hpp"
#include "analysis/orbits/divergence.hpp"
#include "analysis/orbits/drive.hpp"
#include "analysis/orbits/verdict.hpp"
#include "analysis/tangent/point_functions.hpp"
#include "linear_algebra/dense.hpp"

#include <maupertuis/degenerate.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

using orbits::Closed;
using orbits::ReturnMap;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Index = Eigen::Index;

/// Parts of the largest of dΦ_T, whose rounding is some 1e-13 of that: below them an eigenvalue has fewer digits than
/// nine, and none.
constexpr double few_digits = 1e-4, no_digits = 1e-12;

/// The part of the return map that is not trivial. f is an eigenvector with the multiplier 1, and ∂E an eigenvector of
/// the transpose: on the directions that are normal to both, dΦ_T is that of the quotient, in orthonormal directions.
Matrix quotient(const ReturnMap& map, std::vector<Vector> trivial) {
  if (trivial.empty()) return map.monodromy;
  Matrix rows(map.monodromy.rows(), static_cast<Index>(trivial.size()));
  for (std::size_t i = 0; i < trivial.size(); ++i) rows.col(static_cast<Index>(i)) = trivial[i].normalized();
  const Index d = rows.rows();
  const Matrix q = columns_of_q(Eigen::HouseholderQR<Matrix>(rows), d);
  const Matrix rest = q.rightCols(d - rows.cols());
  return rest.transpose() * map.monodromy * rest;
}

class Multipliers {
 public:
  Multipliers(const EquationsOfMotion& equations, const Closed& closed)
      : equations_(equations), closed_(closed), map_(orbits::return_map(closed.begin, closed.end, closed.sizes)) {}

  void fill(FloquetResult& out) const {
    const std::vector<Vector> trivial = trivial_directions(out.motion.driven);
    out.trivial = trivial.size();
    out.trace = map_.monodromy.trace();
    const Matrix rest = quotient(map_, trivial);
    if (rest.rows() > 0) {
      const auto values = Eigen::EigenSolver<Matrix>(rest, false).eigenvalues();
      out.multipliers.assign(values.begin(), values.end());
    }
    const auto larger = [](const std::complex<double>& a, const std::complex<double>& b) {
      if (std::abs(std::abs(a) - std::abs(b)) > 1e-12 * std::abs(a)) return std::abs(a) > std::abs(b);
      return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
    };
    std::sort(out.multipliers.begin(), out.multipliers.end(), larger);
    out.largest = out.multipliers.empty() ? 0 : std::abs(out.multipliers.front());
    out.multipliers.insert(out.multipliers.end(), out.trivial, 1.0);
  }

  /// Rounding of dΦ_T is that of its largest: of what is much smaller the eigenvalues tell little or nothing. A
  /// symplectic map has it as the reciprocal of a large one; where it is one alone, the divergence has it (Liouville).
  void settle_small(FloquetResult& out) const {
    const double size = largest_singular_value();
    const std::size_t count = out.multipliers.size() - out.trivial;
    const auto below = [&](double part) {
      return static_cast<std::size_t>(
          std::count_if(out.multipliers.begin(), out.multipliers.begin() + static_cast<std::ptrdiff_t>(count),
                        [&](const std::complex<double>& mu) { return std::abs(mu) < part * size; }));
    };
    const std::size_t small = below(few_digits);
    if (small == 0) return;
    if (out.symplectic_residual && count % 2 == 0) {
      for (std::size_t j = count - std::min(small, count / 2); j < count; ++j)
        out.multipliers[j] = 1.0 / out.multipliers[count - 1 - j];
    } else if (small == 1 && out.integrated_divergence) {
      take_from_divergence(out, out.multipliers[count - 1], count - 1);
    } else {
      out.lost = below(no_digits);
      std::fill_n(out.multipliers.begin() + static_cast<std::ptrdiff_t>(count - out.lost), out.lost, 0.0);
    }
    out.largest = std::abs(out.multipliers.front());
  }

  double log_determinant() const {
    const Eigen::PartialPivLU<Matrix> lu(map_.monodromy);
    return lu.matrixLU().diagonal().cwiseAbs().array().log().sum();
  }

  /// The least relative error of dΦ_T that moves log |det| by so much: |tr(dΦ_T⁻¹ E)| ≤ d ‖dΦ_T⁻¹‖ ‖E‖.
  double error_from_determinant(double difference) const {
    const Vector values = Eigen::JacobiSVD<Matrix>(map_.monodromy).singularValues();
    if (values.size() == 0) return 0;
    return std::abs(difference) * values.minCoeff() / (values.maxCoeff() * static_cast<double>(values.size()));
  }

 private:
  double largest_singular_value() const {
    const Vector values = Eigen::JacobiSVD<Matrix>(map_.monodromy).singularValues();
    return values.size() == 0 ? 0 : values.maxCoeff();
  }

  /// dΦ_T of a flow keeps the orientation: the product of all multipliers is positive.
  static void take_from_divergence(FloquetResult& out, std::complex<double>& smallest, std::size_t others) {
    double log_others = 0;
    std::complex<double> sign = 1;
    for (std::size_t i = 0; i < others; ++i) {
      log_others += std::log(std::abs(out.multipliers[i]));
      sign *= out.multipliers[i] / std::abs(out.multipliers[i]);
    }
    out.log_smallest = *out.integrated_divergence - log_others;
    smallest = std::copysign(std::exp(*out.log_smallest), sign.real());
  }

  /// In the coordinates of the return map.
  std::vector<Vector> trivial_directions(bool driven) const {
    std::vector<Vector> out;
    if (driven) return out;
    const Vector size = Eigen::Map<const Vector>(closed_.sizes.data(), static_cast<Index>(closed_.sizes.size()));
    out.push_back(map_.directions.transpose() * closed_.flow.cwiseQuotient(size));
    if (!closed_.keeps_energy) return out;
    const tangent::PointFunctions energy(*equations_.system, {&equations_.energy_function, 1});
    const Vector slope = energy.slopes(closed_.motion.start).row(0).transpose();
    out.push_back(map_.directions.transpose() * slope.cwiseProduct(size));
    return out;
  }

  const EquationsOfMotion& equations_;
  const Closed& closed_;
  ReturnMap map_;
};

/// ω of the basis before and after: the largest difference, against the largest of ω itself and against the sizes of
/// the directions.
struct SymplecticMiss {
  double residual = 0, relative = 0;
};

SymplecticMiss symplectic_miss(const TangentGeometry& geometry, const Closed& closed) {
  const auto before = geometry.symplectic_products(closed.begin), after = geometry.symplectic_products(closed.end),
             sizes_before = geometry.symplectic_sizes(closed.begin, closed.sizes),
             sizes = geometry.symplectic_sizes(closed.end, closed.sizes);
  const auto grow = [](double& largest, double value) {
    if (!(value <= largest)) largest = value;  // also not a number
  };
  SymplecticMiss out;
  double size = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double difference = std::abs(after[i] - before[i]);
    grow(out.residual, difference);
    if (difference != 0) grow(out.relative, difference / (sizes[i] + sizes_before[i]));
    size = std::max(size, std::abs(before[i]));
  }
  if (size > 0) out.residual /= size;
  return out;
}

void check(const EquationsOfMotion& equations, const Closed& closed, const Multipliers& multipliers,
           FloquetResult& out) {
  const TangentGeometry geometry(equations);
  // Elastic impacts without friction keep the symplectic form.
  if (geometry.symplectic() && closed.log_volume == 0.0) {
    const SymplecticMiss miss = symplectic_miss(geometry, closed);
    out.symplectic_residual = miss.residual;
    out.error = miss.relative;
  }
  const PeriodicMotion& motion = out.motion;
  if (!closed.through_modes)
    out.integrated_divergence =
        orbits::DivergenceIntegral(equations, geometry)(motion.start, motion.start.t + motion.period);
  else if (geometry.symplectic() && closed.begin.columns() == closed.begin.width())
    out.integrated_divergence = closed.log_volume;  // 2 log e an impact
  if (!out.integrated_divergence) return;
  out.log_determinant = multipliers.log_determinant();
  out.error = std::max(out.error.value_or(0),
                       multipliers.error_from_determinant(*out.log_determinant - *out.integrated_divergence));
}

}  // namespace

std::optional<FloquetResult> floquet(const Model& model, const EquationsOfMotion& equations,
                                     const FloquetOptions& options, Diagnostics& diagnostics) {
  if (refuse_free_functions(equations, "multipliers of a periodic motion", diagnostics)) return std::nullopt;
  if (equations.determined)
    return floquet(with_determined_system(model, equations), *equations.determined, options, diagnostics);
  if (jumps_on_its_way(model) && !can_go_through_modes(equations, diagnostics)) return std::nullopt;
  const auto closed = orbits::close_motion(model, equations, options, diagnostics);
  if (!closed) return std::nullopt;
  FloquetResult out;
  out.motion = closed->motion;
  const Multipliers multipliers(equations, *closed);
  multipliers.fill(out);
  if (closed->through_modes && orbits::bounces_end(model.system))
    out.vanished =
        TangentGeometry(equations).basis(out.motion.start).size() / closed->begin.width() - closed->begin.columns();
  check(equations, *closed, multipliers, out);
  if (!closed->through_modes) multipliers.settle_small(out);
  out.stability = orbits::stability_of(out);
  orbits::warn_of_error(out, diagnostics);
  return out;
}

}  // namespace maupertuis
