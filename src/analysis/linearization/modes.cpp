#include "analysis/linearization/dense.hpp"
#include "analysis/linearization/eigenproblem.hpp"
#include "analysis/linearization/modes_in_digits.hpp"
#include "analysis/linearization/point_equations.hpp"
#include "analysis/linearization/stability.hpp"
#include "linear_algebra/products.hpp"

#include <maupertuis/modes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis {
namespace {

using Complex = std::complex<double>;

double largest(const Matrix& m) { return m.size() == 0 ? 0 : m.lpNorm<Eigen::Infinity>(); }
bool negligible(const Matrix& part, const Matrix& whole) { return largest(part) <= 1e-13 * largest(whole); }

Mode mode(Mode::Kind kind, Complex eigenvalue, double error) {
  Mode out;
  out.kind = kind;
  out.eigenvalue = eigenvalue;
  out.error = error;
  return out;
}

class Analysis {
 public:
  Analysis(const PointEquations& equations, const Linearization& linearization,
           const std::vector<Translation>& translations, const Equilibrium* equilibrium)
      : equations_(equations),
        l_(linearization),
        translations_(translations),
        equilibrium_(equilibrium),
        form_(mass_normal_form(linearization, translations)),
        mass_(equations.impl().at(equations.impl().balance, l_.point).by_a) {}

  ModalAnalysis carry_out() {
    if (form_.valid && form_.symmetric)
      symmetric_modes();
    else if (form_.valid)
      quadratic_modes();
    else
      state_modes();
    if (equilibrium_ && is_in_doubt())
      if (const auto precise = modes_in_digits(equations_, *equilibrium_); precise && is_whole(*precise))
        take(*precise);
    if (!out_.symmetric) join_chains();
    finish();
    return std::move(out_);
  }

 private:
  /// Double does not tell an eigenvalue from its neighbours, or from zero.
  bool is_in_doubt() const {
    constexpr double certain = 1e-9;
    std::size_t zeros = 0, explained = equilibrium_->family;
    for (const Translation& t : translations_) explained += 1 + t.conserved;
    for (const Mode& m : out_.modes) {
      zeros += m.zeros;
      if (m.kind != Mode::Kind::Zero && m.error > certain * std::abs(m.eigenvalue)) return true;
    }
    return zeros > explained || is_lost_in_entries(equations_, l_.point);
  }

  /// Where constraints meet singularly their rows are rounding, and leave other motions in digits than in double.
  bool is_whole(const std::vector<PreciseMode>& modes) const {
    std::size_t count = 0;
    for (const PreciseMode& m : modes) count += m.multiplicity * (m.eigenvalue.imag() > 0 ? 2 : 1);
    return count == l_.a.rows;
  }

  void take(const std::vector<PreciseMode>& modes) {
    out_.modes.clear();
    for (const PreciseMode& m : modes) {
      const auto shapes = static_cast<Index>(m.shapes.size());
      if (m.eigenvalue == 0.0) {
        Matrix kernel(mass_.rows(), shapes);
        for (Index k = 0; k < shapes; ++k)
          for (Index i = 0; i < kernel.rows(); ++i)
            kernel(i, k) = m.shapes[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)].real();
        add_zero_shapes(kernel, m.multiplicity, m.multiplicity - m.shapes.size(), m.error);
        continue;
      }
      for (std::size_t k = 0; k < m.shapes.size(); ++k) {
        Mode one = mode(kind_of(m.eigenvalue), m.eigenvalue, m.error);
        if (k == 0) one.chain += m.multiplicity - m.shapes.size();
        const ComplexVector shape =
            Eigen::Map<const ComplexVector>(m.shapes[k].data(), static_cast<Index>(m.shapes[k].size()));
        add(std::move(one), shape);
      }
    }
  }

  static Mode::Kind kind_of(Complex value) {
    return value.imag() > 0 ? Mode::Kind::Oscillation : value.real() > 0 ? Mode::Kind::Growth : Mode::Kind::Decay;
  }

  // K̂ y = ω² y in coordinates with unit mass.
  void symmetric_modes() {
    out_.symmetric = true;
    const SymmetricEigen parts = symmetric_eigen((form_.k + form_.k.transpose()) / 2);
    const Vector &squares = parts.values, errors = 8 * static_cast<double>(squares.size()) *
                                                   std::numeric_limits<double>::epsilon() * parts.norms;
    std::vector<Index> zeros;
    for (Index i = 0; i < squares.size(); ++i) {
      const Vector vector = parts.vectors.col(i);
      const ComplexVector shape = to_coordinates(vector.cast<Complex>());
      if (std::abs(squares[i]) <= errors[i]) {
        zeros.push_back(i);
        continue;
      }
      const double root = std::sqrt(std::abs(squares[i])), error = errors[i] / (2 * root);
      const double left = (form_.k * vector - squares[i] * vector).norm();
      out_.residual = std::max(out_.residual, left / form_.k.stableNorm());
      if (squares[i] > 0)
        add(mode(Mode::Kind::Oscillation, {0, root}, error), shape);
      else {
        add(mode(Mode::Kind::Growth, {root, 0}, error), shape);
        add(mode(Mode::Kind::Decay, {-root, 0}, error), shape);
      }
    }
    Matrix kernel(squares.size(), static_cast<Index>(zeros.size()));
    for (std::size_t k = 0; k < zeros.size(); ++k) kernel.col(static_cast<Index>(k)) = parts.vectors.col(zeros[k]);
    double error = 0;
    for (const Index i : zeros) error = std::max(error, std::sqrt(errors[i]));
    add_zeros(kernel, 2 * zeros.size(), zeros.size(), error);
  }

  /// Each uncoupled part for itself: slow motions beside fast ones are not rounding of them.
  void quadratic_modes() {
    const Index f = form_.k.rows();
    Zeros zeros{Matrix(f, 0), Matrix(f, 0), 0, 0};
    for (const std::vector<Index>& part : uncoupled_parts(form_.k.cwiseAbs() + form_.c.cwiseAbs()))
      quadratic_modes_of(part, zeros);
    Matrix kernel(f, zeros.chained.cols() + zeros.single.cols());
    kernel << zeros.chained, zeros.single;
    add_zeros(kernel, zeros.count, static_cast<std::size_t>(zeros.chained.cols()), zeros.error);
  }

  struct Zeros {
    Matrix chained, single;  // [f × …] in y: those that begin a Jordan chain, and the others
    std::size_t count = 0;
    double error = 0;
  };

  /// (λ² + λ Ĉ + K̂) y = 0 as ẋ = A x with x = (y, ẏ/s), time in units of 1/s.
  void quadratic_modes_of(const std::vector<Index>& part, Zeros& zeros) {
    const auto f = static_cast<Index>(part.size());
    const Matrix stiffness = form_.k(part, part), rates = form_.c(part, part);
    const double k = stiffness.stableNorm(), c = rates.stableNorm();
    const double s = std::max({std::sqrt(k), c, std::numeric_limits<double>::min()});
    Matrix a = Matrix::Zero(2 * f, 2 * f);
    a.topRightCorner(f, f).setIdentity();
    a.bottomLeftCorner(f, f) = -stiffness / (s * s);
    a.bottomRightCorner(f, f) = -rates / s;
    const EigenSystem system = eigen_system(a);
    for (Index i = 0; i < system.values.size(); ++i) {
      const ComplexVector y = system.vectors.col(i).head(f);
      const Complex z = system.values[i];
      const ComplexVector left =
          z * z * y + z * (rates / s).cast<Complex>() * y + (stiffness / (s * s)).cast<Complex>() * y;
      const double size = std::norm(z) + std::abs(z) * c / s + k / (s * s);
      out_.residual = std::max(out_.residual, left.norm() / y.norm() / size);
      ComplexVector shape = ComplexVector::Zero(form_.k.rows());
      shape(part) = y;
      add_pair(s * z, s * system.errors[i], to_coordinates(shape));
    }
    zeros.count += system.zeros;
    if (system.zeros > 0) zeros.error = std::max(zeros.error, s * system.zero_error);
    for (Index i = 0; i < system.kernel.cols(); ++i) {
      Matrix& of = static_cast<std::size_t>(i) < system.chained ? zeros.chained : zeros.single;
      of.conservativeResize(Eigen::NoChange, of.cols() + 1);
      of.col(of.cols() - 1).setZero();
      of.col(of.cols() - 1)(part) = system.kernel.col(i).head(f);
    }
  }

  // ẋ = A x as it stands, columns scaled by inertia: non-holonomic constraints, or an M that is not positive definite.
  void state_modes() {
    const Matrix a = to_eigen(l_.a), c = to_eigen(l_.c);
    const Index size = a.rows(), n = static_cast<Index>(l_.point.q.size());
    if (size == 0) return;
    Vector scale = balance(a);
    const Matrix balanced = scale.cwiseInverse().asDiagonal() * a * scale.asDiagonal();
    const double s = std::max(balanced.norm(), std::numeric_limits<double>::min());
    const EigenSystem system = eigen_system(balanced / s);
    const Matrix positions = c.topRows(n) * scale.asDiagonal();
    for (Index i = 0; i < system.values.size(); ++i) {
      const ComplexVector x = system.vectors.col(i);
      out_.residual = std::max(out_.residual, ((balanced / s).cast<Complex>() * x - system.values[i] * x).norm());
      add_pair(s * system.values[i], s * system.errors[i], positions.cast<Complex>() * x);
    }
    add_zero_shapes(product(positions, system.kernel), system.zeros, system.chained, s * system.zero_error);
  }

  /// Powers of two that bring rows and columns of A to like sizes (Parlett and Reinsch 1969).
  static Vector balance(Matrix a) {
    Vector scale = Vector::Ones(a.rows());
    for (bool again = true; again;) {
      again = false;
      for (Index i = 0; i < a.rows(); ++i) {
        const double column = a.col(i).lpNorm<1>() - std::abs(a(i, i)), row = a.row(i).lpNorm<1>() - std::abs(a(i, i));
        if (!(column > 0) || !(row > 0)) continue;
        const double f = std::ldexp(1, std::ilogb(std::sqrt(row / column)));
        if (!(column * f + row / f < 0.95 * (column + row))) continue;
        a.col(i) *= f;
        a.row(i) /= f;
        scale[i] *= f;
        again = true;
      }
    }
    return scale;
  }

  ComplexVector to_coordinates(const ComplexVector& y) const {
    return to_eigen(l_.positions).cast<Complex>() * (form_.to_independent.cast<Complex>() * y);
  }

  /// Of a complex pair the one with Im λ > 0; real ones each.
  void add_pair(Complex value, double error, const ComplexVector& shape) {
    if (value.imag() < 0) return;
    if (equations_.energy_never_grows() && negligible_damping() && std::abs(value.real()) <= error) value.real(0);
    add(mode(kind_of(value), value, error), shape);
  }
  bool negligible_damping() const {
    return l_.second_order() && negligible(to_eigen(l_.damping), to_eigen(l_.gyroscopic));
  }

  void add(Mode mode, ComplexVector shape) {
    mode.shape = normalised(std::move(shape));
    out_.modes.push_back(std::move(mode));
  }

  /// Unit modal mass where that is positive, else the largest part 1; the largest part real and positive.
  std::vector<Complex> normalised(ComplexVector shape) const {
    Vector weight = mass_.diagonal().cwiseAbs().cwiseSqrt();
    if (weight.isZero(0)) weight.setOnes();
    Index at = 0;
    shape.cwiseAbs().cwiseProduct(weight).maxCoeff(&at);
    if (std::abs(shape[at]) == 0) return {shape.data(), shape.data() + shape.size()};
    shape *= std::conj(shape[at]) / std::abs(shape[at]);
    const double modal_mass = (shape.adjoint() * mass_.cast<Complex>() * shape)(0).real();
    shape /= modal_mass > 0 ? std::sqrt(modal_mass) : std::abs(shape[at]);
    // No minus signs from rounding. What has no inertia cannot be compared by it with the others, but with its like.
    const double size = shape.cwiseAbs().cwiseProduct(weight).maxCoeff();
    double massless = 0;
    for (Index i = 0; i < shape.size(); ++i)
      if (weight[i] == 0) massless = std::max(massless, std::abs(shape[i]));
    for (Index i = 0; i < shape.size(); ++i) {
      const double unit = weight[i] > 0 ? weight[i] : 1, least = 1e-13 * (weight[i] > 0 ? size : massless);
      if (std::abs(shape[i].imag()) * unit < least) shape[i].imag(0);
      if (std::abs(shape[i].real()) * unit < least) shape[i].real(0);
    }
    return {shape.data(), shape.data() + shape.size()};
  }

  // ------------------------------------------------------------------------------------------------------- zero modes

  void add_zeros(const Matrix& kernel_y, std::size_t zeros, std::size_t chained, double error) {
    add_zero_shapes(product(product(to_eigen(l_.positions), form_.to_independent), kernel_y), zeros, chained, error);
  }

  /// Where symmetries span the kernel, each of them is a mode of its own. The others may be as large as `error`.
  void add_zero_shapes(const Matrix& kernel, std::size_t zeros, std::size_t chained, double error) {
    const Index d = kernel.cols();
    Matrix shapes = kernel;
    std::vector<std::string> causes(static_cast<std::size_t>(d));
    std::size_t explained = 0;
    const std::size_t ways = equilibrium_ ? equilibrium_->ways.size() : 0;  // the first ones
    for (std::size_t k = 0; k < translations_.size(); ++k) {
      const Vector direction = to_eigen(translations_[k].direction);
      if (static_cast<Index>(explained) >= d || !in_span(direction, kernel)) continue;
      shapes.col(static_cast<Index>(explained)) = direction;
      causes[explained++] = k >= ways ? "translation along " + name_of(translations_[k])
                            : k == 0  ? "onward along the steady motion"
                                      : "turned by a rotation that is a symmetry";
    }
    if (explained > 0 && explained < static_cast<std::size_t>(d))
      complete(shapes, kernel, static_cast<Index>(explained));
    std::size_t left = zeros;
    for (Index k = 0; k < d; ++k) {
      Mode zero = mode(Mode::Kind::Zero, 0, 0);
      zero.zeros = k + 1 == d ? left : std::min<std::size_t>(left, static_cast<std::size_t>(k) < chained ? 2 : 1);
      left -= std::min(left, zero.zeros);
      zero.cause = causes[static_cast<std::size_t>(k)];
      if (zero.cause.empty()) zero.error = error;
      add(std::move(zero), shapes.col(k).cast<Complex>());
    }
  }

  static bool in_span(const Vector& x, const Matrix& basis) {
    const Vector rest = x - basis * least_squares(basis, x, 1e-12).x;
    return rest.norm() <= 1e-7 * x.norm();
  }

  /// The further columns span what the first ones leave of the kernel, orthogonal to them in the metric M.
  void complete(Matrix& shapes, const Matrix& kernel, Index explained) const {
    const Matrix known = shapes.leftCols(explained);
    Matrix rest = kernel;
    const Matrix metric = transposed_product(known, mass_);
    const Matrix gram = product(metric, known);
    rest -= product(known, least_squares(gram, product(metric, kernel), 1e-12).x);
    const std::vector<std::size_t> columns = pivot_columns(rest, 1e-9);
    for (std::size_t k = 0; k < columns.size() && explained + static_cast<Index>(k) < shapes.cols(); ++k)
      shapes.col(explained + static_cast<Index>(k)) = rest.col(static_cast<Index>(columns[k]));
  }

  std::string name_of(const Translation& t) const {
    std::string out;
    std::size_t count = 0;
    for (std::size_t i = 0; i < t.direction.size(); ++i)
      if (t.direction[i] != 0) out += (count++ ? ", " : "") + equations_.system().coordinates[i].name;
    return count > 1 ? "(" + out + ")" : out;
  }

  // ----------------------------------------------------------------------------------------------------------- the end

  /// Eigenvalues that are one within their errors, and whose shapes are one as well, are a Jordan chain: their mean is
  /// known better than each.
  void join_chains() {
    std::vector<Mode> left;
    for (const Mode& m : out_.modes) {
      const auto same = std::find_if(left.begin(), left.end(), [&](const Mode& x) {
        return x.kind == m.kind && m.kind != Mode::Kind::Zero &&
               std::abs(x.eigenvalue - m.eigenvalue) <= x.error + m.error && are_parallel(x.shape, m.shape);
      });
      if (same == left.end()) {
        left.push_back(m);
        continue;
      }
      const auto count = static_cast<double>(same->chain);
      same->eigenvalue = (count * same->eigenvalue + m.eigenvalue) / (count + 1);
      constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
      if (std::abs(same->eigenvalue.real()) <= rounding * std::abs(same->eigenvalue)) same->eigenvalue.real(0);
      same->error = std::max(same->error, m.error);
      same->chain += m.chain;
    }
    out_.modes = std::move(left);
  }

  bool are_parallel(const std::vector<Complex>& x, const std::vector<Complex>& y) const {
    constexpr double rounding = 1e-6;
    const auto size = static_cast<Index>(x.size());
    const Eigen::Map<const ComplexVector> a(x.data(), size), b(y.data(), size);
    return (a - b * (b.dot(a) / b.squaredNorm())).norm() <= rounding * a.norm();
  }

  void finish() {
    for (const Mode& m : out_.modes) {
      const std::size_t count = m.kind == Mode::Kind::Zero ? m.zeros : m.chain;
      out_.eigenvalues.insert(out_.eigenvalues.end(), count, m.eigenvalue);
      if (m.kind == Mode::Kind::Oscillation)
        out_.eigenvalues.insert(out_.eigenvalues.end(), count, std::conj(m.eigenvalue));
    }
    std::sort(out_.eigenvalues.begin(), out_.eigenvalues.end(), [](const Complex& x, const Complex& y) {
      return x.real() != y.real() ? x.real() < y.real() : x.imag() < y.imag();
    });
    std::stable_sort(out_.modes.begin(), out_.modes.end(), [](const Mode& x, const Mode& y) {
      const bool zx = x.kind == Mode::Kind::Zero, zy = y.kind == Mode::Kind::Zero;
      if (zx != zy) return zx;
      if (x.frequency() != y.frequency()) return x.frequency() < y.frequency();
      return x.eigenvalue.real() > y.eigenvalue.real();
    });
    for (Mode& m : out_.modes) {
      m.multiplicity = 0;
      for (const Mode& other : out_.modes)
        if (std::abs(m.eigenvalue - other.eigenvalue) <= m.error + other.error) m.multiplicity += other.chain;
    }
    out_.stability = judge_stability(equations_, l_, form_, translations_, out_, equilibrium_);
  }

  const PointEquations& equations_;
  const Linearization& l_;
  const std::vector<Translation>& translations_;
  const Equilibrium* equilibrium_;
  MassNormalForm form_;
  Matrix mass_;
  ModalAnalysis out_;
};

}  // namespace

MassNormalForm mass_normal_form(const Linearization& l, const std::vector<Translation>& translations) {
  MassNormalForm out;
  if (!l.second_order() || l.independent.empty()) return out;
  const Matrix mass = to_eigen(l.mass);
  const std::optional<Cholesky> factor = cholesky(mass);
  if (!factor) return out;
  const auto both_sides = [&](const Matrix& m) {
    return product_transposed(product(factor->inverse, m), factor->inverse);
  };
  const Matrix damping = to_eigen(l.damping), gyroscopic = to_eigen(l.gyroscopic),
               circulatory = to_eigen(l.circulatory);
  out.k = both_sides(to_eigen(l.stiffness) + circulatory);
  out.c = both_sides(damping + gyroscopic);
  const Matrix no_potential = both_sides(circulatory);
  out.symmetric = out.potential = true;
  for (const std::vector<Index>& part : uncoupled_parts(out.k.cwiseAbs() + out.c.cwiseAbs())) {
    const double stiffness = Matrix(out.k(part, part)).stableNorm(), rates = Matrix(out.c(part, part)).stableNorm(),
                 circulation = Matrix(no_potential(part, part)).norm();
    out.symmetric &= rates <= 1e-14 * std::sqrt(stiffness) && circulation <= 1e-14 * stiffness;
    out.potential &= circulation <= 1e-12 * stiffness;
  }
  out.to_independent = factor->inverse.transpose();
  Matrix directions(mass.rows(), static_cast<Index>(translations.size()));
  for (std::size_t t = 0; t < translations.size(); ++t)
    for (std::size_t i = 0; i < l.independent.size(); ++i)
      directions(static_cast<Index>(i), static_cast<Index>(t)) = translations[t].direction[l.independent[i]];
  out.translations = transposed_product(factor->lower, directions);
  out.valid = true;
  return out;
}

ModalAnalysis modal_analysis(const PointEquations& equations, const Linearization& linearization,
                             const std::vector<Translation>& translations, const Equilibrium* equilibrium) {
  return Analysis(equations, linearization, translations, equilibrium).carry_out();
}

}  // namespace maupertuis
