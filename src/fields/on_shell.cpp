#include "fields/on_shell.hpp"

#include <maupertuis/evaluate.hpp>

#include <algorithm>

namespace maupertuis {
namespace {

/// Higher first: by time, then by all derivatives.
bool is_higher(const FieldJet& a, const FieldJet& b) {
  if (a.time != b.time) return a.time > b.time;
  return a.order() > b.order();
}

bool is_linear_in(Expr residual, Expr slope, Expr jet) {
  const Expr roots[] = {slope};
  const std::vector<Expr> below = symbols_of(roots);
  return std::find(below.begin(), below.end(), jet) == below.end() && !slope.is_zero() &&
         residual.context().node_count() > 0;
}

/// What is to be differentiated further to go from `low` to `high`; nothing where high is no derivative of low.
std::optional<FieldJet> beyond(const FieldJet& high, const FieldJet& low) {
  if (high.field != low.field || high.time < low.time) return std::nullopt;
  FieldJet out = high;
  out.time -= low.time;
  for (std::size_t x = 0; x < high.space.size(); ++x)
    if ((out.space[x] -= low.space[x]) < 0) return std::nullopt;
  return out;
}

}  // namespace

OnShell::OnShell(const FieldEquations& equations) : s_(equations.system()) {
  const auto all = [&] {
    ExprMap out;
    for (const Solved& known : solved_) out[s_.jet_symbol(known.jet)] = known.value;
    return out;
  };
  for (const Expr& written : equations.residuals) {
    // Equations with more than one such derivative, of fields with mass in common, are solved together.
    const Expr residual = substitute(s_.expanded(written), all());
    const std::vector<Expr> jets = s_.jets_in(residual);
    const std::vector<Expr> slopes = gradient(residual, jets);
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < jets.size(); ++i) {
      const FieldJet jet = *s_.jet_of(jets[i]);
      if (s_.fields[jet.field].given || jet.order() == 0 || !is_linear_in(residual, slopes[i], jets[i])) continue;
      const bool taken = std::any_of(solved_.begin(), solved_.end(),
                                     [&](const Solved& o) { return beyond(jet, o.jet) || beyond(o.jet, jet); });
      if (!taken && (!best || is_higher(jet, *s_.jet_of(jets[*best])))) best = i;
    }
    if (!best) {
      complete_ = false;
      leading_.push_back({}), coefficient_.push_back({});
      continue;
    }
    const Expr rest = substitute(residual, {{jets[*best], s_.context->number(0)}});
    leading_.push_back(jets[*best]);
    coefficient_.push_back(slopes[*best]);
    const Expr value = -rest / slopes[*best];
    for (Solved& known : solved_) known.value = substitute(known.value, {{jets[*best], value}});
    solved_.push_back({*s_.jet_of(jets[*best]), value});
  }
}

std::optional<Expr> OnShell::reduced(Expr e) const {
  e = s_.expanded(e);
  constexpr int most = 40;
  for (int round = 0; round < most; ++round) {
    ExprMap replacements;
    for (const Expr& symbol : s_.jets_in(e)) {
      const FieldJet jet = *s_.jet_of(symbol);
      for (const Solved& solved : solved_) {
        const auto further = beyond(jet, solved.jet);
        if (!further) continue;
        Expr value = solved.value;
        for (std::size_t x = 0; x < s_.space.size(); ++x)
          for (int k = 0; k < further->space[x]; ++k) value = s_.total_derivative(value, x);
        for (int k = 0; k < further->time; ++k) value = s_.total_derivative(value, s_.space.size());
        replacements[symbol] = value;
        break;
      }
    }
    if (replacements.empty()) return e;
    e = substitute(e, replacements);
  }
  return std::nullopt;
}

}  // namespace maupertuis
