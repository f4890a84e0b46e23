#include "mirrored.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::app {
namespace {

constexpr double same = 1e-9;  // of the larger one, or of the largest entry

bool equal(double x, double y) { return std::abs(x - y) <= same * std::max(std::abs(x), std::abs(y)); }

/// Whether y = S x S with S = diag(signs).
bool is_turned(const RealMatrix& x, const RealMatrix& y, const std::vector<double>& signs) {
  if (x.rows != y.rows || x.columns != y.columns || (x.rows > 0 && x.rows != signs.size())) return false;
  double largest = 0;
  for (const double entry : x.entries) largest = std::max(largest, std::abs(entry));
  for (std::size_t i = 0; i < x.rows; ++i)
    for (std::size_t j = 0; j < x.columns; ++j)
      if (!(std::abs(y.at(i, j) - signs[i] * signs[j] * x.at(i, j)) <= same * largest)) return false;
  return true;
}

std::vector<double> signs_of(const std::vector<std::size_t>& coordinates, const std::vector<double>& signs) {
  std::vector<double> out;
  for (const std::size_t i : coordinates) out.push_back(signs[i]);
  return out;
}

bool has_more(const ModalEntry& e) {
  return !e.side.empty() || e.in_rates || e.linearization.b.columns > 0 || e.linearization.measured.c.rows > 0;
}

bool is_mirror_image(const ModalEntry& x, const ModalEntry& y, const std::vector<double>& signs) {
  const Linearization &a = x.linearization, &b = y.linearization;
  if (x.equilibrium.at_rest != y.equilibrium.at_rest || x.analysis.stability.verdict != y.analysis.stability.verdict ||
      a.independent != b.independent || a.independent_velocities != b.independent_velocities ||
      x.analysis.modes.size() != y.analysis.modes.size())
    return false;
  std::vector<double> states = signs_of(a.independent, signs);
  const std::vector<double> positions = states;
  for (const double sign : signs_of(a.independent_velocities, signs)) states.push_back(sign);
  return is_turned(a.a, b.a, states) && is_turned(a.mass, b.mass, positions) &&
         is_turned(a.damping, b.damping, positions) && is_turned(a.gyroscopic, b.gyroscopic, positions) &&
         is_turned(a.stiffness, b.stiffness, positions) && is_turned(a.circulatory, b.circulatory, positions);
}

}  // namespace

std::optional<Mirrored> mirrored(const ModalStudy& study, std::size_t entry) {
  const ModalEntry& here = study.entries[entry];
  const OperatingPoint& point = here.equilibrium.point;
  if (has_more(here) || here.analysis.modes.empty()) return std::nullopt;
  for (std::size_t k = 0; k < entry; ++k) {
    const OperatingPoint& other = study.entries[k].equilibrium.point;
    Mirrored out{k};
    std::vector<double> signs(point.q.size(), 1);
    bool same_place = true;
    for (std::size_t i = 0; i < point.q.size(); ++i) {
      if (point.q[i] != 0 && equal(point.q[i], -other.q[i])) signs[i] = -1, out.turned.push_back(i);
      same_place = same_place && equal(point.q[i], signs[i] * other.q[i]) && equal(point.v[i], signs[i] * other.v[i]);
    }
    if (same_place && !out.turned.empty() && !has_more(study.entries[k]) &&
        is_mirror_image(study.entries[k], here, signs))
      return out;
  }
  return std::nullopt;
}

}  // namespace maupertuis::app
