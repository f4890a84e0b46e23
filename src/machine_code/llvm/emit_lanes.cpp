#include "kernel/lanes/lanes.hpp"
#include "machine_code/llvm/emitters.hpp"
#include "machine_code/llvm/lanes_emitter.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace maupertuis::llvm_backend {

using llvm::Value;

namespace {

constexpr std::size_t most_unknowns = 40;
constexpr std::size_t most_terms = 6000;
/// Whose reciprocals are tabled.
constexpr int most_orders = 128;

}  // namespace

void emit_lanes(Emission& out, const machine_code::Request& request) {
  const auto& program = *static_cast<const Program*>(request.source);
  if (program.unknowns != program.freedoms)
    throw Declined("constraints are not compiled for several motions side by side");
  if (program.unknowns > most_unknowns || program.terms.size() > most_terms)
    throw Declined("the program is too large to be compiled");
  LanesEmitter(out, program, request.width).run();
}

LanesEmitter::LanesEmitter(Emission& out, const Program& program, int width)
    : out_(out),
      program_(program),
      plan_(program),
      view_(plan_.view()),
      width_(width),
      bytes_(8 * width),
      row_bytes_(static_cast<std::int64_t>(view_.stride) * bytes_),
      n_(program.unknowns),
      real_(out.real(width)),
      matrix_at_(view_.tangent_count),
      pivots_at_(matrix_at_ + n_ * n_),
      reciprocals_at_(pivots_at_ + n_) {
  find_stored();
  plan_accumulators();
}

void LanesEmitter::run() {
  function_ =
      out_.function("expand", {out_.pointer(), out_.pointer(), out_.pointer(), out_.pointer(), out_.b.getInt32Ty()});
  rows_ = function_->getArg(0), constants_ = function_->getArg(1), quality_ = function_->getArg(2),
  scratch_ = function_->getArg(3);
  stages_ = out_.b.CreateSExt(function_->getArg(4), out_.integer());
  done_ = llvm::BasicBlock::Create(out_.context, "", function_);
  refuse_more_orders();
  for (int s = program_.first_stage; s < first_rolled; ++s) {
    if (s > 0) exit_unless_more(s);
    known_stage_ = s;
    stage();
  }
  rolled_stages();
  out_.b.SetInsertPoint(done_);
  out_.end_function();
}

/// Orders beyond the stage's own: those of functions of t alone, and one more of the derivatives of what follows q.
int LanesEmitter::most_ahead() const { return std::max(4, 1 - program_.first_stage); }

/// The quality tells that the reference has to do it.
void LanesEmitter::refuse_more_orders() {
  auto& b = out_.b;
  table_orders();
  llvm::BasicBlock* const refused = llvm::BasicBlock::Create(out_.context, "", function_, done_);
  llvm::BasicBlock* const tabled = llvm::BasicBlock::Create(out_.context, "", function_, refused);
  b.CreateCondBr(b.CreateICmpSGT(stages_, b.getInt64(static_cast<std::uint64_t>(most_orders - most_ahead()))), refused,
                 tabled);
  b.SetInsertPoint(refused);
  out_.store(number(std::numeric_limits<double>::quiet_NaN()), quality_);
  b.CreateBr(done_);
  b.SetInsertPoint(tabled);
}

void LanesEmitter::exit_unless_more(int s) {
  llvm::BasicBlock* const next = llvm::BasicBlock::Create(out_.context, "", function_, done_);
  out_.b.CreateCondBr(out_.b.CreateICmpSGT(stages_, out_.b.getInt64(static_cast<std::uint64_t>(s))), next, done_);
  out_.b.SetInsertPoint(next);
}

/// Two stages a turn, so that of every order it is known whether it is odd.
void LanesEmitter::rolled_stages() {
  auto& b = out_.b;
  known_stage_.reset();
  exit_unless_more(first_rolled);
  llvm::BasicBlock* const before = b.GetInsertBlock();
  llvm::BasicBlock* const turn = llvm::BasicBlock::Create(out_.context, "", function_, done_);
  b.CreateBr(turn);
  b.SetInsertPoint(turn);
  llvm::PHINode* const s = b.CreatePHI(out_.integer(), 2);
  s->addIncoming(b.getInt64(static_cast<std::uint64_t>(first_rolled)), before);
  std::vector<llvm::PHINode*> sums;
  for (Accumulator& accumulator : accumulators_) {
    sums.push_back(b.CreatePHI(real_, 2));
    sums.back()->addIncoming(or_zero(accumulator.sum), before);
    accumulator.sum = sums.back();
  }
  for (int half = 0; half < 2; ++half) {
    stage_ = half == 0 ? s : b.CreateNUWAdd(s, b.getInt64(1));
    parity_ = (first_rolled + half) & 1;
    stage_row_ = row_of(stage_);
    stage_orders_ = out_.at(orders_, b.CreateMul(stage_, b.getInt64(bytes_of_order)));
    stage();
    Value* const next = b.CreateNUWAdd(stage_, b.getInt64(1));
    Value* const more = b.CreateICmpSLT(next, stages_);
    if (half == 1) {
      s->addIncoming(next, b.GetInsertBlock());
      for (std::size_t k = 0; k < sums.size(); ++k) sums[k]->addIncoming(accumulators_[k].sum, b.GetInsertBlock());
      b.CreateCondBr(more, turn, done_);
      return;
    }
    llvm::BasicBlock* const second = llvm::BasicBlock::Create(out_.context, "", function_, done_);
    b.CreateCondBr(more, second, done_);
    b.SetInsertPoint(second);
  }
}

void LanesEmitter::stage() {
  begin_values();
  for (const Run& run : program_.runs[Dynamics])
    for (std::uint32_t i = run.first; i < run.last; ++i)
      if (has_order(ahead_of(program_.instructions[i].out))) instruction(i);
  prepare_next();
  if (!is_known() || known(0) >= 0) {
    if (is_known() && known(0) == 0) {
      factor();
      out_.b.CreateCall(factor_, {rows_, constants_, quality_, scratch_});
    }
    solve();
    correct();
  }
  for (Accumulator& accumulator : accumulators_) {
    accumulator.sum = plus(accumulator.next.first, accumulator.next.second);
    for (const Piece& piece : accumulator.pieces) accumulator.sum = newest(piece, accumulator.ahead, accumulator.sum);
  }
}

/// Coordinates: given up to q̇; from then on 0 until the stage is solved.
void LanesEmitter::begin_values() {
  state_.assign(program_.slots, State::Unknown);
  now_.assign(program_.slots, nullptr);
  rates_.assign(program_.slots, nullptr);
  for (Slot slot = 0; slot < n_; ++slot) {
    const bool given = is_known() && known(2) < 2;
    if (given && known(2) < 0) continue;
    state_[slot] = given ? State::Known : State::Zero;
    if (given) now_[slot] = load(row(2), slot);
  }
}

// -------------------------------------------------------------------------------------------------------------- orders

Value* LanesEmitter::row_of(Value* order) {
  return out_.at(rows_, out_.b.CreateMul(order, out_.b.getInt64(static_cast<std::uint64_t>(row_bytes_))));
}

Value* LanesEmitter::row(int ahead) {
  return is_known() ? out_.at(rows_, known(ahead) * row_bytes_) : out_.at(stage_row_, ahead * row_bytes_);
}

/// m, 1/m and what rounding took from it, and of m (m + 1) the same: a line of the cache each order.
void LanesEmitter::table_orders() {
  std::vector<double> table;
  for (int m = 0; m < most_orders; ++m) {
    const double x = m, y = x * (x + 1), over_x = 1 / x, over_y = 1 / y;
    const std::array<double, 8> line{
        x, over_x, std::fma(-over_x, x, 1.0) * over_x, y, over_y, std::fma(-over_y, y, 1.0) * over_y, 0, 0};
    table.insert(table.end(), line.begin(), line.end());
  }
  llvm::Constant* const values = llvm::ConstantDataArray::get(out_.context, table);
  auto* const global = new llvm::GlobalVariable(*out_.module, values->getType(), true,
                                                llvm::GlobalValue::InternalLinkage, values, "orders");
  global->setAlignment(llvm::Align(bytes_of_order));
  orders_ = global;
}

Value* LanesEmitter::order(int ahead, OrderColumn column) {
  llvm::Type* const scalar = out_.b.getDoubleTy();
  const int at = 8 * static_cast<int>(column);
  Value* const address = is_known() ? out_.at(orders_, known(ahead) * bytes_of_order + at)
                                    : out_.at(stage_orders_, ahead * bytes_of_order + at);
  return out_.splat(out_.b.CreateAlignedLoad(scalar, address, llvm::Align(8)), real_);
}

/// x/d = x (r + ρ) with r the rounded reciprocal and ρ what it lacks: right to 0.51 ulp, without a division of vectors,
/// and without the error that a product with r alone would repeat in every step.
Value* LanesEmitter::over(Value* x, int ahead, OrderColumn number, OrderColumn reciprocal, OrderColumn lack) {
  if (!out_.features.fma) return out_.divide(x, order(ahead, number));
  return out_.fma(x, order(ahead, reciprocal), out_.multiply(x, order(ahead, lack)));
}

Value* LanesEmitter::index(int ahead) {
  if (is_known()) return out_.b.getInt64(static_cast<std::uint64_t>(known(ahead)));
  return out_.b.CreateNUWAdd(stage_, out_.b.getInt64(static_cast<std::uint64_t>(ahead)));
}

Value* LanesEmitter::half(int ahead) { return out_.b.CreateLShr(index(ahead), 1); }

// -------------------------------------------------------------------------------------------------------------- values

bool LanesEmitter::is_literal(ConstantId id, double value) const {
  const Constant& c = program_.constants[id];
  return c.kind == Kind::Number && c.value == value;
}

Value* LanesEmitter::constant(ConstantId id) {
  const Constant& c = program_.constants[id];
  if (c.kind == Kind::Number) return number(c.value);
  return out_.load(real_, out_.at(constants_, static_cast<std::int64_t>(id) * bytes_));
}

LanesEmitter::Coefficient LanesEmitter::coefficient(ConstantId id) {
  if (is_literal(id, 1)) return {nullptr, 1};
  if (is_literal(id, -1)) return {nullptr, -1};
  return {constant(id), 0};
}

Value* LanesEmitter::first(Slot slot) { return load(rows_, slot); }

Value* LanesEmitter::read(Slot slot, int ahead) {
  if (slot == program_.one) return is_order_zero(ahead) ? number(1) : nullptr;
  if (slot == program_.time) {
    if (!is_known() || known(ahead) > 1) return nullptr;
    return known(ahead) == 0 ? first(slot) : number(1);
  }
  if (ahead != ahead_of(slot)) return load(row(ahead), slot);
  if (state_[slot] == State::Unknown) throw std::logic_error("a coefficient is read before it is there; please report");
  return now_[slot];
}

/// What the solution corrects is stored after it.
void LanesEmitter::define(Slot slot, Value* value) {
  state_[slot] = value ? State::Known : State::Zero;
  now_[slot] = value;
  const bool later = corrected_[slot] && (!is_known() || known(0) >= 0);
  if (stored_[slot] && !later) out_.store(or_zero(value), slot_at(row(ahead_of(slot)), slot));
}

Value* LanesEmitter::plus(Value* sum, Value* x, Value* y, bool negative) {
  if (!x || !y) return sum;
  if (negative) x = out_.negate(x);
  return sum ? out_.fma(x, y, sum) : out_.multiply(x, y);
}

Value* LanesEmitter::scaled(const Coefficient& c, Value* x) {
  if (!x) return nullptr;
  return c.value ? out_.multiply(c.value, x) : c.unit > 0 ? x : out_.negate(x);
}

Value* LanesEmitter::plus_scaled(Value* sum, const Coefficient& c, Value* x) {
  if (!sum || !x) return sum ? sum : scaled(c, x);
  if (c.value) return out_.fma(c.value, x, sum);
  return c.unit > 0 ? out_.add(sum, x) : out_.subtract(sum, x);
}

}  // namespace maupertuis::llvm_backend
