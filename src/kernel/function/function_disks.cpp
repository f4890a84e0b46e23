#include "kernel/function/program.hpp"

#include <maupertuis/function_disks.hpp>
#include <maupertuis/slopes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <stdexcept>

namespace maupertuis {
namespace {

using Op = FunctionOp;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The smaller one; what is not a number bounds nothing.
double smaller(double x, double y) { return x < y || std::isnan(y) ? x : y; }
double bound(double x) { return std::isnan(x) ? infinity : x; }
double away(double x) { return std::max(0.0, x); }

/// The same program, with each slot as an output.
FunctionKernel with_every_value(const FunctionKernel& kernel) {
  auto program = std::make_shared<FunctionProgram>(kernel.program());
  program->outputs.resize(program->slots);
  std::iota(program->outputs.begin(), program->outputs.end(), 0u);
  return FunctionKernel(std::move(program));
}

}  // namespace

FunctionDisks::FunctionDisks(const FunctionKernel& kernel, std::span<const double> parameters)
    : kernel_(kernel), every_value_(with_every_value(kernel)), centre_(kernel.program().slots), bounds_(kernel.program().slots) {
  every_value_.set_parameters(parameters);
}

void FunctionDisks::set_centre(std::span<const double> inputs) { every_value_.evaluate(inputs, centre_); }

double FunctionDisks::reach(std::size_t output) const { return bounds_[kernel_.program().outputs[output]].reach; }
double FunctionDisks::tail(std::size_t output) const { return bounds_[kernel_.program().outputs[output]].tail; }

void FunctionDisks::evaluate(std::span<const double> reach) {
  const FunctionProgram& program = kernel_.program();
  for (std::size_t k = 0; k < program.slots; ++k) {
    const double c = std::abs(centre_[k]), d = k < program.inputs ? reach[k] : 0;
    bounds_[k] = {d, 0, away(c - d), c + d};
  }
  for (const FunctionInstruction& i : program.changing) {
    Bounds b = result(i);
    b.reach = bound(b.reach), b.tail = bound(b.tail);
    const double c = std::abs(centre_[i.out]);
    b.low = std::max(std::isnan(b.low) ? 0.0 : b.low, std::isnan(c - b.reach) ? 0.0 : away(c - b.reach));
    b.high = smaller(c + b.reach, bound(b.high));
    bounds_[i.out] = b;
  }
}

FunctionDisks::Bounds FunctionDisks::result(const FunctionInstruction& i) const {
  const Bounds& x = bounds_[i.a];
  switch (i.op) {
    case Op::Add:
    case Op::Subtract: {
      const Bounds& y = bounds_[i.b];
      return {x.reach + y.reach, x.tail + y.tail, away(std::max(x.low - y.high, y.low - x.high)), x.high + y.high};
    }
    case Op::Negate: return x;
    case Op::Multiply: return product(i);
    case Op::Divide: return quotient(i);
    case Op::Square: return power(i.a, 2, centre_[i.out]);
    case Op::Sqrt: return power(i.a, 0.5, centre_[i.out]);
    case Op::PowerInteger: return power(i.a, i.exponent, centre_[i.out]);
    case Op::Power:
      if (bounds_[i.b].reach > 0) return {infinity, infinity, 0, infinity};
      return power(i.a, centre_[i.b], centre_[i.out]);
    case Op::Abs:
    case Op::Sign:
    case Op::Step:
    case Op::Min:
    case Op::Max:
    case Op::Less:
    case Op::LessEqual:
    case Op::And:
    case Op::Or:
    case Op::Choose: return chosen(i);
    case Op::Function:
    case Op::Atan2: return function(i);
  }
  throw std::logic_error("a disk met an operation that has no bounds; please report");
}

/// A constant factor leaves a polynomial what it is.
FunctionDisks::Bounds FunctionDisks::product(const FunctionInstruction& i) const {
  const Bounds &x = bounds_[i.a], &y = bounds_[i.b];
  const double u = std::abs(centre_[i.a]), v = std::abs(centre_[i.b]);
  const auto times = [](double size, double r) { return size == 0 ? 0.0 : size * r; };
  if (x.reach == 0) return {times(u, y.reach), times(u, y.tail), times(u, y.low), times(u, y.high)};
  if (y.reach == 0) return {times(v, x.reach), times(v, x.tail), times(v, x.low), times(v, x.high)};
  const double reach = smaller(u * y.reach + v * x.reach + x.reach * y.reach, x.high * y.high + u * v);
  return {reach, reach, x.low * y.low, x.high * y.high};
}

/// a/b − a₀/b₀ = ((a − a₀) − (a₀/b₀)(b − b₀))/b
FunctionDisks::Bounds FunctionDisks::quotient(const FunctionInstruction& i) const {
  const Bounds &x = bounds_[i.a], &y = bounds_[i.b];
  if (!(y.low > 0)) return {infinity, infinity, 0, infinity};
  if (y.reach == 0) return {x.reach / y.low, x.tail / y.low, x.low / y.low, x.high / y.low};
  const double ratio = std::abs(centre_[i.out]), high = x.high / y.low;
  const double reach = smaller(high + ratio, (x.reach + ratio * y.reach) / y.low);
  return {reach, reach, x.low / y.high, high};
}

/// f' = c w^{c−1}, largest where |w| is largest or smallest; a disk about 0 is one of whole positive powers alone.
FunctionDisks::Bounds FunctionDisks::power(std::uint32_t a, double c, double value) const {
  const Bounds& x = bounds_[a];
  const bool whole = c >= 0 && c == std::nearbyint(c);
  if (x.reach == 0) return {0, 0, std::abs(value), std::abs(value)};
  if (!whole && !(x.low > 0)) return {infinity, infinity, 0, infinity};
  const double slope = std::abs(c) * std::pow(c >= 1 ? x.high : x.low, c - 1);
  const double one = std::pow(x.low, c), other = std::pow(x.high, c), high = std::max(one, other);
  const double reach = smaller(high + std::abs(value), slope * x.reach);
  return {reach, reach, std::min(one, other), high};
}

/// Mostly |f(w) − f(w₀)| ≤ |w − w₀| sup |f′|, the supremum over the disk of w.
FunctionDisks::Bounds FunctionDisks::function(const FunctionInstruction& i) const {
  const Bounds& x = bounds_[i.a];
  const double w = centre_[i.a], size = std::abs(w), d = x.reach, value = std::abs(centre_[i.out]);
  const bool second = i.op == Op::Atan2;
  if (d == 0 && !(second && bounds_[i.b].reach > 0)) return {0, 0, value, value};
  if (!(d < infinity)) return {infinity, infinity, 0, infinity};
  const auto within = [&](double reach, double high, double low = 0) { return Bounds{reach, reach, low, high}; };
  if (second) {  // |dφ| ≤ (|dx| + |dy|)/|x ± iy|
    const double both = d + bounds_[i.b].reach, far = std::hypot(w, centre_[i.b]) - both;
    return within(far > 0 ? both / far : infinity, infinity);
  }
  const double cos = std::abs(std::cos(w)), sin = std::abs(std::sin(w));
  // sin w − sin w₀ = sin w₀ (cos z − 1) + cos w₀ sin z with |z| ≤ d, |cos z − 1| ≤ ½ d sinh d
  if (i.function == Kind::Sin) return within(sin * 0.5 * d * std::sinh(d) + cos * std::sinh(d), std::cosh(d));
  if (i.function == Kind::Cos) return within(cos * 0.5 * d * std::sinh(d) + sin * std::sinh(d), std::cosh(d));
  if (i.function == Kind::Sinh || i.function == Kind::Cosh) {  // both lie between sinh and cosh of |Re w|
    const double most = std::cosh(size + d);
    return within(smaller(most + value, d * most), most, size > d ? std::sinh(size - d) : 0);
  }
  if (i.function == Kind::Exp) {
    const double high = std::exp(w + d);
    return within(high * std::min(1.0, d), high, std::exp(w - d));
  }
  const double reach = d * largest_slope(i.function, w, d, x.low);
  return within(reach, infinity);
}

/// Where the disk decides, the branch in force is the function.
FunctionDisks::Bounds FunctionDisks::chosen(const FunctionInstruction& i) const {
  const Bounds &x = bounds_[i.a], &y = bounds_[i.b];
  const double w = std::abs(centre_[i.a]);
  const Bounds constant{0, 0, std::abs(centre_[i.out]), std::abs(centre_[i.out])}, undecided{infinity, infinity, 0, infinity};
  switch (i.op) {
    case Op::Abs: return w > x.reach || x.reach == 0 ? x : undecided;
    case Op::Sign:
    case Op::Step: return w > x.reach || x.reach == 0 ? constant : undecided;
    case Op::Less:
    case Op::LessEqual: {
      const double both = x.reach + y.reach;
      return std::abs(centre_[i.a] - centre_[i.b]) > both || both == 0 ? constant : undecided;
    }
    case Op::Min:
    case Op::Max: {
      const double both = x.reach + y.reach, difference = centre_[i.a] - centre_[i.b];
      if (!(std::abs(difference) > both || both == 0)) return undecided;
      return (difference < 0) == (i.op == Op::Min) ? x : y;
    }
    case Op::And:
    case Op::Or: return x.reach == 0 && y.reach == 0 ? constant : undecided;
    case Op::Choose: return bounds_[i.c].reach == 0 ? (centre_[i.c] != 0 ? x : y) : undecided;
    case Op::Add:
    case Op::Subtract:
    case Op::Multiply:
    case Op::Divide:
    case Op::Negate:
    case Op::Square:
    case Op::Sqrt:
    case Op::PowerInteger:
    case Op::Power:
    case Op::Function:
    case Op::Atan2: break;  // not here
  }
  throw std::logic_error("a disk met an operation that has no bounds; please report");
}

}  // namespace maupertuis
