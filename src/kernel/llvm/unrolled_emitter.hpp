#pragma once
#include "kernel/llvm/emission.hpp"
#include "kernel/llvm/sines.hpp"
#include "kernel/packed/layout.hpp"

#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Module.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

/// A packed program as straight-line code: every stage unrolled, every sum over orders written out, the newest
/// coefficients kept in registers and added last, so that a stage waits for the one before as late as possible.
namespace maupertuis::llvm_backend {

inline unsigned width_of(std::size_t count) { return static_cast<unsigned>(std::bit_ceil(count)); }

class UnrolledEmitter {
 public:
  UnrolledEmitter(Emission& out, const packed::PackedProgram& program, std::size_t stride, int order);
  void run();

 private:
  using Value = llvm::Value;
  using Type = llvm::Type;
  template <class T>
  using ArrayRef = llvm::ArrayRef<T>;
  using Block = packed::Block;
  using Column = packed::Column;
  using Pack = packed::Pack;

  /// ∂(lanes of a pack)/∂q̈ at order 0. Diagonal: each lane depends on one direction at most.
  struct Tangent {
    std::vector<int> direction;           // diagonal: of each lane, −1 for none
    Value* diagonal = nullptr;
    std::map<int, Value*> dense;          // by direction
  };

  /// How a pack of lag ℓ answers, one order behind the leading one, to a change ε τ^m of a coordinate: with falling
  /// factorials, (m)_ℓ A + (m)_{ℓ−1} B. So the residual at order k holds q̈_{k−1} with the factor A + B/k.
  struct SecondTangent {
    std::map<int, Value*> a, b;           // by direction
  };

  /// Coefficients of a stage that is past: without its q̈, which the next stage need not wait for, and final.
  struct Newest {
    Value *early = nullptr, *final = nullptr;
    int stage = 0;
  };

  /// A place in a vector that holds a slot at the order of the stage.
  struct Place {
    Value* vector;
    unsigned lane;
  };

  void find_awaited();
  std::vector<Slot> read_at_once(const Pack& pack) const;
  void declare();
  void finish();

  // -------------------------------------------------------------------------------------- values (unrolled_values.cpp)
  Type* type(unsigned width) {
    return width == 1 ? b_.getDoubleTy() : llvm::FixedVectorType::get(b_.getDoubleTy(), width);
  }
  Value* vector_of(double x, unsigned width);
  unsigned width(const Value* v);
  static bool is_zero(const Value* v);
  Value* cell(int order, std::size_t slot);
  Value* load(Value* pointer, unsigned w) { return b_.CreateAlignedLoad(type(w), pointer, llvm::Align(8)); }
  void save(Value* pointer, Value* v) { b_.CreateAlignedStore(v, pointer, llvm::Align(8)); }
  Value* load_from(Value* table, std::size_t index, unsigned w);
  Value* coefficients(std::uint32_t first, unsigned w);
  static bool is_one(const Value* v);
  Value* mul(Value* x, Value* y);
  Value* add(Value* x, Value* y);
  Value* fma(Value* x, Value* y, Value* sum);
  Value* splat(double x, const Value* like) { return vector_of(x, width(like)); }
  /// x / d for a whole number d, without the rounding of 1/d, which would be the same in every step and add up.
  Value* over(Value* x, double d) { return over(x, d, vector_of(1.0, width(x))); }
  Value* over(Value* x, double d, Value* c);
  Value* constant_product(Value* c, double factor) { return mul(c, splat(factor, c)); }
  void begin_stage(int stage);
  Value* given_coordinates(int order);
  std::optional<Place> place(Slot slot) const;
  /// The second results of a scalar pair have a vector of their own.
  Slot slot_base(const Pack& pack, Slot slot) const { return pack.kind == Pack::Scalar ? slot : pack.out; }
  Value* element(const Place& place);
  int current_order(Slot slot) const { return stage_ + 2 - p_.program.lags[slot]; }
  Value* assemble(const std::vector<std::optional<Place>>& places, unsigned w,
                  const std::function<Value*(std::size_t)>& other);
  Value* shuffle(const std::vector<std::optional<Place>>& places, const std::vector<Value*>& sources, unsigned w);
  Value* gather(ArrayRef<Slot> slots, int order, unsigned w);
  Value* recent(Slot slot, int order);
  void keep_recent();
  Value* operand(std::uint32_t index, int order, unsigned w);
  bool looks_ahead(int stage) const { return stage >= 2 && look_ahead_; }
  Value* seen(const Newest& newest) const {
    return looks_ahead(stage_) && newest.stage == stage_ - 1 ? newest.early : newest.final;
  }
  void renew_blocks();
  Newest newest_of(ArrayRef<Slot> slots, int order, unsigned w);
  void weigh(const Block& block, Newest& entry, int order);
  bool is_of_coordinates(const Block& block) const;
  Value* weighted_coordinates(const Block& block);
  /// Σ_{j=first..last} a_j b_{k−j}, from the middle outward in two chains; the ends, which may be of this stage or the
  /// last, come last.
  template <class A, class B>
  Value* convolution(A&& a, B&& b, int first, int last, int k) {
    Value* sums[2] = {};
    std::vector<int> order;
    for (int j = first; j <= last; ++j) order.push_back(j);
    std::stable_sort(order.begin(), order.end(),
                     [&](int x, int y) { return std::abs(2 * x - first - last) < std::abs(2 * y - first - last); });
    int next = 0;
    const std::size_t ends = order.size() > 4 ? order.size() - 4 : 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
      // What is newest is added to one finished sum.
      if (i == ends && ends > 0) sums[0] = add(sums[0], sums[1]), sums[1] = nullptr, next = 0;
      Value*& sum = sums[next++ % 2];
      sum = fma(a(order[i]), b(k - order[i]), sum);
    }
    return add(sums[1], sums[0]);
  }

  // ---------------------------------------------------------------------------------- dynamics (unrolled_dynamics.cpp)
  void dynamics(const Pack& pack);
  void keep(const Pack& pack, Value* v) { keep(pack.out, v); }
  void keep(Slot slot, Value* v);
  bool is_corrected(Slot slot) const;
  Value* sum(const Pack& pack, unsigned w);
  Value* shifted_sum(const Pack& pack, std::uint8_t shift, unsigned w, Value* result);
  Value* rates(const std::vector<Slot>& slots, std::uint8_t shift, unsigned w);
  static std::vector<Slot> sources_of(const Column& column, std::uint32_t width);
  Value* products(const Pack& pack, unsigned w, Value* result);
  Value* product(std::uint32_t a, std::uint32_t b, unsigned w);
  unsigned merged_width(const Pack& pack) const;
  static bool is_range(const Block& block);
  Value* merged_products(const Pack& pack, unsigned w, unsigned whole, Value* result);
  Value* range(Slot first, int order, unsigned w);
  Value* self(std::uint32_t a, int first, unsigned w);
  void integral(const Pack& pack, unsigned w);
  Value* quotient(const Pack& pack, unsigned w);
  Value* square_root(const Pack& pack, unsigned w);
  Value* call_elementary(Kind kind, Value* x, Value* y = nullptr);
  Value* one_slot(Slot slot, int order) { return gather({slot}, order, 1); }
  void functions(const Pack& pack, unsigned w);
  void sines_cosines(const Pack& pack, unsigned w);
  SineAndCosine called_sines(Value* x, unsigned count, unsigned size);
  Value* joined(Value* first, Value* second, unsigned count, unsigned w);
  std::pair<Value*, Value*> pair(Op op, Value* u);

  // ------------------------------------------------------------------- single instructions (unrolled_instructions.cpp)
  Value* history(Slot slot, int order) { return one_slot(slot, order); }
  Value* constant(ConstantId id) { return load_from(constants_, id, 1); }
  Value* term_coefficient(std::uint32_t t) { return load_from(term_coefficients_, t, 1); }
  void scalar(const Pack& pack);
  Value* scalar_product(Slot a, Slot b, int first, int last);
  Value* scalar_sum(std::uint32_t index);
  Value* scalar_self(Slot a, int first);
  Value* scalar_quotient(const Instruction& i);
  Value* scalar_root(const Instruction& i);
  Value* scalar_power(const Instruction& i);
  Value* scalar_integral(Slot w, Slot u);
  void scalar_pair(const Instruction& i);
  Value* scalar_function(const Instruction& i);
  template <class F>
  Value* choose(const Instruction& i, F&& value) {
    Value* result = value(p_.program.terms[i.last_term - 1].a);
    for (std::uint32_t t = i.last_term - 1; t-- > i.first_term;) {
      Value* const holds = b_.CreateFCmpUNE(term_coefficient(t), vector_of(0.0, 1));
      result = b_.CreateSelect(holds, value(p_.program.terms[t].a), result);
    }
    return result;
  }
  Value* scalar_select(const Instruction& i);

  // ---------------------------------------------------------------------------------- tangents (unrolled_tangents.cpp)
  std::size_t index_of(const Pack& pack) const { return static_cast<std::size_t>(&pack - p_.packs.data()); }
  std::optional<Place> tangent_place(Slot slot, int d);
  std::set<int> directions(Slot slot);
  bool passes(Slot slot, int shift, int lag) const { return p_.program.tangent_lags[slot] + shift == lag; }
  Value* gather_tangents(ArrayRef<Slot> slots, ArrayRef<int> direction, unsigned w);
  /// One source of a pack's tangent: factor of each lane times the tangent of a slot.
  struct Source {
    std::vector<Slot> slots;
    std::function<Value*(unsigned)> factor;
  };
  void tangent(const Pack& pack);
  Tangent combine(const std::vector<Source>& sources, std::size_t count);
  static std::vector<Slot> slots_of(const Block& block) {
    return {block.slots.begin(), block.slots.begin() + block.width};
  }
  Value* value_at_zero(std::uint32_t block, unsigned w) { return operand_unweighted(block, 0, w); }
  Value* operand_unweighted(std::uint32_t index, int order, unsigned w);
  std::vector<Source> sources(const Pack& pack);
  void scalar_tangent(const Pack& pack);

  // ---------------------------------------------------------------------------------- solution (unrolled_solution.cpp)
  void factor();
  void invert(std::vector<Value*> rows);
  std::vector<Value*> refined(ArrayRef<Value*> inverse, ArrayRef<Value*> matrix);
  void eliminate_one(std::vector<Value*>& rows, unsigned pivot, ArrayRef<Value*> diagonal, std::vector<Value*>& sound);
  void eliminate_pair(std::vector<Value*>& rows, unsigned pivot, ArrayRef<Value*> diagonal, std::vector<Value*>& sound);
  Value* spread(Value* scalar) { return wide_ == 1 ? scalar : b_.CreateVectorSplat(wide_, scalar); }
  Value* with_lane(Value* v, unsigned lane, Value* scalar) {
    return width(v) == 1 ? scalar : b_.CreateInsertElement(v, scalar, lane);
  }
  void trust(Value* condition);
  Value* splat_lane(Value* v, unsigned lane, unsigned w);
  void solve();
  Value* dot(ArrayRef<Value*> x, ArrayRef<Value*> y);
  void correct();
  void correct(Slot slot, const Tangent& t, int lag, const SecondTangent* second_order);
  Value* direction_of(Value* acceleration, const Tangent& t, int d, unsigned w);
  static std::map<int, std::pair<Value*, Value*>> joined(const SecondTangent& s);

  // ------------------------------------------------------------------------------ look-ahead (unrolled_look_ahead.cpp)
  bool has_second_tangents() const;
  void find_second_tangents();
  std::optional<Place> second_place(Slot slot, int d, bool of_a);
  enum class Part { Leading, A, B };
  Value* gather_part(Part part, ArrayRef<Slot> slots, ArrayRef<int> direction, unsigned w);
  SecondTangent second_tangent(const Pack& pack);
  void add_second(const Pack& pack, int name, ArrayRef<int> direction, SecondTangent& result);
  /// A and B while they are added up; null: zero.
  struct Slopes {
    Value *a = nullptr, *b = nullptr;
  };
  void add_column(const Pack& pack, const Column& column, ArrayRef<int> direction, Slopes& s);
  void add_product(const Pack& pack, const packed::ProductTerm& term, ArrayRef<int> direction, Slopes& s);
  void add_integral(const Pack& pack, ArrayRef<int> direction, Slopes& s);
  Value* value_at(std::uint32_t index, int order, unsigned w);

  llvm::Module& module_;
  llvm::LLVMContext& context_;
  llvm::IRBuilder<> b_;
  const packed::PackedProgram& p_;
  bool fuses_;                          // the processor multiplies and adds in one instruction
  std::size_t stride_;
  int order_;
  std::size_t n_;
  unsigned wide_ = 1;                   // lanes of q̈
  llvm::Function* function_ = nullptr;
  Value *rows_ = nullptr, *given_q_ = nullptr, *given_v_ = nullptr, *coefficients_ = nullptr,
        *term_coefficients_ = nullptr, *constants_ = nullptr, *sincos_ = nullptr, *elementary_ = nullptr;
  int stage_ = 0, k_ = 0;
  std::vector<const Pack*> pack_of_;    // [slots]
  Value* coordinates_ = nullptr;        // their coefficients of this stage
  Value *acceleration_ = nullptr, *previous_ = nullptr, *final_coordinates_ = nullptr, *previous_coordinates_ = nullptr,
        *check_ = nullptr;
  bool look_ahead_ = false;
  std::vector<bool> awaited_;           // [packs] by the residual
  bool follows_ = false;                // all packs that follow q̈ are found after it
  std::map<Slot, Value*> open_;         // results of this stage by first slot
  std::map<std::pair<Slot, int>, Value*> recent_;  // final results by first slot and order
  std::map<std::pair<Slot, std::uint8_t>, Value*> rates_;  // first and second derivatives of its integrals
  std::map<Slot, Value*> early_;        // the same without q̈ of this stage
  std::map<std::pair<std::uint32_t, int>, Newest> newest_;  // (block, order): in registers
  std::map<std::tuple<Slot, int, unsigned>, Newest> newest_ranges_;
  std::set<std::pair<Slot, unsigned>> ranges_;
  std::map<Slot, Value*> seconds_;      // at order 0
  std::vector<Tangent> tangents_;       // [packs]
  std::map<Slot, Tangent> second_tangents_;
  static constexpr int along_lanes = -1;  // the direction of each lane of a diagonal tangent
  std::vector<SecondTangent> second_order_;  // [packs]
  std::vector<Value*> inverse_columns_, ahead_a_, ahead_b_;  // −M⁻¹, and q̈_k by q̈_{k−1}: A + B/k
};

}  // namespace maupertuis::llvm_backend
