#include <maupertuis/evaluate.hpp>
#include <maupertuis/fields.hpp>

#include "fields/well_posed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

/// δ∫ℒ = 0: the field equations, the terms that are left at the boundary, and what is natural there.
namespace maupertuis {
namespace {

/// The variation of one density, field by field. Time stands behind the space variables.
class Variation {
 public:
  explicit Variation(FieldEquations& out) : out_(out), s_(out.with_variations), n_(s_.space.size()) {
    out_.boundary_terms.assign(n_ + 1, s_.context->number(0));
    jets_ = s_.jets_in(s_.density);
    slopes_ = gradient(s_.density, jets_);
  }

  void field(std::size_t a) {
    field_ = out_.varied[a];
    eta_ = FieldJet{out_.variation_of(a), std::vector<int>(n_, 0), 0};
    std::vector<Expr> euler;
    p_.assign(n_, {}), m_.assign(n_, {});
    for (std::size_t i = 0; i < jets_.size(); ++i) {
      const FieldJet jet = *s_.jet_of(jets_[i]);
      if (jet.field == field_ && !slopes_[i].is_zero()) euler.push_back(part(jet, slopes_[i]));
    }
    out_.euler.push_back(s_.context->sum(euler));
    for (std::size_t x = 0; x < n_; ++x) {
      if (!p_[x].empty()) out_.natural.push_back({field_, x, false, s_.context->sum(p_[x])});
      if (!m_[x].empty()) out_.natural.push_back({field_, x, true, s_.context->sum(m_[x])});
    }
  }

 private:
  Expr d(Expr e, std::size_t by) const { return s_.total_derivative(e, by); }
  Expr eta(std::size_t by) const {
    FieldJet jet = eta_;
    if (by <= n_) ++(by == n_ ? jet.time : jet.space[by]);
    return s_.jet_symbol(jet);
  }
  static constexpr std::size_t plain = 99;
  void boundary(std::size_t along, Expr term) { out_.boundary_terms[along] = out_.boundary_terms[along] + term; }

  /// ∂ℒ/∂φ_J η_J by parts: its share of E, and of B.
  Expr part(const FieldJet& jet, Expr slope) {
    std::vector<std::size_t> by;
    for (std::size_t x = 0; x < n_; ++x) by.insert(by.end(), static_cast<std::size_t>(jet.space[x]), x);
    by.insert(by.end(), static_cast<std::size_t>(jet.time), n_);
    if (by.empty()) return slope;
    if (by.size() == 1) return first_derivative(by[0], slope);
    return by[0] == by[1] ? same_twice(by[0], slope)
           : by[1] == n_  ? with_time(by[0], slope)
                          : mixed(by[0], by[1], slope);
  }
  Expr first_derivative(std::size_t x, Expr slope) {
    boundary(x, slope * eta(plain));
    if (x < n_) p_[x].push_back(slope);
    return -d(slope, x);
  }
  Expr same_twice(std::size_t x, Expr slope) {
    boundary(x, slope * eta(x) - d(slope, x) * eta(plain));
    p_[x].push_back(-d(slope, x));
    m_[x].push_back(slope);
    return d(d(slope, x), x);
  }
  /// φ_tx: along the boundary δφ is integrated by parts in t.
  Expr with_time(std::size_t x, Expr slope) {
    boundary(n_, slope * eta(x));
    boundary(x, -(d(slope, n_) * eta(plain)));
    p_[x].push_back(-d(slope, n_));
    return d(d(slope, n_), x);
  }
  /// φ_xy, shared evenly in B; at a side all of it is integrated by parts along the side.
  Expr mixed(std::size_t x, std::size_t y, Expr slope) {
    const Rational half(1, 2);
    boundary(x, half * (slope * eta(y) - d(slope, y) * eta(plain)));
    boundary(y, half * (slope * eta(x) - d(slope, x) * eta(plain)));
    p_[x].push_back(-d(slope, y));
    p_[y].push_back(-d(slope, x));
    return d(d(slope, x), y);
  }

  FieldEquations& out_;
  const FieldSystem& s_;
  std::size_t n_, field_ = 0;
  FieldJet eta_;
  std::vector<Expr> jets_, slopes_;
  std::vector<std::vector<Expr>> p_, m_;
};

/// ∂𝒟/∂φ_tJ; an empty handle where 𝒟 does not hold it.
Expr friction_on(const FieldSystem& s, std::size_t field, std::size_t x, std::optional<std::size_t> y = std::nullopt) {
  FieldJet rate{field, std::vector<int>(s.space.size(), 0), 1};
  ++rate.space[x];
  if (y) ++rate.space[*y];
  const Expr out = differentiate(s.dissipation, s.jet_symbol(rate));
  return out.is_zero() ? Expr{} : out;
}

Expr residual_of(const FieldSystem& s, std::size_t field, Expr euler) {
  Expr out = -euler;
  if (s.dissipation) {
    const FieldJet velocity{field, std::vector<int>(s.space.size(), 0), 1};
    std::vector<Expr> parts{differentiate(s.dissipation, s.jet_symbol(velocity))};
    for (std::size_t x = 0; x < s.space.size(); ++x) {  // internal friction: 𝒟 of u_tx, u_txx, u_txy
      if (const Expr d = friction_on(s, field, x)) parts.push_back(-s.total_derivative(d, x));
      for (std::size_t y = x; y < s.space.size(); ++y)
        if (const Expr d = friction_on(s, field, x, y))
          parts.push_back(s.total_derivative(s.total_derivative(d, x), y));
    }
    out = out + s.context->sum(parts);
  }
  return s.forces[field] ? out - s.forces[field] : out;
}

/// Internal friction acts at an end as well: p − ∂𝒟/∂φ_tx + D_x ∂𝒟/∂φ_txx is what is left there, and m − ∂𝒟/∂φ_txx.
void add_friction_at_ends(FieldEquations& out) {
  const FieldSystem& s = out.model->system;
  if (!s.dissipation) return;
  for (NaturalCondition& n : out.natural) {
    const Expr bending = friction_on(s, n.field, n.along, n.along);
    if (n.moment) {
      if (bending) n.value = n.value - bending;
      continue;
    }
    if (const Expr d = friction_on(s, n.field, n.along)) n.value = n.value - d;
    if (bending) n.value = n.value + s.total_derivative(bending, n.along);
    for (std::size_t y = 0; y < s.space.size(); ++y)
      if (y != n.along)
        if (const Expr twist = friction_on(s, n.field, n.along, y)) n.value = n.value + s.total_derivative(twist, y);
  }
}

ReadingOrder reading_order(const FieldModel& model, const std::vector<Expr>& expressions) {
  ReadingOrder order;
  std::vector<Expr> symbols = symbols_of(expressions);
  for (const Expr& s : symbols)
    if (s.role() == Role::Parameter || s.role() == Role::Constant ||
        (s.role() == Role::Auxiliary && model.system.definitions.count(s)))
      order.parameters.push_back(s);
  std::vector<std::pair<int, Expr>> jets;
  for (const Expr& s : symbols)
    if (const auto jet = model.system.jet_of(s))
      jets.push_back({jet->order() - jet->time, model.system.context->symbol(s.name(), s.role(), 0)});
  std::stable_sort(jets.begin(), jets.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [depth, symbol] : jets)
    if (std::find(order.coordinates.begin(), order.coordinates.end(), symbol) == order.coordinates.end())
      order.coordinates.push_back(symbol);
  return order;
}

/// N0640 where no equation moves a field.
void refuse_without_motion(const FieldEquations& equations, Diagnostics& diagnostics) {
  for (const Expr& r : equations.residuals)
    for (const Expr& symbol : equations.system().jets_in(r))
      if (equations.system().jet_of(symbol)->time > 0) return;
  diagnostics.note("N0640", equations.system().density_span, "the field equations hold no derivative in time",
                   "They are those of a field at rest: a catenary, a soap film, a static deflection.", "");
}

}  // namespace

std::size_t FieldEquations::varied_index(std::size_t field) const {
  return static_cast<std::size_t>(std::find(varied.begin(), varied.end(), field) - varied.begin());
}

std::optional<FieldEquations> field_equations(std::shared_ptr<const FieldModel> model, Diagnostics& diagnostics) {
  FieldEquations out;
  out.model = model;
  out.with_variations = model->system;
  const std::size_t count = model->system.fields.size();
  for (std::size_t f = 0; f < count; ++f) {
    if (model->system.fields[f].given) continue;
    out.varied.push_back(f);
    Field eta = model->system.fields[f];
    eta.name = "δ" + eta.name;
    out.with_variations.fields.push_back(eta);
  }
  Variation variation(out);
  for (std::size_t a = 0; a < out.varied.size(); ++a) {
    variation.field(a);
    out.residuals.push_back(residual_of(model->system, out.varied[a], out.euler[a]));
  }
  add_friction_at_ends(out);
  std::vector<Expr> all = out.residuals;
  all.push_back(model->system.density);
  for (const NaturalCondition& c : out.natural) all.push_back(c.value);
  out.order = reading_order(*model, all);
  refuse_without_motion(out, diagnostics);
  refuse_ill_posed(out, diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;
  return out;
}

ReadableForm readable_residual(const FieldEquations& equations, std::size_t varied_index) {
  ReadingOrder order = equations.order;
  const FieldSystem& s = equations.system();
  order.own = s.jet_symbol({equations.varied[varied_index], std::vector<int>(s.space.size(), 0), 0});
  const Expr rows[] = {equations.residuals[varied_index]};
  return readable_equations(rows, order).front();
}

// ------------------------------------------------------------------------------------------------------------- print

namespace {

Layout jet_layout(const FieldSystem& s, const FieldJet& jet) {
  const FieldJet field{jet.field, std::vector<int>(s.space.size(), 0), 0};
  Layout partial;
  partial.shape = Shape::Partial;
  partial.parts.push_back(layouts::symbol(s.jet_symbol(field)));
  for (int k = 0; k < jet.time; ++k) partial.parts.push_back(layouts::name("t"));
  for (std::size_t x = 0; x < s.space.size(); ++x)
    for (int k = 0; k < jet.space[x]; ++k) partial.parts.push_back(layouts::symbol(s.space[x].symbol));
  return layouts::labelled(s.jet_name(jet), std::move(partial));
}

}  // namespace

Layout jet_with_subscripts(const FieldSystem& s, const FieldJet& jet) {
  const Layout field = layouts::symbol(s.jet_symbol({jet.field, std::vector<int>(s.space.size(), 0), 0}));
  std::vector<Layout> below;
  for (int k = 0; k < jet.time; ++k) below.push_back(layouts::name("t"));
  for (std::size_t x = 0; x < s.space.size(); ++x)
    for (int k = 0; k < jet.space[x]; ++k) below.push_back(layouts::symbol(s.space[x].symbol));
  return below.empty() ? field : layouts::indexed(field, {layouts::product(std::move(below))});
}

Layout field_layout(const FieldSystem& system, Layout layout) {
  if (layout.shape == Shape::Symbol)
    if (const auto jet = system.jet_of(layout.symbol); jet && jet->order() > 0) return jet_layout(system, *jet);
  for (Layout& part : layout.parts) part = field_layout(system, std::move(part));
  return layout;
}

}  // namespace maupertuis
