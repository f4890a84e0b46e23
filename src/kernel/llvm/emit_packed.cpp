#include "kernel/llvm/emit_packed.hpp"

#include "kernel/packed/compiled.hpp"

#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Intrinsics.h>
#include <llvm/IR/Module.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>

/// A packed program as straight-line code: every stage unrolled, every sum over orders written out, the newest coefficients
/// kept in registers and added last, so that a stage waits for the one before as late as possible.
namespace maupertuis::compiler {
namespace {

using llvm::ArrayRef;
using llvm::Type;
using llvm::Value;
using packed::Block;
using packed::Column;
using packed::Pack;
using packed::PackedProgram;
using packed::lanes;

constexpr std::size_t most_unknowns = 8;
constexpr std::size_t most_looking_ahead = 2;
constexpr unsigned most_shuffled = 4;   // lanes
constexpr double least_pivot = 1e-10;
constexpr std::size_t most_operations = 40'000;

unsigned width_of(std::size_t count) { return static_cast<unsigned>(std::bit_ceil(count)); }

/// ∂(lanes of a pack)/∂q̈ at order 0. Diagonal: each lane depends on one direction at most.
struct Tangent {
  std::vector<int> direction;           // diagonal: of each lane, −1 for none
  Value* diagonal = nullptr;
  std::map<int, Value*> dense;          // by direction
};

/// How a pack of lag ℓ answers, one order behind the leading one, to a change ε τ^m of a coordinate: with falling factorials,
/// (m)_ℓ A + (m)_{ℓ−1} B. So the residual at order k holds q̈_{k−1} with the factor A + B/k.
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

class Emitter {
 public:
  Emitter(llvm::Module& module, const PackedProgram& program, std::size_t stride, int order)
      : module_(module), context_(module.getContext()), b_(context_), p_(program), stride_(stride), order_(order),
        n_(program.program.unknowns), pack_of_(program.program.slots, nullptr), tangents_(program.packs.size()),
        second_order_(program.packs.size()) {
    for (const Pack& pack : p_.packs)
      for (unsigned lane = 0; lane < pack.width; ++lane) {
        if (pack.kind == Pack::Scalar && p_.program.instructions[pack.instruction].second != no_slot)
          pack_of_[p_.program.instructions[pack.instruction].second] = &pack;
        pack_of_[pack.out + lane] = &pack;
      }
  }

  void run() {
    declare();
    look_ahead_ = has_second_tangents();
    for (int stage = p_.program.first_stage; stage < order_; ++stage) {
      begin_stage(stage);
      for (const Pack& pack : p_.packs) dynamics(pack);
      if (stage == 0) factor();
      if (stage >= 0) {
        solve();
        correct();
      }
      if (stage == 1 && look_ahead_) find_second_tangents();
      renew_blocks();
    }
    finish();
  }

 private:
  // ------------------------------------------------------------------------------------------------------- scaffold

  void declare() {
    Type* const pointer = b_.getPtrTy();
    auto* const type = llvm::FunctionType::get(b_.getInt32Ty(), {pointer}, false);
    function_ = llvm::Function::Create(type, llvm::Function::ExternalLinkage, "expand", module_);
    function_->addFnAttr(llvm::Attribute::NoUnwind);
    b_.SetInsertPoint(llvm::BasicBlock::Create(context_, "", function_));
    const auto field = [&](std::size_t offset) {
      return b_.CreateLoad(pointer, b_.CreateConstInBoundsGEP1_64(b_.getInt8Ty(), function_->getArg(0), offset));
    };
    rows_ = field(offsetof(packed::CompiledArguments, rows));
    coefficients_ = field(offsetof(packed::CompiledArguments, coefficients));
    term_coefficients_ = field(offsetof(packed::CompiledArguments, term_coefficients));
    constants_ = field(offsetof(packed::CompiledArguments, constants));
    bordered_ = field(offsetof(packed::CompiledArguments, bordered));
    sincos_ = field(offsetof(packed::CompiledArguments, sincos));
    elementary_ = field(offsetof(packed::CompiledArguments, elementary));
    wide_ = width_of(n_);
  }

  /// The sum of all q̈_k times 0 tells whether all were finite.
  void finish() {
    Value* const zero = vector_of(0.0, wide_);
    Value* bad = b_.CreateFCmpUNE(check_, zero);
    if (wide_ > 1) bad = b_.CreateOrReduce(bad);
    b_.CreateRet(b_.CreateZExt(bad, b_.getInt32Ty()));
  }

  Type* type(unsigned width) { return width == 1 ? b_.getDoubleTy() : llvm::FixedVectorType::get(b_.getDoubleTy(), width); }
  Value* vector_of(double x, unsigned width) {
    llvm::Constant* const scalar = llvm::ConstantFP::get(b_.getDoubleTy(), x);
    return width == 1 ? scalar : llvm::ConstantVector::getSplat(llvm::ElementCount::getFixed(width), scalar);
  }
  unsigned width(const Value* v) {
    const auto* const t = llvm::dyn_cast<llvm::FixedVectorType>(v->getType());
    return t ? t->getNumElements() : 1;
  }
  static bool is_zero(const Value* v) {
    const auto* const c = llvm::dyn_cast<llvm::Constant>(v);
    return c && c->isZeroValue();
  }
  Value* cell(int order, std::size_t slot) {
    return b_.CreateConstInBoundsGEP1_64(b_.getDoubleTy(), rows_, static_cast<std::uint64_t>(order) * stride_ + slot);
  }
  Value* load(Value* pointer, unsigned w) { return b_.CreateAlignedLoad(type(w), pointer, llvm::Align(8)); }
  void save(Value* pointer, Value* v) { b_.CreateAlignedStore(v, pointer, llvm::Align(8)); }
  Value* load_from(Value* table, std::size_t index, unsigned w) {
    return load(b_.CreateConstInBoundsGEP1_64(b_.getDoubleTy(), table, index), w);
  }
  /// Numbers of the model's text are numbers of the code.
  Value* coefficients(std::uint32_t first, unsigned w) {
    std::vector<llvm::Constant*> values;
    for (unsigned lane = 0; lane < w; ++lane) {
      const Constant& c = p_.program.constants[p_.coefficients[first + lane]];
      if (c.kind != Kind::Number) return load_from(coefficients_, first, w);
      values.push_back(llvm::ConstantFP::get(b_.getDoubleTy(), c.value));
    }
    return w == 1 ? values[0] : llvm::ConstantVector::get(values);
  }

  static bool is_one(const Value* v) {
    const auto* const c = llvm::dyn_cast<llvm::Constant>(v);
    return c && (c->getType()->isVectorTy() ? c->getSplatValue() && is_one(c->getSplatValue()) : llvm::cast<llvm::ConstantFP>(c)->isExactlyValue(1.0));
  }
  Value* mul(Value* x, Value* y) {
    return is_zero(x) || is_one(y) ? x : is_zero(y) || is_one(x) ? y : b_.CreateFMul(x, y);
  }
  /// Null stands for a sum without terms.
  Value* add(Value* x, Value* y) {
    if (!x || !y) return x ? x : y;
    return is_zero(x) ? y : is_zero(y) ? x : b_.CreateFAdd(x, y);
  }
  /// x y + sum; a null sum is zero.
  Value* fma(Value* x, Value* y, Value* sum) {
    if (is_zero(x) || is_zero(y)) return sum ? sum : is_zero(x) ? x : y;
    if (!sum || is_zero(sum)) return mul(x, y);
    if (is_one(x) || is_one(y)) return b_.CreateFAdd(is_one(x) ? y : x, sum);
    return b_.CreateIntrinsic(llvm::Intrinsic::fma, {x->getType()}, {x, y, sum});
  }
  Value* splat(double x, const Value* like) { return vector_of(x, width(like)); }
  /// x / d for a whole number d, without the rounding of 1/d, which would be the same in every step and add up.
  Value* over(Value* x, double d) { return over(x, d, vector_of(1.0, width(x))); }
  /// c x / d
  Value* over(Value* x, double d, Value* c) {
    if (is_zero(x)) return x;
    const double high = 1 / d, low = std::fma(-high, d, 1.0) / d;
    Value* const by_high = constant_product(c, high);
    return low == 0 ? mul(x, by_high) : fma(x, by_high, mul(x, constant_product(c, low)));
  }
  Value* constant_product(Value* c, double factor) { return mul(c, splat(factor, c)); }

  // --------------------------------------------------------------------------------------------------------- values

  void begin_stage(int stage) {
    stage_ = stage;
    open_.clear();
    early_.clear();
    if (stage < 0) {
      const int k = stage + 2;
      coordinates_ = k < 2 && k >= 0 ? load(cell(k, 0), wide_) : nullptr;
    } else {
      coordinates_ = vector_of(0.0, wide_);
    }
  }

  /// Where the coefficient of this stage stands; nothing: it was not computed in this stage's registers.
  std::optional<Place> place(Slot slot) const {
    if (slot < n_) return coordinates_ ? std::optional<Place>({coordinates_, slot}) : std::nullopt;
    const Pack* const pack = pack_of_[slot];
    if (!pack) return std::nullopt;
    const auto found = open_.find(slot_base(*pack, slot));
    if (found == open_.end()) return std::nullopt;
    return Place{found->second, slot - found->first};
  }

  /// The second results of a scalar pair have a vector of their own.
  Slot slot_base(const Pack& pack, Slot slot) const { return pack.kind == Pack::Scalar ? slot : pack.out; }

  Value* element(const Place& place) {
    return width(place.vector) == 1 ? place.vector : b_.CreateExtractElement(place.vector, place.lane);
  }

  int current_order(Slot slot) const { return stage_ + 2 - p_.program.lags[slot]; }

  /// Lanes from up to two vectors by one shuffle, else one by one.
  Value* assemble(const std::vector<std::optional<Place>>& places, unsigned w, const std::function<Value*(std::size_t)>& other) {
    std::vector<Value*> sources;
    bool shuffles = true;
    for (const auto& p : places) {
      if (!p || width(p->vector) == 1) { shuffles = false; break; }
      if (std::find(sources.begin(), sources.end(), p->vector) == sources.end()) sources.push_back(p->vector);
    }
    if (w == 1) return places[0] ? element(*places[0]) : other(0);
    if (shuffles && sources.size() <= 2 && width(sources[0]) == width(sources.back())) return shuffle(places, sources, w);
    Value* result = llvm::PoisonValue::get(type(w));
    for (unsigned lane = 0; lane < w; ++lane) {
      const std::size_t from = std::min<std::size_t>(lane, places.size() - 1);
      result = b_.CreateInsertElement(result, places[from] ? element(*places[from]) : other(from), lane);
    }
    return result;
  }

  Value* shuffle(const std::vector<std::optional<Place>>& places, const std::vector<Value*>& sources, unsigned w) {
    const unsigned size = width(sources[0]);
    const bool one_lane = std::all_of(places.begin(), places.end(), [&](const auto& p) { return p->lane == places[0]->lane; });
    if (sources.size() == 1 && one_lane) return splat_lane(sources[0], places[0]->lane, w);
    std::vector<int> mask;
    bool identity = w == size && sources.size() == 1;
    for (unsigned lane = 0; lane < w; ++lane) {
      const Place& p = *places[std::min<std::size_t>(lane, places.size() - 1)];
      mask.push_back(static_cast<int>(p.lane + (p.vector == sources[0] ? 0 : size)));
      identity = identity && (lane >= places.size() || mask.back() == static_cast<int>(lane));
    }
    if (identity) return sources[0];
    return b_.CreateShuffleVector(sources[0], sources.size() > 1 ? sources[1] : llvm::PoisonValue::get(sources[0]->getType()), mask);
  }

  /// Slots at given orders (one for each), from registers where they were computed in this stage, else from memory.
  Value* gather(ArrayRef<Slot> slots, int order, unsigned w) {
    bool range = true, all_zero = true, any_open = false;
    std::vector<std::optional<Place>> places;
    for (std::size_t lane = 0; lane < slots.size(); ++lane) {
      range = range && slots[lane] == slots[0] + lane;
      places.push_back(current_order(slots[lane]) == order ? place(slots[lane]) : std::nullopt);
      any_open = any_open || places.back();
      all_zero = all_zero && places.back() && is_zero(places.back()->vector);
    }
    if (all_zero) return vector_of(0.0, w);
    if (!any_open && range) return load(cell(order, slots[0]), w);
    const bool same = std::all_of(slots.begin(), slots.end(), [&](Slot s) { return s == slots[0]; });
    if (!any_open && same && w > 1) return b_.CreateVectorSplat(w, load(cell(order, slots[0]), 1));
    return assemble(places, w, [&](std::size_t lane) { return load(cell(order, slots[lane]), 1); });
  }

  /// A block's coefficients of some order, final or of this stage.
  Value* operand(std::uint32_t index, int order, unsigned w) {
    const Block& block = p_.blocks[index];
    const auto newest = newest_.find({index, order});
    if (newest != newest_.end() && width(newest->second.final) == w) return seen(newest->second);
    const ArrayRef<Slot> slots(block.slots.data(), block.width);
    if (current_order(block.slots[0]) == order) {
      Value* const values = gather(slots, order, w);
      return block.weighted ? mul(values, splat(order, values)) : values;
    }
    return load(cell(order, block.first), w);
  }

  bool looks_ahead(int stage) const { return stage >= 2 && look_ahead_; }
  Value* seen(const Newest& newest) const { return looks_ahead(stage_) && newest.stage == stage_ - 1 ? newest.early : newest.final; }

  /// Σ_{j=first..last} a_j b_{k−j}, from the middle outward in two chains; the ends, which may be of this stage or the last, come last.
  template <class A, class B>
  Value* convolution(A&& a, B&& b, int first, int last, int k) {
    Value* sums[2] = {};
    std::vector<int> order;
    for (int j = first; j <= last; ++j) order.push_back(j);
    std::stable_sort(order.begin(), order.end(), [&](int x, int y) { return std::abs(2 * x - first - last) < std::abs(2 * y - first - last); });
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

  // ------------------------------------------------------------------------------------------------------- dynamics

  void dynamics(const Pack& pack) {
    k_ = stage_ + 2 - pack.lag;
    if (k_ < 0) return;
    const unsigned w = width_of(pack.width);
    switch (pack.kind) {
      case Pack::Sum: keep(pack, sum(pack, w)); break;
      case Pack::Integral: integral(pack, w); break;
      case Pack::Quotient: keep(pack, quotient(pack, w)); break;
      case Pack::SquareRoot: keep(pack, square_root(pack, w)); break;
      case Pack::Scalar: scalar(pack); break;
      case Pack::Scan: case Pack::ScanDown: break;  // of large systems alone, which are declined
    }
  }

  void keep(const Pack& pack, Value* v) { keep(pack.out, v); }
  void keep(Slot slot, Value* v) {
    open_[slot] = v;
    // What is corrected is written when it is final; order 0 of lag 2 is read by the tangents from registers.
    if (stage_ < 0 || !is_corrected(slot)) save(cell(current_order(slot), slot), v);
  }
  bool is_corrected(Slot slot) const {
    return slot < p_.program.stored_end[2] && p_.program.tangent_lags[slot] != Program::unmoved;
  }

  Value* sum(const Pack& pack, unsigned w) {
    Value* result = nullptr;
    for (std::uint8_t shift = 0; shift < 3; ++shift) result = shifted_sum(pack, shift, w, result);
    return products(pack, w, result ? result : vector_of(0.0, w));
  }

  /// The factor of the shift goes to the coefficients where they are few, since nothing waits for those, else to their sum.
  Value* shifted_sum(const Pack& pack, std::uint8_t shift, unsigned w, Value* result) {
    const double factor = shift == 0 ? 1 : shift == 1 ? k_ + 1.0 : (k_ + 1.0) * (k_ + 2.0);
    std::vector<const Column*> columns;
    for (std::uint32_t c = pack.first_aligned; c < pack.last_aligned; ++c)
      if (p_.columns[c].shift == shift && (p_.columns[c].source != p_.program.one || k_ + shift == 0)) columns.push_back(&p_.columns[c]);
    const bool few = columns.size() <= 2;
    Value* sums[2] = {few ? result : nullptr, nullptr};
    std::size_t next = 0;
    for (const Column* const column : columns) {
      Value* const c = coefficients(column->coefficients, w);
      Value* const values = gather(sources_of(*column, pack.width), k_ + shift, w);
      Value*& sum = sums[few ? 0 : next++ % 2];
      sum = fma(values, few ? mul(c, splat(factor, c)) : c, sum);
    }
    if (few) return sums[0];
    Value* const whole = add(sums[0], sums[1]);
    return fma(whole, splat(factor, whole), result);
  }

  static std::vector<Slot> sources_of(const Column& column, std::uint32_t width) {
    if (column.kind == Column::Broadcast) return std::vector<Slot>(width, column.source);
    return {column.sources.begin(), column.sources.begin() + width};
  }

  Value* products(const Pack& pack, unsigned w, Value* result) {
    const std::uint32_t count = pack.last_product - pack.first_product;
    if (const unsigned whole = merged_width(pack); whole > 0) return merged_products(pack, w, whole, result);
    for (std::uint32_t i = 0; i < count; ++i) {
      const packed::ProductTerm& term = p_.products[pack.first_product + i];
      Value* const value = term.a == term.b ? self(term.a, 0, w) : product(term.a, term.b, w);
      result = fma(value, coefficients(term.coefficients, w), result);
    }
    return result;
  }

  Value* product(std::uint32_t a, std::uint32_t b, unsigned w) {
    return convolution([&](int j) { return operand(a, j, w); }, [&](int j) { return operand(b, j, w); }, 0, k_, k_);
  }

  /// Products of several terms whose operands lie side by side are one convolution of wider vectors.
  unsigned merged_width(const Pack& pack) const {
    const std::uint32_t count = pack.last_product - pack.first_product;
    const std::size_t whole = static_cast<std::size_t>(count) * pack.width;
    if (count < 2 || whole > lanes || !std::has_single_bit(whole)) return 0;
    const auto follows = [&](std::uint32_t block, std::uint32_t first, std::uint32_t t) {
      const Block &x = p_.blocks[block], &y = p_.blocks[first];
      return x.lag == y.lag && x.slots[0] == y.slots[0] + t * pack.width && is_range(x);
    };
    const packed::ProductTerm& first = p_.products[pack.first_product];
    for (std::uint32_t t = 0; t < count; ++t) {
      const packed::ProductTerm& term = p_.products[pack.first_product + t];
      if (term.a == term.b || !follows(term.a, first.a, t) || !follows(term.b, first.b, t)) return 0;
    }
    return static_cast<unsigned>(whole);
  }
  static bool is_range(const Block& block) {
    for (std::uint32_t lane = 0; lane < block.width; ++lane)
      if (block.slots[lane] != block.slots[0] + lane) return false;
    return !block.weighted;
  }

  Value* merged_products(const Pack& pack, unsigned w, unsigned whole, Value* result) {
    const packed::ProductTerm& first = p_.products[pack.first_product];
    const auto wide = [&](std::uint32_t block) {
      return [this, block, whole](int j) { return range(p_.blocks[block].slots[0], j, whole); };
    };
    Value* const all = convolution(wide(first.a), wide(first.b), 0, k_, k_);
    for (unsigned t = 0; t * pack.width < whole; ++t) {
      Value* part = nullptr;
      if (pack.width == 1) {
        part = b_.CreateExtractElement(all, t);
      } else {
        std::vector<int> mask;
        for (unsigned lane = 0; lane < w; ++lane) mask.push_back(static_cast<int>(t * pack.width + std::min(lane, pack.width - 1)));
        part = b_.CreateShuffleVector(all, mask);
      }
      result = fma(part, coefficients(p_.products[pack.first_product + t].coefficients, w), result);
    }
    return result;
  }

  /// Neighbouring slots of one lag at an order.
  Value* range(Slot first, int order, unsigned w) {
    const auto newest = newest_ranges_.find({first, order, w});
    if (newest != newest_ranges_.end()) return seen(newest->second);
    if (current_order(first) != order) return load(cell(order, first), w);
    std::vector<Slot> slots;
    for (unsigned lane = 0; lane < w; ++lane) slots.push_back(first + lane);
    ranges_.insert({first, w});
    return gather(slots, order, w);
  }

  /// Σ_{j=first..k−first} a_j a_{k−j}, each pair once.
  Value* self(std::uint32_t a, int first, unsigned w) {
    Value* sum = nullptr;
    for (int j = (k_ - 1) / 2; j >= first && 2 * j < k_; --j) sum = fma(operand(a, j, w), operand(a, k_ - j, w), sum);
    if (sum) sum = b_.CreateFAdd(sum, sum);
    if (k_ % 2 == 0 && k_ / 2 >= first) {
      Value* const middle = operand(a, k_ / 2, w);
      sum = fma(middle, middle, sum);
    }
    return sum ? sum : vector_of(0.0, w);
  }

  void integral(const Pack& pack, unsigned w) {
    if (k_ == 0) return functions(pack, w);
    Value* const sum = convolution([&](int j) { return operand(pack.a, j, w); }, [&](int j) { return operand(pack.b, j, w); }, 1, k_, k_);
    keep(pack, over(sum, k_, coefficients(pack.coefficients, w)));
  }

  Value* quotient(const Pack& pack, unsigned w) {
    Value* const a = operand(pack.a, k_, w);
    Value* const b0 = operand(pack.b, 0, w);
    if (k_ == 0) return b_.CreateFDiv(a, b0);
    Value* const sum = convolution([&](int j) { return operand(pack.b, j, w); }, [&](int j) { return operand(pack.y, j, w); }, 1, k_, k_);
    return b_.CreateFDiv(b_.CreateFSub(a, sum), b0);
  }

  Value* square_root(const Pack& pack, unsigned w) {
    Value* const u = operand(pack.a, k_, w);
    if (k_ == 0) return b_.CreateUnaryIntrinsic(llvm::Intrinsic::sqrt, u);
    Value* const y0 = operand(pack.y, 0, w);
    return b_.CreateFDiv(b_.CreateFSub(u, self(pack.y, 1, w)), b_.CreateFAdd(y0, y0));
  }

  // ------------------------------------------------------------------------------------------- elementary functions

  Value* call_elementary(Kind kind, Value* x, Value* y = nullptr) {
    auto* const signature = llvm::FunctionType::get(b_.getDoubleTy(), {b_.getInt8Ty(), b_.getDoubleTy(), b_.getDoubleTy()}, false);
    return b_.CreateCall(signature, elementary_, {b_.getInt8(static_cast<std::uint8_t>(kind)), x, y ? y : vector_of(0.0, 1)});
  }

  Value* one_slot(Slot slot, int order) { return gather({slot}, order, 1); }

  void functions(const Pack& pack, unsigned w) {
    std::vector<Value*> values(w, nullptr);
    bool second_pack = pack.first_function == pack.last_function;  // cosines of the sines before
    if (second_pack) {
      for (unsigned lane = 0; lane < pack.width; ++lane) values[lane] = seconds_.at(pack.out + lane);
    } else {
      if (pack.pairs != packed::no_block) return sines_cosines(pack, w);
      unsigned lane = 0;
      for (std::uint32_t f = pack.first_function; f < pack.last_function; ++f, ++lane) {
        const Instruction& i = p_.program.instructions[p_.functions[f]];
        Value* const u = one_slot(i.a, current_order(i.a));
        if (i.second == no_slot) { values[lane] = call_elementary(i.function, u); continue; }
        const auto [first, second] = pair(i.op, u);
        values[lane] = first;
        const unsigned count = pack.last_function - pack.first_function;
        if (pack.width == 2 * count) values[lane + count] = second;
        else seconds_[i.second] = second;
      }
    }
    Value* result = w == 1 ? values[0] : llvm::PoisonValue::get(type(w));
    for (unsigned lane = 0; w > 1 && lane < w; ++lane)
      result = b_.CreateInsertElement(result, values[lane] ? values[lane] : vector_of(0.0, 1), lane);
    keep(pack, result);
  }

  /// Through memory: the function takes and gives arrays.
  void sines_cosines(const Pack& pack, unsigned w) {
    const unsigned count = pack.last_function - pack.first_function, size = width_of(count);
    const Block& block = p_.blocks[pack.a];
    llvm::AllocaInst *const x = b_.CreateAlloca(type(lanes)), *const out = b_.CreateAlloca(type(lanes), b_.getInt32(2));
    x->setAlignment(llvm::Align(64)), out->setAlignment(llvm::Align(64));
    const ArrayRef<Slot> slots(block.slots.data(), count);
    save(x, gather(slots, current_order(slots[0]), size));
    auto* const signature = llvm::FunctionType::get(b_.getVoidTy(), {b_.getPtrTy(), b_.getPtrTy(), b_.getInt32Ty()}, false);
    b_.CreateCall(signature, sincos_, {x, out, b_.getInt32(count)});
    Value *const sines = load_from(out, 0, size), *const cosines = load_from(out, lanes, size);
    if (pack.width == 2 * count) return keep(pack, joined(sines, cosines, count, w));
    for (unsigned lane = 0; lane < count; ++lane) seconds_[pack.pairs + lane] = splat_lane(cosines, lane, 1);
    keep(pack, sines);
  }

  /// The first `count` lanes of two vectors.
  Value* joined(Value* first, Value* second, unsigned count, unsigned w) {
    if (width(first) == 1) {
      Value* const both = b_.CreateInsertElement(llvm::PoisonValue::get(type(2)), first, std::uint64_t{0});
      return b_.CreateInsertElement(both, second, std::uint64_t{1});
    }
    std::vector<int> mask;
    for (unsigned lane = 0; lane < w; ++lane)
      mask.push_back(static_cast<int>(lane < count ? lane : lane < 2 * count ? width(first) + lane - count : 0));
    return b_.CreateShuffleVector(first, second, mask);
  }

  std::pair<Value*, Value*> pair(Op op, Value* u) {
    if (op == Op::SinhCosh) return {call_elementary(Kind::Sinh, u), call_elementary(Kind::Cosh, u)};
    return {call_elementary(Kind::Sin, u), call_elementary(Kind::Cos, u)};
  }

  // -------------------------------------------------------------------------------------------- single instructions

  Value* history(Slot slot, int order) { return one_slot(slot, order); }
  Value* constant(ConstantId id) { return load_from(constants_, id, 1); }
  Value* term_coefficient(std::uint32_t t) { return load_from(term_coefficients_, t, 1); }

  void scalar(const Pack& pack) {
    const Instruction& i = p_.program.instructions[pack.instruction];
    switch (i.op) {
      case Op::Linear: case Op::Products: keep(i.out, scalar_sum(pack.instruction)); break;
      case Op::Square: keep(i.out, scalar_self(i.a, 0)); break;
      case Op::Quotient: keep(i.out, scalar_quotient(i)); break;
      case Op::SquareRoot: keep(i.out, scalar_root(i)); break;
      case Op::Power: keep(i.out, scalar_power(i)); break;
      case Op::SinCos: case Op::SinhCosh: scalar_pair(i); break;
      case Op::Function: keep(i.out, scalar_function(i)); break;
      case Op::Select: keep(i.out, scalar_select(i)); break;
      case Op::Derivative: keep(i.out, mul(history(i.a, k_ + 1), vector_of(k_ + 1.0, 1))); break;
      default: break;
    }
  }

  Value* scalar_product(Slot a, Slot b, int first, int last) {
    return convolution([&](int j) { return history(a, j); }, [&](int j) { return history(b, j); }, first, last, k_);
  }

  Value* scalar_sum(std::uint32_t index) {
    const Instruction& i = p_.program.instructions[index];
    Value* sum = nullptr;
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
      const Term& term = p_.program.terms[t];
      const int order = k_ + static_cast<int>(term.shift);
      if (term.b == no_slot && term.a == p_.program.one && order > 0) continue;
      const double factor = term.shift == 0 ? 1 : term.shift == 1 ? k_ + 1.0 : (k_ + 1.0) * (k_ + 2.0);
      Value* const value = term.b != no_slot ? scalar_product(term.a, term.b, 0, k_) : mul(history(term.a, order), vector_of(factor, 1));
      sum = fma(value, term_coefficient(t), sum);
    }
    return sum ? sum : vector_of(0.0, 1);
  }

  Value* scalar_self(Slot a, int first) {
    Value* sum = nullptr;
    for (int j = (k_ - 1) / 2; j >= first && 2 * j < k_; --j) sum = fma(history(a, j), history(a, k_ - j), sum);
    if (sum) sum = b_.CreateFAdd(sum, sum);
    if (k_ % 2 == 0 && k_ / 2 >= first) sum = fma(history(a, k_ / 2), history(a, k_ / 2), sum);
    return sum ? sum : vector_of(0.0, 1);
  }

  Value* scalar_quotient(const Instruction& i) {
    Value* const a = history(i.a, k_);
    Value* const sum = k_ == 0 ? vector_of(0.0, 1) : scalar_product(i.b, i.out, 1, k_);
    return b_.CreateFDiv(b_.CreateFSub(a, sum), history(i.b, 0));
  }

  Value* scalar_root(const Instruction& i) {
    if (k_ == 0) return b_.CreateUnaryIntrinsic(llvm::Intrinsic::sqrt, history(i.a, 0));
    Value* const y0 = history(i.out, 0);
    return b_.CreateFDiv(b_.CreateFSub(history(i.a, k_), scalar_self(i.out, 1)), b_.CreateFAdd(y0, y0));
  }

  Value* scalar_power(const Instruction& i) {
    Value* const p = constant(i.constant);
    if (k_ == 0) return call_elementary(Kind::Power, history(i.a, 0), p);
    Value* sum = nullptr;
    for (int j = 1; j <= k_; ++j) {
      Value* const weight = b_.CreateFSub(b_.CreateFMul(p, vector_of(j, 1)), vector_of(k_ - j, 1));
      sum = fma(b_.CreateFMul(history(i.a, j), weight), history(i.out, k_ - j), sum);
    }
    return b_.CreateFDiv(sum, b_.CreateFMul(vector_of(k_, 1), history(i.a, 0)));
  }

  Value* scalar_integral(Slot w, Slot u) {
    Value* sum = nullptr;
    for (int j = 1; j <= k_; ++j) sum = fma(mul(history(u, j), vector_of(j, 1)), history(w, k_ - j), sum);
    return over(sum, k_);
  }

  void scalar_pair(const Instruction& i) {
    if (k_ == 0) {
      const auto [first, second] = pair(i.op, history(i.a, 0));
      keep(i.out, first), keep(i.second, second);
      return;
    }
    Value *const first = scalar_integral(i.second, i.a), *const second = scalar_integral(i.out, i.a);
    keep(i.out, first);
    keep(i.second, i.op == Op::SinCos ? b_.CreateFNeg(second) : second);
  }

  Value* scalar_function(const Instruction& i) {
    if (k_ == 0) return call_elementary(i.function, history(i.a, 0), i.b == no_slot ? nullptr : history(i.b, 0));
    Value* sum = nullptr;
    for (std::uint32_t t = i.first_term; t < i.last_term; ++t)
      sum = fma(scalar_integral(p_.program.terms[t].a, p_.program.terms[t].b), term_coefficient(t), sum);
    return sum;
  }

  template <class F>
  Value* choose(const Instruction& i, F&& value) {
    Value* result = value(p_.program.terms[i.last_term - 1].a);
    for (std::uint32_t t = i.last_term - 1; t-- > i.first_term;) {
      Value* const holds = b_.CreateFCmpUNE(term_coefficient(t), vector_of(0.0, 1));
      result = b_.CreateSelect(holds, value(p_.program.terms[t].a), result);
    }
    return result;
  }
  Value* scalar_select(const Instruction& i) {
    return choose(i, [&](Slot slot) { return history(slot, k_); });
  }

  // ------------------------------------------------------------------------------------------------------- tangents

  std::size_t index_of(const Pack& pack) const { return static_cast<std::size_t>(&pack - p_.packs.data()); }

  /// The tangent of one slot in one direction: where it stands; nothing for zero.
  std::optional<Place> tangent_place(Slot slot, int d) {
    if (slot < n_) return static_cast<int>(slot) == d ? std::optional<Place>({vector_of(1.0, 2), 0}) : std::nullopt;
    const Pack* const pack = pack_of_[slot];
    if (!pack) return std::nullopt;
    const Tangent& t = pack->kind == Pack::Scalar && slot != pack->out ? second_tangents_[slot] : tangents_[index_of(*pack)];
    const unsigned lane = pack->kind == Pack::Scalar ? 0 : slot - pack->out;
    if (t.diagonal) return t.direction[lane] == d ? std::optional<Place>({t.diagonal, lane}) : std::nullopt;
    const auto found = t.dense.find(d);
    return found == t.dense.end() ? std::nullopt : std::optional<Place>({found->second, lane});
  }

  std::set<int> directions(Slot slot) {
    std::set<int> result;
    if (slot < n_) return {static_cast<int>(slot)};
    const Pack* const pack = pack_of_[slot];
    if (!pack) return result;
    const Tangent& t = pack->kind == Pack::Scalar && slot != pack->out ? second_tangents_[slot] : tangents_[index_of(*pack)];
    const unsigned lane = pack->kind == Pack::Scalar ? 0 : slot - pack->out;
    if (t.diagonal && t.direction[lane] >= 0) result.insert(t.direction[lane]);
    for (const auto& [d, value] : t.dense) result.insert(d);
    return result;
  }

  bool passes(Slot slot, int shift, int lag) const { return p_.program.tangent_lags[slot] + shift == lag; }

  /// Tangents of slots, lane by lane, in the direction given for each lane (−1: zero).
  Value* gather_tangents(ArrayRef<Slot> slots, ArrayRef<int> direction, unsigned w) {
    std::vector<std::optional<Place>> places;
    bool any = false;
    for (std::size_t lane = 0; lane < slots.size(); ++lane) {
      places.push_back(direction[lane] < 0 ? std::nullopt : tangent_place(slots[lane], direction[lane]));
      any = any || places.back();
    }
    if (!any) return vector_of(0.0, w);
    return assemble(places, w, [&](std::size_t) { return vector_of(0.0, 1); });
  }

  /// One source of a pack's tangent: factor of each lane times the tangent of a slot.
  struct Source {
    std::vector<Slot> slots;
    std::function<Value*(unsigned)> factor;
  };

  void tangent(const Pack& pack) {
    if (pack.kind == Pack::Scalar) return scalar_tangent(pack);
    tangents_[index_of(pack)] = combine(sources(pack), pack.width);
  }

  Tangent combine(const std::vector<Source>& sources, std::size_t count) {
    const unsigned w = width_of(count);
    std::vector<std::set<int>> of_lane(count);
    std::set<int> all;
    for (const Source& source : sources)
      for (std::size_t lane = 0; lane < count; ++lane)
        for (const int d : directions(source.slots[lane])) of_lane[lane].insert(d), all.insert(d);
    Tangent result;
    const auto accumulate = [&](ArrayRef<int> direction) {
      Value* sum = nullptr;
      for (const Source& source : sources) {
        Value* const values = gather_tangents(source.slots, direction, w);
        if (!is_zero(values)) sum = fma(values, source.factor(w), sum);
      }
      return sum ? sum : vector_of(0.0, w);
    };
    if (all.empty()) return result;
    if (std::all_of(of_lane.begin(), of_lane.end(), [](const auto& s) { return s.size() <= 1; })) {
      for (const auto& s : of_lane) result.direction.push_back(s.empty() ? -1 : *s.begin());
      result.diagonal = accumulate(result.direction);
      return result;
    }
    for (const int d : all) result.dense[d] = accumulate(std::vector<int>(count, d));
    return result;
  }

  static std::vector<Slot> slots_of(const Block& block) { return {block.slots.begin(), block.slots.begin() + block.width}; }
  Value* value_at_zero(std::uint32_t block, unsigned w) { return operand_unweighted(block, 0, w); }
  /// Order 0 stands in memory by now, or in registers.
  Value* operand_unweighted(std::uint32_t index, int order, unsigned w) {
    const Block& block = p_.blocks[index];
    return gather(ArrayRef<Slot>(block.slots.data(), block.width), order, w);
  }

  std::vector<Source> sources(const Pack& pack) {
    std::vector<Source> result;
    const auto block_source = [&](std::uint32_t block, std::function<Value*(unsigned)> factor) {
      if (p_.blocks[block].lag == pack.lag) result.push_back({slots_of(p_.blocks[block]), std::move(factor)});
    };
    switch (pack.kind) {
      case Pack::Sum:
        for (std::uint32_t c = pack.first_aligned; c < pack.last_aligned; ++c) {
          const Column& column = p_.columns[c];
          if (!passes(column.source, column.shift, pack.lag)) continue;
          result.push_back({sources_of(column, pack.width), [this, &column](unsigned w) { return coefficients(column.coefficients, w); }});
        }
        for (std::uint32_t i = pack.first_product; i < pack.last_product; ++i) {
          const packed::ProductTerm& term = p_.products[i];
          const auto times = [&](std::uint32_t other) {
            return [this, &term, other](unsigned w) { return mul(coefficients(term.coefficients, w), value_at_zero(other, w)); };
          };
          block_source(term.a, times(term.b));
          block_source(term.b, times(term.a));
        }
        break;
      case Pack::Integral:
        block_source(pack.a, [this, &pack](unsigned w) { return mul(coefficients(pack.coefficients, w), value_at_zero(pack.b, w)); });
        break;
      case Pack::Quotient:
        block_source(pack.a, [this, &pack](unsigned w) { return b_.CreateFDiv(vector_of(1.0, w), value_at_zero(pack.b, w)); });
        block_source(pack.b, [this, &pack](unsigned w) {
          return b_.CreateFNeg(b_.CreateFDiv(value_at_zero(pack.y, w), value_at_zero(pack.b, w)));
        });
        break;
      case Pack::SquareRoot:
        block_source(pack.a, [this, &pack](unsigned w) { return b_.CreateFDiv(vector_of(0.5, w), value_at_zero(pack.y, w)); });
        break;
      default: break;
    }
    return result;
  }

  void scalar_tangent(const Pack& pack) {
    const Instruction& i = p_.program.instructions[pack.instruction];
    std::vector<Source> sources;
    const auto source = [&](Slot slot, int shift, Value* factor) {
      if (slot != no_slot && passes(slot, shift, i.lag)) sources.push_back({{slot}, [factor](unsigned) { return factor; }});
    };
    const auto now = [&](Slot slot) { return history(slot, 0); };
    Value* const one = vector_of(1.0, 1);
    switch (i.op) {
      case Op::Linear: case Op::Products:
        for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
          const Term& term = p_.program.terms[t];
          if (term.b == no_slot) { source(term.a, static_cast<int>(term.shift), term_coefficient(t)); continue; }
          source(term.a, 0, mul(term_coefficient(t), now(term.b)));
          source(term.b, 0, mul(term_coefficient(t), now(term.a)));
        }
        break;
      case Op::Square: source(i.a, 0, mul(vector_of(2.0, 1), now(i.a))); break;
      case Op::Quotient:
        source(i.a, 0, b_.CreateFDiv(one, now(i.b)));
        source(i.b, 0, b_.CreateFNeg(b_.CreateFDiv(now(i.out), now(i.b))));
        break;
      case Op::SquareRoot: source(i.a, 0, b_.CreateFDiv(vector_of(0.5, 1), now(i.out))); break;
      case Op::Power: source(i.a, 0, b_.CreateFDiv(mul(constant(i.constant), now(i.out)), now(i.a))); break;
      case Op::SinCos: case Op::SinhCosh: {
        source(i.a, 0, i.op == Op::SinCos ? b_.CreateFNeg(now(i.out)) : now(i.out));
        second_tangents_[i.second] = combine(sources, 1);
        sources.clear();
        source(i.a, 0, now(i.second));
        break;
      }
      case Op::Function:
        for (std::uint32_t t = i.first_term; t < i.last_term; ++t)
          source(p_.program.terms[t].b, 0, mul(term_coefficient(t), now(p_.program.terms[t].a)));
        break;
      case Op::Derivative: source(i.a, 1, one); break;
      default: break;  // Select is declined
    }
    tangents_[index_of(pack)] = combine(sources, 1);
  }

  // ------------------------------------------------------------------------------------------------ solve and correct

  void factor() {
    for (const Pack& pack : p_.packs)
      if (p_.program.tangent_lags[pack.out] != Program::unmoved) tangent(pack);
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t d = 0; d < n_; ++d) {
        const Slot slot = p_.program.residual[i];
        const auto found = passes(slot, 0, 2) ? tangent_place(slot, static_cast<int>(d)) : std::nullopt;
        save(b_.CreateConstInBoundsGEP1_64(b_.getDoubleTy(), bordered_, i * n_ + d), found ? element(*found) : vector_of(0.0, 1));
      }
    invert();
  }

  /// −M₀⁻¹ by Gauss and Jordan without pivoting, a row a vector: stable for a symmetric, positive definite matrix. The smallest
  /// pivot against its diagonal entry tells whether it is one.
  void invert() {
    std::vector<Value*> rows;
    Value* least = nullptr;
    for (std::size_t i = 0; i < n_; ++i) {
      std::vector<Value*> entries;
      for (std::size_t d = 0; d < n_; ++d) entries.push_back(load_from(bordered_, i * n_ + d, 1));
      Value* row = wide_ == 1 ? entries[0] : llvm::PoisonValue::get(type(wide_));
      for (unsigned lane = 0; wide_ > 1 && lane < wide_; ++lane)
        row = b_.CreateInsertElement(row, lane < n_ ? entries[lane] : vector_of(0.0, 1), lane);
      rows.push_back(row);
    }
    for (unsigned pivot = 0; pivot < n_; ++pivot) {
      Value* const p = splat_lane(rows[pivot], pivot, 1);
      Value* const share = b_.CreateFDiv(p, load_from(bordered_, pivot * n_ + pivot, 1));
      least = least ? b_.CreateSelect(b_.CreateFCmpULT(share, least), share, least) : share;
      Value* const inverse = b_.CreateFDiv(vector_of(1.0, 1), p);
      Value* const row = mul(with_lane(rows[pivot], pivot, vector_of(1.0, 1)), spread(inverse));
      for (unsigned i = 0; i < n_; ++i) {
        if (i == pivot) continue;
        Value* const factor = splat_lane(rows[i], pivot, wide_);
        rows[i] = fma(b_.CreateFNeg(factor), row, with_lane(rows[i], pivot, vector_of(0.0, 1)));
      }
      rows[pivot] = row;
    }
    for (Value* const row : rows) inverse_rows_.push_back(b_.CreateFNeg(row));  // symmetric: rows are columns
    trust(b_.CreateFCmpOGT(least, vector_of(least_pivot, 1)));
  }

  Value* spread(Value* scalar) { return wide_ == 1 ? scalar : b_.CreateVectorSplat(wide_, scalar); }
  Value* with_lane(Value* v, unsigned lane, Value* scalar) { return width(v) == 1 ? scalar : b_.CreateInsertElement(v, scalar, lane); }

  /// A copy on the stack: a load that fills all lanes costs nothing where a shuffle takes the place of a multiplication.
  Value* in_memory(Value* v) {
    Value*& copy = copies_[v];
    if (copy) return copy;
    copy = llvm::IRBuilder<>(&function_->getEntryBlock(), function_->getEntryBlock().begin()).CreateAlloca(v->getType());
    save(copy, v);
    return copy;
  }

  /// Beyond this point only if the condition holds; else the slow path has to decide.
  void trust(Value* condition) {
    auto* const good = llvm::BasicBlock::Create(context_, "", function_);
    auto* const bad = llvm::BasicBlock::Create(context_, "", function_);
    b_.CreateCondBr(condition, good, bad);
    b_.SetInsertPoint(bad);
    b_.CreateRet(b_.getInt32(2));
    b_.SetInsertPoint(good);
  }

  Value* splat_lane(Value* v, unsigned lane, unsigned w) {
    if (width(v) == 1) return w == 1 ? v : b_.CreateVectorSplat(w, v);
    if (w == 1) return b_.CreateExtractElement(v, lane);
    if (w > most_shuffled && !llvm::isa<llvm::Constant>(v)) return b_.CreateVectorSplat(w, load_from(in_memory(v), lane, 1));
    return b_.CreateShuffleVector(v, std::vector<int>(w, static_cast<int>(lane)));
  }

  /// q̈_k = −M₀⁻¹ R_k; looking ahead, R_k lacks its part by q̈_{k−1}, which comes last.
  void solve() {
    Value *even = nullptr, *odd = nullptr;
    for (unsigned d = 0; d < n_; ++d) {
      const Slot slot = p_.program.residual[d];
      const auto r = current_order(slot) == stage_ ? place(slot) : std::nullopt;
      Value* const value = r ? splat_lane(r->vector, r->lane, wide_) : spread(load(cell(stage_, slot), 1));
      Value*& sum = d % 2 == 0 ? even : odd;
      sum = fma(value, inverse_rows_[d], sum);
    }
    Value* found = add(even, odd);
    if (looks_ahead(stage_))
      for (unsigned d = 0; d < n_; ++d)
        found = fma(splat_lane(acceleration_, d, wide_), fma(ahead_b_[d], vector_of(1.0 / stage_, wide_), ahead_a_[d]), found);
    previous_ = std::exchange(acceleration_, found);
    Value* const nothing = b_.CreateFMul(found, vector_of(0.0, wide_));  // NaN where it is not finite
    check_ = check_ ? b_.CreateFAdd(check_, nothing) : nothing;
  }

  void correct() {
    coordinates_ = over(acceleration_, (stage_ + 1.0) * (stage_ + 2.0));
    save(cell(stage_ + 2, 0), coordinates_);  // the other lanes of the row's first vector belong to nobody
    for (const Pack& pack : p_.packs) {
      if (!is_corrected(pack.out)) continue;
      const SecondTangent* const second_order = looks_ahead(stage_) ? &second_order_[index_of(pack)] : nullptr;
      correct(pack.out, tangents_[index_of(pack)], pack.lag, second_order);
      if (pack.kind != Pack::Scalar) continue;
      const Slot second = p_.program.instructions[pack.instruction].second;
      if (second != no_slot) correct(second, second_tangents_[second], pack.lag, nullptr);
    }
  }

  void correct(Slot slot, const Tangent& t, int lag, const SecondTangent* second_order) {
    const auto found = open_.find(slot);
    if (found == open_.end()) return;
    Value* result = found->second;
    const unsigned w = width(result);
    const double k = stage_;
    if (second_order) {
      // (k+1)_ℓ A + (k+1)_{ℓ−1} B over (k+1) k, since q_{k+1} = q̈_{k−1} / ((k+1) k)
      const double of_a = lag == 2 ? 1 : lag == 1 ? 1 / k : 1 / (k * (k + 1)), of_b = of_a / (k + 2 - lag);
      for (const auto& [d, values] : joined(*second_order)) {
        Value* slope = values.first ? mul(values.first, vector_of(of_a, w)) : nullptr;
        if (values.second) slope = fma(values.second, vector_of(of_b, w), slope);
        result = fma(direction_of(previous_, t, d, w), slope, result);
      }
    }
    found->second = early_[slot] = result;
    const double factor = lag == 2 ? 1 : lag == 1 ? 1.0 / (k + 1) : 1.0 / ((k + 1) * (k + 2));
    const auto scaled = [&](Value* v) { return mul(v, splat(factor, v)); };
    if (t.diagonal) result = fma(direction_of(acceleration_, t, along_lanes, w), scaled(t.diagonal), result);
    for (const auto& [d, value] : t.dense) result = fma(splat_lane(acceleration_, static_cast<unsigned>(d), w), scaled(value), result);
    found->second = result;
    save(cell(stage_ + 2 - lag, slot), result);
  }

  /// Accelerations as the lanes of a diagonal tangent need them, or one for all lanes.
  Value* direction_of(Value* acceleration, const Tangent& t, int d, unsigned w) {
    if (d != along_lanes) return splat_lane(acceleration, static_cast<unsigned>(d), w);
    std::vector<std::optional<Place>> places;
    for (const int x : t.direction) places.push_back(Place{acceleration, static_cast<unsigned>(std::max(0, x))});
    return assemble(places, w, [&](std::size_t) { return vector_of(0.0, 1); });
  }

  static std::map<int, std::pair<Value*, Value*>> joined(const SecondTangent& s) {
    std::map<int, std::pair<Value*, Value*>> result;
    for (const auto& [d, value] : s.a) result[d].first = value;
    for (const auto& [d, value] : s.b) result[d].second = value;
    return result;
  }

  // ----------------------------------------------------------------------------------------------------- look-ahead

  /// Whether the second tangents of all packs are found by the rules below, and no sum reads what the stage before has just found: that would
  /// hold the q̈ that is to come last.
  bool has_second_tangents() const {
    return n_ <= most_looking_ahead && std::all_of(p_.packs.begin(), p_.packs.end(), [&](const Pack& pack) {
      if (p_.program.tangent_lags[pack.out] == Program::unmoved) return true;
      for (std::uint32_t c = pack.first_aligned; pack.kind == Pack::Sum && c < pack.last_aligned; ++c)
        if (passes(p_.columns[c].source, p_.columns[c].shift, pack.lag - 1)) return false;
      return pack.kind == Pack::Sum || pack.kind == Pack::Integral;
    });
  }

  /// After stage 0, when all coefficients of order 1 that it takes are known.
  void find_second_tangents() {
    for (const Pack& pack : p_.packs)
      if (p_.program.tangent_lags[pack.out] != Program::unmoved) second_order_[index_of(pack)] = second_tangent(pack);
    for (unsigned d = 0; d < n_; ++d) {
      Value *a = vector_of(0.0, wide_), *b = a;
      for (unsigned i = 0; i < n_; ++i) {
        const Slot slot = p_.program.residual[i];
        if (const auto found = second_place(slot, static_cast<int>(d), true)) a = fma(spread(element(*found)), inverse_rows_[i], a);
        if (const auto found = second_place(slot, static_cast<int>(d), false)) b = fma(spread(element(*found)), inverse_rows_[i], b);
      }
      ahead_a_.push_back(a), ahead_b_.push_back(b);
    }
  }

  std::optional<Place> second_place(Slot slot, int d, bool of_a) {
    if (slot < n_ || !pack_of_[slot]) return std::nullopt;
    const Pack& pack = *pack_of_[slot];
    const auto& map = of_a ? second_order_[index_of(pack)].a : second_order_[index_of(pack)].b;
    const unsigned lane = slot - pack.out;
    if (const auto found = map.find(d); found != map.end()) return Place{found->second, lane};
    const auto found = map.find(along_lanes);
    if (found == map.end() || tangents_[index_of(pack)].direction[lane] != d) return std::nullopt;
    return Place{found->second, lane};
  }

  enum class Part { Leading, A, B };
  /// Lanes of slots in the directions given.
  Value* gather_part(Part part, ArrayRef<Slot> slots, ArrayRef<int> direction, unsigned w) {
    if (part == Part::Leading) return gather_tangents(slots, direction, w);
    std::vector<std::optional<Place>> places;
    bool any = false;
    for (std::size_t lane = 0; lane < slots.size(); ++lane) {
      places.push_back(direction[lane] < 0 ? std::nullopt : second_place(slots[lane], direction[lane], part == Part::A));
      any = any || places.back();
    }
    return any ? assemble(places, w, [&](std::size_t) { return vector_of(0.0, 1); }) : vector_of(0.0, w);
  }

  SecondTangent second_tangent(const Pack& pack) {
    const Tangent& t = tangents_[index_of(pack)];
    SecondTangent result;
    if (t.diagonal) add_second(pack, along_lanes, t.direction, result);
    else
      for (unsigned d = 0; d < n_; ++d) add_second(pack, static_cast<int>(d), std::vector<int>(pack.width, static_cast<int>(d)), result);
    return result;
  }

  void add_second(const Pack& pack, int name, ArrayRef<int> direction, SecondTangent& result) {
    const unsigned w = width_of(pack.width);
    Value *a = nullptr, *b = nullptr;
    const auto value = [&](Part part, ArrayRef<Slot> slots) { return gather_part(part, slots, direction, w); };
    for (std::uint32_t c = pack.first_aligned; pack.kind == Pack::Sum && c < pack.last_aligned; ++c) {
      const Column& column = p_.columns[c];
      const std::vector<Slot> slots = sources_of(column, pack.width);
      Value* const factor = coefficients(column.coefficients, w);
      if (passes(column.source, column.shift, pack.lag)) {
        Value* const of_a = value(Part::A, slots);
        a = fma(of_a, factor, a);
        b = fma(value(Part::B, slots), factor, b);
        if (column.shift > 0) b = fma(of_a, mul(factor, vector_of(column.shift, w)), b);
      } else if (passes(column.source, column.shift, pack.lag - 1)) {
        b = fma(value(Part::Leading, slots), factor, b);
      }
    }
    for (std::uint32_t i = pack.first_product; pack.kind == Pack::Sum && i < pack.last_product; ++i) {
      const packed::ProductTerm& term = p_.products[i];
      Value* const factor = coefficients(term.coefficients, w);
      for (const auto& [x, y] : {std::pair{term.a, term.b}, std::pair{term.b, term.a}}) {
        const std::vector<Slot> slots = slots_of(p_.blocks[x]);
        Value* const y0 = mul(factor, value_at(y, 0, w));
        if (p_.blocks[x].lag == pack.lag) {
          a = fma(value(Part::A, slots), y0, a);
          a = fma(value(Part::Leading, slots), mul(factor, value_at(y, 1, w)), a);
          b = fma(value(Part::B, slots), y0, b);
        } else if (p_.blocks[x].lag == pack.lag - 1) {
          b = fma(value(Part::Leading, slots), y0, b);
        }
      }
    }
    if (pack.kind == Pack::Integral) {
      // y' = c w u': the factors (m)_ℓ (m − ℓ)/(m − ℓ + 1) of T_u w₁ are (m)_ℓ − (m)_{ℓ−1}
      const std::vector<Slot> u = slots_of(p_.blocks[pack.a]), x = slots_of(p_.blocks[pack.b]);
      Value* const c = coefficients(pack.coefficients, w);
      Value* const w0 = mul(c, value_at(pack.b, 0, w));
      if (p_.blocks[pack.a].lag == pack.lag) {
        Value* const by_w1 = mul(value(Part::Leading, u), mul(c, value_at(pack.b, 1, w)));
        a = add(fma(value(Part::A, u), w0, a), by_w1);
        b = fma(value(Part::B, u), w0, b);
        b = fma(by_w1, vector_of(-1.0, w), b);
      } else if (p_.blocks[pack.a].lag == pack.lag - 1) {
        b = fma(value(Part::Leading, u), w0, b);
      }
      if (p_.blocks[pack.b].lag == pack.lag) b = fma(value(Part::Leading, x), mul(c, value_at(pack.a, 1, w)), b);
    }
    if (a && !is_zero(a)) result.a[name] = a;
    if (b && !is_zero(b)) result.b[name] = b;
  }

  /// Final coefficients of a block's slots, after their stage.
  Value* value_at(std::uint32_t index, int order, unsigned w) {
    const Block& block = p_.blocks[index];
    const ArrayRef<Slot> slots(block.slots.data(), block.width);
    if (current_order(slots[0]) == order) return gather(slots, order, w);
    bool range = true;
    for (std::size_t lane = 0; lane < slots.size(); ++lane) range = range && slots[lane] == slots[0] + lane;
    if (range) return load(cell(order, slots[0]), w);
    Value* result = w == 1 ? load(cell(order, slots[0]), 1) : llvm::PoisonValue::get(type(w));
    for (unsigned lane = 0; w > 1 && lane < w; ++lane)
      result = b_.CreateInsertElement(result, load(cell(order, slots[std::min<std::size_t>(lane, slots.size() - 1)]), 1), lane);
    return result;
  }

  // --------------------------------------------------------------------------------------------------------- blocks

  /// Copies of what is final now; the newest two stages stay in registers.
  void renew_blocks() {
    std::erase_if(newest_, [&](const auto& entry) { return entry.second.stage < stage_ - 1; });
    std::erase_if(newest_ranges_, [&](const auto& entry) { return entry.second.stage < stage_ - 1; });
    for (std::uint32_t index = 0; index < p_.blocks.size(); ++index) {
      const Block& block = p_.blocks[index];
      const int order = stage_ + 2 - block.lag;
      if (order < 0) continue;
      Newest entry = newest_of(ArrayRef<Slot>(block.slots.data(), block.width), order, width_of(block.width));
      if (block.weighted) weigh(block, entry, order);
      if (!block.direct) save(cell(order, block.first), entry.final);
      newest_[{index, order}] = entry;
    }
    for (const auto& [first, w] : ranges_) {
      const int order = stage_ + 2 - p_.program.lags[first];
      std::vector<Slot> slots;
      for (unsigned lane = 0; lane < w; ++lane) slots.push_back(first + lane);
      if (order >= 0) newest_ranges_[{first, order, w}] = newest_of(slots, order, w);
    }
  }

  Newest newest_of(ArrayRef<Slot> slots, int order, unsigned w) {
    Newest entry{.final = gather(slots, order, w), .stage = stage_};
    entry.early = entry.final;
    if (!looks_ahead(stage_ + 1)) return entry;
    std::vector<std::optional<Place>> places;
    for (const Slot slot : slots) {
      auto p = place(slot);
      if (slot < n_) p = Place{vector_of(0.0, width(coordinates_)), slot};
      else if (p)
        if (const auto early = early_.find(slot - p->lane); early != early_.end()) p->vector = early->second;
      places.push_back(p);
    }
    entry.early = assemble(places, w, [&](std::size_t lane) { return load(cell(order, slots[lane]), 1); });
    return entry;
  }

  /// k q_k of a coordinate is q̈/(k−1): one operation fewer to wait for.
  void weigh(const Block& block, Newest& entry, int order) {
    const unsigned w = width_of(block.width);
    const bool coordinates = std::all_of(block.slots.begin(), block.slots.begin() + block.width, [&](Slot s) { return s < n_; });
    const bool same = entry.early == entry.final;
    entry.early = mul(entry.early, vector_of(order, w));
    if (coordinates && stage_ >= 0) {
      std::vector<std::optional<Place>> places;
      for (std::uint32_t lane = 0; lane < block.width; ++lane) places.push_back(Place{acceleration_, block.slots[lane]});
      entry.final = over(assemble(places, w, [&](std::size_t) { return vector_of(0.0, 1); }), stage_ + 1.0);
    } else {
      entry.final = mul(entry.final, vector_of(order, w));
    }
    if (same) entry.early = entry.final;
  }

  llvm::Module& module_;
  llvm::LLVMContext& context_;
  llvm::IRBuilder<> b_;
  const PackedProgram& p_;
  std::size_t stride_;
  int order_;
  std::size_t n_;
  unsigned wide_ = 1;                   // lanes of q̈
  llvm::Function* function_ = nullptr;
  Value *rows_ = nullptr, *coefficients_ = nullptr, *term_coefficients_ = nullptr, *constants_ = nullptr, *bordered_ = nullptr,
        *sincos_ = nullptr, *elementary_ = nullptr;
  int stage_ = 0, k_ = 0;
  std::vector<const Pack*> pack_of_;    // [slots]
  Value* coordinates_ = nullptr;        // their coefficients of this stage
  Value *acceleration_ = nullptr, *previous_ = nullptr, *check_ = nullptr;
  bool look_ahead_ = false;
  std::map<Slot, Value*> open_;         // results of this stage by first slot
  std::map<Slot, Value*> early_;        // the same without q̈ of this stage
  std::map<std::pair<std::uint32_t, int>, Newest> newest_;  // (block, order): in registers
  std::map<std::tuple<Slot, int, unsigned>, Newest> newest_ranges_;
  std::set<std::pair<Slot, unsigned>> ranges_;
  std::map<Value*, Value*> copies_;
  std::map<Slot, Value*> seconds_;      // at order 0
  std::vector<Tangent> tangents_;       // [packs]
  std::map<Slot, Tangent> second_tangents_;
  static constexpr int along_lanes = -1;  // the direction of each lane of a diagonal tangent
  std::vector<SecondTangent> second_order_;  // [packs]
  std::vector<Value*> inverse_rows_, ahead_a_, ahead_b_;  // −M⁻¹, and q̈_k by q̈_{k−1}: A + B/k
};

/// Vector operations that the sums over orders take.
std::size_t operations(const PackedProgram& program, int order) {
  std::size_t convolutions = 0, others = 0;
  for (const Pack& pack : program.packs) {
    convolutions += pack.kind == Pack::Sum ? pack.last_product - pack.first_product : 1;
    others += 2 + pack.last_aligned - pack.first_aligned;
  }
  const auto p = static_cast<std::size_t>(order);
  return 3 * convolutions * p * p / 2 + others * p;
}

}  // namespace

bool can_emit_packed(const PackedProgram& program, int order) {
  const Program& p = program.program;
  const bool has_select = std::any_of(p.instructions.begin(), p.instructions.end(), [](const Instruction& i) { return i.op == Op::Select; });
  return p.unknowns == p.freedoms && p.unknowns <= most_unknowns && !has_select && operations(program, order) <= most_operations;
}

void emit_packed(llvm::Module& module, const PackedProgram& program, std::size_t stride, int order) {
  Emitter(module, program, stride, order).run();
}

}  // namespace maupertuis::compiler
