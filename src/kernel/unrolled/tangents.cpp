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

/// `second`: with all that A and B need.
std::vector<Unrolling::Source> Unrolling::sources(const Step& step, bool second) {
  std::vector<Source> out;
  const auto value = [&](const Slots& slots, int order) { return gather(slots, order); };
  const auto leads = [&](const Slots& slots) { return p_.lags[slots[0]] == step.lag; };
  const auto is_behind = [&](const Slots& slots) { return second && p_.lags[slots[0]] == step.lag - 1; };
  for (const Column& c : step.columns)
    if (p_.lags[c.slots[0]] + c.shift == step.lag) out.push_back({.slots = c.slots, .f = c.coefficient, .shift = c.shift});
  const auto times = [&](const Product& p, double factor, const Slots& other, int order) {
    return to_.product(factor, p.coefficient, value(other, order));
  };
  for (const Product& p : step.products) {
    if (step.kind == Step::Sum) {
      for (const auto& [x, y] : {std::pair{p.a, p.b}, std::pair{p.b, p.a}}) {
        if (leads(x)) out.push_back({.slots = x, .f = times(p, 1, y, 0), .g = second ? times(p, 1, y, 1) : none});
        else if (is_behind(x)) out.push_back({.slots = x, .h = times(p, 1, y, 0)});
      }
    } else if (step.kind == Step::Integral) {
      // the factors (m)_ℓ (m − ℓ)/(m − ℓ + 1) of T_u w₁ are (m)_ℓ − (m)_{ℓ−1}
      if (leads(p.a)) {
        out.push_back({.slots = p.a, .f = times(p, 1, p.b, 0)});
        if (second) out.back().g = times(p, 1, p.b, 1), out.back().h = times(p, -1, p.b, 1);
      } else if (is_behind(p.a)) {
        out.push_back({.slots = p.a, .h = times(p, 1, p.b, 0)});
      }
      if (second && leads(p.b)) out.push_back({.slots = p.b, .h = times(p, 1, p.a, 1)});
    } else if (step.kind == Step::Quotient) {
      const Value reciprocal = to_.reciprocal(value(p.b, 0));
      if (leads(p.a)) out.push_back({.slots = p.a, .f = reciprocal});
      if (leads(p.b)) out.push_back({.slots = p.b, .f = to_.product(-1, value(step.out, 0), reciprocal)});
    } else if (leads(p.a)) {
      const bool is_root = step.kind == Step::Root;
      const Value y = value(step.out, 0);
      out.push_back({.slots = p.a, .f = is_root ? to_.sum({{0.5}}, none, y)
                                                : to_.sum({{1, p.coefficient, y}}, none, value(p.a, 0))});
    }
  }
  return out;
}

/// Diagonal, if each lane depends on one direction at most.
void Unrolling::find_tangents(Step& step) {
  const std::vector<Source> all = sources(step, false);
  std::vector<std::set<int>> of_lanes(step.out.size());
  std::set<int> directions;
  for (const Source& source : all)
    for (std::size_t i = 0; i < step.out.size(); ++i)
      for (int d = 0; d < static_cast<int>(n_); ++d)
        if (!to_.is_zero(tangent(Step::T, source.slots[i], d))) of_lanes[i].insert(d), directions.insert(d);
  const auto add = [&](int name, const std::vector<int>& direction) {
    std::vector<Term> terms;
    for (const Source& source : all) terms.push_back({1, source.f, tangents(Step::T, source.slots, direction)});
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

/// Whether A and B of all steps are found by the rules for sums and integrals, and no sum reads what the stage before
/// has just found: that would hold the q̈ that is to come last.
bool Unrolling::can_look_ahead() const {
  return n_ <= most_waiting && std::all_of(steps_.begin(), steps_.end(), [&](const Step& step) {
    if (!is_moved(step)) return true;
    for (const Column& column : step.columns)
      for (const Slot slot : column.slots)
        if (passes(slot, column.shift, step.lag - 1)) return false;
    return step.kind == Step::Sum || step.kind == Step::Integral;
  });
}

/// After stage 1, when all coefficients of order 1 are known that A and B take.
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

void Unrolling::find_second_tangents(Step& step) {
  const std::vector<Source> all = sources(step, true);
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
  if (step.tangents[Step::T].contains(Step::own)) return add(Step::own, step.direction);
  for (int d = 0; d < static_cast<int>(n_); ++d) add(d, std::vector<int>(step.out.size(), d));
}

}  // namespace maupertuis::unrolled
