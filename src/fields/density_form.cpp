#include "fields/density_form.hpp"

#include <algorithm>

namespace maupertuis {
namespace {

bool holds_jets_or_time(const FieldSystem& s, Expr e) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::any_of(symbols.begin(), symbols.end(),
                     [&](Expr symbol) { return s.jet_of(symbol) || symbol.role() == Role::Time; });
}

void run_unsupported(Diagnostics& diagnostics, Span span, const std::string& what) {
  diagnostics.error("E0508", span, "not supported yet: a run of " + what,
                    "Runs are those of fields of one or two space variables on a bounded domain.",
                    "`maup derive`, `maup invariants` and expectations about formulas work for all fields.");
}

struct FormBuilder {
  const FieldEquations& equations;
  Diagnostics& diagnostics;
  const FieldSystem& s;
  ExprMap given;
  DensityForm out;
  Expr density, dissipation;

  Expr plain(Expr e) const { return s.expanded(substitute(s.expanded(e), given)); }
  Expr jet(std::size_t varied, const std::array<int, 2>& space, bool rate) const {
    return s.jet_symbol({equations.varied[varied], {space.begin(), space.begin() + directions()}, rate ? 1 : 0});
  }
  std::ptrdiff_t directions() const { return static_cast<std::ptrdiff_t>(s.space.size()); }

  bool supported() {
    if (s.space.size() > 2)
      return run_unsupported(diagnostics, s.density_span, "fields of three space variables"), false;
    if (!s.space.front().from) return run_unsupported(diagnostics, s.density_span, "a field without a domain"), false;
    for (std::size_t f = 0; f < s.fields.size(); ++f) {
      if (!s.fields[f].given) continue;
      if (!s.fields[f].formula)
        return run_unsupported(diagnostics, s.fields[f].span, "an input without a formula"), false;
      given[s.jet_symbol({f, std::vector<int>(s.space.size(), 0), 0})] = s.fields[f].formula;
    }
    return true;
  }

  /// 𝒟 of u_txx.
  bool damps_bending(std::size_t a) const {
    const std::vector<Expr> jets = s.jets_in(dissipation);
    return std::any_of(jets.begin(), jets.end(), [&](const Expr& symbol) {
      const FieldJet jet = *s.jet_of(symbol);
      return jet.field == equations.varied[a] && jet.time == 1 && jet.order() == 3;
    });
  }

  void slots() {
    std::vector<Expr> all{density, dissipation};
    for (const Expr& f : s.forces)
      if (f) all.push_back(plain(f));
    const std::size_t n = equations.varied.size();
    out.smooth.assign(n, false);
    for (const Expr& e : all)
      for (const Expr& symbol : s.jets_in(e)) {
        const FieldJet j = *s.jet_of(symbol);
        for (std::size_t a = 0; a < n; ++a)
          if (equations.varied[a] == j.field && j.order() - j.time > 1) out.smooth[a] = true;
      }
    // A field whose u_tx has a kinetic energy has slopes of its own too: its highest derivatives are those of a beam.
    for (std::size_t a = 0; a < n; ++a)
      for (const bool rate : {false, true})
        for (int order = 0; order <= (out.smooth[a] && (!rate || damps_bending(a)) ? 2 : 1); ++order)
          for (int along_y = 0; along_y <= (directions() > 1 ? order : 0); ++along_y) {
            const std::array<int, 2> space{order - along_y, along_y};
            out.slots.push_back({a, space, rate, false, jet(a, space, rate)});
          }
    for (const DensityForm::Slot& slot : out.slots) out.inputs.push_back(slot.jet);
    for (const SpaceVariable& x : s.space) out.inputs.push_back(x.symbol);
    out.inputs.push_back(s.context->time());
  }

  void derivatives() {
    std::vector<Expr> energy{-density};
    for (const DensityForm::Slot& slot : out.slots) {
      Expr e = differentiate(density, slot.jet);
      if (slot.rate) {
        energy.push_back(slot.jet * e);
      } else {
        const Expr friction = differentiate(dissipation, jet(slot.field, slot.space, true));
        out.damps = out.damps || (slot.order() > 0 && !friction.is_zero());
        e = e - friction;
        if (const Expr f = s.forces[equations.varied[slot.field]]; slot.order() == 0 && f) e = e + plain(f);
      }
      out.by_slot.push_back(e);
    }
    out.energy = s.context->sum(energy);
    const std::vector<Expr> standing = symbols_of(out.by_slot);
    for (DensityForm::Slot& slot : out.slots)
      slot.stands = std::find(standing.begin(), standing.end(), slot.jet) != standing.end();
    out.linear = out.steady = true;
    out.first_order.assign(out.smooth.size(), true);
    for (std::size_t row = 0; row < out.slots.size(); ++row)
      for (std::size_t column = 0; column < out.slots.size(); ++column) {
        const Expr value = differentiate(out.by_slot[row], out.slots[column].jet);
        if (value.is_zero()) continue;
        out.hessian.push_back({row, column, value});
        if (out.slots[row].rate && out.slots[column].rate) out.first_order[out.slots[row].field] = false;
        const bool changes = holds_jets_or_time(s, value);
        out.linear = out.linear && !changes;
        out.steady = out.steady && !(changes && (out.slots[row].rate || out.slots[column].rate));
      }
  }

  /// A force by a velocity of a field of first order: friction moves it, and not a part linear in the velocities.
  bool in_its_friction(const DensityForm::Entry& e) const {
    const DensityForm::Slot& column = out.slots[e.column];
    return column.order() == 0 && out.first_order[column.field] && !differentiate(dissipation, column.jet).is_zero();
  }

  bool well_formed() {
    std::vector<bool> moves(out.smooth.size(), false);
    for (const DensityForm::Entry& e : out.hessian) {
      const DensityForm::Slot &row = out.slots[e.row], &column = out.slots[e.column];
      if (row.rate) moves[row.field] = true;
      if (row.rate || column.rate) moves[column.field] = true;
      if (row.rate && out.first_order[row.field] && holds_jets_or_time(s, e.value))
        return run_unsupported(diagnostics, s.density_span,
                               "a density whose part linear in the velocities has coefficients that change"),
               false;
    }
    for (const DensityForm::Entry& e : out.hessian)
      out.damps = out.damps || (out.slots[e.column].rate && !out.slots[e.row].rate && in_its_friction(e));
    for (std::size_t a = 0; a < moves.size(); ++a)
      if (!moves[a]) {
        diagnostics.error("E0642", s.density_span,
                          "the motion of " + s.fields[equations.varied[a]].name + " is not determined",
                          "No equation holds its derivative by t.",
                          "`maup derive` shows them; eliminate it, or give it a part in the kinetic energy.");
        return false;
      }
    for (const FieldStart& start : equations.model->start)
      for (std::size_t a = 0; a < moves.size(); ++a)
        if (start.order == 1 && equations.varied[a] == start.field && out.first_order[a]) {
          diagnostics.error("E0642", start.span,
                            "the velocity of " + s.fields[start.field].name + " cannot be chosen at the start",
                            "The density is linear in the velocities: its equations are of first order, and the field "
                            "alone determines how it goes on.",
                            "Leave it out.");
          return false;
        }
    return true;
  }
};

}  // namespace

bool needs_collocation(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  if (s.space.size() > 2) return false;
  const Expr density = s.expanded(s.density);
  const std::vector<Expr> jets = s.jets_in(density);
  for (const Expr& symbol : jets)
    if (s.jet_of(symbol)->order() > 1) return true;
  if (s.dissipation)
    for (const Expr& symbol : s.jets_in(s.expanded(s.dissipation)))
      if (const FieldJet jet = *s.jet_of(symbol); jet.time > 0 && jet.order() > jet.time) return true;
  for (const std::size_t f : equations.varied) {
    const Expr p = differentiate(density, s.jet_symbol({f, std::vector<int>(s.space.size(), 0), 1}));
    bool squared = false;
    for (const Expr& symbol : jets)
      squared = squared || (s.jet_of(symbol)->time > 0 && !differentiate(p, symbol).is_zero());
    if (!squared) return true;
  }
  return false;
}

std::optional<DensityForm> density_form(const FieldEquations& equations, Diagnostics& diagnostics) {
  FormBuilder b{equations, diagnostics, equations.system(), {}, {}, {}, {}};
  if (!b.supported()) return std::nullopt;
  const FieldSystem& s = equations.system();
  b.density = b.plain(s.density);
  b.dissipation = s.dissipation ? b.plain(s.dissipation) : s.context->number(0);
  b.slots();
  b.derivatives();
  if (!b.well_formed()) return std::nullopt;
  bool forced =
      !b.dissipation.is_zero() || !differentiate(b.density, s.context->time()).is_zero() || !s.end_forces.empty();
  for (const Expr& f : s.forces) forced = forced || static_cast<bool>(f);
  // A given slope is a force at the end, which does work, where slopes are not held themselves.
  for (const BoundaryCondition& c : s.boundary) {
    const auto field = std::find(equations.varied.begin(), equations.varied.end(), c.jet.field);
    const bool held = c.jet.order() == 0 || b.out.smooth[static_cast<std::size_t>(field - equations.varied.begin())];
    forced = forced || s.context->depends_on_time(c.value.id()) || (!held && !c.value.is_zero());
  }
  b.out.conserves = !forced;
  return std::move(b.out);
}

}  // namespace maupertuis
