#pragma once
#include "../model_text.hpp"

#include <maupertuis/modes.hpp>

#include <algorithm>
#include <cmath>

/// A pendulum of 70 cm in Cartesian coordinates, held by its rod; the start is left to the test.
inline const std::string cartesian_pendulum = R"(system cartesian
param m = 2 kg, l = 70 cm, g = 9.81 m/s^2
coord x, y : length
point P mass m at (x, y)
gravity (0, -g)
constraint x^2 + y^2 = l^2 name rod
)";

/// A model with its equations at points, starting where it says (numbers alone, no constraints are solved for).
struct Linearized : ModelText {
  maupertuis::PointEquations at;
  maupertuis::MotionState start;

  explicit Linearized(std::string text) : ModelText(std::move(text)), at(equations) {
    start = {0, std::vector<double>(system->coordinates.size()), std::vector<double>(system->coordinates.size())};
    const maupertuis::Bindings bindings = maupertuis::parameter_bindings(*system);
    for (const maupertuis::StartValue& s : model.experiment.start)
      (s.order == 0 ? start.q : start.v)[s.coordinate] = maupertuis::evaluate(s.value, bindings);
  }

  maupertuis::ModalStudy study() {
    auto result = maupertuis::modal_study(at, start, diagnostics);
    INFO(maupertuis::render(diagnostics, source));
    REQUIRE(result);
    return std::move(*result);
  }

  /// About the values of the start, all of them kept.
  maupertuis::ModalEntry here(const std::vector<std::size_t>& rates = {}) {
    std::vector<maupertuis::StartValue> given;
    for (std::size_t i = 0; i < start.q.size(); ++i) given.push_back({i, 0, number(start.q[i]), {}, {}});
    for (const std::size_t i : rates) given.push_back({i, 1, number(start.v[i]), {}, {}});
    auto result = maupertuis::modal_study_at(at, start, given, diagnostics);
    INFO(maupertuis::render(diagnostics, source));
    REQUIRE(result);
    return std::move(result->entries.front());
  }

  maupertuis::Expr number(double x) const { return system->context->number(maupertuis::Rational::from_double(x)); }
};

/// Of the modes that oscillate, ascending.
inline std::vector<double> frequencies(const maupertuis::ModalAnalysis& analysis) {
  std::vector<double> out;
  for (const maupertuis::Mode& m : analysis.modes)
    if (m.kind == maupertuis::Mode::Kind::Oscillation) out.push_back(m.frequency());
  std::sort(out.begin(), out.end());
  return out;
}

inline bool near(double a, double b, double relative) {
  return std::abs(a - b) <= relative * std::max(std::abs(a), std::abs(b));
}

/// How far the characteristic polynomial of a matrix is from vanishing at values, relative to the sum of the sizes of
/// its terms and of a thousandth of ‖A‖^(n−k) |z|^k, below which coefficients may be rounding alone (those that vanish
/// are). By Faddeev and Leverrier, which shares nothing with the eigenvalue routines.
inline double largest_root_error(const maupertuis::RealMatrix& a, const std::vector<std::complex<double>>& values) {
  const std::size_t n = a.rows;
  std::vector<double> coefficients(n + 1, 0), power(n * n, 0), next(n * n);
  coefficients[n] = 1;
  for (std::size_t k = 1; k <= n; ++k) {
    for (std::size_t i = 0; i < n; ++i) power[i * n + i] += coefficients[n - k + 1];
    double trace = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        double sum = 0;
        for (std::size_t s = 0; s < n; ++s) sum += a.at(i, s) * power[s * n + j];
        next[i * n + j] = sum;
        if (i == j) trace += sum;
      }
    power = next;
    coefficients[n - k] = -trace / static_cast<double>(k);
  }
  double norm = 0, worst = 0;
  for (const double x : a.entries) norm = std::hypot(norm, x);
  for (const auto& z : values) {
    std::complex<double> value = 0;
    double size = 0, power_of_norm = 1e-3;
    for (std::size_t k = n + 1; k-- > 0; power_of_norm *= norm) {
      value = value * z + coefficients[k];
      size = size * std::abs(z) + std::abs(coefficients[k]) + power_of_norm;
    }
    worst = std::max(worst, std::abs(value) / size);
  }
  return worst;
}
