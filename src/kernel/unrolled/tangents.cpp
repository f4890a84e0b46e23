#include "kernel/unrolled/unrolling.hpp"

#include <algorithm>
#include <set>

namespace maupertuis::unrolled {

Value Unrolling::tangent(Step::Part part, Slot slot, int direction) {
  if (slot < n_) return to_.literal(part == Step::T && static_cast<int>(slot) == direction);
  if (direction < 0 || step_of_[slot] < 0) return to_.literal(0);
  const Step& step = steps_[static_cast<std::size_t>(step_of_[slot])];
  const auto& of = step.tangents[part];
  const std::uint32_t lane = slot - step.out[0];
  if (const auto found = of.find(direction); found != of.end()) return to_.lane(found->second, lane);
  const auto found = of.find(Step::own);
  return found != of.end() && step.direction[lane] == direction ? to_.lane(found->second, lane) : to_.literal(0);
}

Value Unrolling::tangents(Step::Part part, const Slots& slots, const std::vector<int>& directions) {
  std::vector<Value> lanes;
  for (std::size_t i = 0; i < slots.size(); ++i) lanes.push_back(tangent(part, slots[i], directions[i]));
  return gathered(std::move(lanes));
}

/// What the change of a step is made of (see Source): f times the change of an operand of the same lag; where f itself
/// changes along the motion, g is its coefficient of order 1; h belongs to operands one lag below.
std::vector<Unrolling::Source> Unrolling::sources(const Step& step) {
  std::vector<Source> out;
  for (const Column& c : step.columns)
    if (p_.lags[c.slots[0]] + c.shift == step.lag)
      out.push_back({.slots = c.slots, .f = c.coefficient, .shift = c.shift});
  for (const Product& p : step.products) {
    switch (step.kind) {
      case Step::Sum:
        add_sources(step, p, p.a, p.b, out), add_sources(step, p, p.b, p.a, out);
        break;
      case Step::Integral:
        add_integral(step, p, out);
        break;
      case Step::Quotient: {
        const Value reciprocal = to_.reciprocal(gather(p.b, 0));
        if (leads(p.a, step)) out.push_back({.slots = p.a, .f = reciprocal});
        if (leads(p.b, step)) out.push_back({.slots = p.b, .f = to_.product(-1, gather(step.out, 0), reciprocal)});
        break;
      }
      case Step::Root:
        out.push_back({.slots = p.a, .f = to_.sum({{0.5}}, none, gather(step.out, 0))});
        break;
      case Step::Power:
        out.push_back({.slots = p.a, .f = to_.sum({{1, p.coefficient, gather(step.out, 0)}}, none, gather(p.a, 0))});
        break;
    }
  }
  return out;
}

/// c a b by a
void Unrolling::add_sources(const Step& step, const Product& p, const Slots& a, const Slots& b,
                            std::vector<Source>& out) {
  const Value b0 = to_.product(1, p.coefficient, gather(b, 0));
  if (leads(a, step))
    out.push_back({.slots = a, .f = b0, .g = first_order(p.coefficient, b)});
  else if (p_.lags[a[0]] == step.lag - 1)
    out.push_back({.slots = a, .h = b0});
}

/// y' = c w u': the factors (m)_ℓ (m − ℓ)/(m − ℓ + 1) of T_u w₁ are (m)_ℓ − (m)_{ℓ−1}.
void Unrolling::add_integral(const Step& step, const Product& p, std::vector<Source>& out) {
  add_sources(step, p, p.a, p.b, out);
  if (leads(p.a, step) && out.back().g != none) out.back().h = to_.product(-1, out.back().g);
  if (leads(p.b, step)) out.push_back({.slots = p.b, .h = first_order(p.coefficient, p.a)});
}

/// Where it is needed: after stage 0.
Value Unrolling::first_order(Value coefficient, const Slots& slots) {
  return stage_ == 0 ? none : to_.product(1, coefficient, gather(slots, 1));
}

/// Diagonal, if each lane depends on one direction at most.
void Unrolling::find_tangents(Step& step) {
  const std::vector<Source> all = sources(step);
  std::vector<std::set<int>> of_lanes(step.out.size());
  std::set<int> directions;
  for (const Source& source : all)
    for (std::size_t i = 0; source.f != none && i < step.out.size(); ++i)
      for (int d = 0; d < static_cast<int>(n_); ++d)
        if (!to_.is_zero(tangent(Step::T, source.slots[i], d))) of_lanes[i].insert(d), directions.insert(d);
  const auto add = [&](int name, const std::vector<int>& direction) {
    std::vector<Term> terms;
    for (const Source& source : all)
      if (source.f != none) terms.push_back({1, source.f, tangents(Step::T, source.slots, direction)});
    step.tangents[Step::T][name] = to_.sum(terms);
  };
  if (directions.empty()) return;
  if (std::any_of(of_lanes.begin(), of_lanes.end(), [](const auto& d) { return d.size() > 1; })) {
    for (const int d : directions) add(d, std::vector<int>(step.out.size(), d));
    return;
  }
  for (const auto& d : of_lanes) step.direction.push_back(d.empty() ? -1 : *d.begin());
  add(Step::own, step.direction);
}

/// Whether stage k can be computed before q̈_{k−1} is known. Its part in q̈_k is linear, (A + B/k) q̈_{k−1} with matrices
/// A and B of the point alone, and is added at the end: so stage k does not wait for the solution of stage k − 1. Only
/// sums and integrals have rules for A and B; and no sum may read a coefficient that q̈_{k−1} changes, since that change
/// would be missing in it.
bool Unrolling::can_look_ahead() const {
  return n_ <= most_waiting && std::all_of(steps_.begin(), steps_.end(), [&](const Step& step) {
           if (!is_moved(step)) return true;
           for (const Column& column : step.columns)
             for (const Slot slot : column.slots)
               if (passes(slot, column.shift, step.lag - 1)) return false;
           return step.kind == Step::Sum || step.kind == Step::Integral;
         });
}

/// A and B of the residual times −M₀⁻¹. After stage 1: they are made of coefficients of order 1.
void Unrolling::look_ahead() {
  for (Step& step : steps_)
    if (is_moved(step)) find_second_tangents(step);
  for (int d = 0; d < static_cast<int>(n_); ++d) {
    std::vector<Term> a, b;
    for (std::uint32_t i = 0; i < n_; ++i) {
      a.push_back({1, tangent(Step::A, p_.residual[i], d), inverse_[i]});
      b.push_back({1, tangent(Step::B, p_.residual[i], d), inverse_[i]});
    }
    ahead_a_.push_back(to_.sum(a)), ahead_b_.push_back(to_.sum(b));
  }
}

/// Whether each lane is changed by one coordinate alone also through A and B, the one that changes it through T. Not so
/// where q̈_i = f(q, q̇_j), as in polar coordinates.
bool Unrolling::keeps_directions(const Step& step, const std::vector<Source>& all) {
  const auto is_moved_by = [&](const Source& s, std::size_t lane, int d) {
    const auto has = [&](Step::Part part) { return !to_.is_zero(tangent(part, s.slots[lane], d)); };
    return (s.f != none && (has(Step::A) || has(Step::B))) || ((s.g != none || s.h != none) && has(Step::T));
  };
  for (const Source& s : all)
    for (std::size_t lane = 0; lane < step.out.size(); ++lane)
      for (int d = 0; d < static_cast<int>(n_); ++d)
        if (d != step.direction[lane] && is_moved_by(s, lane, d)) return false;
  return true;
}

void Unrolling::find_second_tangents(Step& step) {
  const std::vector<Source> all = sources(step);
  const auto add = [&](int name, const std::vector<int>& direction) {
    std::vector<Term> a, b;
    for (const Source& s : all) {
      const auto of = [&](Step::Part part) { return tangents(part, s.slots, direction); };
      if (s.f != none) {
        a.push_back({1, s.f, of(Step::A)});
        b.push_back({1, s.f, of(Step::B)});
        b.push_back({static_cast<double>(s.shift), s.f, of(Step::A)});
      }
      if (s.g != none) a.push_back({1, s.g, of(Step::T)});
      if (s.h != none) b.push_back({1, s.h, of(Step::T)});
    }
    if (const Value sum = to_.sum(a); !to_.is_zero(sum)) step.tangents[Step::A][name] = sum;
    if (const Value sum = to_.sum(b); !to_.is_zero(sum)) step.tangents[Step::B][name] = sum;
  };
  if (step.tangents[Step::T].contains(Step::own) && keeps_directions(step, all)) return add(Step::own, step.direction);
  for (int d = 0; d < static_cast<int>(n_); ++d) add(d, std::vector<int>(step.out.size(), d));
}

}  // namespace maupertuis::unrolled
