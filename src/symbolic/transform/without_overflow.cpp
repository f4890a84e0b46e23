#include <maupertuis/transform.hpp>

#include "symbolic/transform/rebuild.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

/// 1/(1 + exp(u)), sinh u/cosh³ u, log(1 + exp(u)): finite where exp(u) is not. Beyond |u| = 300 each is a constant,
/// zero or a straight line to 130 digits, so that u may stay at ±300 there:
///
///     1 ┤▔▔▔▔▔▔▔▔▔▔╲                       exp(u) in it is exp(w),       w  300 ┤      ╱▔▔▔▔
///       │           ╲                      w = max(min(u, 300), −300)           │    ╱
///     0 ┤            ╲▁▁▁▁▁▁▁▁▁▁                                           −300 ┤▁▁╱
///            −300     0      300   u                                              −300  300   u
///
/// A side where the quotient grows keeps its u. Of cosh³ u and (1 + exp(u))⁶ the powers must not overflow either: u
/// stays at ±600/3 and ±600/6 there; or nearer, where the series of exp(600) would leave the range of numbers.
namespace maupertuis {
namespace {

constexpr double bound = 300;  // of u
/// Coefficients beside exponentials lie between its inverse and it: exp(300) outweighs them by 70 digits.
constexpr double largest_coefficient = 1e60;
constexpr double largest_shift = 50;  // of one exponent against another

bool is_exponential(Expr e) { return e.is(Kind::Exp) || e.is(Kind::Cosh) || e.is(Kind::Sinh); }

bool moves(Expr e) { return e.context().depends_on_time(e.id()); }

/// How fast an expression grows: as exp(up u) for u → ∞, as exp(−down u) for u → −∞.
struct Growth {
  double up = 0, down = 0;
};

/// The exponents of a quotient as multiples of one of them, u.
class Exponents {
 public:
  explicit Exponents(double largest_exponent) : most_(largest_exponent) {}

  /// False where an exponential is no power of exp(u).
  bool take(Expr exponential) {
    const Expr e = exponential[0];
    if (!moves(e) || e.context().has_time_derivative(e.id())) return false;
    if (!u_) u_ = e;
    const auto multiple = multiple_of(e);
    if (!multiple) return false;
    multiples_[exponential] = *multiple;
    largest_ = std::max(largest_, std::abs(*multiple));
    return true;
  }

  Growth growth(Expr exponential) const {
    const double a = multiples_.at(exponential);
    return exponential.is(Kind::Exp) ? Growth{a, -a} : Growth{std::abs(a), std::abs(a)};
  }

  /// exp(n u) is computed on the way: it must not overflow either.
  void pass_through(double n) { largest_ = std::max(largest_, std::abs(n)); }

  Expr u() const { return u_; }
  double limit() const { return std::floor(std::min(bound, most_ / largest_)); }

  /// The exponentials with w in place of u.
  ExprMap with(Expr w) const {
    ExprMap out;
    for (const auto& [exponential, multiple] : multiples_)
      out[exponential] = apply(exponential.kind(), exponential[0] == u_
                                                       ? w
                                                       : expand(exponential[0] - Rational::from_double(multiple) * u_) +
                                                             Rational::from_double(multiple) * w);
    return out;
  }

 private:
  std::optional<double> multiple_of(Expr e) const {
    if (e == u_) return 1;
    for (const Expr& s : symbols_of({&u_, 1})) {
      if (!moves(s)) continue;
      const Expr ratio = differentiate(e, s) / differentiate(u_, s);
      const Rational* const a = ratio.number_or_null();
      if (!a || Rational::from_double(a->to_double()) != *a) return std::nullopt;
      const Expr rest = expand(e - *a * u_);
      const Rational* const shift = rest ? rest.number_or_null() : nullptr;
      if (!shift || std::abs(shift->to_double()) > largest_shift) return std::nullopt;
      return a->to_double();
    }
    return std::nullopt;
  }

  double most_;
  Expr u_;
  double largest_ = 1;
  std::unordered_map<Expr, double, ExprHash> multiples_;
};

struct Numbers {
  const std::function<double(Expr)>& value_of;
  double largest_exponent;
};

/// A sum of exponentials times what does not move, and of what does not move; or one exponential.
class Quotient {
 public:
  explicit Quotient(const Numbers& numbers) : value_of_(numbers.value_of), exponents_(numbers.largest_exponent) {}

  /// The factors of a product, or a power alone.
  static std::optional<Quotient> of(Expr node, const Numbers& numbers) {
    Quotient out(numbers);
    const auto factors = node.is(Kind::Product) ? arguments(node) : std::vector<Expr>{node};
    Growth above, below;  // of what is multiplied, and of what divides
    for (const Expr& factor : factors) {
      const PowerOf power = split_power(factor);
      if (!moves(power.base)) continue;
      const auto growth = out.growth_of(power.base);
      if (!growth) return std::nullopt;
      const double k = power.exponent.to_double();
      out.overflows_up_ = out.overflows_up_ || growth->up > 0;
      out.overflows_down_ = out.overflows_down_ || growth->down > 0;
      out.total_.up += k * growth->up, out.total_.down += k * growth->down;
      Growth& part = k > 0 ? above : below;
      part.up += std::abs(k * growth->up), part.down += std::abs(k * growth->down);
    }
    for (const double n : {above.up, above.down, below.up, below.down}) out.exponents_.pass_through(n);
    return out.exponents_.u() ? std::optional(out) : std::nullopt;
  }

  /// Of a logarithm of a sum.
  static std::optional<Quotient> of_logarithm(Expr argument, const Numbers& numbers) {
    Quotient out(numbers);
    const auto growth = out.growth_of(argument);
    if (!growth || !out.exponents_.u()) return std::nullopt;
    out.total_ = *growth;
    return out;
  }

  /// max(min(u, limit), −limit), on the sides where the whole stays bounded.
  Expr kept() const { return kept(overflows_up_ && total_.up <= 0, overflows_down_ && total_.down <= 0); }
  Expr kept(bool above, bool below) const {
    Context& c = exponents_.u().context();
    Expr w = exponents_.u();
    const Rational limit = Rational::from_double(exponents_.limit());
    if (above) w = c.function(Kind::Min, std::vector<Expr>{w, c.number(limit)});
    if (below) w = c.function(Kind::Max, std::vector<Expr>{w, c.number(-limit)});
    return w;
  }
  const Exponents& exponents() const { return exponents_; }
  const Growth& total() const { return total_; }

 private:
  static std::vector<Expr> arguments(Expr node) {
    std::vector<Expr> out;
    for (std::size_t i = 0; i < node.size(); ++i) out.push_back(node[i]);
    return out;
  }

  /// Factors without exponentials do not grow; nothing where exponentials stand in another way, or beside what may be
  /// of any size.
  std::optional<Growth> growth_of(Expr base) {
    if (is_exponential(base)) return exponents_.take(base) ? std::optional(exponents_.growth(base)) : std::nullopt;
    if (!base.is(Kind::Sum)) return holds_exponentials(base) ? std::nullopt : std::optional(Growth{});
    if (!holds_exponentials(base)) return Growth{};
    constexpr double none = -std::numeric_limits<double>::infinity();
    Growth out{none, none};
    for (const Expr& term : arguments(base)) {
      const auto growth = growth_of_term(term);
      if (!growth) return std::nullopt;
      out = {std::max(out.up, growth->up), std::max(out.down, growth->down)};
    }
    return out;
  }

  std::optional<Growth> growth_of_term(Expr term) {
    const ScaledTerm scaled = split_coefficient(term);
    double size = std::abs(scaled.coefficient.to_double());
    Growth out;
    for (const Expr& factor : scaled.rest.is(Kind::Product) ? arguments(scaled.rest) : std::vector<Expr>{scaled.rest}) {
      if (factor.is_number()) continue;
      if (!moves(factor) && value_of_) {
        size *= std::abs(value_of_(factor));
        continue;
      }
      const PowerOf power = split_power(factor);
      if (!is_exponential(power.base) || !exponents_.take(power.base)) return std::nullopt;
      const Growth growth = exponents_.growth(power.base);
      const double k = power.exponent.to_double();
      if (k < 0 && !power.base.is(Kind::Exp)) return std::nullopt;
      out.up += k * growth.up, out.down += k * growth.down;
    }
    if (!(size < largest_coefficient && size > 1 / largest_coefficient)) return std::nullopt;
    exponents_.pass_through(out.up), exponents_.pass_through(out.down);
    return out;
  }

  static bool holds_exponentials(Expr e) {
    const auto nodes = topological_order({&e, 1});
    return std::any_of(nodes.begin(), nodes.end(), [](const Expr& n) { return is_exponential(n) && moves(n); });
  }

  const std::function<double(Expr)>& value_of_;
  Exponents exponents_;
  Growth total_;
  bool overflows_up_ = false, overflows_down_ = false;
};

/// log D(u) = log D(w) + (growth of D) · (u − w), where both sides are kept.
Expr logarithm(Expr node, const Numbers& numbers) {
  const auto quotient =
      node[0].is(Kind::Sum) || node[0].is(Kind::Cosh) ? Quotient::of_logarithm(node[0], numbers) : std::nullopt;
  if (!quotient || (quotient->total().up <= 0 && quotient->total().down <= 0)) return node;
  Context& c = node.context();
  const Growth growth = quotient->total();
  const Expr u = quotient->exponents().u(), w = quotient->kept(growth.up > 0, growth.down > 0);
  const Rational limit = Rational::from_double(quotient->exponents().limit());
  const auto beyond = [&](Expr side) { return c.function(Kind::Max, std::vector<Expr>{side - limit, c.number(0)}); };
  Expr out = substitute(node, quotient->exponents().with(w));
  if (growth.up > 0) out = out + Rational::from_double(growth.up) * beyond(u);
  if (growth.down > 0) out = out + Rational::from_double(growth.down) * beyond(-u);
  return out;
}

Expr quotient(Expr node, const Numbers& numbers) {
  const auto quotient = Quotient::of(node, numbers);
  if (!quotient) return node;
  const Expr w = quotient->kept();
  return w == quotient->exponents().u() ? node : substitute(node, quotient->exponents().with(w));
}

}  // namespace

std::vector<Expr> without_overflow(std::span<const Expr> roots, const std::function<double(Expr)>& value_of,
                                   double largest_exponent) {
  const Numbers numbers{value_of, largest_exponent};
  const std::vector<Expr> nodes = topological_order(roots);
  std::vector<Expr> out(roots.begin(), roots.end());
  if (std::none_of(nodes.begin(), nodes.end(), [](const Expr& e) { return is_exponential(e) && moves(e); })) return out;
  ExprMap done;
  const auto replaced = [&](Expr e) {
    const auto found = done.find(e);
    return found == done.end() ? e : found->second;
  };
  for (const Expr& node : nodes) {
    Expr value = node;
    if (node.is(Kind::Log))
      value = logarithm(node, numbers);
    else if (node.is(Kind::Product) || node.is(Kind::Power))
      value = quotient(node, numbers);
    if (value == node) value = rebuild(node, replaced);
    if (value != node) done.emplace(node, value);
  }
  for (Expr& root : out) root = replaced(root);
  return out;
}

}  // namespace maupertuis
