#include "analysis/invariants/linear_fit.hpp"

#include "analysis/invariants/parameter_fit.hpp"

#include <algorithm>

namespace maupertuis::invariants {
namespace {

std::vector<Expr> flat(const LinearFitRows& fit) {
  std::vector<Expr> out;
  for (const auto& row : fit.rows) out.insert(out.end(), row.begin(), row.end());
  return out;
}

/// At these parameters, from a few more points than there are unknowns.
std::optional<std::vector<Value>> solution_at(const ParameterRoots& roots, const LinearFitRows& fit,
                                              MotionSampler& sampler) {
  const std::size_t width = fit.unknowns + 1, points = width / fit.rows.size() + 3;
  FieldMatrix m(points * fit.rows.size(), width);
  for (std::size_t p = 0; p < points; ++p) {
    const auto sample = sampler.draw(roots);
    if (!sample) return std::nullopt;
    std::copy(sample->values.begin(), sample->values.end(),
              m.entries.begin() + static_cast<std::ptrdiff_t>(p * sample->values.size()));
  }
  return solve(std::move(m), sampler.field());
}

/// The columns with a factor other than 0: as functions they are independent, since `solve` leaves the others free.
std::optional<std::vector<std::size_t>> columns_used(const MotionRows& motion, const LinearFitRows& fit,
                                                     std::uint64_t seed) {
  MotionSampler sampler(motion, flat(fit), false, seed);
  const auto roots = sampler.usable_parameters();
  const auto solution = roots ? solution_at(*roots, fit, sampler) : std::nullopt;
  if (!solution) return std::nullopt;
  std::vector<std::size_t> used;
  for (std::size_t k = 0; k < solution->size(); ++k)
    if ((*solution)[k] != 0) used.push_back(k);
  return used;
}

LinearFitRows of_columns(const LinearFitRows& fit, const std::vector<std::size_t>& columns) {
  LinearFitRows out;
  out.unknowns = columns.size();
  for (const auto& row : fit.rows) {
    out.rows.emplace_back();
    for (const std::size_t k : columns) out.rows.back().push_back(row[k]);
    out.rows.back().push_back(row.back());
  }
  return out;
}

}  // namespace

bool depends_at_a_point(const MotionRows& motion, const LinearFitRows& fit, std::uint64_t seed) {
  MotionSampler sampler(motion, flat(fit), false, seed);
  const auto roots = sampler.usable_parameters();
  const auto sample = roots ? sampler.draw(*roots) : std::nullopt;
  if (!sample) return true;
  FieldMatrix m(fit.rows.size(), fit.unknowns + 1);
  m.entries = sample->values;
  return solve(std::move(m), sampler.field()).has_value();
}

std::optional<std::vector<Expr>> fit_constants(const MotionRows& motion, const LinearFitRows& fit, std::uint64_t seed) {
  const auto used = fit.rows.empty() ? std::nullopt : columns_used(motion, fit, seed);
  if (!used) return std::nullopt;
  std::vector<Expr> out(fit.unknowns);
  if (used->empty()) return out;
  // At all other parameters these columns alone are looked at: fewer points, and fewer functions at each.
  const LinearFitRows shorter = of_columns(fit, *used);
  MotionSampler sampler(motion, flat(shorter), false, seed);
  ParameterFit parameters(sampler, [&](const ParameterRoots& roots) -> std::optional<std::vector<std::vector<Value>>> {
    auto solution = solution_at(roots, shorter, sampler);
    if (!solution || std::count(solution->begin(), solution->end(), Value{0}) > 0) return std::nullopt;
    return std::vector<std::vector<Value>>{std::move(*solution)};
  });
  if (!parameters.prepare()) return std::nullopt;
  for (std::size_t k = 0; k < used->size(); ++k) {
    const auto c = parameters.find(0, k);
    if (!c) return std::nullopt;
    out[(*used)[k]] = expression(*c, sampler.parameters(), *motion.system->context);
  }
  return out;
}

}  // namespace maupertuis::invariants
