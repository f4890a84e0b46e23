#include "analysis/hamiltonian/readable_choice.hpp"

#include <maupertuis/couplings.hpp>
#include <maupertuis/hamiltonian.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/shared_form.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {

using namespace phase_space;

namespace {

std::string names_of(const std::vector<std::size_t>& coordinates, const MechanicalSystem& system) {
  std::string text;
  for (const std::size_t i : coordinates) text += (text.empty() ? "" : ", ") + system.coordinates[i].name;
  return text;
}

class Lines {
 public:
  Lines(const Hamiltonian& h, const EquationsOfMotion& equations)
      : h_(h), equations_(equations), shown_(equations.shown()) {}

  std::vector<DerivationStep> write(const Routhian* routhian) {
    momenta();
    primary_constraints();
    hamiltonian();
    canonical_equations();
    if (routhian && routhian->readable.value) routh(*routhian);
    share_long_ones();
    return std::move(lines_);
  }

 private:
  void formula(const std::string& section, const std::string& rule, Layout left, const ReadableForm& right) {
    if (right.value && right.intermediates.empty() && is_long(right.value))
      long_ones_.emplace_back(lines_.size(), right.value);
    lines_.push_back({section, rule, std::move(left), right.value, {}, right.intermediates});
  }
  void formula(const std::string& section, const std::string& rule, Expr left, const ReadableForm& right) {
    formula(section, rule, lay_out(left, h_.order), right);
  }
  void sentence(const std::string& section, std::string text) {
    lines_.push_back({section, {}, {}, {}, std::move(text), {}});
  }

  /// Rows that would fill pages are written by shared parts, whose names stand with the first of them.
  void share_long_ones() {
    if (long_ones_.empty()) return;
    ExprVector rows;
    for (const auto& [line, value] : long_ones_) rows.push_back(value);
    SharedForm shared = shared_form(rows, h_.order);
    for (std::size_t i = 0; i < long_ones_.size(); ++i) {
      DerivationStep& line = lines_[long_ones_[i].first];
      line.right = shared.rows[i];
      line.intermediates.clear();
    }
    lines_[long_ones_.front().first].intermediates = std::move(shared.intermediates);
  }

  void momenta() {
    const bool by_shared_parts = couples_too_much_to_read(equations_);
    for (std::size_t i = 0; i < h_.momenta.size(); ++i) {
      const ReadableForm form = by_shared_parts ? ReadableForm{} : momentum(i);
      const bool is_short = form.value && form.intermediates.empty();
      if (!is_short) long_ones_.emplace_back(lines_.size(), h_.momentum_values[i]);
      formula("Momenta", "p = ∂L/∂q'", h_.momenta[i], form);
    }
  }

  /// The shortest of the readable form and Σ M_ij q_j' + b_i with each coefficient in brackets.
  ReadableForm momentum(std::size_t i) const {
    constexpr std::size_t most_arranged = 24;  // longer sums are collected by their velocities as it is
    ReadableForm form = readable(h_.momentum_values[i], h_.order);
    const ExprVector velocities = velocities_in(h_.momentum_values[i]);
    if (!form.intermediates.empty() || velocities.size() > most_arranged) return form;
    ExprVector terms;
    ExprMap at_rest;
    for (const Expr& v : velocities) at_rest.emplace(v, v.context().number(0));
    const ExprVector coefficients = gradient(h_.momentum_values[i], velocities);
    for (std::size_t j = 0; j < velocities.size(); ++j) {
      if (!velocities_in(coefficients[j]).empty()) return form;
      terms.push_back(tidy(coefficients[j], h_.order) * velocities[j]);
    }
    terms.push_back(tidy(substitute(h_.momentum_values[i], at_rest), h_.order));
    const Expr candidates[] = {form.value, flat_sum(terms, *h_.system->context)};
    form.value = shortest(candidates, h_.order);
    return form;
  }

  static ExprVector velocities_in(Expr e) {
    ExprVector symbols = symbols_of({&e, 1});
    std::erase_if(symbols, [](Expr s) { return s.role() != Role::Coordinate || s.order() != 1; });
    return symbols;
  }

  void primary_constraints() {
    for (const LegendreBlock& block : h_.legendre.blocks) {
      for (const Expr& c : block.primary_constraints)
        formula("Primary constraints", "follows from p = ∂L/∂q'", layouts::number("0"), ReadableForm{c, {}, {}});
      if (block.kind == LegendreKind::Singular && !block.primary_constraints.empty())
        sentence(
            "Primary constraints",
            fmt::format(
                "The momenta do not determine every velocity of {}; H stands for its values on these constraints, and "
                "H plus any multiples of them gives the same motion.",
                names_of(block.coordinates, *h_.system)));
    }
  }

  /// ½ (p − b)·q' of the groups that were not inverted beside the energies of the others.
  Expr with_velocities() const {
    ExprVector parts{h_.legendre.at_rest};
    for (const LegendreBlock& block : h_.legendre.blocks) {
      if (block.energy_is_readable)
        parts.push_back(block.energy);
      else
        for (std::size_t i = 0; i < block.coordinates.size(); ++i) {
          const std::size_t k = block.coordinates[i];
          const Expr pi = h_.momenta[k] - block.shift[i];
          parts.push_back(Rational(1, 2) * (pi * h_.system->coordinates[k].velocity));
        }
    }
    return flat_sum(parts, *h_.system->context);
  }

  void hamiltonian() {
    const std::string section = "Hamiltonian";
    if (!h_.value) {
      sentence(section, "H = p·q' − L, in which the velocities that belong to p were not written out.");
      return;
    }
    if (h_.legendre.readable.value) {
      formula(section, "H = p·q' − L", layouts::name("H"), h_.legendre.readable);
    } else {
      formula(section, "H = p·q' − L", layouts::name("H"), ReadableForm{with_velocities(), {}, {}});
      for (const LegendreBlock& block : h_.legendre.blocks)
        if (!block.energy_is_readable && block.kind == LegendreKind::Singular)
          sentence(section, fmt::format("The velocities of {} stand for any solution of M q' = p − b, the lines of the "
                                        "momenta: H is the same for all of them where "
                                        "the primary constraints hold.",
                                        names_of(block.coordinates, *h_.system)));
        else if (!block.energy_is_readable)
          sentence(section, fmt::format("The velocities of {} stand for the solution of M q' = p − b, the lines of the "
                                        "momenta: H is ½ (p − b)ᵀ M⁻¹ (p − b) + V, "
                                        "and M⁻¹ is too long to be written out.",
                                        names_of(block.coordinates, *h_.system)));
    }
    energy(section);
  }

  void energy(const std::string& section) {
    const ConservedQuantities conserved = conserved_quantities(equations_);
    std::string text = conserved.energy_case;
    for (auto at = text.find("h_E"); at != std::string::npos; at = text.find("h_E")) text.replace(at, 3, "H");
    std::string names;
    for (const std::size_t i : conserved.conserved_momenta) names += ", " + momentum_name(*h_.system, i);
    if (conserved.energy_conserved) names += ", H";
    if (!text.empty()) sentence(section, text);
    if (!conserved.energy_conserved)
      formula(section, "along the motion",
              layouts::rate(layouts::name("H"), lay_out(h_.system->context->time(), h_.order)),
              ReadableForm{tidy(shown_.power, h_.order), {}, {}});
    sentence(section, names.empty() ? "Neither H nor a momentum is conserved." : "Conserved: " + names.substr(2) + ".");
  }

  void canonical_equations() {
    const std::string section = "Canonical equations";
    bool has_velocities = false;
    for (std::size_t i = 0; i < h_.velocities.size(); ++i)
      if (h_.velocities[i].right.value) formula(section, "q' = ∂H/∂p", h_.velocities[i].left, h_.velocities[i].right);
    for (const CanonicalEquation& e : h_.forces) {
      formula(section, e.has_velocities ? "p' = ∂L/∂q + forces, which is −∂H/∂q + forces" : "p' = −∂H/∂q + forces",
              e.left, e.right);
      has_velocities |= e.has_velocities;
    }
    if (has_velocities && h_.regular()) sentence(section, "Velocities on the right stand for ∂H/∂p.");
    if (h_.forces.empty() || !shown_.system->constrained()) return;
    std::string names;
    for (std::size_t k = 0; k < shown_.system->constraints.size(); ++k)
      names += (k ? ", " : "") + shown_.system->constraint_label(k);
    sentence(section, fmt::format("With the constraints of the model ({}), whose velocities stand for ∂H/∂p.", names));
  }

  void routh(const Routhian& r) {
    const std::string section = "Routhian without " + names_of(r.replaced, *h_.system);
    formula(section, "R = L − Σ p q'", layouts::name("R"), r.readable);
    if (r.rest.empty())
      sentence(section, "No other coordinate is left: the motion is known once its momenta are.");
    else if (r.conserved)
      formula(section, "−R at rest", layouts::name("V_eff"), r.effective_potential);
    for (const CanonicalEquation& e : r.velocities) formula(section, "q' = −∂R/∂p", e.left, e.right);
    for (const ReadableForm& row : r.equations) formula(section, "Routh, p constant", layouts::number("0"), row);
    if (r.conserved && !r.rest.empty() && r.equations.empty())
      sentence(section, "Its equations of motion would fill more than some lines.");
    if (!r.conserved)
      sentence(
          section,
          "These momenta are not all conserved: p' = ∂R/∂q + forces goes with the equations of the other coordinates.");
  }

  const Hamiltonian& h_;
  const EquationsOfMotion& equations_;
  const EquationsOfMotion& shown_;
  std::vector<DerivationStep> lines_;
  std::vector<std::pair<std::size_t, Expr>> long_ones_;  // lines whose right sides would fill pages
};

}  // namespace

std::vector<DerivationStep> phase_space_lines(const Hamiltonian& h, const Routhian* routhian,
                                              const EquationsOfMotion& equations) {
  return Lines(h, equations).write(routhian);
}

void report_legendre(const Hamiltonian& h, Diagnostics& diagnostics) {
  std::vector<std::size_t> singular;  // of all blocks: one sentence says it
  for (const LegendreBlock& block : h.legendre.blocks)
    if (block.kind == LegendreKind::Singular)
      singular.insert(singular.end(), block.coordinates.begin(), block.coordinates.end());
  std::sort(singular.begin(), singular.end());
  if (!singular.empty())
    diagnostics.warning("W1101", std::nullopt,
                        fmt::format("the Legendre transform of {} is singular", names_of(singular, *h.system)),
                        "M = ∂²L/∂q'∂q' has no inverse here, so that p = ∂L/∂q' cannot be solved for every velocity: "
                        "the momenta obey primary constraints.",
                        h.system->constrained() ? "Lagrange's equations with their multipliers need no inverse: "
                                                  "`maup derive` and `maup simulate` are unaffected."
                                                : "`maup derive` shows what Lagrange's equations make of it.");
  for (const LegendreBlock& block : h.legendre.blocks) {
    const std::string names = names_of(block.coordinates, *h.system);
    if (block.kind == LegendreKind::Unsolved)
      diagnostics.warning(
          "W1103", std::nullopt, fmt::format("the velocities of {} are not written in terms of the momenta", names),
          block.coordinates.size() > largest_eliminated
              ? fmt::format("More than {} coordinates are coupled.", largest_eliminated)
              : std::string(
                    "L is neither quadratic in them nor has it the one square root of a relativistic particle."),
          "The momenta are right; H is the energy function of `maup derive` at the velocities that belong to them.");
  }
}

}  // namespace maupertuis
