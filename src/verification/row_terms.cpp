#include "verification/row_terms.hpp"

#include <maupertuis/tree_size.hpp>

#include <algorithm>

namespace maupertuis {
namespace {

constexpr std::size_t kMostRowTerms = 200;

class RowReader {
 public:
  RowReader(const EquationsOfMotion& equations, const ExprMatrix& mass, std::size_t row)
      : equations_(equations), system_(*equations.system), mass_(mass), row_(row) {}

  std::vector<RowTerm> read() {
    for (std::size_t j = 0; j < system_.coordinates.size(); ++j)
      add(j == row_ ? TermOrigin::Inertia : TermOrigin::Coupling,
          mass_.at(row_, j) * system_.coordinates[j].acceleration, j);
    add_what_l_gives();
    add(TermOrigin::Dissipation, equations_.dissipative_terms[row_]);
    add(TermOrigin::Force, -equations_.generalized_forces[row_]);
    for (std::size_t k = 0; k < equations_.multipliers.size(); ++k) {
      const Expr multiplier = equations_.multipliers[k];
      add(TermOrigin::Constraint,
          -differentiate(expand_time_derivatives(equations_.constraint_forces[row_]), multiplier) * multiplier, k);
    }
    return too_long_ ? std::vector<RowTerm>() : std::move(terms_);
  }

 private:
  /// d/dt ∂L/∂q̇ − ∂L/∂q without its accelerations, by what it depends on and where it comes from.
  void add_what_l_gives() {
    const Expr own =
        equations_.residual[row_] - equations_.dissipative_terms[row_] + equations_.generalized_forces[row_];
    const Expr rest = substitute(expand_time_derivatives(own), zeros(2));
    if (mass_depends_on_velocities()) return add(TermOrigin::Velocity, rest);
    const Expr at_rest = substitute(rest, zeros(1));
    const Expr potential = expand_time_derivatives(system_.potential_energy());
    const Expr given = system_.lagrangian_given ? at_rest : differentiate(potential, system_.coordinates[row_].q);
    add(TermOrigin::Velocity, rest - at_rest);
    add(TermOrigin::Potential, given);
    const Expr accelerated = system_.lagrangian_given ? system_.context->number(Rational(0)) : by_time_alone();
    add(TermOrigin::PrescribedAcceleration, accelerated);
    add(TermOrigin::PrescribedMotion, at_rest - given - accelerated);
  }

  /// ∂/∂t of the momentum at rest: what d/dt has through t alone.
  Expr by_time_alone() const {
    const Expr momentum = substitute(expand_time_derivatives(equations_.momenta[row_]), zeros(1));
    ExprMap resting = zeros(1);
    return substitute(expand_time_derivatives(total_time_derivative(momentum)), resting);
  }

  ExprMap zeros(int order) const {
    ExprMap out;
    for (const Coordinate& c : system_.coordinates)
      out.emplace(order == 2 ? c.acceleration : c.velocity, system_.context->number(Rational(0)));
    return out;
  }

  bool mass_depends_on_velocities() const {
    for (std::size_t j = 0; j < system_.coordinates.size(); ++j) {
      const Expr entry = mass_.at(row_, j);
      for (const Expr& s : symbols_of({&entry, 1}))
        if (s.role() == Role::Coordinate && s.order() > 0) return true;
    }
    return false;
  }

  void add(TermOrigin origin, Expr part, std::size_t of = 0) {
    too_long_ = too_long_ || !is_short_enough(part);
    if (too_long_ || part.is_zero()) return;
    const ReadableForm form = readable(part, equations_.order);
    ExprMap written_out;
    for (const Intermediate& i : form.intermediates) written_out.emplace(i.symbol, substitute(i.value, written_out));
    const Expr expanded = expand(substitute(form.value, written_out), kMostRowTerms);
    if (!expanded)
      too_long_ = true;
    else if (expanded.is(Kind::Sum))
      for (std::size_t k = 0; k < expanded.size(); ++k) terms_.push_back({origin, expanded[k], of});
    else if (!expanded.is_zero())
      terms_.push_back({origin, expanded, of});
    too_long_ = too_long_ || terms_.size() > kMostRowTerms;
  }

  const EquationsOfMotion& equations_;
  const MechanicalSystem& system_;
  const ExprMatrix& mass_;
  std::size_t row_;
  std::vector<RowTerm> terms_;
  bool too_long_ = false;
};

}  // namespace

bool is_short_enough(Expr e) {
  constexpr std::size_t most = 1000;
  return tree_size(e, most) < most;
}

std::vector<RowTerm> row_terms(const EquationsOfMotion& equations, const ExprMatrix& mass, std::size_t row) {
  return RowReader(equations, mass, row).read();
}

}  // namespace maupertuis
