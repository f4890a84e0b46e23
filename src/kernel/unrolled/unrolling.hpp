#pragma once
#include "kernel/packed/layout.hpp"
#include "kernel/straight_line/builder.hpp"
#include "kernel/unrolled/unroll.hpp"

#include <bit>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace maupertuis::unrolled {

using straight::none;
using straight::Term;
using straight::Value;
using Slots = std::vector<Slot>;

inline std::uint32_t width_of(std::size_t lanes) { return static_cast<std::uint32_t>(std::bit_ceil(lanes)); }

/// coefficient · dʳ/dtʳ of slots, r = shift
struct Column {
  Slots slots;
  int shift;
  Value coefficient;
};
/// coefficient · a · b
struct Product {
  Slots a, b;
  Value coefficient;
};

/// What is found together, lane by lane: a pack, or an instruction that stands alone.
struct Step {
  enum Kind : std::uint8_t {
    Sum,       // columns + products
    Integral,  // Σ over products of coefficient · ∫ b da
    Quotient,  // a / b of its product
    Root,      // √a
    Power,     // a to the coefficient
  } kind = Sum;
  int lag = 0;
  Slots out = {};
  std::vector<Column> columns = {};
  std::vector<Product> products = {};
  std::vector<std::uint32_t> functions = {};  // Integral: the instructions that give order 0

  /// How it answers to a change ε τ^m of a coordinate: of lag ℓ, with falling factorials, by
  ///     (m)_ℓ T τ^{m−ℓ} + ((m)_ℓ A + (m)_{ℓ−1} B) τ^{m−ℓ+1}.
  /// By direction; `own`: of each lane in a direction of its own, −1 for none.
  enum Part : std::uint8_t { T, A, B };
  static constexpr int own = -1;
  std::vector<int> direction = {};  // [lanes]
  std::map<int, Value> tangents[3] = {};
};

/// Unknowns up to which a stage mostly waits; beyond, the number of operations counts.
inline constexpr std::uint32_t most_waiting = 4;

/// See docs/design/packed_kernels.md, "Unrolled code".
class Unrolling {
 public:
  Unrolling(const packed::PackedProgram& program, std::size_t stride, int order);
  straight::StraightLine run();

 private:
  // -------------------------------------------------------------------------------------------------- steps
  // (steps.cpp)
  void add_steps(const packed::Pack& pack);
  void add_sum(const packed::Pack& pack, Step step);
  void add_instruction(const Instruction& i);
  std::optional<Step> step_for(const Instruction& i);
  void add(Step step);
  void add_points();
  Slots slots_of(std::uint32_t block) const;
  Value coefficients(std::uint32_t first, std::size_t count);
  Value constant(ConstantId id);

  // ------------------------------------------------------------------------------------------------ values
  // (values.cpp)
  int current_order(Slot slot) const { return stage_ + 2 - p_.lags[slot]; }
  std::size_t cell(int order, Slot slot) const { return static_cast<std::size_t>(order) * stride_ + slot; }
  std::size_t place(Slot slot, int order) const { return static_cast<std::size_t>(order) * p_.slots + slot; }
  void give_coordinates(int order);
  Value at(Slot slot, int order);
  Value gather(const Slots& slots, int order);
  Value gathered(std::vector<Value> lanes);
  Value operand(const Slots& slots, int order);
  Value weighted(const Slots& slots, int order);
  Value over(Value x, double divisor, Value times = none);
  Value dot(const std::vector<Term>& terms);
  template <class F, class G>
  Value convolution(F&& a, G&& b, int first);
  Value product(const Slots& a, const Slots& b, int first);
  Value square(const Slots& a, int first);
  void keep(const Step& step, Value value);
  void store(const Slots& slots, int order, Value value);

  void find(const Step& step);
  void find_points();
  Value value_of(const Step& step);
  Value sum(const Step& step);
  Value columns(const Step& step, int shift, Value before);
  Value rate(const Column& column);
  Value products(const Step& step, Value before);
  Value merged_products(const Step& step, Value before);
  bool can_be_merged(const Step& step) const;
  Value integral(const Step& step);
  Value functions(const Step& step);
  Value quotient(const Step& step);
  Value root(const Step& step);
  Value power(const Step& step);
  Value weighted_pair(Value p, const Slots& a, int j);

  // -------------------------------------------------------------------------------------------- tangents
  // (tangents.cpp)
  /// T += f T', A += f A' + g T', B += f (B' + shift A') + h T' with those of some slots; `none` is 0.
  struct Source {
    Slots slots;
    Value f = none, g = none, h = none;
    int shift = 0;
  };
  bool is_moved(const Step& step) const { return p_.tangent_lags[step.out[0]] != Program::unmoved; }
  bool passes(Slot slot, int shift, int lag) const { return p_.tangent_lags[slot] + shift == lag; }
  Value tangent(Step::Part part, Slot slot, int direction);
  Value tangents(Step::Part part, const Slots& slots, const std::vector<int>& directions);
  bool leads(const Slots& slots, const Step& step) const { return p_.lags[slots[0]] == step.lag; }
  std::vector<Source> sources(const Step& step);
  void add_sources(const Step& step, const Product& p, const Slots& a, const Slots& b, std::vector<Source>& out);
  void add_integral(const Step& step, const Product& p, std::vector<Source>& out);
  Value first_order(Value coefficient, const Slots& slots);
  void find_tangents(Step& step);
  bool can_look_ahead() const;
  void look_ahead();
  bool keeps_directions(const Step& step, const std::vector<Source>& all);
  void find_second_tangents(Step& step);

  // -------------------------------------------------------------------------------------------- solution
  // (solution.cpp)
  bool looks_ahead(int stage) const { return looks_ahead_ && stage >= 2; }
  bool is_corrected(Slot slot) const { return slot < p_.stored_end[2] && p_.tangent_lags[slot] != Program::unmoved; }
  void factor();
  void eliminate(std::uint32_t pivot, std::uint32_t count, const std::vector<Value>& matrix);
  void refine(const std::vector<Value>& matrix);
  Value without(Value row, std::uint32_t pivot, std::uint32_t count, std::uint32_t one);
  void solve();
  void correct();
  void correct(const Step& step);
  Value add_before(const Step& step, Value result);
  void set(const Step& step, int order, Value value, std::vector<Value>& values);
  Value lanes_for(const Step& step, Value coordinates, int direction);

  const packed::PackedProgram& packed_;
  const Program& p_;
  std::size_t stride_;
  int order_, stage_ = 0, k_ = 0;
  std::uint32_t n_;
  straight::Builder to_;
  std::vector<Step> steps_;
  std::vector<int> step_of_;  // [slots] −1: none
  /// Of the observables, which stages up to 0 find when their q̈ is there.
  struct Point {
    Step step;
    int highest;  // order
  };
  std::vector<Point> points_;
  bool looks_ahead_ = false;
  std::vector<Value> final_, early_;                      // [orders × slots]; early: without q̈ of the stage
  std::map<std::pair<Value, int>, Value> weighted_;       // k u_k by u_k and k
  std::map<std::tuple<Value, Value, int>, Value> pairs_;  // of powers: (p + 1) k u_k and u_k by u_k, p and k
  std::map<Slot, Value> starts_;                          // values of functions
  std::map<std::pair<Slot, int>, Value> rates_;           // of integrals of this stage: first and second derivatives
  std::vector<Value> accelerations_, coordinates_;        // [stages]
  std::vector<Value> inverse_;                            // columns of −M₀⁻¹
  std::vector<Value> ahead_a_, ahead_b_;                  // q̈_k by q̈_{k−1}: A + B/k
  Value check_ = none;
};

}  // namespace maupertuis::unrolled
