#include "kernel/function/program.hpp"

#include <maupertuis/function_disks.hpp>
#include <maupertuis/kinds.hpp>
#include <maupertuis/require.hpp>
#include <maupertuis/slopes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace maupertuis {

/// Of a value on the disk: its number at the centre, reach, tail, and low ≤ |f| ≤ high.
struct DiskBounds {
  double centre = 0, reach = 0, tail = 0, low = 0, high = 0;
};

namespace {

using Bounds = DiskBounds;
using straight::Node;
using straight::Value;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The smaller one; what is not a number bounds nothing.
double smaller(double x, double y) { return x < y || std::isnan(y) ? x : y; }
double bound(double x) { return std::isnan(x) ? infinity : x; }
double away(double x) { return std::max(0.0, x); }

Bounds undecided(double centre) { return {centre, infinity, infinity, 0, infinity}; }
Bounds constant(double centre) { return {centre, 0, 0, std::abs(centre), std::abs(centre)}; }

/// What the centre and its reach say as well.
Bounds within_reach(Bounds b) {
  b.reach = bound(b.reach), b.tail = bound(b.tail);
  const double c = std::abs(b.centre);
  b.low = std::max(std::isnan(b.low) ? 0.0 : b.low, std::isnan(c - b.reach) ? 0.0 : away(c - b.reach));
  b.high = smaller(c + b.reach, bound(b.high));
  return b;
}

Bounds sum(const Bounds& x, const Bounds& y) {
  return within_reach({x.centre + y.centre, x.reach + y.reach, x.tail + y.tail,
                       away(std::max(x.low - y.high, y.low - x.high)), x.high + y.high});
}

/// A constant factor leaves a polynomial what it is.
Bounds product(const Bounds& x, const Bounds& y) {
  const double u = std::abs(x.centre), v = std::abs(y.centre), centre = x.centre * y.centre;
  const auto scaled = [&](double size, const Bounds& b) {
    const auto times = [size](double r) { return size == 0 ? 0.0 : size * r; };
    return within_reach({centre, times(b.reach), times(b.tail), times(b.low), times(b.high)});
  };
  if (x.reach == 0) return scaled(u, y);
  if (y.reach == 0) return scaled(v, x);
  const double reach = smaller(u * y.reach + v * x.reach + x.reach * y.reach, x.high * y.high + u * v);
  return within_reach({centre, reach, reach, x.low * y.low, x.high * y.high});
}

/// a/b − a₀/b₀ = ((a − a₀) − (a₀/b₀)(b − b₀))/b
Bounds quotient(const Bounds& x, const Bounds& y) {
  const double centre = x.centre / y.centre, ratio = std::abs(centre), high = x.high / y.low;
  if (!(y.low > 0)) return undecided(centre);
  if (y.reach == 0) return within_reach({centre, x.reach / y.low, x.tail / y.low, x.low / y.low, high});
  const double reach = smaller(high + ratio, (x.reach + ratio * y.reach) / y.low);
  return within_reach({centre, reach, reach, x.low / y.high, high});
}

/// f' = c w^{c−1}, largest where |w| is largest or smallest; a disk about 0 is one of whole positive powers alone.
Bounds power(const Bounds& x, double c, double centre) {
  const bool whole = c >= 0 && c == std::nearbyint(c);
  if (x.reach == 0) return constant(centre);
  if (!whole && !(x.low > 0)) return undecided(centre);
  const double slope = std::abs(c) * std::pow(c >= 1 ? x.high : x.low, c - 1);
  const double one = std::pow(x.low, c), other = std::pow(x.high, c), high = std::max(one, other);
  const double reach = smaller(high + std::abs(centre), slope * x.reach);
  return {centre, reach, reach, std::min(one, other), high};
}

/// |dφ| ≤ (|dx| + |dy|)/|x ± iy|
Bounds angle(const Bounds& x, const Bounds& y, double centre) {
  const double both = x.reach + y.reach, far = std::hypot(x.centre, y.centre) - both;
  if (both == 0) return constant(centre);
  const double reach = far > 0 ? both / far : infinity;
  return {centre, reach, reach, 0, infinity};
}

/// Mostly |f(w) − f(w₀)| ≤ |w − w₀| sup |f′|, the supremum over the disk of w.
Bounds function(Kind kind, const Bounds& x, double centre) {
  const double w = x.centre, size = std::abs(w), d = x.reach;
  if (d == 0) return constant(centre);
  if (!(d < infinity)) return undecided(centre);
  const auto within = [&](double reach, double high, double low = 0) {
    return Bounds{centre, reach, reach, low, high};
  };
  const double cos = std::abs(std::cos(w)), sin = std::abs(std::sin(w));
  // sin w − sin w₀ = sin w₀ (cos z − 1) + cos w₀ sin z with |z| ≤ d, |cos z − 1| ≤ ½ d sinh d
  if (kind == Kind::Sin) return within(sin * 0.5 * d * std::sinh(d) + cos * std::sinh(d), std::cosh(d));
  if (kind == Kind::Cos) return within(cos * 0.5 * d * std::sinh(d) + sin * std::sinh(d), std::cosh(d));
  if (kind == Kind::Sinh || kind == Kind::Cosh) {  // both lie between sinh and cosh of |Re w|
    const double most = std::cosh(size + d);
    return within(smaller(most + std::abs(centre), d * most), most, size > d ? std::sinh(size - d) : 0);
  }
  if (kind == Kind::Exp) return within(std::exp(w + d) * std::min(1.0, d), std::exp(w + d), std::exp(w - d));
  return within(d * largest_slope(kind, w, d, x.low), infinity);
}

/// Where the disk decides, the branch in force is the function.
Bounds call(Kind kind, const Bounds& x, const Bounds& y, double centre) {
  if (is_function(kind)) return function(kind, x, centre);
  if (kind == Kind::Atan2) return angle(x, y, centre);
  if (kind == Kind::Power) return y.reach > 0 ? undecided(centre) : power(x, y.centre, centre);
  const auto decides = [](double distance, double reach) { return std::abs(distance) > reach || reach == 0; };
  const double both = x.reach + y.reach, difference = x.centre - y.centre;
  const auto with_centre = [centre](Bounds b) {
    b.centre = centre;
    return b;
  };
  if (kind == Kind::Abs) return decides(x.centre, x.reach) ? with_centre(x) : undecided(centre);
  if (kind == Kind::Sign || kind == Kind::Step)
    return decides(x.centre, x.reach) ? constant(centre) : undecided(centre);
  if (kind == Kind::Less || kind == Kind::LessEqual)
    return decides(difference, both) ? constant(centre) : undecided(centre);
  if (kind == Kind::And || kind == Kind::Or) return both == 0 ? constant(centre) : undecided(centre);
  if (kind != Kind::Min && kind != Kind::Max) throw unknown_kind(kind, "the bounds on a disk");
  if (!decides(difference, both)) return undecided(centre);
  return with_centre((difference < 0) == (kind == Kind::Min) ? x : y);
}

/// Outputs are the values of all nodes.
straight::StraightLine with_every_value(straight::StraightLine line) {
  line.stores.clear();
  for (Value v = 0; v < line.nodes.size(); ++v) line.stores.push_back({v, ValueArray, v});
  return line;
}

}  // namespace

struct FunctionDisks::Impl {
  Impl(const FunctionKernel& k, std::span<const double> parameters)
      : kernel(k),
        line(kernel.program().line),
        every_value(with_every_value(line), seldom_arrays),
        centre(line.nodes.size()),
        bounds(line.nodes.size()) {
    every_value.set(unused, parameters.data(), unused);
  }

  Bounds at(Value v) const { return v == straight::none ? constant(1) : bounds[v]; }

  Bounds term_of(const straight::Term& term) const {
    Bounds out = constant(term.factor);
    bool is_one = term.factor == 1;
    for (const Value v : {term.a, term.b, term.c})
      if (v != straight::none) out = std::exchange(is_one, false) ? bounds[v] : product(out, bounds[v]);
    return out;
  }

  Bounds sum_of(const Node& node) const {
    Bounds out;
    for (std::uint32_t t = node.first; t < node.last; ++t)
      out = t == node.first ? term_of(line.terms[t]) : sum(out, term_of(line.terms[t]));
    if (node.a != straight::none) out = product(out, at(node.a));
    return node.b == straight::none ? out : quotient(out, at(node.b));
  }

  Bounds result(Value v, std::span<const double> reach) const {
    const Node& node = line.nodes[v];
    switch (node.what) {
      case Node::Literal:
        return constant(centre[v]);
      case Node::Given: {
        const double d = node.array == InputArray ? reach[node.index] : 0, c = std::abs(centre[v]);
        return {centre[v], d, 0, away(c - d), c + d};
      }
      case Node::Sum:
        return sum_of(node);
      case Node::Root:
        return power(at(node.a), 0.5, centre[v]);
      case Node::Call:
        return call(node.function, at(node.a), at(node.b), centre[v]);
      case Node::Chosen:
        return at(node.a).reach > 0 ? undecided(centre[v]) : centre[node.a] != 0 ? at(node.b) : at(node.c);
      case Node::Magnitudes:
      case Node::Larger:
      case Node::Angles:
      case Node::Sine:
      case Node::Cosine:
      case Node::Unit:
      case Node::Wide:
      case Node::Lane:
      case Node::Gather:
        break;
    }
    throw std::logic_error("a disk met a node that has no bounds; please report");
  }

  static constexpr const double* unused = nullptr;
  FunctionKernel kernel;
  const straight::StraightLine& line;
  straight::Evaluator every_value;
  std::vector<double> centre;  // [nodes]
  std::vector<Bounds> bounds;  // [nodes]
};

FunctionDisks::FunctionDisks(const FunctionKernel& kernel, std::span<const double> parameters)
    : impl_(std::make_unique<Impl>(kernel, parameters)) {
  MAUP_REQUIRE(parameters.size() == kernel.parameters());
}
FunctionDisks::~FunctionDisks() = default;
FunctionDisks::FunctionDisks(FunctionDisks&&) noexcept = default;

void FunctionDisks::set_centre(std::span<const double> inputs) {
  impl_->every_value(inputs.data(), impl_->unused, impl_->centre.data());
}

double FunctionDisks::reach(std::size_t output) const { return impl_->bounds[impl_->line.stores[output].value].reach; }
double FunctionDisks::tail(std::size_t output) const { return impl_->bounds[impl_->line.stores[output].value].tail; }

void FunctionDisks::evaluate(std::span<const double> reach) {
  Impl& s = *impl_;
  for (Value v = 0; v < s.bounds.size(); ++v) s.bounds[v] = within_reach(s.result(v, reach));
}

}  // namespace maupertuis
