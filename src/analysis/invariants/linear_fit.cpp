#include "analysis/invariants/linear_fit.hpp"

#include "analysis/invariants/parameter_fit.hpp"

namespace maupertuis::invariants {
namespace {

class Fitter {
 public:
  Fitter(const MotionRows& motion, const LinearFitRows& fit, std::uint64_t seed)
      : fit_(fit), sampler_(motion, flat(fit), false, seed), context_(*motion.system->context) {}

  std::optional<std::vector<Expr>> carry_out() {
    const auto roots = sampler_.usable_parameters();
    const auto first = roots ? solution_at(*roots) : std::nullopt;
    if (!first) return std::nullopt;
    for (std::size_t k = 0; k < first->size(); ++k)
      if ((*first)[k] != 0) used_.push_back(k);
    std::vector<Expr> out(fit_.unknowns);
    if (used_.empty()) return out;
    ParameterFit parameters(sampler_, [this](const ParameterRoots& roots) { return entries_at(roots); });
    if (!parameters.prepare()) return std::nullopt;
    for (std::size_t k = 0; k < used_.size(); ++k) {
      const auto c = parameters.find(0, k);
      if (!c) return std::nullopt;
      out[used_[k]] = expression(*c, sampler_.parameters(), context_);
    }
    return out;
  }

 private:
  static std::vector<Expr> flat(const LinearFitRows& fit) {
    std::vector<Expr> out;
    for (const auto& row : fit.rows) out.insert(out.end(), row.begin(), row.end());
    return out;
  }

  std::optional<std::vector<Value>> solution_at(const ParameterRoots& roots) {
    const std::size_t width = fit_.unknowns + 1, points = width / fit_.rows.size() + 3;
    FieldMatrix m(points * fit_.rows.size(), width);
    for (std::size_t p = 0; p < points; ++p) {
      const auto sample = sampler_.draw(roots);
      if (!sample) return std::nullopt;
      std::copy(sample->values.begin(), sample->values.end(),
                m.entries.begin() + static_cast<std::ptrdiff_t>(p * sample->values.size()));
    }
    return solve(std::move(m), sampler_.field());
  }

  std::optional<std::vector<std::vector<Value>>> entries_at(const ParameterRoots& roots) {
    const auto solution = solution_at(roots);
    if (!solution) return std::nullopt;
    std::vector<Value> out;
    for (const std::size_t k : used_) {
      if ((*solution)[k] == 0) return std::nullopt;
      out.push_back((*solution)[k]);
    }
    return std::vector<std::vector<Value>>{out};
  }

  const LinearFitRows& fit_;
  MotionSampler sampler_;
  Context& context_;
  std::vector<std::size_t> used_;
};

}  // namespace

bool depends_at_a_point(const MotionRows& motion, const LinearFitRows& fit, std::uint64_t seed) {
  std::vector<Expr> flat;
  for (const auto& row : fit.rows) flat.insert(flat.end(), row.begin(), row.end());
  MotionSampler sampler(motion, flat, false, seed);
  const auto roots = sampler.usable_parameters();
  const auto sample = roots ? sampler.draw(*roots) : std::nullopt;
  if (!sample) return true;
  FieldMatrix m(fit.rows.size(), fit.unknowns + 1);
  m.entries = sample->values;
  return solve(std::move(m), sampler.field()).has_value();
}

std::optional<std::vector<Expr>> fit_constants(const MotionRows& motion, const LinearFitRows& fit, std::uint64_t seed) {
  return fit.rows.empty() ? std::nullopt : Fitter(motion, fit, seed).carry_out();
}

}  // namespace maupertuis::invariants
