#pragma once
#include "../model_text.hpp"

#include <maupertuis/extended_simulation.hpp>
#include <maupertuis/tangent.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

inline maupertuis::MotionState start_of(const ModelText& m) {
  maupertuis::Diagnostics diagnostics;
  const auto start = maupertuis::consistent_start(m.model, m.equations, diagnostics);
  REQUIRE(start);
  return start->state;
}

/// ∂(q,q̇)(t) / ∂(direction) of the model's start, in every direction that the constraints allow.
inline maupertuis::TangentPoint carried(const ModelText& m, double t, const maupertuis::TangentOptions& options = {}) {
  maupertuis::TangentFlow flow(m.equations, options);
  maupertuis::TangentPoint point = flow.all_directions(start_of(m));
  const auto stop = flow.advance(point, t);
  if (stop) FAIL(stop->reason);
  return point;
}

/// The largest difference of two lists, against the largest entry of the second.
inline double relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference = std::max(difference, std::abs(a[i] - b[i])), size = std::max(size, std::abs(b[i]));
  return difference / size;
}

/// The determinant, by elimination.
inline double determinant(std::vector<double> a) {
  const auto n = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(a.size()))));
  double product = 1;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < n; ++i)
      if (std::abs(a[i * n + k]) > std::abs(a[pivot * n + k])) pivot = i;
    if (pivot != k) {
      for (std::size_t j = 0; j < n; ++j) std::swap(a[k * n + j], a[pivot * n + j]);
      product = -product;
    }
    product *= a[k * n + k];
    for (std::size_t i = k + 1; i < n; ++i)
      for (std::size_t j = n; j-- > k;) a[i * n + j] -= a[i * n + k] / a[k * n + k] * a[k * n + j];
  }
  return product;
}

/// The final state in quad precision when one component of the start (order 0: q, 1: q̇) is moved by `by`.
inline std::vector<std::string> quad_end(const ModelText& m, double t, std::size_t coordinate, int order,
                                         const maupertuis::Rational& by) {
  maupertuis::Model model = m.model;
  maupertuis::Context& context = *m.system->context;
  bool written = false;
  for (auto& start : model.experiment.start)
    if (start.coordinate == coordinate && start.order == order)
      start.value = start.value + context.number(by), written = true;
  if (!written) model.experiment.start.push_back({coordinate, order, context.number(by), {1, 2}, {}});
  maupertuis::ExtendedSimulationOptions options;
  options.duration = maupertuis::Rational::from_double(t);
  maupertuis::Diagnostics diagnostics;
  const auto result = maupertuis::simulate_extended(model, m.equations, options, diagnostics);
  REQUIRE(result);
  REQUIRE(result->ok());
  std::vector<std::string> out;
  for (const auto* part : {&result->final.q, &result->final.v})
    for (const auto& x : *part) out.push_back(x.text);
  return out;
}
