#pragma once
#include "kernel/lanes/plan.hpp"
#include "kernel/lanes/recurrences.hpp"
#include "kernel/series/sine_cosine.hpp"

/// The structured Taylor step of docs/design/kernel_program.md for W lanes: the stages of KernelWorkspace without
/// constraints. Each file that includes this is compiled for one instruction set (see vector.hpp for what that asks).
namespace maupertuis::lanes {
namespace {

template <int W>
class Machine {
 public:
  using V = Vec<W>;

  Machine(const PlanView& plan, double* rows, const double* constants, double* scratch)
      : p_(plan),
        n_(plan.unknowns),
        step_(static_cast<std::ptrdiff_t>(plan.stride) * W),
        rows_(rows),
        constants_(constants) {
    const auto take = [&scratch](std::size_t count) {
      double* const from = scratch;
      scratch += count * W;
      return from;
    };
    factors_ = take(p_.factor_count);
    tangents_ = take(p_.tangent_count);
    matrix_ = take(n_ * n_);
    inverse_pivots_ = take(n_);
    accelerations_ = take(n_);
    direction_ = take(n_);
  }

  V run(int stages) {
    V quality = V::all(1), check = V::all(0);
    for (int stage = p_.first_stage; stage < stages; ++stage) {
      if (stage >= 0) clear_unknowns(stage);
      for (std::size_t r = 0; r < p_.run_count; ++r) {
        const Run& run = p_.runs[r];
        const int order = stage + 2 - run.lag;
        if (order >= 0) run_at(run, order);
      }
      if (stage < 0) continue;
      if (stage == 0) quality = factor();
      check = check + solve(stage);
      correct(stage);
    }
    // Infinity and NaN times 0 are NaN, and a sum keeps it.
    return quality + check * 0.0;
  }

 private:
  double* at(Slot slot) const { return row_ + static_cast<std::size_t>(slot) * W; }
  double* at(int order, Slot slot) const { return rows_ + order * step_ + static_cast<std::size_t>(slot) * W; }
  V value(Slot slot) const { return V::load(at(slot)); }
  V initial(Slot slot) const { return V::load(rows_ + static_cast<std::size_t>(slot) * W); }
  V constant(ConstantId id) const { return V::load(constants_ + static_cast<std::size_t>(id) * W); }
  V tangent(std::uint32_t index) const { return V::load(tangents_ + static_cast<std::size_t>(index) * W); }
  double* entry(std::size_t i, std::size_t j) const { return matrix_ + (i * n_ + j) * W; }
  Series<W> series(Slot slot) const { return {rows_ + static_cast<std::size_t>(slot) * W, step_}; }

  void clear_unknowns(int stage) {
    for (std::size_t i = 0; i < n_; ++i) V::all(0).store(at(stage + 2, static_cast<Slot>(i)));
  }

  // ------------------------------------------------------------------------------------------------ instructions

  template <class F>
  void each(const Run& run, F&& f) {
    const Instruction* const last = p_.instructions + run.last;
    for (const Instruction* i = p_.instructions + run.first; i != last; ++i) f(*i);
  }

  void run_at(const Run& run, int order) {
    k_ = order;
    row_ = rows_ + order * step_;
    switch (run.op) {
      case Op::Linear:
        return each(run, [this](const Instruction& i) { linear_part(i).store(at(i.out)); });
      case Op::Products:
        return each(run, [this](const Instruction& i) { (linear_part(i) + products(i)).store(at(i.out)); });
      case Op::Square:
        return each(run, [this](const Instruction& i) { square(series(i.a), k_).store(at(i.out)); });
      case Op::Quotient:
        return each(run, [this](const Instruction& i) { quotient_of(i).store(at(i.out)); });
      case Op::SquareRoot:
        return each(run, [this](const Instruction& i) { square_root_of(i).store(at(i.out)); });
      case Op::Power:
        return each(run, [this](const Instruction& i) { power_of(i).store(at(i.out)); });
      case Op::SinCos:
        return each(run, [this](const Instruction& i) { sincos(i); });
      case Op::SinhCosh:
        return each(run, [this](const Instruction& i) { sinhcosh(i); });
      case Op::Function:
        return each(run, [this](const Instruction& i) { function(i).store(at(i.out)); });
      case Op::Derivative:
        return each(run, [this](const Instruction& i) { derivative(i).store(at(i.out)); });
      case Op::Select:
        return each(run, [this](const Instruction& i) { chosen(i).store(at(i.out)); });
      case Op::One:
      case Op::Time:
      case Op::Coordinate:
      case Op::Companion:
        return;
    }
  }

  V linear_part(const Instruction& i) const {
    const double factors[3] = {1.0, k_ + 1.0, (k_ + 1.0) * (k_ + 2.0)};
    V sum = V::all(0);
    for (std::uint32_t t = i.first_term; t < i.first_product; ++t) {
      const Term& term = p_.terms[t];
      const V a = V::load(at(term.a) + term.shift * step_);
      sum = fma(constant(term.coefficient), a * factors[term.shift], sum);
    }
    return sum;
  }

  V products(const Instruction& i) const {
    V sum = V::all(0);
    for (std::uint32_t t = i.first_product; t < i.last_term; ++t) {
      const Term& term = p_.terms[t];
      sum = fma(constant(term.coefficient), product(series(term.a), series(term.b), k_), sum);
    }
    return sum;
  }

  V quotient_of(const Instruction& i) const {
    return k_ == 0 ? value(i.a) / value(i.b) : quotient(value(i.a), series(i.b), series(i.out), k_);
  }

  V square_root_of(const Instruction& i) const {
    if (k_ > 0) return square_root(series(i.a), series(i.out), k_);
    return by_lane(i, [](const Instruction&, double x, double) { return __builtin_sqrt(x); });
  }

  V power_of(const Instruction& i) const {
    const V exponent = constant(i.constant);
    if (k_ > 0) return power(series(i.a), series(i.out), exponent, k_);
    return by_lane(value(i.a), exponent, [](double x, double y) { return power_function(x, y); });
  }

  void sincos(const Instruction& i) {
    if (k_ == 0) {
      const SineCosine<W> result(value(i.a));
      result.sine.store(at(i.out));
      result.cosine.store(at(i.second));
      return;
    }
    V sine, cosine;
    integral_pair(series(i.out), series(i.second), series(i.a), k_, sine, cosine);
    sine.store(at(i.out));
    (-cosine).store(at(i.second));
  }

  void sinhcosh(const Instruction& i) {
    V sinh, cosh;
    if (k_ == 0) {
      sinh = by_lane(i, [](const Instruction&, double x, double) { return elementary_function(Kind::Sinh, x, 0); });
      cosh = by_lane(i, [](const Instruction&, double x, double) { return elementary_function(Kind::Cosh, x, 0); });
    } else {
      integral_pair(series(i.out), series(i.second), series(i.a), k_, sinh, cosh);
    }
    sinh.store(at(i.out));
    cosh.store(at(i.second));
  }

  V function(const Instruction& i) const {
    if (k_ == 0)
      return by_lane(i, [](const Instruction& f, double x, double y) { return elementary_function(f.function, x, y); });
    V sum = V::all(0);
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      const Term& term = p_.terms[t];
      sum = fma(constant(term.coefficient), integral(series(term.a), series(term.b), k_), sum);
    }
    return sum;
  }

  V derivative(const Instruction& i) const { return V::load(at(i.a) + step_) * (k_ + 1.0); }

  V chosen(const Instruction& i) const {
    std::uint32_t t = i.last_term - 1;
    V result = value(p_.terms[t].a);
    while (t-- > i.first_term)
      result = select(constant(p_.terms[t].coefficient) == V::all(0), result, value(p_.terms[t].a));
    return result;
  }

  /// f(x, y) one lane after the other.
  template <class F>
  static V by_lane(const V& x, const V& y, F&& f) {
    alignas(64) double first[W], second[W];
    x.store(first), y.store(second);
    for (int lane = 0; lane < W; ++lane) first[lane] = f(first[lane], second[lane]);
    return V::load(first);
  }
  template <class F>
  V by_lane(const Instruction& i, F&& f) const {
    const V x = value(i.a), y = i.b == no_slot ? V::all(0) : value(i.b);
    return by_lane(x, y, [&](double a, double b) { return f(i, a, b); });
  }

  // --------------------------------------------------------------------------------------------------- tangents

  V factor_value(const sparse::Edge& f) const {
    using sparse::Rule;
    switch (f.rule) {
      case Rule::Coefficient:
        return constant(f.index);
      case Rule::Scaled:
        return constant(f.index) * initial(f.x);
      case Rule::Double:
        return initial(f.x) + initial(f.x);
      case Rule::Reciprocal:
        return V::all(1) / initial(f.x);
      case Rule::Ratio:
        return -initial(f.y) / initial(f.x);
      case Rule::HalfReciprocal:
        return V::all(0.5) / initial(f.x);
      case Rule::PowerSlope:
        return constant(f.index) * initial(f.y) / initial(f.x);
      case Rule::Value:
        return initial(f.x);
      case Rule::Negative:
        return -initial(f.x);
      case Rule::Choice:
        return in_force(f);
      case Rule::One:
        break;
    }
    return V::all(1);
  }

  V in_force(const sparse::Edge& f) const {
    V result = V::all(1);
    if (f.index + 1 < f.y) result = select(constant(p_.terms[f.index].coefficient) == V::all(0), V::all(0), result);
    for (std::uint32_t t = f.x; t < f.index; ++t)
      result = select(constant(p_.terms[t].coefficient) == V::all(0), result, V::all(0));
    return result;
  }

  void find_tangents() {
    for (std::size_t i = 0; i < p_.factor_count; ++i) factor_value(p_.factors[i]).store(factors_ + i * W);
    V::all(1).store(tangents_);
    for (std::size_t i = 0; i < p_.combination_count; ++i) {
      const Combination& c = p_.combinations[i];
      V sum = V::all(0);
      for (std::uint32_t k = c.first; k < c.last; ++k) {
        const V factor = V::load(factors_ + static_cast<std::size_t>(p_.pairs[k].factor) * W);
        const V operand = tangent(p_.pairs[k].tangent);
        sum = c.chooses ? select(factor == V::all(0), sum, operand) : fma(factor, operand, sum);
      }
      sum.store(tangents_ + static_cast<std::size_t>(c.out) * W);
    }
  }

  // ------------------------------------------------------------------------------------------------------- solve

  /// M₀ = L D Lᵀ: L in the lower triangle without its unit diagonal, 1/D beside it. Returns the quality.
  V factor() {
    find_tangents();
    for (std::size_t i = 0; i < n_ * n_; ++i) V::all(0).store(matrix_ + i * W);
    for (std::size_t i = 0; i < p_.mass_count; ++i)
      tangent(p_.mass[i].tangent).store(entry(p_.mass[i].row, p_.mass[i].column));
    const V symmetric = symmetry();
    V least = V::all(1), largest = V::all(0);
    for (std::size_t j = 0; j < n_; ++j) {
      const V ratio = eliminate(j);
      // A comparison with NaN is false: the smallest stays what it is not less than.
      least = select(least < ratio, least, ratio);
      largest = select(largest < ratio, ratio, largest);
    }
    return least / largest * symmetric;
  }

  /// 1 where M₀ is symmetric to rounding, as LinearSolver asks, else 0.
  V symmetry() const {
    constexpr double tolerance = 64 * 0x1p-52;
    V result = V::all(1);
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const V below = V::load(entry(i, j)), difference = below - V::load(entry(j, i));
        const V size = absolute(V::load(entry(i, i)) * V::load(entry(j, j))) + below * below;
        result = select(size * (tolerance * tolerance) < difference * difference, V::all(0), result);
      }
    return result;
  }

  /// Column j of L. Returns its pivot in units of the diagonal element.
  V eliminate(std::size_t j) {
    const V diagonal = V::load(entry(j, j));
    V pivot = diagonal;
    for (std::size_t k = 0; k < j; ++k) {
      const V l = V::load(entry(j, k));
      // The row of D Lᵀ above the diagonal: what is left there of M₀ is not needed any more.
      pivot = fma(-l, V::load(entry(k, j)), pivot);
    }
    const V inverse = V::all(1) / pivot;
    inverse.store(inverse_pivots_ + j * W);
    for (std::size_t i = j + 1; i < n_; ++i) {
      V sum = V::load(entry(i, j));
      for (std::size_t k = 0; k < j; ++k) sum = fma(-V::load(entry(i, k)), V::load(entry(k, j)), sum);
      sum.store(entry(j, i));
      (sum * inverse).store(entry(i, j));
    }
    return pivot / diagonal;
  }

  /// q̈_k = −M₀⁻¹ R_k. Returns a sum that is finite where they are.
  V solve(int stage) {
    double* const x = accelerations_;
    for (std::size_t i = 0; i < n_; ++i) {
      V sum = -V::load(at(stage, p_.residual[i]));
      for (std::size_t k = 0; k < i; ++k) sum = fma(-V::load(entry(i, k)), V::load(x + k * W), sum);
      sum.store(x + i * W);
    }
    V check = V::all(0);
    for (std::size_t i = n_; i-- > 0;) {
      V sum = V::load(x + i * W) * V::load(inverse_pivots_ + i * W);
      for (std::size_t k = i + 1; k < n_; ++k) sum = fma(-V::load(entry(k, i)), V::load(x + k * W), sum);
      sum.store(x + i * W);
      check = check + sum * 0.0;
    }
    return check;
  }

  /// Coefficient k + 2 − ℓ of a stored slot of lag ℓ follows q̈_k, divided by (k + 1)(k + 2), k + 1 or 1.
  void correct(int stage) {
    const Divisor by_both((stage + 1.0) * (stage + 2.0)), by_one(stage + 1.0);
    double* const position = at(stage + 2, 0);
    for (std::size_t i = 0; i < n_; ++i) {
      const V a = V::load(accelerations_ + i * W);
      (a / by_both).store(position + i * W);
      (a / by_one).store(direction_ + i * W);
    }
    correct_lag(0, 0, stage + 2, position);
    correct_lag(1, p_.corrections_end[0], stage + 1, direction_);
    correct_lag(2, p_.corrections_end[1], stage, accelerations_);
  }

  void correct_lag(int lag, std::size_t first, int order, const double* direction) {
    for (std::size_t i = first; i < p_.corrections_end[lag]; ++i) {
      const Correction& c = p_.corrections[i];
      double* const to = at(order, c.slot);
      V sum = V::load(to);
      for (std::uint32_t t = c.first; t < c.last; ++t) {
        const CorrectionTerm& term = p_.correction_terms[t];
        sum = fma(tangent(term.tangent), V::load(direction + static_cast<std::size_t>(term.direction) * W), sum);
      }
      sum.store(to);
    }
  }

  const PlanView& p_;
  std::size_t n_;
  std::ptrdiff_t step_;
  double* rows_;
  const double* constants_;
  double *factors_, *tangents_, *matrix_, *inverse_pivots_, *accelerations_, *direction_;
  int k_ = 0;
  double* row_ = nullptr;
};

template <int W>
void expand(const PlanView& plan, double* rows, const double* constants, double* quality, double* scratch, int stages) {
  Machine<W>(plan, rows, constants, scratch).run(stages).store(quality);
}

inline Expanders expanders_of_this_file() { return {{expand<1>, expand<2>, expand<4>, expand<8>, expand<16>}}; }

}  // namespace
}  // namespace maupertuis::lanes
