#include "machine_code/llvm/emission.hpp"
#include "machine_code/llvm/emitters.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

/// The engine's functions of polynomials for the rows of one small program: all orders and weights written out, in
/// vectors no wider than the unknowns.
namespace maupertuis::llvm_backend {
namespace {

using llvm::Value;

class StepEmitter {
 public:
  StepEmitter(Emission& out, std::size_t unknowns, std::size_t stride, int order)
      : out_(out),
        b_(out.b),
        n_(static_cast<int>(unknowns)),
        width_(std::bit_ceil(static_cast<unsigned>(n_))),
        stride_(stride),
        order_(order),
        type_(out.real(static_cast<int>(width_))),
        scalar_(out.real(1)) {}

  void radius();
  void increments();
  void accelerations();
  void sizes();

 private:
  Value* argument(unsigned i) { return function_->getArg(i); }
  Value* number(double x) { return out_.number(x, type_); }
  Value* spread(Value* scalar) { return out_.splat(scalar, type_); }
  Value* row(int k) { return out_.load(type_, out_.at(argument(0), static_cast<std::int64_t>(8 * stride_) * k)); }
  Value* speed(int k) { return out_.multiply(out_.absolute(row(k + 1)), number(k + 1)); }
  Value* larger(Value* x, Value* y) { return b_.CreateSelect(b_.CreateFCmpOGT(x, y), x, y); }
  Value* smaller(Value* x, Value* y) { return b_.CreateSelect(b_.CreateFCmpOLT(x, y), x, y); }
  Value* cubic(Value* x, const std::array<double, 4>& c, Value* sum = nullptr);
  Value* rough_log2(Value* x);
  Value* rough_exp2(Value* x);
  Value* size();
  Value* least_lane(Value* x);
  void store(Value* x, Value* address) { b_.CreateAlignedStore(x, address, llvm::Align(8)); }
  struct Powers {
    Value *first, *second, *fourth;
  };
  Powers powers(Value* tau);
  Value* joined(Value* const (&sums)[4], const Powers& tau);
  void increment(unsigned out, bool derivative, const Powers& tau);

  Emission& out_;
  llvm::IRBuilder<>& b_;
  int n_;
  unsigned width_;
  std::size_t stride_;
  int order_;
  llvm::Type *type_, *scalar_;
  llvm::Function* function_ = nullptr;
};

/// Σ c_i x^i of degree 3, and a sum that is there early.
Value* StepEmitter::cubic(Value* x, const std::array<double, 4>& c, Value* sum) {
  llvm::Type* const type = x->getType();
  const auto pair = [&](std::size_t i) { return out_.fma(x, out_.number(c[i + 1], type), out_.number(c[i], type)); };
  Value* const low = sum ? out_.add(sum, pair(0)) : pair(0);
  return out_.fma(out_.multiply(x, x), pair(2), low);
}

/// maupertuis/rough_powers.hpp
Value* StepEmitter::rough_log2(Value* x) {
  llvm::Type* const whole = type_->getWithNewType(out_.integer());
  const auto constant = [&](std::uint64_t bits) { return llvm::ConstantInt::get(whole, bits); };
  Value* const bits = b_.CreateBitCast(x, whole);
  Value* const exponent =
      b_.CreateOr(b_.CreateAnd(b_.CreateLShr(bits, constant(52)), constant(0x7ff)), constant(0x4330000000000000));
  Value* const fraction = b_.CreateOr(b_.CreateAnd(bits, constant(0x000fffffffffffff)), constant(0x3ff0000000000000));
  Value* const e = out_.subtract(b_.CreateBitCast(exponent, type_), number(0x1p52 + 1023));
  Value* const f = out_.subtract(b_.CreateBitCast(fraction, type_), number(1));
  return cubic(f, {0.0006371172847411266, 1.4188802113925905, -0.5771289141576275, 0.15824870276503722}, e);
}

/// The same, of one number between −1020 and 1020.
Value* StepEmitter::rough_exp2(Value* x) {
  Value* const shifter = out_.number(0x1.8p52, scalar_);
  Value* const shifted = out_.add(x, shifter);
  Value* const f = out_.subtract(x, out_.subtract(shifted, shifter));
  Value* const power = cubic(f, {0.9999280735404955, 0.6932609854573358, 0.242611122194331, 0.05517166907486526});
  Value* const bits = b_.CreateAdd(b_.CreateBitCast(power, out_.integer()),
                                   b_.CreateShl(b_.CreateBitCast(shifted, out_.integer()), 52));
  return b_.CreateBitCast(bits, scalar_);
}

/// Of each coordinate's velocity over a step.
Value* StepEmitter::size() {
  Value* const h = argument(1);
  Value* size = out_.multiply(spread(out_.divide(out_.number(0x1p-52, scalar_), h)), out_.absolute(row(0)));
  Value* power = nullptr;
  for (int k = 0; k <= 3 && k <= order_ - 2; ++k) {
    size = larger(size, power ? out_.multiply(speed(k), spread(power)) : speed(k));
    power = power ? out_.multiply(power, h) : h;
  }
  return size;
}

/// Of those that belong to unknowns.
Value* StepEmitter::least_lane(Value* x) {
  std::vector<int> used;
  for (unsigned i = 0; i < width_; ++i) used.push_back(static_cast<int>(i) < n_ ? static_cast<int>(i) : 0);
  if (width_ != static_cast<unsigned>(n_)) x = b_.CreateShuffleVector(x, used);
  for (unsigned half = width_ / 2; half > 0; half /= 2) {
    std::vector<int> other;
    for (unsigned i = 0; i < width_; ++i) other.push_back(static_cast<int>(i ^ half));
    x = smaller(b_.CreateShuffleVector(x, other), x);
  }
  return width_ == 1 ? x : b_.CreateExtractElement(x, std::uint64_t{0});
}

/// Early orders first: they are there while the last coefficients are still waited for.
void StepEmitter::radius() {
  constexpr double widened = 0.32192809488736235, infinity = std::numeric_limits<double>::infinity();  // log₂ 1.25
  function_ = out_.function("radius", {out_.pointer(), scalar_}, true, scalar_);
  Value* const inverse = out_.divide(number(1), size());
  Value* least = number(infinity);
  for (int k = std::max(std::min(2, order_ - 1), order_ - 5); k <= order_; ++k) {
    Value* const ratio = out_.multiply(speed(k), inverse);
    Value* const exponent = out_.fma(rough_log2(ratio), number(-1.0 / k), number(k < order_ - 1 ? widened : 0));
    Value* const counts = b_.CreateFCmpOGT(ratio, number(0));
    least = smaller(b_.CreateSelect(counts, exponent, number(infinity)), least);
  }
  Value* const exponent = least_lane(least);
  Value* const ends = b_.CreateFCmpOLT(exponent, out_.number(1020, scalar_));
  Value* const estimate = b_.CreateSelect(ends, rough_exp2(exponent), out_.number(infinity, scalar_));
  Value* const known = b_.CreateFCmpOGT(exponent, out_.number(-900.0 / order_, scalar_));
  b_.CreateRet(b_.CreateSelect(known, estimate, out_.number(std::numeric_limits<double>::quiet_NaN(), scalar_)));
}

StepEmitter::Powers StepEmitter::powers(Value* tau) {
  Value *const first = spread(tau), *const second = out_.multiply(first, first);
  return {first, second, out_.multiply(second, second)};
}

/// Σ_r sums[r] τ^r of the remainders r that there are.
Value* StepEmitter::joined(Value* const (&sums)[4], const Powers& tau) {
  const auto pair = [&](Value* x, Value* y) { return y ? out_.fma(y, tau.first, x) : x; };
  Value* const low = pair(sums[0], sums[1]);
  return sums[2] ? out_.fma(pair(sums[2], sums[3]), tau.second, low) : low;
}

/// Powers of τ apart by their remainders mod 4, each by Horner's rule.
void StepEmitter::increment(unsigned out, bool derivative, const Powers& tau) {
  Value* sums[4] = {};
  for (int k = order_ + 1; k >= 2; --k) {
    Value*& sum = sums[(k - 2) % 4];
    Value* term = row(k);
    if (derivative && sum) term = out_.multiply(term, number(k));
    sum = sum ? out_.fma(sum, tau.fourth, term) : derivative ? out_.multiply(term, number(k)) : term;
  }
  store(out_.multiply(joined(sums, tau), tau.first), argument(out));
}

/// The parameters are the engine's; stride, columns and degree are known.
void StepEmitter::increments() {
  function_ = out_.function("increments", {out_.pointer(), out_.integer(), out_.integer(), b_.getInt32Ty(), scalar_,
                                           out_.pointer(), out_.pointer()});
  const Powers tau = powers(argument(4));
  increment(5, false, tau);
  increment(6, true, tau);
  out_.end_function();
}

/// The stride is the caller's: these are asked of copies.
void StepEmitter::accelerations() {
  function_ = out_.function("accelerations",
                            {out_.pointer(), out_.integer(), out_.integer(), b_.getInt32Ty(), scalar_, out_.pointer()});
  const Powers tau = powers(argument(4));
  Value* const stride = b_.CreateShl(argument(1), 3);
  Value* sums[4] = {};
  for (int k = order_ + 1; k >= 2; --k) {
    Value* const c =
        b_.CreateAlignedLoad(type_, out_.at(argument(0), b_.CreateMul(stride, b_.getInt64(k))), llvm::Align(8));
    Value*& sum = sums[(k - 2) % 4];
    Value* const term = out_.multiply(c, number(k * (k - 1)));
    sum = sum ? out_.fma(sum, tau.fourth, term) : term;
  }
  store(joined(sums, tau), argument(5));
  out_.end_function();
}

/// Of |c_k|, its products with k and with k (k − 1).
void StepEmitter::sizes() {
  function_ = out_.function("sizes", {out_.pointer(), scalar_, out_.pointer()});
  const Powers r = powers(argument(1));
  for (int derivative = 0; derivative < 3; ++derivative) {
    const int first = std::max(1, derivative);  // order
    Value* sums[4] = {};
    for (int k = order_ + 1; k >= first; --k) {
      const int weight = derivative == 0 ? 1 : derivative == 1 ? k : k * (k - 1);
      Value*& sum = sums[(k - first) % 4];
      Value* const size = out_.absolute(row(k));
      Value* const term = weight == 1 ? size : out_.multiply(size, number(weight));
      sum = sum ? out_.fma(sum, r.fourth, term) : term;
    }
    Value* const all = joined(sums, r);
    store(derivative == 0 ? out_.multiply(all, r.first) : all, out_.at(argument(2), std::int64_t{8} * derivative * n_));
  }
  out_.end_function();
}

}  // namespace

void emit_step(Emission& out, std::size_t unknowns, std::size_t stride, int order) {
  StepEmitter emitter(out, unknowns, stride, order);
  emitter.radius();
  emitter.increments();
  emitter.accelerations();
  emitter.sizes();
}

}  // namespace maupertuis::llvm_backend
