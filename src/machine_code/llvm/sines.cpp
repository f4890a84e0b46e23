#include "machine_code/llvm/sines.hpp"

#include <llvm/IR/MDBuilder.h>

/// The numbers of kernel/series/sine_cosine.hpp in another order: what is known last is added last, and polynomials are
/// evaluated in three parts at once, since such a calculation is all waiting.
namespace maupertuis::llvm_backend {
namespace {

using llvm::Value;

class InPlace {
 public:
  InPlace(llvm::IRBuilder<>& b, Value* x)
      : b_(b), x_(x), type_(x->getType()), whole_(type_->getWithNewType(b.getInt64Ty())) {}

  SineAndCosine run() {
    reduce();
    powers();
    return to_quadrant(sine(), cosine());
  }

  /// Of all lanes. False if one is not a number.
  Value* is_inside() {
    Value* const inside = b_.CreateFCmpOLT(b_.CreateUnaryIntrinsic(llvm::Intrinsic::fabs, x_), number(0x1p20));
    return b_.CreateAndReduce(inside);
  }

 private:
  Value* number(double value) { return llvm::ConstantFP::get(type_, value); }
  Value* integer(std::uint64_t value) { return llvm::ConstantInt::get(whole_, value); }
  Value* add(Value* x, Value* y) { return b_.CreateFAdd(x, y); }
  Value* subtract(Value* x, Value* y) { return b_.CreateFSub(x, y); }
  Value* multiply(Value* x, Value* y) { return b_.CreateFMul(x, y); }
  Value* fma(Value* x, Value* y, Value* z) { return b_.CreateIntrinsic(llvm::Intrinsic::fma, {type_}, {x, y, z}); }
  Value* fma(Value* x, double y, Value* z) { return fma(x, number(y), z); }
  Value* fma(Value* x, double y, double z) { return fma(x, number(y), number(z)); }

  /// high + low = x − n π/2 to 2⁻¹⁰⁰; adding the shifter rounds to a whole number, whose last bits the sum then ends
  /// with. The first difference is exact, and so is what the second one lost, unless cancellation left less than 10⁻¹⁰
  /// of x; then it is half a unit of it.
  void reduce() {
    constexpr double shifter = 0x1.8p52, first_part = -0x1.921fb54442d18p0, second_part = -0x1.1a62633145c07p-54,
                     third_part = 0x1.f1976b7ed8fbcp-110;
    Value* const shifted = fma(x_, 0x1.45f306dc9c883p-1, shifter);
    Value* const n = subtract(shifted, number(shifter));
    Value* const first = fma(n, first_part, x_);
    high_ = add(first, multiply(n, number(second_part)));
    low_ = add(fma(n, second_part, subtract(first, high_)), multiply(n, number(third_part)));
    quadrant_ = b_.CreateBitCast(shifted, whole_);
  }

  void powers() {
    z_ = multiply(high_, high_);
    z2_ = multiply(z_, z_);
    rest_ = fma(z_, -0.5, 1);
  }

  /// h − (h³ (1/6 − z P(z)) − low (1 − z/2))
  Value* sine() {
    Value* const p01 = fma(z_, -8.33333333332248946124e-03, 1.66666666666666324348e-01);
    Value* const p23 = fma(z_, -2.75573137070700676789e-06, 1.98412698298579493134e-04);
    Value* const p45 = fma(z_, -1.58969099521155010221e-10, 2.50507602534068634195e-08);
    Value* const cube = multiply(z_, high_);
    Value* const all = fma(multiply(cube, z2_), fma(z2_, p45, p23), multiply(cube, p01));
    return subtract(high_, subtract(all, multiply(low_, rest_)));
  }

  /// 1 − z/2, what it lost by rounding, − h low, and z² Q(z)
  Value* cosine() {
    Value* const q01 = fma(z_, -1.38888888888741095749e-03, 4.16666666666666019037e-02);
    Value* const q23 = fma(z_, -2.75573143513906633035e-07, 2.48015872894767294178e-05);
    Value* const q45 = fma(z_, -1.13596475577881948265e-11, 2.08757232129817482790e-09);
    Value* const all = fma(multiply(z2_, z2_), fma(z2_, q45, q23), multiply(z2_, q01));
    Value* const lost = subtract(subtract(number(1), rest_), multiply(z_, number(0.5)));
    return add(rest_, add(all, subtract(lost, multiply(high_, low_))));
  }

  SineAndCosine to_quadrant(Value* sine, Value* cosine) {
    Value* const odd = b_.CreateICmpNE(b_.CreateAnd(quadrant_, integer(1)), integer(0));
    return {with_sign(b_.CreateSelect(odd, cosine, sine), quadrant_),
            with_sign(b_.CreateSelect(odd, sine, cosine), b_.CreateAdd(quadrant_, integer(1)))};
  }

  /// x or −x, as bit 1 of `which` tells.
  Value* with_sign(Value* x, Value* which) {
    Value* const sign = b_.CreateShl(b_.CreateAnd(which, integer(2)), integer(62));
    return b_.CreateBitCast(b_.CreateXor(b_.CreateBitCast(x, whole_), sign), type_);
  }

  llvm::IRBuilder<>& b_;
  Value* x_;
  llvm::Type *type_, *whole_;
  Value *high_ = nullptr, *low_ = nullptr, *quadrant_ = nullptr, *z_ = nullptr, *z2_ = nullptr, *rest_ = nullptr;
};

/// A number becomes two, since choices between single numbers can become branches that no processor foresees.
Value* paired(llvm::IRBuilder<>& b, Value* x) {
  if (x->getType()->isVectorTy()) return x;
  return b.CreateInsertElement(llvm::ConstantFP::get(llvm::FixedVectorType::get(x->getType(), 2), 0.0), x,
                               std::uint64_t{0});
}

}  // namespace

SineAndCosine sines_in_place(llvm::IRBuilder<>& b, Value* x, const std::function<SineAndCosine()>& beyond) {
  InPlace lanes(b, paired(b, x));
  auto [sine, cosine] = lanes.run();
  if (!x->getType()->isVectorTy())
    sine = b.CreateExtractElement(sine, std::uint64_t{0}), cosine = b.CreateExtractElement(cosine, std::uint64_t{0});
  llvm::BasicBlock* const here = b.GetInsertBlock();
  llvm::BasicBlock* const rare = llvm::BasicBlock::Create(b.getContext(), "", here->getParent());
  llvm::BasicBlock* const after = llvm::BasicBlock::Create(b.getContext(), "", here->getParent());
  b.CreateCondBr(lanes.is_inside(), after, rare, llvm::MDBuilder(b.getContext()).createBranchWeights(1 << 20, 1));
  b.SetInsertPoint(rare);
  const SineAndCosine others = beyond();
  llvm::BasicBlock* const end_of_rare = b.GetInsertBlock();
  b.CreateBr(after);
  b.SetInsertPoint(after);
  const auto either = [&](Value* usual, Value* other) {
    llvm::PHINode* const both = b.CreatePHI(x->getType(), 2);
    both->addIncoming(usual, here), both->addIncoming(other, end_of_rare);
    return both;
  };
  Value* const first = either(sine, others.first);
  return {first, either(cosine, others.second)};
}

}  // namespace maupertuis::llvm_backend
