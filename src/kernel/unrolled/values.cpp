#include "kernel/straight_line/power.hpp"
#include "kernel/unrolled/unrolling.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace maupertuis::unrolled {

/// q or q̇. Few numbers are read one by one: a wider load would wait until all of what was written is in the cache.
void Unrolling::give_coordinates(int order) {
  const auto array = order == 0 ? Positions : Velocities;
  for (std::uint32_t i = 0; i < n_; ++i)
    final_[place(i, order)] =
        n_ <= most_waiting ? to_.given(array, i) : to_.lane(to_.wide_given(Rows, cell(order, 0), width_of(n_)), i);
}

/// As far as it is known: coordinates of a stage count as 0 before its solution.
Value Unrolling::at(Slot slot, int order) {
  Value& found = final_[place(slot, order)];
  if (found != none) return found;
  if (slot < n_) return to_.literal(0);
  if (slot == p_.one || (slot == p_.time && order > 0)) return to_.literal(order == (slot == p_.one ? 0 : 1));
  return found = to_.given(Rows, cell(order, slot));
}

Value Unrolling::gathered(std::vector<Value> lanes) {
  lanes.resize(width_of(lanes.size()), lanes.back());
  return to_.gather(lanes);
}

Value Unrolling::gather(const Slots& slots, int order) {
  std::vector<Value> lanes;
  for (const Slot slot : slots) lanes.push_back(at(slot, order));
  return gathered(std::move(lanes));
}

/// What the stage before found is taken without its q̈ where that comes last.
Value Unrolling::operand(const Slots& slots, int order) {
  std::vector<Value> lanes;
  for (const Slot slot : slots) {
    const bool is_early = looks_ahead(stage_) && order == current_order(slot) - 1;
    if (is_early && slot < n_)
      lanes.push_back(to_.literal(0));
    else if (is_early && early_[place(slot, order)] != none)
      lanes.push_back(early_[place(slot, order)]);
    else
      lanes.push_back(at(slot, order));
  }
  return gathered(std::move(lanes));
}

/// k u_k. Of coordinates that is q̈/(k − 1): one operation fewer to wait for.
Value Unrolling::weighted(const Slots& slots, int order) {
  const Value values = operand(slots, order);
  if (to_.is_zero(values)) return values;
  const auto [found, fresh] = weighted_.try_emplace({values, order}, none);
  if (!fresh) return found->second;
  if (order < 2 || std::any_of(slots.begin(), slots.end(), [&](Slot s) { return s >= n_; }))
    return found->second = to_.product(order, values);
  std::vector<Value> lanes;
  for (const Slot slot : slots) lanes.push_back(to_.lane(accelerations_[static_cast<std::size_t>(order) - 2], slot));
  return found->second = over(gathered(std::move(lanes)), order - 1);
}

/// times · x / divisor for a whole number, without the rounding of its reciprocal, which would be the same in every
/// step and add up.
Value Unrolling::over(Value x, double divisor, Value times) {
  const double high = 1 / divisor, low = std::fma(-high, divisor, 1.0) / divisor;
  if (low == 0) return to_.product(high, times, x);
  return to_.sum({{low, times, x}, {high, times, x}});
}

/// In two chains; `none` without terms.
Value Unrolling::dot(const std::vector<Term>& terms) {
  std::vector<Term> halves[2];
  for (std::size_t i = 0; i < terms.size(); ++i) halves[i % 2].push_back(terms[i]);
  if (terms.size() < 2) return terms.empty() ? none : to_.sum(terms);
  return to_.sum({{1, to_.sum(halves[0])}, {1, to_.sum(halves[1])}});
}

/// Σ_{j=first..k} a(j) b(k−j), from the middle outward in two chains; the ends, which may be of this stage or the last,
/// are added to one finished sum.
template <class F, class G>
Value Unrolling::convolution(F&& a, G&& b, int first) {
  constexpr std::size_t at_the_ends = 4;
  std::vector<int> order;
  for (int j = first; j <= k_; ++j) order.push_back(j);
  const auto from_middle = [&](int j) { return std::abs(2 * j - first - k_); };
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return from_middle(i) < from_middle(j); });
  std::vector<Term> terms;
  for (const int j : order) terms.push_back({1, a(j), b(k_ - j)});
  if (terms.size() <= at_the_ends) return dot(terms);
  const auto ends = terms.end() - at_the_ends;
  std::vector<Term> outer{{1, dot({terms.begin(), ends})}};
  std::vector<Term> other;
  for (auto t = ends; t != terms.end(); ++t) ((t - ends) % 2 == 0 ? outer : other).push_back(*t);
  return to_.sum({{1, to_.sum(outer)}, {1, to_.sum(other)}});
}

Value Unrolling::product(const Slots& a, const Slots& b, int first) {
  if (a == b) return square(a, first);
  return convolution([&](int j) { return operand(a, j); }, [&](int j) { return operand(b, j); }, first);
}

/// Σ_{j=first..k−first} a_j a_{k−j}, each pair once.
Value Unrolling::square(const Slots& a, int first) {
  std::vector<Term> pairs, all;
  for (int j = (k_ - 1) / 2; j >= first && 2 * j < k_; --j) pairs.push_back({1, operand(a, j), operand(a, k_ - j)});
  if (!pairs.empty()) all.push_back({2, to_.sum(pairs)});
  if (k_ % 2 == 0 && k_ / 2 >= first) all.push_back({1, operand(a, k_ / 2), operand(a, k_ / 2)});
  return to_.sum(all);
}

// --------------------------------------------------------------------------------------------------------------- steps

void Unrolling::find(const Step& step) {
  k_ = stage_ + 2 - step.lag;
  if (k_ >= 0) keep(step, value_of(step));
}

Value Unrolling::value_of(const Step& step) {
  switch (step.kind) {
    case Step::Sum:
      return sum(step);
    case Step::Integral:
      return k_ == 0 ? functions(step) : integral(step);
    case Step::Quotient:
      return quotient(step);
    case Step::Root:
      return root(step);
    case Step::Power:
      break;
  }
  return power(step);
}

/// After the corrections of the stage: rates of integrals that stand in it are those from before.
void Unrolling::find_points() {
  rates_.clear();
  for (const auto& [step, highest] : points_) {
    k_ = stage_ + 2 - step.lag;
    if (k_ < 0 || k_ > highest) continue;
    const Value value = value_of(step);
    set(step, k_, value, final_);
    for (std::uint32_t i = 0; i < step.out.size(); ++i)
      to_.store(to_.lane(value, i), Rows, static_cast<std::uint32_t>(cell(k_, step.out[i])));
  }
}

/// What is corrected is stored when it is final.
void Unrolling::keep(const Step& step, Value value) {
  set(step, k_, value, final_);
  if (stage_ < 0 || !is_corrected(step.out[0])) store(step.out, k_, value);
}

/// Places behind the last one, up to a whole vector, belong to nobody.
void Unrolling::store(const Slots& slots, int order, Value value) {
  const auto place = [&](Slot slot) { return static_cast<std::uint32_t>(cell(order, slot)); };
  if (to_.width(value) >= slots.size()) return to_.store(value, Rows, place(slots[0]));
  for (const Slot slot : slots) to_.store(value, Rows, place(slot));
}

Value Unrolling::sum(const Step& step) {
  Value result = to_.literal(0);
  for (int shift = 0; shift <= static_cast<int>(::maupertuis::Term::most_shift); ++shift)
    result = columns(step, shift, result);
  return can_be_merged(step) ? merged_products(step, result) : products(step, result);
}

/// The factor of the shift goes to the coefficients where they are few, since nothing waits for those, else to their
/// sum.
Value Unrolling::columns(const Step& step, int shift, Value before) {
  const double factor = shift == 0 ? 1 : shift == 1 ? k_ + 1.0 : (k_ + 1.0) * (k_ + 2.0);
  std::vector<Term> derivatives, others;
  for (const Column& column : step.columns) {
    if (column.shift != shift) continue;
    if (const Value known = rate(column); known != none)
      derivatives.push_back({1, column.coefficient, known});
    else if (const Value x = gather(column.slots, k_ + shift); !to_.is_zero(x))
      others.push_back({1, column.coefficient, x});
  }
  std::vector<Term> all{{1, before}};
  if (!derivatives.empty()) all.push_back({1, dot(derivatives)});
  if (others.size() > 2) others = {{1, dot(others)}};
  for (Term& t : others) t.factor = factor, all.push_back(t);
  return to_.sum(all);
}

/// Derivatives of integrals of this stage: k y_k is there before y_k is. `none`: not all of the slots are such.
Value Unrolling::rate(const Column& column) {
  std::vector<Value> lanes;
  for (const Slot slot : column.slots) {
    const auto found =
        column.shift > 0 && current_order(slot) == k_ + column.shift ? rates_.find({slot, column.shift}) : rates_.end();
    if (found == rates_.end()) return none;
    lanes.push_back(found->second);
  }
  return gathered(std::move(lanes));
}

Value Unrolling::products(const Step& step, Value before) {
  std::vector<Term> terms{{1, before}};
  for (const Product& p : step.products) terms.push_back({1, p.coefficient, product(p.a, p.b, 0)});
  return to_.sum(terms);
}

/// Products of several terms are one convolution of wider values, where these are full.
bool Unrolling::can_be_merged(const Step& step) const {
  const std::size_t whole = step.products.size() * step.out.size();
  return step.products.size() > 1 && whole <= packed::lanes && std::has_single_bit(whole) &&
         std::all_of(step.products.begin(), step.products.end(), [](const Product& p) { return p.a != p.b; });
}

Value Unrolling::merged_products(const Step& step, Value before) {
  Slots a, b;
  for (const Product& p : step.products)
    a.insert(a.end(), p.a.begin(), p.a.end()), b.insert(b.end(), p.b.begin(), p.b.end());
  const Value all = product(a, b, 0);
  std::vector<Term> terms{{1, before}};
  std::uint32_t lane = 0;
  for (const Product& p : step.products) {
    std::vector<Value> part;
    for (std::size_t i = 0; i < p.a.size(); ++i) part.push_back(to_.lane(all, lane++));
    terms.push_back({1, p.coefficient, gathered(std::move(part))});
  }
  return to_.sum(terms);
}

Value Unrolling::integral(const Step& step) {
  std::vector<Term> terms;
  for (const Product& p : step.products)
    terms.push_back({1, p.coefficient,
                     convolution([&](int j) { return weighted(p.a, j); }, [&](int j) { return operand(p.b, j); }, 1)});
  const Value rate = to_.sum(terms);
  const Value second = terms.size() > 1 ? to_.product(k_ - 1, rate) : to_.product(k_ - 1, terms[0].a, terms[0].b);
  for (std::uint32_t i = 0; i < step.out.size(); ++i) {
    rates_[{step.out[i], 1}] = to_.lane(rate, i);
    rates_[{step.out[i], 2}] = to_.lane(second, i);
  }
  return terms.size() > 1 ? over(rate, k_) : over(terms[0].b, k_, terms[0].a);
}

/// Order 0. Second results, such as cosines, may be those of a step before.
Value Unrolling::functions(const Step& step) {
  std::vector<Value> angles, lanes;
  std::vector<const Instruction*> of_angles;
  for (const std::uint32_t index : step.functions) {
    const Instruction& i = p_.instructions[index];
    const Value x = at(i.a, 0);
    if (i.op == Op::SinCos)
      angles.push_back(x), of_angles.push_back(&i);
    else if (i.op == Op::SinhCosh)
      starts_[i.out] = to_.call(Kind::Sinh, x), starts_[i.second] = to_.call(Kind::Cosh, x);
    else
      starts_[i.out] = to_.call(i.function, x, i.b == no_slot ? none : at(i.b, 0));
  }
  if (!angles.empty()) {
    const auto both = to_.sines(angles);
    for (std::size_t i = 0; i < both.size(); ++i)
      starts_[of_angles[i]->out] = both[i].first, starts_[of_angles[i]->second] = both[i].second;
  }
  for (const Slot slot : step.out) lanes.push_back(starts_.at(slot));
  return gathered(std::move(lanes));
}

Value Unrolling::quotient(const Step& step) {
  const Product& p = step.products[0];
  if (k_ == 0) return to_.sum({{1, operand(p.a, 0)}}, none, operand(p.b, 0));
  return to_.sum({{1, operand(p.a, k_)}, {-1, product(p.b, step.out, 1)}}, to_.reciprocal(operand(p.b, 0)));
}

Value Unrolling::root(const Step& step) {
  const Value u = operand(step.products[0].a, k_);
  if (k_ == 0) return to_.root(u);
  return to_.sum({{0.5, u}, {-0.5, square(step.out, 1)}}, to_.reciprocal(operand(step.out, 0)));
}

/// y = a^p from a y' = p y a', as a_0 y_k = p a_k y_0 + Σ_{0<j<k} ((p + 1) j/k − 1) a_j y_{k−j}: the sums with both
/// weights side by side, what is known last by itself.
Value Unrolling::power(const Step& step) {
  const Slots& a = step.products[0].a;
  const Value p = step.products[0].coefficient, first = operand(a, 0);
  if (k_ == 0) return straight::power(to_, first, p);
  const Value reciprocal = to_.reciprocal(first);
  const Value slope = to_.product(1, to_.product(1, p, operand(step.out, 0)), reciprocal);
  const Term newest{1, slope, operand(a, k_)};
  if (k_ == 1) return to_.sum({newest});
  const auto both = [&](int j) { return j < k_ ? weighted_pair(p, a, j) : to_.literal(0); };
  const Value sums = convolution(
      both, [&](int j) { return operand(step.out, j); }, 1);
  const Value rest = to_.sum({{-1, to_.lane(sums, 1)}, {1, over(to_.lane(sums, 0), k_)}});
  return to_.sum({{1, reciprocal, rest}, newest});
}

/// (p + 1) j a_j and a_j.
Value Unrolling::weighted_pair(Value p, const Slots& a, int j) {
  const Value value = operand(a, j);
  const auto [found, fresh] = pairs_.try_emplace({value, p, j}, none);
  if (fresh) {
    const double k = j;
    const Value weighted =
        to_.is_literal(p) ? to_.product(k * (to_.literal_of(p) + 1), value) : to_.sum({{k, value}, {k, p, value}});
    found->second = to_.gather({weighted, value});
  }
  return found->second;
}

}  // namespace maupertuis::unrolled
