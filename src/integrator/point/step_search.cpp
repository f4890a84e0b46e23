#include "integrator/point/step_search.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int most_pieces = 1500;
constexpr double shortest = 0x1p-30;
/// What interpolation at Chebyshev points adds to the best polynomial: 1 + Lebesgue's constant, and the rest of the
/// series.
constexpr double of_interpolation = 4.0;

template <std::size_t N>
std::array<double, N> chebyshev_points() {
  std::array<double, N> out;
  for (std::size_t j = 0; j < N; ++j) out[j] = -std::cos(pi * (static_cast<double>(j) + 0.5) / static_cast<double>(N));
  return out;
}

/// Of ∫ f dx over [−1, 1] by values at these points (Fejér's first rule).
std::array<double, StepSearch::piece_points> fejer_weights() {
  constexpr std::size_t n = StepSearch::piece_points;
  std::array<double, n> out;
  for (std::size_t j = 0; j < n; ++j) {
    const double angle = pi * (static_cast<double>(j) + 0.5) / n;
    double sum = 1;
    for (std::size_t k = 1; k <= n / 2; ++k) {
      const double twice = 2.0 * static_cast<double>(k);
      sum -= 2 * std::cos(twice * angle) / (twice * twice - 1);
    }
    out[j] = 2 * sum / n;
  }
  return out;
}

using Path = std::array<double, StepSearch::path_points>;

double value(const Path& c, double x) {
  double sum = 0;
  for (std::size_t k = c.size(); k-- > 0;) sum = sum * x + c[k];
  return sum;
}

/// Newton's divided differences, multiplied out. What rounding leaves of coefficients that vanish is taken out: on a
/// large disk it would count.
Path coefficients(Path values) {
  const auto& x = StepSearch::path_nodes();
  const std::size_t n = values.size();
  double size = 0;
  for (const double v : values) size = std::max(size, std::abs(v));
  for (std::size_t k = 1; k < n; ++k)
    for (std::size_t j = n - 1; j >= k; --j) values[j] = (values[j] - values[j - 1]) / (x[j] - x[j - k]);
  Path out{};
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = n - 1; j > 0; --j) out[j] = out[j - 1] - x[k] * out[j];
    out[0] = values[k] - x[k] * out[0];
  }
  for (std::size_t k = 2; k < n; ++k)
    if (std::abs(out[k]) < 1e-14 * size) out[k] = 0;
  return out;
}

/// Σ_{k≥1} |coefficient of s^k| radius^k about x = centre.
double reach_of(Path c, double centre, double radius) {
  for (std::size_t k = 0; k < c.size(); ++k)
    for (std::size_t j = c.size() - 1; j-- > k;) c[j] += centre * c[j + 1];
  double sum = 0;
  for (std::size_t k = c.size(); k-- > 1;) sum = (sum + std::abs(c[k])) * radius;
  return sum;
}

}  // namespace

const std::array<double, StepSearch::path_points>& StepSearch::path_nodes() {
  static const auto nodes = chebyshev_points<path_points>();
  return nodes;
}

StepSearch::StepSearch(const FunctionKernel& function, std::span<const double> parameters)
    : function_(function),
      work_(function),
      disks_(function, parameters),
      path_(function.inputs()),
      point_(function.inputs()),
      reach_(function.inputs()),
      values_(function.outputs()),
      tails_(function.outputs()) {
  work_.set_parameters(parameters);
}

void StepSearch::set_path(std::span<const double> points) {
  const std::size_t n = path_.size();
  for (std::size_t i = 0; i < n; ++i) {
    Path values;
    for (std::size_t j = 0; j < path_points; ++j) values[j] = points[j * n + i];
    path_[i] = coefficients(values);
  }
}

std::span<const double> StepSearch::values_at(double x) {
  for (std::size_t i = 0; i < path_.size(); ++i) point_[i] = value(path_[i], x);
  work_.evaluate(point_, values_);
  return values_;
}

/// A large disk leaves least to its tail, a small one meets least that is singular.
bool StepSearch::is_resolved(const Piece& piece, const Small& small) {
  for (std::size_t i = 0; i < path_.size(); ++i) point_[i] = value(path_[i], piece.centre);
  disks_.set_centre(point_);
  for (const double ratio : {8.0, 5.0, 3.5}) {
    for (std::size_t i = 0; i < path_.size(); ++i) reach_[i] = reach_of(path_[i], piece.centre, ratio * piece.half);
    disks_.evaluate(reach_);
    const double left_out = of_interpolation * std::pow(ratio, -static_cast<double>(piece_points)) / (1 - 1 / ratio);
    for (std::size_t k = 0; k < tails_.size(); ++k) tails_[k] = left_out * disks_.tail(k);
    if (small(tails_)) return true;
  }
  return false;
}

StepSearch::Outcome StepSearch::visit(const Small& small, const Visitor& visitor) {
  static const auto nodes = chebyshev_points<piece_points>();
  static const auto weights = fejer_weights();
  std::vector<Piece> open{{0, 1}};
  for (int count = 0; !open.empty(); ++count) {
    if (count > most_pieces) return Outcome::TooRough;
    const Piece piece = open.back();
    open.pop_back();
    const bool switched = piece.half < shortest, resolved = switched || is_resolved(piece, small);
    if (!resolved) {
      const double half = piece.half / 2;
      open.push_back({piece.centre + half, half});
      open.push_back({piece.centre - half, half});
      continue;
    }
    for (std::size_t j = 0; j < piece_points; ++j) {
      const double x = piece.centre + piece.half * nodes[j];
      const auto found = values_at(x);
      for (const double f : found)
        if (!std::isfinite(f)) return Outcome::NotFinite;
      if (!visitor(x, piece.half * weights[j], found, switched)) return Outcome::Stopped;
    }
  }
  return Outcome::Seen;
}

}  // namespace maupertuis
