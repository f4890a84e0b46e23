#include "kernel/disks/node.hpp"

#include <maupertuis/slopes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

/// The rules of docs/design/safe_steps.md: from bounds of the operands on a disk to those of the result. Most follow
/// from |f(w) − f(w₀)| ≤ |w − w₀| sup |f′|, the supremum taken over the disk of the operand, which is convex.
namespace maupertuis {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double power_of(double base, double exponent) { return exponent == 0 ? 1.0 : std::pow(base, exponent); }

/// Of what is bounded by `reach` about `centre`, when nothing is known of a polynomial part.
double smaller(double x, double y) { return x < y ? x : y; }

}  // namespace

void Disks::evaluate(const Node& node) {
  const Instruction& i = node.instruction;
  switch (i.op) {
    case Op::One:
    case Op::Time:
    case Op::Coordinate:
    case Op::Companion:
      return;
    case Op::Linear:
    case Op::Products:
      return set(i.out, sum(node));
    case Op::Square: {
      Bounds b = product(i.a, i.a);
      if (degree_[i.out] < now_.order) b.tail = 0;
      return set(i.out, b);
    }
    case Op::Quotient:
      return set(i.out, quotient(node));
    case Op::SquareRoot:
      return set(i.out, power(i.a, 0.5, centre(i.out)));
    case Op::Power:
      return set(i.out, power(i.a, node.exponent, centre(i.out)));
    case Op::SinCos:
    case Op::SinhCosh:
      return pair(node);
    case Op::Function:
      return set(i.out, function(node));
    case Op::Derivative: {
      const Term term{1, 0, i.a, no_slot, 1};
      return set(i.out, {shifted_reach(term), shifted_tail(term), 0, infinity});
    }
    case Op::Select:
      return set(i.out, chosen(i));
  }
  throw std::logic_error("disks met an operation that they do not know; please report");
}

/// d^shift/dt^shift of an operand: how far it is from its value at the centre.
double Disks::shifted_reach(const Term& term) const {
  if (term.shift == 0) return reach_[term.a];
  if (term.a < program_.unknowns) return rate_reach_[term.shift - 1][term.a];
  if (degree_[term.a] < static_cast<int>(term.shift)) return 0;
  if (term.a == program_.time) return 0;
  if (!(previous_ > radius_)) return infinity;
  // Cauchy's estimate of the derivative between the two circles …
  const double gap = previous_ - radius_;
  const double by_circles = term.shift == 1 ? 2 * reach_before_[term.a] / gap : 4 * reach_before_[term.a] / (gap * gap);
  return has_series_[term.a] ? smaller(by_circles, series_of_derivative(term.a, term.shift)) : by_circles;
}

/// … or its coefficients, and what the larger disk leaves out of them: Σ_{k>K} k^s |f_k| r^{k−s} with |f_k| ≤ tail/R^k.
double Disks::series_of_derivative(std::uint32_t slot, std::uint32_t shift) const {
  const int lag = std::max<int>(0, program_.lags[slot]), last = now_.order + 1 - lag;
  double sum = 0;
  for (int k = static_cast<int>(shift) + 1; k <= last; ++k) {
    const double weight = shift == 1 ? k : static_cast<double>(k) * (k - 1);
    sum += weight * std::abs(coefficient(k, slot)) * powers_[static_cast<std::size_t>(k) - shift];
  }
  const double unit = shift == 1 ? now_.unit : now_.unit * now_.unit;
  const double widened = (last + 2) / (radius_ * (1 - radius_ / previous_));
  return sum / unit +
         tail_before_[slot] * passed_on_[static_cast<std::size_t>(lag)] * (shift == 1 ? widened : widened * widened);
}

/// The k-th coefficient of the derivative is at most (k + s)^s tail/r^{k+s}; with x ≤ ½ its sum is this tail's.
double Disks::shifted_tail(const Term& term) const {
  if (term.a < program_.unknowns || tail_[term.a] == 0) return 0;
  const double once = 2 * (now_.order + 3) / radius_;
  return tail_[term.a] * (term.shift == 0 ? 1 : term.shift == 1 ? once : once * once);
}

Disks::Bounds Disks::product(std::uint32_t a, std::uint32_t b) const {
  const double u = std::abs(centre(a)), v = std::abs(centre(b));
  const double reach = smaller(u * reach_[b] + v * reach_[a] + reach_[a] * reach_[b], high_[a] * high_[b] + u * v);
  return {reach, reach, low_[a] * low_[b], high_[a] * high_[b]};
}

/// The modulus of a sum is at least the largest lower bound of a term less the upper bounds of the others.
Disks::Bounds Disks::sum(const Node& node) const {
  const Instruction& i = node.instruction;
  if (!needs_reach_[i.out]) return {0, tail_of_sum(i), 0, infinity};
  Bounds total{0, 0, 0, 0};
  double largest = 0;  // of low + high
  for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
    const Term& term = terms_[t];
    if (term.size == 0) continue;
    Bounds b;
    if (i.op == Op::Products && t >= i.first_product) {
      b = product(term.a, term.b);
      if (degree_[term.a] + degree_[term.b] < now_.order) b.tail = 0;
    } else if (term.shift == 0) {
      b = {reach_[term.a], tail_[term.a], low_[term.a], high_[term.a]};
    } else {
      b = {shifted_reach(term), shifted_tail(term), 0, 0};
      b.high = std::abs(centre(term.a, term.shift)) + b.reach;
    }
    total.reach += term.size * b.reach;
    total.tail += term.size * b.tail;
    total.high += term.size * b.high;
    largest = std::max(largest, term.size * (b.low + b.high));
  }
  total.low = total.high < infinity ? std::max(0.0, largest - total.high) : 0.0;
  return total;
}

double Disks::tail_of_sum(const Instruction& i) const {
  double tail = 0;
  for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
    const Term& term = terms_[t];
    if (term.size == 0) continue;
    const bool is_product = i.op == Op::Products && t >= i.first_product;
    if (!is_product)
      tail += term.size * shifted_tail(term);
    else if (degree_[term.a] + degree_[term.b] >= now_.order)
      tail += term.size * product(term.a, term.b).tail;
  }
  return tail;
}

/// a/b − a₀/b₀ = ((a − a₀) − (a₀/b₀)(b − b₀))/b
Disks::Bounds Disks::quotient(const Node& node) const {
  const Instruction& i = node.instruction;
  const double low = low_[i.b], ratio = std::abs(centre(i.out));
  if (!(low > 0)) return {infinity, infinity, 0, infinity};
  const double high = high_[i.a] / low;
  const double reach = smaller((reach_[i.a] + ratio * reach_[i.b]) / low, high + ratio);
  return {reach, reach, low_[i.a] / high_[i.b], high};
}

/// f′ = c w^{c−1}, largest where |w| is largest or smallest; a disk about 0 is one of whole positive powers alone.
/// Others have a branch point there: values of bounded modulus, but no series, whatever they are multiplied by.
Disks::Bounds Disks::power(std::uint32_t a, double c, double value) const {
  if (c == 0) return {0, 0, 1, 1};
  const bool is_whole = c > 0 && c == std::nearbyint(c);
  if (!(low_[a] > 0) && !is_whole) return {infinity, infinity, 0, infinity};
  const double slope = std::abs(c) * power_of(c >= 1 ? high_[a] : low_[a], c - 1);
  const double at_low = power_of(low_[a], c), at_high = power_of(high_[a], c);
  const double low = std::min(at_low, at_high), high = std::max(at_low, at_high);
  const double reach = reach_[a] == 0 ? 0.0 : smaller(slope * reach_[a], high + std::abs(value));
  return {reach, reach, low, high};
}

/// sin w − sin w₀ = sin w₀ (cos z − 1) + cos w₀ sin z with |z| ≤ δ, and so the others.
void Disks::pair(const Node& node) {
  const Instruction& i = node.instruction;
  const double d = reach_[i.a], s = std::abs(centre(i.out)), c = std::abs(centre(i.second));
  if (i.op == Op::SinCos) {
    // cosh 1 = 1.54308
    const double cosh = d <= 1 ? 1 + 0.5431 * d * d : std::cosh(d), sinh = d <= 1 ? d * cosh : std::sinh(d);
    const double rest = 0.5 * d * sinh;  // cosh − 1 ≤ ½ d sinh
    const double of_sine = s * rest + c * sinh, of_cosine = c * rest + s * sinh;
    set(i.out, {of_sine, of_sine, 0, cosh});
    set(i.second, {of_cosine, of_cosine, 0, cosh});
    return;
  }
  // |sinh w| and |cosh w| lie between sinh and cosh of |Re w|.
  const double w = std::abs(centre(i.a)), most = std::cosh(w + d), least = w > d ? std::sinh(w - d) : 0.0;
  const double of_sine = smaller(d * most, most + s), of_cosine = smaller(d * most, most + c);
  set(i.out, {of_sine, of_sine, least, most});
  set(i.second, {of_cosine, of_cosine, least, most});
}

/// The branch in force is the function; its end is a switch.
Disks::Bounds Disks::chosen(const Instruction& i) const {
  std::uint32_t t = i.first_term;
  while (t + 1 < i.last_term && constants_[terms_[t].coefficient] == 0) ++t;
  const std::uint32_t a = terms_[t].a;
  return {reach_[a], tail_[a], low_[a], high_[a]};
}

/// The reach of f(w) from the largest |f′| on the disk of w.
Disks::Bounds Disks::function(const Node& node) const {
  const Instruction& i = node.instruction;
  const double w = centre(i.a), d = reach_[i.a], value = std::abs(centre(i.out));
  if (d == 0 && (i.b == no_slot || reach_[i.b] == 0)) return {0, 0, value, value};
  if (!(d < infinity)) return {infinity, infinity, 0, infinity};
  if (i.function == Kind::Exp) {
    const double high = std::exp(w + d), reach = high * std::min(1.0, d);
    return {reach, reach, std::exp(w - d), high};
  }
  if (i.function == Kind::Atan2) {  // |dφ| ≤ (|dx| + |dy|)/|x ± iy|
    const double both = d + reach_[i.b], far = std::hypot(w, centre(i.b)) - both;
    const double reach = far > 0 ? both / far : infinity;
    return {reach, reach, 0, infinity};
  }
  const double slope = largest_slope(i.function, w, d, low_[i.a]);
  const double reach = slope >= 0 ? slope * d : infinity;
  return {reach, reach, 0, infinity};
}

}  // namespace maupertuis
