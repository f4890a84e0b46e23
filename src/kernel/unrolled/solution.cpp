#include "kernel/unrolled/unrolling.hpp"

#include <algorithm>

namespace maupertuis::unrolled {

/// The columns of −M₀⁻¹ by Gauss and Jordan on the transposed matrix without pivoting: stable where M₀ is symmetric and
/// positive definite. The pivots against their diagonal entries tell whether it is.
void Unrolling::factor() {
  for (Step& step : steps_)
    if (is_moved(step)) find_tangents(step);
  std::vector<Value> matrix;
  for (int d = 0; d < static_cast<int>(n_); ++d) {
    std::vector<Value> lanes;
    for (const Slot slot : p_.residual)
      lanes.push_back(passes(slot, 0, 2) ? tangent(Step::T, slot, d) : to_.literal(0));
    lanes.resize(width_of(n_), to_.literal(0));
    matrix.push_back(to_.gather(lanes));
  }
  inverse_ = matrix;
  for (std::uint32_t pivot = 0; pivot < n_; pivot += 2) eliminate(pivot, std::min(n_ - pivot, 2u), matrix);
  refine(matrix);
}

/// The row with 0 in the lanes of the pivots, and `one` in a lane.
Value Unrolling::without(Value row, std::uint32_t pivot, std::uint32_t count, std::uint32_t one) {
  std::vector<Value> lanes;
  for (std::uint32_t i = 0; i < width_of(n_); ++i)
    lanes.push_back(i - pivot < count ? to_.literal(i == one) : to_.lane(row, i));
  return to_.gather(lanes);
}

/// Rows of the inverse of the pivots' block times theirs, from all others: two pivots at once divide once.
void Unrolling::eliminate(std::uint32_t pivot, std::uint32_t count, const std::vector<Value>& matrix) {
  constexpr double least_pivot = 1e-10, least_determinant = 1e-280;
  const auto entry = [&](std::uint32_t i, std::uint32_t j) { return to_.lane(inverse_[i], j); };
  const auto unit = [&](std::uint32_t i) { return without(inverse_[i], pivot, count, i); };
  const std::uint32_t other = pivot + 1;
  const Value a = entry(pivot, pivot);
  to_.check({a, to_.lane(matrix[pivot], pivot), least_pivot});
  std::vector<Value> rows{unit(pivot)};
  Value determinant = a;
  if (count == 2) {
    const Value b = entry(pivot, other), c = entry(other, pivot), d = entry(other, other);
    determinant = to_.sum({{1, a, d}, {-1, b, c}});
    to_.check({determinant, to_.product(1, a, to_.lane(matrix[other], other)), least_pivot});
    to_.check({determinant, to_.literal(1), least_determinant});  // one that is too small has lost digits
    rows = {to_.sum({{1, d, unit(pivot)}, {-1, b, unit(other)}}), to_.sum({{1, a, unit(other)}, {-1, c, unit(pivot)}})};
  }
  const Value reciprocal = to_.reciprocal(determinant);
  for (std::uint32_t i = 0; i < n_; ++i) {
    if (i - pivot < count) continue;
    std::vector<Term> terms{{1, without(inverse_[i], pivot, count, n_)}};
    for (std::uint32_t p = 0; p < count; ++p)
      terms.push_back({-1, to_.product(1, entry(i, pivot + p), reciprocal), rows[p]});
    inverse_[i] = to_.sum(terms);
  }
  for (std::uint32_t p = 0; p < count; ++p) inverse_[pivot + p] = to_.product(1, reciprocal, rows[p]);
}

/// Newton's step X + X (1 − N X) for the inverse X of N, and its sign: what rounding left in X would act on all orders
/// of a step, and the energy of a double pendulum drift.
void Unrolling::refine(const std::vector<Value>& matrix) {
  const std::vector<Value> before = inverse_;
  std::vector<Value> rest;
  for (std::uint32_t i = 0; i < n_; ++i) {
    std::vector<Term> terms{{1, without(to_.literal(0), i, 1, i)}};
    for (std::uint32_t j = 0; j < n_; ++j) terms.push_back({-1, to_.lane(matrix[i], j), before[j]});
    rest.push_back(to_.sum(terms));
  }
  for (std::uint32_t i = 0; i < n_; ++i) {
    std::vector<Term> change;
    for (std::uint32_t j = 0; j < n_; ++j) change.push_back({1, to_.lane(before[i], j), rest[j]});
    inverse_[i] = to_.sum({{-1, before[i]}, {-1, to_.sum(change)}});
  }
}

/// q̈_k = −M₀⁻¹ R_k; looking ahead, R_k lacks its part by q̈_{k−1}.
void Unrolling::solve() {
  std::vector<Term> now, before;
  for (std::uint32_t d = 0; d < n_; ++d) {
    now.push_back({1, at(p_.residual[d], stage_), inverse_[d]});
    if (!looks_ahead(stage_)) continue;
    const Value slope = to_.sum({{1, ahead_a_[d]}, {1.0 / stage_, ahead_b_[d]}});
    before.push_back({1, to_.lane(accelerations_.back(), d), slope});
  }
  const Value found = before.empty() ? dot(now) : to_.sum({{1, dot(before)}, {1, dot(now)}});
  accelerations_.push_back(found);
  check_ = check_ == none ? found : to_.sum({{1, check_}, {1, found}});
}

void Unrolling::correct() {
  const Value q = over(accelerations_.back(), (stage_ + 1.0) * (stage_ + 2.0));
  coordinates_.push_back(q);
  Slots slots;
  for (std::uint32_t i = 0; i < n_; ++i) slots.push_back(i), final_[place(i, stage_ + 2)] = to_.lane(q, i);
  store(slots, stage_ + 2, q);
  for (const Step& step : steps_)
    if (is_corrected(step.out[0]) && stage_ + 2 - step.lag >= 0) correct(step);
}

/// What a tangent is multiplied by.
Value Unrolling::lanes_for(const Step& step, Value coordinates, int direction) {
  if (direction != Step::own) return to_.lane(coordinates, static_cast<std::uint32_t>(direction));
  std::vector<Value> lanes;
  for (const int d : step.direction) lanes.push_back(to_.lane(coordinates, static_cast<std::uint32_t>(std::max(0, d))));
  return gathered(std::move(lanes));
}

void Unrolling::set(const Step& step, int order, Value value, std::vector<Value>& values) {
  for (std::uint32_t i = 0; i < step.out.size(); ++i) values[place(step.out[i], order)] = to_.lane(value, i);
}

/// The next stage waits for this where nothing looks ahead: then the tangents are scaled, which are there before.
void Unrolling::correct(const Step& step) {
  const int order = stage_ + 2 - step.lag;
  const double k = stage_;
  Value result = gather(step.out, order);
  if (looks_ahead(stage_)) result = add_before(step, result);
  set(step, order, result, early_);
  const bool by_coordinates = looks_ahead(stage_) && step.lag == 0;
  const double factor = by_coordinates || step.lag == 2 ? 1 : step.lag == 1 ? 1 / (k + 1) : 1 / ((k + 1) * (k + 2));
  const Value change = by_coordinates ? coordinates_.back() : accelerations_.back();
  std::vector<Term> terms{{1, result}};
  for (const auto& [d, value] : step.tangents[Step::T]) terms.push_back({factor, value, lanes_for(step, change, d)});
  result = to_.sum(terms);
  set(step, order, result, final_);
  store(step.out, order, result);
}

/// Its part by q̈_{k−1}: (k+1)_ℓ A + (k+1)_{ℓ−1} B over (k+1) k, since q_{k+1} = q̈_{k−1} / ((k+1) k).
Value Unrolling::add_before(const Step& step, Value result) {
  const auto &a = step.tangents[Step::A], &b = step.tangents[Step::B];
  const auto stage = static_cast<std::size_t>(stage_);
  const double factor = step.lag == 1 ? 1.0 / stage_ : 1;
  const Value before = step.lag == 0 ? coordinates_[stage - 1] : accelerations_[stage - 1];
  std::vector<Term> terms{{1, result}};
  for (int d = Step::own; d < static_cast<int>(n_); ++d) {
    std::vector<Term> slope;
    if (a.contains(d)) slope.push_back({factor, a.at(d)});
    if (b.contains(d)) slope.push_back({factor / (stage_ + 2.0 - step.lag), b.at(d)});
    if (!slope.empty()) terms.push_back({1, to_.sum(slope), lanes_for(step, before, d)});
  }
  return to_.sum(terms);
}

}  // namespace maupertuis::unrolled
