#include <maupertuis/print.hpp>

#include "system/field_elaboration.hpp"

#include <fmt/format.h>

#include <algorithm>

/// The density of a field, and the density of the forces on it.
namespace maupertuis::elaboration {
namespace {

using syntax::Expression;

/// E0299 for a value at a place, which would act on every piece of the field at once.
bool refuse_values_at_places(Elaboration& e, Expr value, const Expression& x) {
  const std::vector<Expr> symbols = symbols_of({&value, 1});
  for (const PlaceValue& place : e.fields->places) {
    if (std::find(symbols.begin(), symbols.end(), place.symbol) == symbols.end()) continue;
    e.diagnostics.error("E0299", x.span, fmt::format("`{}` stands in a density", e.texts.slice(place.span)),
                        "A density is local: what it says of a piece of space is the field there.",
                        "Values at places stand in T, V, L, D, constraints and forces at places.");
    return true;
  }
  return false;
}

/// Whether a jet is one of friction on what bends: the rate of a second derivative in space.
bool is_rate_of_bending(const FieldJet& jet) { return jet.time == 1 && jet.order() == 3; }

/// E0282, E0283 and E0299 for what a density cannot hold; `time` and `space`: derivatives that it may hold.
bool check_jets(Elaboration& e, Expr value, const Expression& x, int time, int space, bool friction = false) {
  if (refuse_values_at_places(e, value, x)) return false;
  for (const Expr& symbol : system_of(e).jets_in(value)) {
    const FieldJet jet = *system_of(e).jet_of(symbol);
    if (system_of(e).fields[jet.field].given) continue;
    if (jet.time > time) {
      Span at = culprit_of_order(e, x, time + 1);
      e.diagnostics.error(
          "E0282", at.end > at.begin ? at : x.span,
          fmt::format("`{}` stands in the density", system_of(e).jet_name(jet)),
          "A density depends on fields and their velocities; accelerations are what the field equations give.",
          "Write it with first derivatives in time.");
      return false;
    }
    if (jet.order() <= space || (friction && is_rate_of_bending(jet))) continue;
    e.diagnostics.error("E0283", x.span, fmt::format("`{}` stands in the density", system_of(e).jet_name(jet)),
                        friction ? "A dissipation density holds rates of derivatives in space up to the second."
                                 : "A density holds derivatives up to the second.",
                        "Name what is differentiated as a field of its own.");
    return false;
  }
  return true;
}

/// E0293: a density in complex fields has no imaginary part.
bool check_real(Elaboration& e, const syntax::DensityText& s, const Dimension& dimension) {
  const Value v = scalar_of(e, *s.imaginary, dimension, "the imaginary part of the density");
  if (v.poisoned) return false;
  const Expr imaginary = drives_as_formulas(e, v.scalar());
  if (zero_test(imaginary).verdict == Verdict::Zero) return true;
  e.diagnostics.error(
      "E0293", s.value->span, "this density is not real",
      fmt::format("Its imaginary part is {}; an action is a real number.", to_plain(imaginary, ReadingOrder{})),
      "Write for example i/2 (conj(ψ) ψ' - ψ conj(ψ')) in the place of i conj(ψ) ψ'.");
  return false;
}

}  // namespace

namespace {

/// E0283 for 𝒟 of u_txx where the density holds no u_xx: no moment is there that it could damp.
void refuse_friction_without_bending(Elaboration& e, Span span) {
  const FieldSystem& system = system_of(e);
  const std::vector<Expr> jets = system.jets_in(system.density);
  for (const Expr& symbol : system.jets_in(system.dissipation)) {
    const FieldJet rate = *system.jet_of(symbol);
    if (!is_rate_of_bending(rate)) continue;
    const bool bends = std::any_of(jets.begin(), jets.end(), [&](const Expr& one) {
      const FieldJet jet = *system.jet_of(one);
      return jet.field == rate.field && jet.time == 0 && jet.order() == 2;
    });
    if (bends) continue;
    e.diagnostics.error("E0283", span, fmt::format("`{}` stands in the dissipation density", system.jet_name(rate)),
                        fmt::format("The density holds no second derivative of {} in space: what does not bend has no "
                                    "moment that friction could damp.",
                                    system.fields[rate.field].name),
                        "Give the density a bending energy, or damp u_tx.");
    return;
  }
}

}  // namespace

Expr drives_as_formulas(Elaboration& e, Expr value) {
  return expand_time_derivatives(with_inputs_as_formulas(e.system(), value));
}

void densities(Elaboration& e) {
  FieldSystem& system = system_of(e);
  std::optional<Span> first[2];
  std::vector<Expr> parts[2];
  each_clause<syntax::DensityText>(e, [&](const syntax::DensityText& s, Span) {
    const char* what = s.dissipation ? "the dissipation density" : "the density";
    if (first[s.dissipation] && !s.adds) {
      e.diagnostics.error("E0207", s.name_span, fmt::format("{} is given twice", what),
                          fmt::format("It is already given in line {}.", e.texts.locate(*first[s.dissipation]).line),
                          "Write `density += …` to add to it.");
      return;
    }
    first[s.dissipation] = s.name_span;
    const Dimension dimension =
        s.dissipation ? system.density_dimension / system.time_dimension : system.density_dimension;
    const Value v = scalar_of(e, *s.value, dimension, what);
    if (v.poisoned) return;
    const Expr value = drives_as_formulas(e, v.scalar());
    if (s.imaginary && !check_real(e, s, dimension)) return;
    if (check_jets(e, value, *s.value, 1, 2, s.dissipation)) parts[s.dissipation].push_back(value);
  });
  if (!first[0]) {
    if (!e.diagnostics.has_errors())  // else it was lost with a mistake of its own
      e.diagnostics.error("E0280",
                          system.fields.empty() ? std::nullopt : std::optional<Span>(system.fields.front().span),
                          "the field has no density",
                          "The action of a field is the integral of its Lagrangian density over space and time.",
                          "Write it, for example `density = 1/2 ρ u'^2 - 1/2 T u_x^2`.");
    return;
  }
  system.density_span = *first[0];
  system.density = sum_of(parts[0], e.context);
  if (first[1]) system.dissipation = sum_of(parts[1], e.context);
  if (first[1] && !parts[0].empty()) refuse_friction_without_bending(e, *first[1]);
  for (const Field& f : system.fields) {
    if (f.given) continue;
    bool stands = false;
    for (const Expr& symbol : system.jets_in(system.density))
      stands = stands || &system.fields[system.jet_of(symbol)->field] == &f;
    if (!stands && !parts[0].empty())
      e.diagnostics.error("E0280", f.span, fmt::format("the field `{}` does not stand in the density", f.name),
                          "Without a part in the density no equation says what it does.",
                          "Leave it out, or add its part with `density += …`.");
  }
}

void force_density(Elaboration& e, const syntax::FieldForce& s, const FieldJet& jet) {
  FieldSystem& system = system_of(e);
  const Value v = scalar_of(e, *s.value, system.density_dimension / system.fields[jet.field].dimension,
                            fmt::format("the force density on {}", system.fields[jet.field].name));
  if (v.poisoned) return;
  const Expr value = drives_as_formulas(e, v.scalar());
  if (!check_jets(e, value, *s.value, 1, 2)) return;
  Expr& force = system.forces[jet.field];
  force = force ? force + value : value;
}

}  // namespace maupertuis::elaboration
