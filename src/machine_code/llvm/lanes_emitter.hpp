#pragma once
#include "kernel/lanes/plan.hpp"
#include "machine_code/llvm/emission.hpp"

#include <functional>
#include <optional>
#include <vector>

/// The Taylor expansion of W motions as code: lanes::Expand for one program.
///
/// A processor could do the sums of products in a fraction of the time that the chain of operations from one stage to
/// the next takes; so what hangs on that chain is kept short. Of a convolution Σ a_j b_{m−j}
///
///   the *interior*, 2 ≤ j ≤ m − 2, holds coefficients that are final a stage earlier; it is added up there, before
///   that stage is
///     solved, while the processor would wait. Interiors of one lag share a loop and the loads of common operands, and
///     those of two stages are added up at once, which takes half of the loads;
///   the *newest* products, of orders 1 and m − 1, are added at the end of the stage before, as soon as it is solved;
///   those at the *ends*, of orders 0 and m, need the instructions of this stage.
///
/// What instructions hand to each other stays in registers; coefficients that later orders read are stored. Coordinates
/// count as 0 at their new order until the stage is solved, and whatever is linear in them vanishes and is not emitted.
/// The corrections are the sums of lanes::Plan.
namespace maupertuis::llvm_backend {

class LanesEmitter {
 public:
  LanesEmitter(Emission& out, const Program& program, int width);
  void run();

 private:
  using Value = llvm::Value;

  // ------------------------------------------------------------------------------------------- stages (emit_lanes.cpp)
  /// Stages below this are written out: there sums have fewer products than those of two stages at once take for
  /// granted.
  static constexpr int first_rolled = 4;
  void stage();
  void begin_values();
  void exit_unless_more(int stage);
  void rolled_stages();
  /// Orders are counted from the stage: m = stage + ahead.
  bool is_known() const { return known_stage_.has_value(); }
  int known(int ahead) const { return *known_stage_ + ahead; }
  bool has_order(int ahead) const { return !is_known() || known(ahead) >= 0; }
  bool is_order_zero(int ahead) const { return is_known() && known(ahead) == 0; }
  bool is_odd(int ahead) const { return ((is_known() ? known(ahead) : parity_ + ahead) & 1) != 0; }
  Value* row(int ahead);  // address of the row of that order
  /// Of the table of orders: m, 1/m and what rounding took from it, and of m (m + 1) the same.
  enum class OrderColumn : std::uint8_t { Order, Reciprocal, Lack, Pair, PairReciprocal, PairLack };
  static constexpr int bytes_of_order = 64;
  void table_orders();
  void refuse_more_orders();
  int most_ahead() const;
  Value* order(int ahead, OrderColumn column = OrderColumn::Order);  // in all lanes
  Value* index(int ahead);                                           // m, 64-bit integer
  Value* half(int ahead);                                            // ⌊m / 2⌋
  Value* over_order(Value* x, int ahead) {
    return over(x, ahead, OrderColumn::Order, OrderColumn::Reciprocal, OrderColumn::Lack);
  }
  /// x / (m (m + 1)) at once: the error of two roundings would be larger, and the same in every step.
  Value* over_orders(Value* x, int ahead) {
    return over(x, ahead, OrderColumn::Pair, OrderColumn::PairReciprocal, OrderColumn::PairLack);
  }
  Value* over(Value* x, int ahead, OrderColumn number, OrderColumn reciprocal, OrderColumn lack);
  Value* row_of(Value* order);

  // ------------------------------------------------------------------------------------------------------------ values
  struct Coefficient {
    Value* value = nullptr;  // null: it is `unit`, +1 or −1
    int unit = 0;
  };
  Coefficient coefficient(ConstantId id);
  Value* constant(ConstantId id);
  bool is_literal(ConstantId id, double value) const;
  Value* number(double x) { return out_.number(x, real_); }
  Value* slot_at(Value* row, Slot slot) { return out_.at(row, static_cast<std::int64_t>(slot) * bytes_); }
  Value* load(Value* row, Slot slot) { return out_.load(real_, slot_at(row, slot)); }
  Value* first(Slot slot);  // coefficient of order 0, nonzero or not
  int ahead_of(Slot slot) const { return 2 - program_.lags[slot]; }
  /// A coefficient that is final or of this stage; null: it is zero.
  Value* read(Slot slot, int ahead);
  void define(Slot slot, Value* value);
  /// sum + x y; null counts as zero.
  Value* plus(Value* sum, Value* x, Value* y, bool negative = false);
  Value* plus(Value* sum, Value* x) { return sum && x ? out_.add(sum, x) : sum ? sum : x; }
  Value* scaled(const Coefficient& c, Value* x);
  Value* plus_scaled(Value* sum, const Coefficient& c, Value* x);
  Value* or_zero(Value* x) { return x ? x : number(0); }
  Value* scratch(std::size_t index) { return out_.at(scratch_, static_cast<std::int64_t>(index) * bytes_); }

  // ----------------------------------------------------------------------------------- interiors (lanes_interiors.cpp)
  enum class Shape : std::uint8_t { Product, Square, Weighted, Power };
  /// Σ a_j b_{m−j}, Σ a_j a_{m−j} (half of it), Σ j a_j b_{m−j}, Σ (p j − (m − j)) a_j b_{m−j}.
  struct Piece {
    Shape shape;
    Slot a, b;
    bool negative = false;
    ConstantId exponent = 0;
  };
  struct Sum {
    Value *first = nullptr, *second = nullptr;  // chains of additions; null: zero
  };
  struct Accumulator {
    int ahead;  // its order counts from the stage
    std::vector<Piece> pieces;
    Value* sum = nullptr;  // the interior of this stage; null: zero
    Sum next, after;       // of the next, and of the one after that but for the pair of order 2
    bool begun = false;    // … was found with those of the stage that ends
  };
  /// Terms of an instruction that share a coefficient share an accumulator.
  struct Group {
    Coefficient coefficient;
    ConstantId id = 0;
    std::uint32_t accumulator = 0;
  };
  void plan_accumulators();
  std::uint32_t add_accumulator(int ahead, std::vector<Piece> pieces);
  void group_terms(const Instruction& i, std::uint32_t first, std::uint32_t last, Shape shape,
                   std::vector<Group>& groups);
  void prepare_next();
  bool prepares_two() const;
  void interiors_of(const std::vector<std::uint32_t>& group, bool two);
  void finish(const std::vector<std::uint32_t>& group);
  struct Row;  // an order
  Row row_at(Value* order);
  /// Adds the pairs of two rows to the sums of a group, of the next stage or of the one after it.
  using AddRows = std::function<void(Row& low, Row& high, bool after)>;
  void rolled_pairs(const std::vector<std::uint32_t>& group, bool two, const AddRows& add);
  void load_lows(const std::vector<std::uint32_t>& group, Row& row);
  Value* loaded(Row& row, Slot slot);
  Value* weighted(const Piece& piece, Row& row, const Row& other);
  void add_pair(const Accumulator& accumulator, Row& low, Row& high, Sum& sum);
  Value* middle_of(const Accumulator& accumulator, int ahead);
  Value* newest(const Piece& piece, int ahead, Value* sum);
  Value* latest(Slot slot, int ahead);

  // ----------------------------------------------------------------------------- instructions (lanes_instructions.cpp)
  void instruction(std::uint32_t index);
  Value* linear_part(const Instruction& i);
  Value* products(std::uint32_t index, Value* sum);
  Value* ends(const Piece& piece, int ahead, Value* sum, bool late);
  Value* sum_of(std::uint32_t accumulator, Slot integral = no_slot);
  Value* derivative_of(Slot slot, int ahead, std::uint32_t times);
  Value* self_sum(std::uint32_t index);
  Value* square(std::uint32_t index);
  Value* quotient(std::uint32_t index);
  Value* square_root(std::uint32_t index);
  Value* power(std::uint32_t index);
  void pair(std::uint32_t index);
  Value* function(std::uint32_t index);
  Value* derivative(const Instruction& i);
  Value* select(const Instruction& i);
  Value* divide_by_first(Value* x, std::uint32_t index, Value* divisor);
  void keep_reciprocal(std::uint32_t index, Value* divisor);

  // ------------------------------------------------------------------------------------- solution (lanes_solution.cpp)
  void find_stored();
  void factor();
  void factor_mass();
  void find_tangents();
  Value* factor_value(const sparse::Edge& f);
  Value* in_force(const sparse::Edge& f);
  Value* symmetry(const std::vector<Value*>& m);
  void decompose(std::vector<Value*> m, Value* symmetric);
  void solve();
  void correct();
  void invert(const std::vector<Value*>& m);
  Value* minus_inverse(std::size_t i, std::size_t j) { return out_.load(real_, scratch(matrix_at_ + i * n_ + j)); }
  void solve_by_factors();
  void correct_lag(std::size_t first, std::size_t last, const std::vector<Value*>& direction);

  Emission& out_;
  const Program& program_;
  lanes::Plan plan_;
  lanes::PlanView view_;
  int width_;
  std::int64_t bytes_;  // of one number of all lanes
  std::int64_t row_bytes_;
  std::size_t n_;
  llvm::Type* real_;
  llvm::Function *function_ = nullptr, *factor_ = nullptr;
  llvm::BasicBlock* done_ = nullptr;
  Value *rows_ = nullptr, *constants_ = nullptr, *quality_ = nullptr, *scratch_ = nullptr, *stages_ = nullptr;

  std::optional<int> known_stage_;  // else `stage_`, of known parity
  Value* stage_ = nullptr;          // 64-bit integer
  Value* stage_row_ = nullptr;
  Value *orders_ = nullptr, *stage_orders_ = nullptr;  // the table, and its line of the stage
  int parity_ = 0;

  enum class State : std::uint8_t { Unknown, Zero, Known };
  std::vector<State> state_;              // [slots] at the order of this stage
  std::vector<Value*> now_;               // [slots]
  std::vector<Value*> rates_;             // [slots] m y_m of integrals, which is there before y_m; null: not known
  std::vector<bool> stored_, corrected_;  // [slots]

  std::vector<Accumulator> accumulators_;
  std::vector<std::vector<Group>> groups_;              // [instructions]
  std::vector<Value*> acceleration_;                    // [n]
  std::vector<Value*> tangents_;                        // at stage 0
  std::size_t matrix_at_, pivots_at_, reciprocals_at_;  // in scratch
};

}  // namespace maupertuis::llvm_backend
