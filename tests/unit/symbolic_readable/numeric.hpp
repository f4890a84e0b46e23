#pragma once
#include <maupertuis/functions.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <unordered_map>

namespace maupertuis::test {

/// A point of random values for symbols, and the plainest possible evaluation: it shares no code with the library's.
class Point {
 public:
  explicit Point(unsigned seed) : random_(seed) {}

  double operator()(Expr e) {
    if (const auto known = values_.find(e.id()); known != values_.end()) return known->second;
    const double value = compute(e);
    values_.emplace(e.id(), value);
    return value;
  }

 private:
  double compute(Expr e) {
    const auto arg = [&](std::size_t i) { return (*this)(e[i]); };
    if (e.is_number()) return e.number().to_double();
    if (e.is(Kind::Pi)) return std::acos(-1.0);
    if (e.is_symbol()) return std::uniform_real_distribution<double>(0.3, 1.7)(random_);
    if (e.is(Kind::Sum)) {
      double s = 0;
      for (std::size_t i = 0; i < e.size(); ++i) s += arg(i);
      return s;
    }
    if (e.is(Kind::Product)) {
      double p = 1;
      for (std::size_t i = 0; i < e.size(); ++i) p *= arg(i);
      return p;
    }
    if (e.is(Kind::Power)) return std::pow(arg(0), arg(1));
    if (is_function(e.kind())) return functions::value(e.kind(), arg(0));
    if (e.is(Kind::Abs)) return std::abs(arg(0));
    if (e.is(Kind::Sign)) return arg(0) > 0 ? 1 : arg(0) < 0 ? -1 : 0;
    if (e.is(Kind::Step)) return arg(0) >= 0 ? 1 : 0;
    if (e.is(Kind::Min)) return std::min(arg(0), arg(1));
    if (e.is(Kind::Max)) return std::max(arg(0), arg(1));
    if (e.is(Kind::Less)) return arg(0) < arg(1);
    if (e.is(Kind::LessEqual)) return arg(0) <= arg(1);
    if (!e.is(Kind::Piecewise)) return std::nan("");
    for (std::size_t i = 0; i + 1 < e.size(); i += 2)
      if (arg(i) != 0) return arg(i + 1);
    return arg(e.size() - 1);
  }

  std::mt19937 random_;
  std::unordered_map<NodeId, double> values_;
};

/// Gives every symbol of both sides the same value, then compares. `scale` is the size of the largest term met.
inline bool agree(Expr a, Expr b, unsigned seed, double tolerance = 1e-8) {
  Point point(seed);
  const Expr both[] = {a, b};
  for (const Expr& s : symbols_of(both)) point(s);
  const double x = point(a), y = point(b);
  if (!std::isfinite(x) || std::abs(x) > 1e12) return true;  // no test at this point
  return std::abs(x - y) <= tolerance * std::max({1.0, std::abs(x), std::abs(y)});
}

}  // namespace maupertuis::test
