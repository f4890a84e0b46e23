#pragma once
#include "disks/least_modulus.hpp"
#include "disks/plan.hpp"
#include "disks/rules.hpp"

#include <maupertuis/disks.hpp>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace maupertuis {

/// Bounds of the values of a program on one disk (V = double), or on several about one centre (V = Lanes, a disk a
/// lane). The *larger disk* of a lane is the one that it had in the call before, since begin().
template <class V>
class DiskValues {
 public:
  using Bounds = disk_rules::Bounds<V>;

  explicit DiskValues(const DiskPlan& plan)
      : plan_(plan),
        values_(plan.program.slots),
        before_(plan.program.slots),
        series_(plan.program.slots),
        upper_(plan.program.unknowns) {
    for (auto& values : rate_reach_) values.resize(plan.program.unknowns);
  }
  void begin(const SlotCoefficients& coefficients) {
    now_ = coefficients;
    radius_ = larger_ = disk_rules::all<V>(0);
    const std::size_t orders = (static_cast<std::size_t>(now_.order) + 11) / 4 * 4;
    if (powers_.size() != orders) powers_.resize(orders);
  }
  /// by_coefficients: what the rows say of a value besides the rules, where a larger disk has bounded what they leave
  /// out.
  void evaluate(const V& radius, const std::vector<std::uint32_t>& nodes, bool by_coefficients);

  const Bounds& of(std::uint32_t slot) const { return values_[slot]; }
  const SlotCoefficients& coefficients() const { return now_; }
  /// Of d^shift/dt^shift of a slot.
  V shifted_tail(std::uint32_t slot, std::uint32_t shift) const;
  V tail_of_product(std::uint32_t a, std::uint32_t b) const {
    return plan_.degree[a] + plan_.degree[b] < now_.order ? number(0) : product(a, b).tail;
  }

 private:
  static constexpr double infinity = disk_rules::infinity;
  static V number(double x) { return disk_rules::all<V>(x); }

  void find_powers();
  void find_what_is_passed_on();
  void evaluate_coordinates();
  V series(std::uint32_t slot, int first, int last) const;
  V reach_of_rate(std::uint32_t slot, int shift) const;
  void evaluate_series();
  void add_to_series(std::uint32_t first, std::uint32_t last, int lag);
  void evaluate(const DiskPlan::Node& node);
  Bounds sum(const Instruction& instruction) const;
  V tail_of_sum(const Instruction& instruction) const;
  Bounds product(std::uint32_t a, std::uint32_t b) const {
    return disk_rules::product(size(a), size(b), values_[a], values_[b]);
  }
  V shifted_reach(std::uint32_t slot, std::uint32_t shift) const;
  V series_of_derivative(std::uint32_t slot, std::uint32_t shift) const;
  V low_of_base(std::uint32_t slot) const;
  V beyond(std::uint32_t slot) const;
  void set(std::uint32_t slot, const Bounds& bounds);

  double coefficient(int k, std::uint32_t slot) const {
    return now_.rows[static_cast<std::size_t>(k) * now_.stride + slot * now_.step];
  }
  double centre(std::uint32_t slot) const { return coefficient(0, slot); }
  double size(std::uint32_t slot) const { return std::abs(centre(slot)); }
  double size_of_rate(std::uint32_t slot, std::uint32_t shift) const {
    const double c = std::abs(coefficient(static_cast<int>(shift), slot)) / now_.unit;
    return shift == 1 ? c : 2 * c / now_.unit;
  }
  int last_order(std::uint32_t slot) const { return now_.order + 1 - std::max<int>(0, plan_.program.lags[slot]); }
  double in_seconds(int shift) const { return shift == 1 ? now_.unit : now_.unit * now_.unit; }
  static double weight(int k, int shift) { return shift == 1 ? k : static_cast<double>(k) * (k - 1); }

  const DiskPlan& plan_;
  SlotCoefficients now_;
  V radius_{}, larger_{};  // larger_ < radius_: there is no larger disk
  bool by_coefficients_ = false;
  std::vector<V> powers_;                     // [orders] radius^k, in units of now_.unit
  std::array<V, 4> passed_on_{};              // by lag + 1: what a tail on the larger disk leaves in the series
  std::vector<Bounds> values_, before_;       // [slots]; before: of the call before
  std::vector<V> series_;                     // [slots] Σ_{k≥1} |f_k| r^k
  std::vector<V> upper_;                      // [unknowns] Σ |q_k| r^k of the upper half of the orders
  std::array<std::vector<V>, 2> rate_reach_;  // [unknowns] of q̇ and q̈
};

template <class V>
void DiskValues<V>::evaluate(const V& radius, const std::vector<std::uint32_t>& nodes, bool by_coefficients) {
  before_.swap(values_);
  larger_ = radius_;
  radius_ = radius;
  find_powers();
  by_coefficients_ = by_coefficients;
  if (by_coefficients || !plan_.derived.empty()) find_what_is_passed_on();
  evaluate_coordinates();
  if (by_coefficients_) evaluate_series();
  const Program& program = plan_.program;
  if (program.one != no_slot) set(program.one, {number(0), number(0), number(1), number(1)});
  if (program.time != no_slot) {
    const V t = number(size(program.time));
    set(program.time, {radius_, number(0), disk_rules::larger(number(0), t - radius_), t + radius_});
  }
  for (const std::uint32_t at : nodes) evaluate(plan_.nodes[at]);
}

template <class V>
void DiskValues<V>::find_what_is_passed_on() {
  for (std::size_t lag = 0; lag < passed_on_.size(); ++lag)
    passed_on_[lag] = disk_rules::lane_by_lane(
        [&](double r, double larger) {
          const double x = r / larger;
          return larger > r ? std::pow(x, now_.order + 2 - static_cast<int>(lag)) / (1 - x) : infinity;
        },
        radius_, larger_);
}

/// In four strands, since each product waits for the one before, in registers.
template <class V>
void DiskValues<V>::find_powers() {
  const V x = radius_ / now_.unit, second = x * x, fourth = second * second;
  V a = number(1), b = x, c = second, d = second * x;
  for (std::size_t k = 0; k + 4 <= powers_.size(); k += 4) {
    powers_[k] = a, powers_[k + 1] = b, powers_[k + 2] = c, powers_[k + 3] = d;
    a *= fourth, b *= fourth, c *= fourth, d *= fourth;
  }
}

/// q, q̇ and q̈ of the coordinates, and of what multipliers are the second derivatives of: polynomials that are known
/// whole.
template <class V>
void DiskValues<V>::evaluate_coordinates() {
  const int degree = now_.order + 1, half = now_.order / 2;
  for (std::uint32_t slot = 0; slot < plan_.program.unknowns; ++slot) {
    if (!plan_.needs_reach[slot]) continue;
    upper_[slot] = series(slot, half, degree);
    const V reach = series(slot, 1, half - 1) + upper_[slot], c = number(size(slot));
    for (int shift = 1; shift <= plan_.most_rates; ++shift)
      rate_reach_[static_cast<std::size_t>(shift) - 1][slot] = reach_of_rate(slot, shift);
    values_[slot] = {reach, number(0), disk_rules::larger(number(0), c - reach), c + reach};
  }
}

/// Σ |f_k| r^k from first to last, in two strands, since each sum waits for the one before.
template <class V>
V DiskValues<V>::series(std::uint32_t slot, int first, int last) const {
  V even = number(0), odd = even;
  const V* power = powers_.data() + first;
  const double* c = now_.rows + static_cast<std::size_t>(first) * now_.stride + slot * now_.step;
  int left = last - first + 1;
  for (; left > 1; left -= 2, power += 2, c += 2 * now_.stride) {
    even = even + power[0] * std::abs(c[0]);
    odd = odd + power[1] * std::abs(c[now_.stride]);
  }
  if (left == 1) even = even + power[0] * std::abs(c[0]);
  return even + odd;
}

template <class V>
V DiskValues<V>::reach_of_rate(std::uint32_t slot, int shift) const {
  V sum = number(0);
  for (int k = shift + 1; k <= now_.order + 1; ++k)
    sum = sum + powers_[static_cast<std::size_t>(k - shift)] * (weight(k, shift) * std::abs(coefficient(k, slot)));
  return sum / in_seconds(shift);
}

/// Σ_{k≥1} |f_k| r^k of slots whose coefficients are in the rows.
template <class V>
void DiskValues<V>::evaluate_series() {
  const Program& program = plan_.program;
  std::uint32_t first = static_cast<std::uint32_t>(program.unknowns);
  for (int lag = 0; lag <= 2 && !plan_.only_few; ++lag) {
    const std::uint32_t last = std::max<std::uint32_t>(first, program.stored_end[static_cast<std::size_t>(lag)]);
    add_to_series(first, last, lag);
    first = last;
  }
  for (const std::uint32_t slot : plan_.only_few ? plan_.few : plan_.alone)
    add_to_series(slot, slot + 1, std::max<int>(0, program.lags[slot]));
}

/// Row after row, as they lie in memory.
template <class V>
void DiskValues<V>::add_to_series(std::uint32_t first, std::uint32_t last, int lag) {
  V* const series = series_.data();
  std::fill(series + first, series + last, number(0));
  for (int k = 1; k <= now_.order + 1 - lag; ++k) {
    const double* const row = now_.rows + static_cast<std::size_t>(k) * now_.stride;
    const V power = powers_[static_cast<std::size_t>(k)];
    if (now_.step == 1)
      for (std::uint32_t s = first; s < last; ++s) series[s] = series[s] + power * std::abs(row[s]);
    else
      for (std::uint32_t s = first; s < last; ++s) series[s] = series[s] + power * std::abs(row[s * now_.step]);
  }
}

/// What an instruction says of its result, and where the coefficients and a larger disk say less, those.
template <class V>
[[gnu::always_inline]] inline void DiskValues<V>::set(std::uint32_t slot, const Bounds& b) {
  using namespace disk_rules;
  const V c = number(size(slot)), most = number(infinity), tail = smaller(b.tail, most);
  V reach = smaller(b.reach, most), low = b.low;  // what is no number is infinite
  values_[slot].tail = tail;
  if (by_coefficients_ && plan_.has_series[slot]) {
    const auto lag = static_cast<std::size_t>(std::max<int>(0, plan_.program.lags[slot]));
    reach = smaller(series_[slot] + before_[slot].tail * passed_on_[lag], reach);
  }
  if (plan_.is_base[slot]) low = larger(low, low_of_base(slot));
  values_[slot].reach = reach;
  values_[slot].low = larger(low, larger(number(0), c - reach));
  values_[slot].high = smaller(b.high, c + reach);
}

template <class V>
void DiskValues<V>::evaluate(const DiskPlan::Node& node) {
  const Instruction& i = node.instruction;
  using disk_rules::lane_by_lane;
  using Disk = disk_rules::Bounds<double>;
  const auto of_each = [&](auto&& rule) {
    return lane_by_lane(rule, values_[i.a], values_[i.b == no_slot ? i.a : i.b]);
  };
  switch (i.op) {
    case Op::One:
    case Op::Time:
    case Op::Coordinate:
    case Op::Companion:
      return;
    case Op::Linear:
    case Op::Products:
      if (plan_.needs_reach[i.out]) return set(i.out, sum(i));
      return set(i.out, {number(0), tail_of_sum(i), number(0), number(infinity)});
    case Op::Square: {
      const Bounds b = product(i.a, i.a);
      return set(i.out, {b.reach, plan_.degree[i.out] < now_.order ? number(0) : b.tail, b.low, b.high});
    }
    case Op::Quotient:
      return set(i.out, disk_rules::quotient(size(i.out), values_[i.a], values_[i.b]));
    case Op::SquareRoot:
      return set(i.out, disk_rules::square_root(size(i.out), values_[i.a]));
    case Op::Power:
      if (node.halves != 0) return set(i.out, disk_rules::half_power(size(i.out), values_[i.a], node.halves));
      return set(i.out,
                 of_each([&](const Disk& a, const Disk&) { return disk_rules::power(a, node.exponent, size(i.out)); }));
    case Op::SinCos: {
      const double s = size(i.out), c = size(i.second);
      set(i.out, of_each([&](const Disk& a, const Disk&) { return disk_rules::sine(a, s, c); }));
      return set(i.second, of_each([&](const Disk& a, const Disk&) { return disk_rules::sine(a, c, s); }));
    }
    case Op::SinhCosh:
      for (const Slot slot : {i.out, i.second})
        set(slot,
            of_each([&](const Disk& a, const Disk&) { return disk_rules::hyperbolic(a, size(i.a), size(slot)); }));
      return;
    case Op::Function:
      return set(i.out, of_each([&](const Disk& a, const Disk& b) {
                   const bool two = i.b != no_slot;
                   return disk_rules::function(i.function, a, two ? &b : nullptr, centre(i.a), two ? centre(i.b) : 0,
                                               size(i.out));
                 }));
    case Op::Derivative:
      return set(i.out, {shifted_reach(i.a, 1), shifted_tail(i.a, 1), number(0), number(infinity)});
    case Op::Select:
      return set(i.out, values_[plan_.chosen(i)]);
  }
  throw std::logic_error("disks met an operation that they do not know; please report");
}

/// The modulus of a sum is at least the largest lower bound of a term less the upper bounds of the others.
template <class V>
[[gnu::always_inline]] inline typename DiskValues<V>::Bounds DiskValues<V>::sum(const Instruction& i) const {
  using namespace disk_rules;
  V reach = number(0), tail = reach, high = reach, largest = reach;  // largest: of low + high
  for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
    const DiskPlan::Term& term = plan_.terms[t];
    if (term.size == 0) continue;
    const auto add = [&](const V& r, const V& rest, const V& least, const V& most) {
      reach = reach + r * term.size;
      tail = tail + rest * term.size;
      high = high + most * term.size;
      largest = larger(largest, (least + most) * term.size);
    };
    if (DiskPlan::is_product(i, t)) {
      const Bounds b = product(term.a, term.b);
      add(b.reach, plan_.degree[term.a] + plan_.degree[term.b] < now_.order ? number(0) : b.tail, b.low, b.high);
    } else if (term.shift == 0) {
      const Bounds& b = values_[term.a];
      add(b.reach, b.tail, b.low, b.high);
    } else {
      const V r = shifted_reach(term.a, term.shift);
      add(r, shifted_tail(term.a, term.shift), number(0), r + number(size_of_rate(term.a, term.shift)));
    }
  }
  const V low = select(high < number(infinity), larger(number(0), largest - high), number(0));
  return {reach, tail, low, high};
}

template <class V>
V DiskValues<V>::tail_of_sum(const Instruction& i) const {
  V tail = number(0);
  for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
    const DiskPlan::Term& term = plan_.terms[t];
    if (term.size == 0) continue;
    const V of_term = DiskPlan::is_product(i, t) ? tail_of_product(term.a, term.b) : shifted_tail(term.a, term.shift);
    tail = tail + of_term * term.size;
  }
  return tail;
}

/// d^shift/dt^shift of an operand: how far it is from its value at the centre.
template <class V>
V DiskValues<V>::shifted_reach(std::uint32_t slot, std::uint32_t shift) const {
  if (shift == 0) return values_[slot].reach;
  if (slot < plan_.program.unknowns) return rate_reach_[shift - 1][slot];
  if (plan_.degree[slot] < static_cast<int>(shift) || slot == plan_.program.time) return number(0);
  // Cauchy's estimate of the derivative between the two circles …
  const V gap = larger_ - radius_, reach = before_[slot].reach;
  V least = shift == 1 ? reach * 2.0 / gap : reach * 4.0 / (gap * gap);
  if (plan_.has_series[slot]) least = disk_rules::smaller(least, series_of_derivative(slot, shift));
  return disk_rules::select(radius_ < larger_, least, number(infinity));
}

/// … or its coefficients, and what the larger disk leaves out of them: Σ_{k>K} k^s |f_k| r^{k−s} with |f_k| ≤ tail/R^k.
template <class V>
V DiskValues<V>::series_of_derivative(std::uint32_t slot, std::uint32_t shift) const {
  const int last = last_order(slot);
  const auto lag = static_cast<std::size_t>(std::max<int>(0, plan_.program.lags[slot]));
  V sum = number(0);
  for (int k = static_cast<int>(shift) + 1; k <= last; ++k)
    sum = sum + powers_[static_cast<std::size_t>(k) - shift] *
                    (weight(k, static_cast<int>(shift)) * std::abs(coefficient(k, slot)));
  const V widened = number(last + 2) / (radius_ * (number(1) - radius_ / larger_));
  return sum / in_seconds(static_cast<int>(shift)) +
         before_[slot].tail * passed_on_[lag] * (shift == 1 ? widened : widened * widened);
}

/// The k-th coefficient of the derivative is at most (k + s)^s tail/r^{k+s}; with x ≤ ½ its sum is this tail's.
template <class V>
V DiskValues<V>::shifted_tail(std::uint32_t slot, std::uint32_t shift) const {
  if (slot < plan_.program.unknowns) return number(0);
  const V tail = values_[slot].tail;
  if (shift == 0) return tail;
  const V once = number(2 * (now_.order + 3)) / radius_;
  return tail * (shift == 1 ? once : once * once);
}

/// Distances: how near to 0 the known coefficients of w = r² take it, where bounds of x_i − x_j alone would let any two
/// bodies meet. Its terms up to the second, less all others.
template <class V>
V DiskValues<V>::low_of_base(std::uint32_t slot) const {
  const V rest = series(slot, 3, last_order(slot));
  const V least = disk_rules::least_modulus(coefficient(0, slot), coefficient(1, slot), coefficient(2, slot),
                                            V(radius_ / now_.unit));
  return disk_rules::larger(number(0), least - rest - beyond(slot));
}

/// What the rows leave out of a base: there is little, since a base is a sum of products u v of linear functions of q,
/// and where i + j > K, i or j is at least half of that, so that Σ_{k>K} |w_k| r^k ≤ U_u |v| + |u| U_v with the upper
/// halves U of the series of u and v. Of a linear function: the upper half of its orders, which is more.
template <class V>
V DiskValues<V>::beyond(std::uint32_t slot) const {
  if (slot < plan_.program.unknowns) return upper_[slot];
  if (plan_.maker[slot] < 0) return number(0);
  const auto of_product = [this](std::uint32_t a, std::uint32_t b) {
    const V by_a = beyond(a) * values_[b].high;
    return a == b ? by_a * 2.0 : by_a + values_[a].high * beyond(b);
  };
  const Instruction& i = plan_.nodes[static_cast<std::size_t>(plan_.maker[slot])].instruction;
  if (i.op == Op::Square) return of_product(i.a, i.a);
  V sum = number(0);
  for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
    const DiskPlan::Term& term = plan_.terms[t];
    sum = sum + (DiskPlan::is_product(i, t) ? of_product(term.a, term.b) : beyond(term.a)) * term.size;
  }
  return sum;
}

}  // namespace maupertuis
