#include "kernel/extended/close_constants.hpp"

#include "kernel/extended/number.hpp"
#include "kernel/reference/reference.hpp"
#include "kernel/series/elementary_code.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <vector>

namespace maupertuis::extended {
namespace {

using Wide = Real<448>;

/// The literal as it was written; null for numbers that steps brought along, which are doubles.
const Rational* written(const Program& program, const Constant& number) {
  if (number.index >= program.literals.size()) return nullptr;
  const Rational& literal = program.literals[number.index];
  return literal.to_double() == number.value ? &literal : nullptr;
}

bool is_a_double(const Program& program, const Constant& number) {
  if (!std::isfinite(number.value)) return true;  // beyond all doubles, where none is near
  constexpr double integers_end = 9007199254740992;
  if (std::abs(number.value) < integers_end && number.value == std::nearbyint(number.value)) return true;
  const Rational* literal = written(program, number);
  return !literal || *literal == Rational::from_double(number.value);
}

/// 1 or −1, as a hash of seed and mantissa says.
double direction_of(std::uint64_t seed, double value) {
  int exponent = 0;
  const double mantissa = std::frexp(std::abs(value), &exponent);
  std::uint64_t hash = seed * 0x9E3779B97F4A7C15ull ^ static_cast<std::uint64_t>(std::ldexp(mantissa, 53));
  hash = (hash ^ (hash >> 31)) * 0xBF58476D1CE4E5B9ull;
  hash = (hash ^ (hash >> 29)) * 0x94D049BB133111EBull;
  return (hash >> 63) != 0 ? 1 : -1;
}

/// Of a sum or a product of two doubles, for which double holds what rounding takes away.
bool is_exact_sum(double a, double b) {
  const double sum = a + b, part = sum - a;
  return (a - (sum - part)) + (b - part) == 0;
}
bool is_exact_product(double a, double b) { return std::fma(a, b, -(a * b)) == 0; }

bool is_choice(Kind kind) {
  return kind == Kind::Less || kind == Kind::LessEqual || kind == Kind::And || kind == Kind::Or || kind == Kind::Sign ||
         kind == Kind::Step;
}

/// Errors are relative, in units of ε.
class CloseConstants {
 public:
  CloseConstants(const Program& program, std::span<const double> parameters, std::span<const std::int8_t> sides,
                 std::span<double> constants)
      : program_(program), parameters_(parameters), sides_(sides), constants_(constants), errors_(constants.size()) {}

  void compute() {
    constexpr double enough = 16;
    for (std::size_t i = 0; i < constants_.size(); ++i) {
      constants_[i] = reference::compute_constant<double>(program_, i, parameters_, sides_, constants_, operands_);
      errors_[i] = error_of(i);
      if (errors_[i] <= enough) continue;
      constants_[i] = static_cast<double>(wide(static_cast<ConstantId>(i)));
      errors_[i] = 0.5;
    }
    if (program_.rounding) round_otherwise(static_cast<std::uint64_t>(parameters_[*program_.rounding]));
  }

 private:
  void round_otherwise(std::uint64_t seed) {
    std::vector<bool> exponents(constants_.size());
    for (const Instruction& i : program_.instructions)
      if (i.op == Op::Power) exponents[i.constant] = true;
    for (std::size_t i = 0; i < constants_.size(); ++i) {
      double& value = constants_[i];
      if (errors_[i] == 0 || exponents[i] || !std::isfinite(value)) continue;
      const double unit = std::nextafter(std::abs(value), std::numeric_limits<double>::infinity()) - std::abs(value);
      value += (value < 0 ? -1 : 1) * direction_of(seed, value) * std::ceil(errors_[i]) * unit;
    }
  }

  std::span<const ConstantId> operands_of(const Constant& c) const {
    return std::span(program_.constant_arguments).subspan(c.first_argument, c.arguments);
  }

  double error_of(std::size_t i) const {
    const Constant& c = program_.constants[i];
    if (c.kind == Kind::Number) return is_a_double(program_, c) ? 0 : 0.5;
    if (c.arguments == 0) return c.kind == Kind::Pi ? 0.5 : 0;
    if (c.kind == Kind::Sum) return error_of_sum(c, constants_[i]);
    if (c.kind == Kind::Product) return error_of_product(c);
    if (c.kind == Kind::Power && is_exact_power(c, constants_[i])) return 0;
    if (c.kind == Kind::Piecewise || c.kind == Kind::Min || c.kind == Kind::Max) return largest_error(c);
    return error_of_function(c, constants_[i]);
  }

  /// Whether each operation of a chain of them is exact: of sums is_exact_sum, else of products.
  bool is_exact(const Constant& c, bool (*operation)(double, double)) const {
    const auto operands = operands_of(c);
    double so_far = constants_[operands[0]];
    for (const ConstantId k : operands.subspan(1)) {
      if (!operation(so_far, constants_[k])) return false;
      so_far = c.kind == Kind::Sum ? so_far + constants_[k] : so_far * constants_[k];
    }
    return true;
  }

  double error_of_sum(const Constant& c, double value) const {
    double off = 0, size = 0;
    for (const ConstantId k : operands_of(c)) {
      off += errors_[k] * std::abs(constants_[k]);
      size += std::abs(constants_[k]);
    }
    if (off == 0 && is_exact(c, is_exact_sum)) return 0;
    const double of_partial_sums = 0.5 * (c.arguments - 2.0) * size, all = off + of_partial_sums;
    return all == 0 ? 0.5 : all / std::abs(value) + 0.5;
  }

  double error_of_product(const Constant& c) const {
    double out = 0;
    for (const ConstantId k : operands_of(c)) out += errors_[k];
    return out == 0 && is_exact(c, is_exact_product) ? 0 : out + 0.5 * (c.arguments - 1.0);
  }

  /// Of the usual powers, and those of 1.
  bool is_exact_power(const Constant& c, double value) const {
    const auto operands = operands_of(c);
    const double base = constants_[operands[0]], exponent = constants_[operands[1]];
    if (errors_[operands[0]] != 0 || errors_[operands[1]] != 0) return false;
    if (exponent == 2) return is_exact_product(base, base);
    if (exponent == -1) return value * base == 1 && is_exact_product(value, base);
    if (exponent == 0.5) return value * value == base && is_exact_product(value, value);
    return base == 1;
  }

  double largest_error(const Constant& c) const {
    double out = 0;
    for (const ConstantId k : operands_of(c)) out = std::max(out, errors_[k]);
    return out;
  }

  /// By its condition |x f'/f| in each operand, whose slope a difference tells. A comparison that rounding may decide
  /// has an infinite one.
  double error_of_function(const Constant& c, double value) const {
    if (c.kind == Kind::Abs) return errors_[operands_of(c)[0]];
    constexpr double step = 0x1p-26;
    double out = is_choice(c.kind) ? 0 : 1;
    const auto operands = operands_of(c);
    for (std::size_t k = 0; k < operands.size(); ++k) {
      if (errors_[operands[k]] == 0) continue;
      double change = 0;
      for (const double h : {step, -step}) change = std::max(change, std::abs(with_moved(c, k, h) - value));
      if (change != 0) out += errors_[operands[k]] * change / (step * std::abs(value));
    }
    return out;
  }

  double with_moved(const Constant& c, std::size_t moved, double relative) const {
    std::vector<double> x;
    for (const ConstantId k : operands_of(c)) x.push_back(constants_[k]);
    x[moved] *= 1 + relative;
    return series::operation<double>(c.kind, x);
  }

  const Wide& wide(ConstantId id) {
    const auto found = wide_.find(id);
    return found != wide_.end() ? found->second : wide_.emplace(id, make_wide(id)).first->second;
  }

  Wide make_wide(ConstantId id) {
    const Constant& c = program_.constants[id];
    if (c.kind == Kind::Symbol) return Wide(parameters_[c.index]);
    if (c.kind == Kind::Sign && c.arguments == 0) return Wide(static_cast<int>(sides_[c.index]));
    if (c.kind == Kind::Number) {
      const Rational* literal = written(program_, c);
      return literal ? series::Exactly<Wide>::from(*literal) : Wide(c.value);
    }
    std::vector<Wide> x;
    for (const ConstantId k : operands_of(c)) x.push_back(wide(k));
    const Wide value = series::operation<Wide>(c.kind, x);
    return is_rounding_of_zero(c.kind, value, x) ? Wide(0) : value;
  }

  /// √2·√2 − 2 and sin π are 0.
  static bool is_rounding_of_zero(Kind kind, const Wide& value, const std::vector<Wide>& operands) {
    if (kind != Kind::Sum && kind != Kind::Sin && kind != Kind::Cos && kind != Kind::Tan) return false;
    static const Wide rounding = epsilon_to<Wide>(0.9);
    for (const Wide& x : operands)
      if (abs(value) < rounding * abs(x)) return true;
    return false;
  }

  const Program& program_;
  std::span<const double> parameters_;
  std::span<const std::int8_t> sides_;
  std::span<double> constants_;
  std::vector<double> errors_, operands_;
  std::unordered_map<ConstantId, Wide> wide_;
};

}  // namespace

void compute_close_constants(const Program& program, std::span<const double> parameters,
                             std::span<const std::int8_t> sides, std::span<double> constants) {
  CloseConstants(program, parameters, sides, constants).compute();
}

}  // namespace maupertuis::extended
