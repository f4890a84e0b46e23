#include "analysis/hamiltonian/canonical_kernel.hpp"

#include <maupertuis/integral_symbol.hpp>

namespace maupertuis::phase_space {
namespace {

class CanonicalSource {
 public:
  CanonicalSource(const Hamiltonian& h, const EquationsOfMotion& equations)
      : h_(h), equations_(equations), context_(*h.system->context) {
    for (const Coordinate& c : h.system->coordinates) add_state(c.q, c.name);
    for (std::size_t i = 0; i < h.momenta.size(); ++i) add_state(h.momenta[i], momentum_name(*h.system, i));
    for (const Parameter& p : h.system->parameters) source_.parameters.push_back(p.symbol);
  }

  KernelSource build(const std::vector<std::size_t>& kept) {
    ExprVector right = h_.flow;
    if (!kept.empty()) constrain(right, kept);
    right.push_back(h_.value);
    right = in_terms_of_motion(*h_.system, with_definitions(*h_.system, right));
    right = substitute(right, rates_);
    source_.observables = {right.back()};
    for (std::size_t i = 0; i < source_.coordinates.size(); ++i)
      source_.residual.push_back(context_.symbol(source_.coordinates[i].name(), Role::Coordinate, 2) - right[i]);
    return std::move(source_);
  }

 private:
  void add_state(Expr symbol, const std::string& name) {
    source_.coordinates.push_back(context_.symbol(integral_name(name), Role::Coordinate));
    rates_.emplace(symbol, rate_of_integral(context_, name));
  }

  /// A function of q, q̇, λ, t in the kernel's terms.
  Expr of_state(Expr e) const {
    const Expr there = in_phase_space(e, h_);
    if (!there) throw std::logic_error("a velocity is left in the canonical equations; please report");
    return substitute(in_terms_of_motion(*h_.system, with_definitions(*h_.system, {&there, 1})).front(), rates_);
  }

  /// p' = … + Aᵀλ keeps dφ/dt = 0 or ψ = 0, functions of z without λ, whose rates have λ in them.
  void constrain(ExprVector& right, const std::vector<std::size_t>& kept) {
    const EquationsOfMotion& shown = equations_.shown();
    ExprMap left_out;
    for (const Constraint& c : shown.system->constraints) left_out.emplace(c.multiplier, context_.number(0));
    for (const std::size_t k : kept) {
      const Expr multiplier = shown.system->constraints[k].multiplier;
      left_out.erase(multiplier);
      source_.multipliers.push_back(multiplier);
      source_.constraints.push_back({of_state(shown.constraint_rates[k]), 1, h_.system->constraint_label(k)});
    }
    const std::size_t n = h_.momenta.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Expr force = substitute(expand_time_derivatives(shown.constraint_forces[i]), left_out);
      right[n + i] = right[n + i] + in_phase_space(force, h_);
    }
  }

  const Hamiltonian& h_;
  const EquationsOfMotion& equations_;
  Context& context_;
  KernelSource source_;
  ExprMap rates_;
};

}  // namespace

Kernel canonical_kernel(const Hamiltonian& hamiltonian, const EquationsOfMotion& equations,
                        const std::vector<std::size_t>& constraints) {
  return build_kernel(CanonicalSource(hamiltonian, equations).build(constraints));
}

}  // namespace maupertuis::phase_space
