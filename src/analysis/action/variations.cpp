#include "analysis/action/problem.hpp"
#include "linear_algebra/dense.hpp"
#include "linear_algebra/products.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

/// The first variation, to be seen: S on q + ε ξ for sines of each coordinate and for the shape that lowers S most, or
/// raises it least. S(ε) − S(0) is a parabola without a slope where the path is stationary.
namespace maupertuis::action {
namespace {

constexpr int waves = 6;  // of each coordinate, among which the lowest shape is sought
constexpr std::size_t most_shown = 5;
constexpr int half_count = 20;  // values of ε on each side
constexpr double largest_epsilon = 0.2;
constexpr double least_terms = 1e-3;  // of those of S: where the equations cancel within each term, slopes are rounding

struct Shape {
  std::string name;
  Matrix xi;  // [n × nodes]
};

/// Functions of τ in [0, 1] that the ends allow.
std::vector<std::pair<std::string, std::vector<double>>> waves_of(const Trial& trial, bool free_start, bool free_end) {
  std::vector<std::pair<std::string, std::vector<double>>> out;
  const double begin = trial.mesh.start, whole = trial.mesh.whole;
  const auto add = [&](std::string name, auto f) {
    std::vector<double> values;
    for (Index k = 0; k < trial.mesh.nodes(); ++k) values.push_back(f((trial.mesh.time(k) - begin) / whole));
    out.emplace_back(std::move(name), std::move(values));
  };
  constexpr double pi = std::numbers::pi;
  if (trial.mesh.closed) {
    add("1", [](double) { return 1.0; });
    for (int k = 1; k <= waves / 2; ++k) {
      add(fmt::format("cos({}π τ)", 2 * k), [k](double s) { return std::cos(2 * k * pi * s); });
      add(fmt::format("sin({}π τ)", 2 * k), [k](double s) { return std::sin(2 * k * pi * s); });
    }
    return out;
  }
  for (int k = 1; k <= waves; ++k)
    add(k == 1 ? "sin(π τ)" : fmt::format("sin({}π τ)", k), [k](double s) { return std::sin(k * pi * s); });
  if (free_start) add("1 − τ", [](double s) { return 1 - s; });
  if (free_end) add("τ", [](double s) { return s; });
  return out;
}

/// The same of a coordinate whose q'' stands in L, with its rate: both vanish at the ends.
struct WaveWithRate {
  std::string name;
  std::vector<double> value, rate;
};
std::vector<WaveWithRate> clamped_waves_of(const Trial& trial) {
  constexpr double pi = std::numbers::pi;
  std::vector<WaveWithRate> out;
  for (int k = 1; k <= waves; ++k) {
    WaveWithRate wave{k == 1 ? "sin²(π τ)" : fmt::format("sin(π τ) sin({}π τ)", k), {}, {}};
    for (Index node = 0; node < trial.mesh.nodes(); ++node) {
      const double s = (trial.mesh.time(node) - trial.mesh.start) / trial.mesh.whole;
      const double once = std::sin(pi * s), more = std::sin(k * pi * s);
      wave.value.push_back(once * more);
      wave.rate.push_back(pi * (std::cos(pi * s) * more + k * once * std::cos(k * pi * s)) / trial.mesh.whole);
    }
    out.push_back(std::move(wave));
  }
  return out;
}

class Neighbourhood {
 public:
  Neighbourhood(Problem& problem, const Trial& trial, const FixedEnds& fixed, const Vector& least)
      : problem_(problem),
        trial_(trial),
        fixed_(fixed),
        scale_(even_scale(trial, least)),
        a_(assemble(problem.functional, trial, 2)),
        directions_(directions_of(problem.functional, trial, fixed, scale_, a_.gradient)) {
    gradient_ = action::with_reactions(problem.functional, trial, directions_, a_.gradient);
  }

  bool usable() const { return a_.finite; }

  /// Each coordinate's waves, brought onto the directions that are allowed.
  std::vector<Shape> shapes() const {
    std::vector<Shape> out;
    const MechanicalSystem& system = *problem_.equations.system;
    add_clamped_shapes(out);
    const OrderOfCoordinates& orders = problem_.functional.orders();
    for (const Index i : orders.tops) {
      if (std::count(orders.rates_of_others.begin(), orders.rates_of_others.end(), i) > 0) continue;
      const auto at = static_cast<std::size_t>(i);
      for (const auto& [name, values] : waves_of(trial_, !fixed_.from[at], !fixed_.to[at])) {
        Matrix xi = Matrix::Zero(trial_.q.rows(), trial_.q.cols());
        xi.row(i) = scale_(i, 0) * Eigen::Map<const Vector>(values.data(), trial_.q.cols()).transpose();
        allow(xi);
        if (xi.cwiseQuotient(scale_).norm() > 1e-6)
          out.push_back({system.coordinates[at].name + ": " + name, std::move(xi)});
      }
    }
    return out;
  }

  /// The combination of shapes with the lowest curvature.
  std::optional<Shape> lowest(const std::vector<Shape>& shapes) const {
    if (shapes.empty()) return std::nullopt;
    const auto count = static_cast<Index>(shapes.size());
    Matrix x(trial_.q.size(), count);
    for (Index i = 0; i < count; ++i)
      x.col(i) = Eigen::Map<const Vector>(shapes[static_cast<std::size_t>(i)].xi.data(), x.rows());
    if (problem_.functional.integrals() > 0)
      x = product(x, null_basis(transposed_product(a_.integral_gradients, x), count));
    if (x.cols() == 0) return std::nullopt;
    Matrix h = transposed_product(x, times(a_.hessians, x, true)),
           k = transposed_product(x, times(a_.kinetic, x, false));
    if (!(k.trace() > 0)) return std::nullopt;  // L is of the first order in velocities: nothing measures curvature
    k += 1e-12 * k.trace() * Matrix::Identity(k.rows(), k.cols());  // shapes that constraints make alike
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> eigen(symmetric_part(h), symmetric_part(k));
    if (eigen.info() != Eigen::Success) return std::nullopt;
    Vector best = x * eigen.eigenvectors().col(0);
    const double size =
        best.cwiseQuotient(Eigen::Map<const Vector>(scale_.data(), scale_.size())).lpNorm<Eigen::Infinity>();
    best /= best.dot(x.col(0)) < 0 ? -size : size;
    return Shape{"lowest", Eigen::Map<const Matrix>(best.data(), trial_.q.rows(), trial_.q.cols())};
  }

  TestVariation vary(const Shape& shape) {
    TestVariation out;
    out.name = shape.name;
    const Eigen::Map<const Vector> xi(shape.xi.data(), shape.xi.size());
    out.curvature = xi.dot(times(a_.hessians, xi, true).col(0)) / xi.dot(times(a_.kinetic, xi, false).col(0));
    const double terms = std::max(gradient_terms(shape.xi), least_terms * size_of_action(problem_.functional, trial_));
    out.slope = terms > 0 ? gradient_.dot(xi) / terms : 0;
    const double own = value(trial_);
    for (int k = -half_count; k <= half_count; ++k) {
      Trial moved = trial_;
      const double epsilon = largest_epsilon * k / half_count;
      moved.q += epsilon * shape.xi;
      if (!move_onto_constraints(problem_.functional, moved, fixed_, scale_)) continue;
      if (const double there = value(moved); std::isfinite(there)) {
        out.epsilon.push_back(epsilon);
        out.change.push_back(k == 0 ? 0.0 : there - own);
      }
    }
    return out;
  }

 private:
  /// Where q'' stands in L: ξ of q with v moved by ξ', so that q' = v stays and S* is S.
  void add_clamped_shapes(std::vector<Shape>& out) const {
    const OrderOfCoordinates& orders = problem_.functional.orders();
    for (std::size_t k = 0; k < orders.bases.size(); ++k)
      for (const WaveWithRate& wave : clamped_waves_of(trial_)) {
        const auto row = [&](const std::vector<double>& values) -> Eigen::RowVectorXd {
          return scale_(orders.bases[k], 0) * Eigen::Map<const Vector>(values.data(), trial_.q.cols()).transpose();
        };
        Matrix xi = Matrix::Zero(trial_.q.rows(), trial_.q.cols());
        xi.row(orders.bases[k]) = row(wave.value);
        xi.row(orders.rates_of_others[k]) = row(wave.rate);
        const auto base = static_cast<std::size_t>(orders.bases[k]);
        out.push_back({problem_.equations.system->coordinates[base].name + ": " + wave.name, std::move(xi)});
      }
  }

  /// Directions alone, also of an integral constraint's path: the rest of ξ is taken off node by node.
  void allow(Matrix& xi) const {
    for (Index k = 0; k < xi.cols(); ++k) {
      const Matrix& z = directions_.basis[static_cast<std::size_t>(k)];
      xi.col(k) =
          z.cols() == 0 ? Vector(Vector::Zero(xi.rows())) : Vector(z * z.householderQr().solve(Vector(xi.col(k))));
    }
  }

  Matrix times(const std::vector<Matrix>& blocks, const Matrix& x, bool with_curvature) const {
    Matrix out = Matrix::Zero(x.rows(), x.cols());
    const Index n = trial_.q.rows(), p = trial_.mesh.rule->degree;
    for (Index e = 0; e < trial_.mesh.elements(); ++e) {
      Matrix local(n * (p + 1), x.cols());
      for (Index j = 0; j <= p; ++j) local.middleRows(j * n, n) = x.middleRows(trial_.mesh.node(e, j) * n, n);
      const Matrix times_local = product(blocks[static_cast<std::size_t>(e)], local);
      for (Index j = 0; j <= p; ++j) out.middleRows(trial_.mesh.node(e, j) * n, n) += times_local.middleRows(j * n, n);
    }
    if (!with_curvature || problem_.functional.constraints() == 0) return out;
    for (Index k = 0; k < trial_.mesh.nodes(); ++k)
      out.middleRows(k * n, n) +=
          product(problem_.functional.constraint_curvature(trial_.mesh.time(k), trial_.q.col(k),
                                                           directions_.mu[static_cast<std::size_t>(k)]),
                  x.middleRows(k * n, n));
    return out;
  }

  /// Σ of the sizes of what adds up to ∇S·ξ, point by point.
  double gradient_terms(const Matrix& xi) {
    const Rule& rule = *trial_.mesh.rule;
    Trial shape = trial_;
    shape.q = xi;
    shape.advance.setZero();
    Density density;
    double out = 0;
    for (Index e = 0; e < trial_.mesh.elements(); ++e) {
      const Matrix own = trial_.element(e), other = shape.element(e);
      for (Index g = 0; g < rule.points.size(); ++g) {
        const Place at = place_of(trial_.mesh, e, g);
        const Vector q = own * at.value, v = own * at.slope, x = other * at.value, dx = other * at.slope;
        problem_.functional.evaluate(at.t, q.data(), v.data(), trial_.multipliers, 1, density);
        out += at.weight * (density.gradient.head(q.size()).cwiseProduct(x).cwiseAbs().sum() +
                            density.gradient.tail(q.size()).cwiseProduct(dx).cwiseAbs().sum());
      }
    }
    return out;
  }

  /// S, with integral constraints S + λ (∫ G − value).
  double value(const Trial& trial) {
    const Assembly a = assemble(problem_.functional, trial, 0);
    return a.finite ? a.action + trial.multipliers.dot(a.integrals - problem_.functional.wanted()) : HUGE_VAL;
  }

  Problem& problem_;
  const Trial& trial_;
  const FixedEnds& fixed_;
  Matrix scale_;
  Assembly a_;
  Directions directions_;
  Vector gradient_;
};

}  // namespace

std::vector<TestVariation> test_variations(Problem& problem, const Trial& trial, const FixedEnds& fixed,
                                           const Vector& least) {
  Neighbourhood near(problem, trial, fixed, least);
  if (!near.usable()) return {};
  const std::vector<Shape> shapes = near.shapes();
  std::vector<TestVariation> out;
  if (const auto lowest = near.lowest(shapes)) out.push_back(near.vary(*lowest));
  // The slowest waves of each coordinate, as many as a reader wants to see.
  const std::size_t each =
      std::max<std::size_t>(1, (most_shown - 1) / static_cast<std::size_t>(std::max<Index>(1, problem.n())));
  std::string before;
  std::size_t of_this = 0;
  for (const Shape& s : shapes) {
    const std::string coordinate = s.name.substr(0, s.name.find(':'));
    of_this = coordinate == before ? of_this + 1 : 1;
    before = coordinate;
    if (of_this <= each && out.size() < most_shown) out.push_back(near.vary(s));
  }
  return out;
}

}  // namespace maupertuis::action
