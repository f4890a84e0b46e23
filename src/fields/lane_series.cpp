#include "fields/lane_series.hpp"

#include "fields/lane_sines.hpp"

#include <maupertuis/kinds.hpp>

#include "fields/wide_lanes.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {

namespace {

constexpr std::size_t kBlock = 2 * kWide;  // lanes that are summed in registers

/// out = Σ_j factor_j a_j b_{k−j} for j = from … to; coefficients stand `stride` apart.
MAUP_LANES void convolve(double* __restrict out, const double* a, const double* b, const double* factor,
                         std::size_t from, std::size_t to, std::size_t k, std::size_t stride, std::size_t n) {
  std::size_t i = 0;
  for (; i + kBlock <= n; i += kBlock) {
    Lanes first = {}, second = {};
    for (std::size_t j = from; j <= to; ++j) {
      const double* x = a + j * stride + i;
      const double* y = b + (k - j) * stride + i;
      first += factor[j] * (lanes_at(x) * lanes_at(y));
      second += factor[j] * (lanes_at(x + kWide) * lanes_at(y + kWide));
    }
    lanes_at(out + i) = first;
    lanes_at(out + i + kWide) = second;
  }
  for (; i < n; ++i) {
    double sum = 0;
    for (std::size_t j = from; j <= to; ++j) sum += factor[j] * (a[j * stride + i] * b[(k - j) * stride + i]);
    out[i] = sum;
  }
}
MAUP_LANES void add_to(double* __restrict out, const double* __restrict a, double factor, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] += factor * a[i];
}
MAUP_LANES void sum_of_two(double* __restrict out, const double* __restrict a, const double* __restrict b,
                           std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] = a[i] + b[i];
}
MAUP_LANES void set_scaled(double* __restrict out, const double* __restrict a, double factor, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] = factor * a[i];
}
MAUP_LANES void divide_by(double* __restrict out, const double* __restrict a, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] /= a[i];
}

}  // namespace

struct LaneCompiler {
  LaneSeries& out;
  const std::vector<Expr>& inputs;
  const std::unordered_map<Expr, double, ExprHash>& constants;
  std::string& trouble;
  std::unordered_map<Expr, std::size_t, ExprHash> done, secants;
  using Op = LaneSeries::Op;

  std::size_t push(LaneSeries::Instruction i) {
    out.code_.push_back(i);
    return out.code_.size() - 1;
  }
  bool constant(std::size_t i) const { return out.code_[i].constant; }
  std::size_t number(double value) { return push({Op::Constant, 0, 0, value, true}); }
  bool is_number(std::size_t i) const { return out.code_[i].op == Op::Constant; }
  std::size_t binary(Op op, std::size_t a, std::size_t b) {
    const double x = out.code_[a].number, y = out.code_[b].number;
    if (is_number(a) && is_number(b)) return number(op == Op::Add ? x + y : x * y);
    if (op == Op::Add && ((is_number(a) && x == 0) || (is_number(b) && y == 0))) return is_number(a) ? b : a;
    return push({op, a, b, 0, constant(a) && constant(b)});
  }
  std::size_t unary(Op op, std::size_t a, double n = 0) {
    const double x = out.code_[a].number;
    if (is_number(a) && op == Op::Scale) return number(n * x);
    if (is_number(a) && op == Op::Power) return number(std::pow(x, n));
    return push({op, a, 0, n, constant(a)});
  }
  std::size_t pair(Op wanted, Op first, Op second, std::size_t a) {
    const std::size_t s = unary(first, a);
    const std::size_t c = unary(second, a);
    out.code_[s].b = c, out.code_[c].b = s;
    return wanted == first ? s : c;
  }

  std::size_t visit(Expr e) {
    if (const auto found = done.find(e); found != done.end()) return found->second;
    const std::size_t i = compile(e);
    done.emplace(e, i);
    return i;
  }
  std::size_t compile(Expr e) {
    if (const auto known = constants.find(e); known != constants.end()) return number(known->second);
    switch (family_of(e.kind())) {
      case Family::Leaf:
        return leaf(e);
      case Family::Algebra:
        return algebra(e);
      case Family::Function:
        return function(e);
      case Family::TimeDerivative:
      case Family::Angle:
      case Family::Switch:
      case Family::Extremum:
      case Family::Piecewise:
      case Family::Comparison:
      case Family::Logic:
        break;
    }
    trouble = std::string(name_of(e.kind()));
    return number(0);
  }
  std::size_t leaf(Expr e) {
    if (e.is(Kind::Number)) return number(e.number().to_double());
    if (e.is(Kind::Pi)) return number(3.14159265358979323846);
    trouble = e.name();
    return number(0);
  }
  std::size_t algebra(Expr e) {
    if (e.is(Kind::Power)) {
      if (!e[1].is_number()) {
        trouble = "a power with a variable exponent";
        return visit(e[0]);
      }
      const Rational& r = e[1].number();
      const double n = r.to_double();
      if (e[0].is(Kind::Cosh) && n < 0 && n == std::floor(n) && -n <= most_factors)
        return whole_power(hyperbolic_secant(e[0][0]), static_cast<unsigned>(-n));
      const std::size_t base = visit(e[0]);
      // The recurrence of powers divides by the base, which a field may have as 0.
      if (std::abs(n) == std::floor(std::abs(n)) && std::abs(n) <= most_factors) {
        const std::size_t product = whole_power(base, static_cast<unsigned>(std::abs(n)));
        return n < 0 ? unary(Op::Power, product, -1) : product;
      }
      return unary(Op::Power, base, n);
    }
    const bool sum = e.is(Kind::Sum);
    std::size_t total = visit(e[0]);
    for (std::size_t i = 1; i < e.size(); ++i) total = combine(sum, total, visit(e[i]));
    return total;
  }
  static constexpr double most_factors = 64;
  std::size_t whole_power(std::size_t base, unsigned n) {
    if (n == 0) return number(1);
    if (n == 1) return base;
    const std::size_t root = whole_power(base, n / 2), square = binary(Op::Multiply, root, root);
    return n % 2 ? binary(Op::Multiply, square, base) : square;
  }
  std::size_t combine(bool sum, std::size_t a, std::size_t b) {
    if (sum) return binary(Op::Add, a, b);
    if (out.code_[a].op == Op::Constant) return unary(Op::Scale, b, out.code_[a].number);
    if (out.code_[b].op == Op::Constant) return unary(Op::Scale, a, out.code_[b].number);
    return binary(Op::Multiply, a, b);
  }
  /// tanh u and its slope 1/cosh²u have values where cosh u has none: a pair of their own.
  std::size_t hyperbolic_tangent(Expr u) {
    const Expr tanh = apply(Kind::Tanh, u);
    if (const auto found = done.find(tanh); found != done.end()) return found->second;
    const std::size_t a = visit(u), t = unary(Op::Tanh, a), slope = unary(Op::SlopeOfTanh, t);
    out.code_[t].b = slope, out.code_[slope].b = t;
    done.emplace(tanh, t);
    return t;
  }
  /// 1/cosh u, with f' = −f tanh u u'.
  std::size_t hyperbolic_secant(Expr u) {
    const auto [place, is_new] = secants.try_emplace(u, 0);
    if (!is_new) return place->second;
    const std::size_t a = visit(u), t = hyperbolic_tangent(u), f = unary(Op::Sech, a);
    out.code_[f].b = push({Op::Multiply, f, t, 0, constant(a)});
    return secants[u] = f;
  }
  std::size_t function(Expr e) {
    const std::size_t a = visit(e[0]);
    const Kind kind = e.kind();
    const auto both = [&](Op first, Op second, Kind f, Kind s, bool wanted_first) {
      const std::size_t i = pair(wanted_first ? first : second, first, second, a);
      const Expr argument = e[0];
      done.emplace(apply(wanted_first ? s : f, argument), out.code_[i].b);
      return i;
    };
    if (kind == Kind::Sin || kind == Kind::Cos) return both(Op::Sin, Op::Cos, Kind::Sin, Kind::Cos, kind == Kind::Sin);
    if (kind == Kind::Sinh || kind == Kind::Cosh)
      return both(Op::Sinh, Op::Cosh, Kind::Sinh, Kind::Cosh, kind == Kind::Sinh);
    if (kind == Kind::Exp) return unary(Op::Exp, a);
    if (kind == Kind::Log) return unary(Op::Log, a);
    if (kind == Kind::Tanh) return hyperbolic_tangent(e[0]);
    trouble = std::string(name_of(kind));
    return a;
  }
};

std::optional<LaneSeries> LaneSeries::make(const std::vector<Expr>& roots, const std::vector<Expr>& inputs,
                                           const std::unordered_map<Expr, double, ExprHash>& constants,
                                           std::string& trouble) {
  LaneSeries out;
  LaneCompiler compiler{out, inputs, constants, trouble, {}, {}};
  for (const Expr& input : inputs) {
    out.inputs_.push_back(out.code_.size());
    compiler.done.emplace(input, compiler.push({Op::Input, 0, 0, 0, false}));
  }
  for (const Expr& root : roots) out.roots_.push_back(compiler.visit(root));
  return trouble.empty() ? std::optional(std::move(out)) : std::nullopt;
}

void LaneSeries::keep(const std::vector<std::size_t>& inputs, std::size_t roots) {
  for (Instruction& x : code_) x.kept = x.op == Op::Constant;
  for (const std::size_t i : inputs) code_[inputs_[i]].kept = true;
  for (std::size_t i = 0; i < roots; ++i) code_[roots_[i]].kept = true;
  for (std::size_t i = 0; i < code_.size(); ++i) {
    const Instruction x = code_[i];
    if (x.op == Op::Input || x.op == Op::Constant || x.op == Op::Add || x.op == Op::Scale) continue;
    code_[x.a].kept = true;
    if (x.op == Op::Multiply || x.op >= Op::Sin) code_[x.b].kept = true;
    if (x.op != Op::Multiply) code_[i].kept = true;
  }
}

double LaneSeries::bytes(double lanes, std::size_t orders) const {
  double pasts = 0;
  for (std::size_t i = 0; i < code_.size(); ++i) pasts += own_past(i) ? 1 : 0;
  return pasts * lanes * static_cast<double>(orders * sizeof(double));
}

void LaneSeries::resize(std::size_t lanes, std::size_t orders, std::size_t blocks) {
  lanes_ = lanes, orders_ = orders, block_ = 0, block_size_ = 0;
  std::size_t shared = 0;
  for (Instruction& x : code_)
    if (!x.kept || x.op == Op::Constant) x.place = shared, shared += lanes * (x.kept ? orders : 1);
  for (std::size_t i = 0; i < code_.size(); ++i)
    if (own_past(i)) code_[i].place = shared + block_size_, block_size_ += lanes * orders;
  data_.assign(shared + blocks * block_size_, 0);
  for (std::size_t i = 0; i < code_.size(); ++i)
    if (code_[i].op == Op::Constant) std::fill_n(at(i, 0), lanes, code_[i].number);
}

void LaneSeries::first(std::size_t i) {
  const Instruction& x = code_[i];
  double* out = at(i, 0);
  const double* a = at(x.a, 0);
  const double* b = at(x.b, 0);
  const auto each = [&](auto f) {
    for (std::size_t n = 0; n < lanes_; ++n) out[n] = f(a[n]);
  };
  switch (x.op) {
    case Op::Input:
    case Op::Constant:
      return;
    case Op::Add:
      return sum_of_two(out, a, b, lanes_);
    case Op::Multiply:
      for (std::size_t n = 0; n < lanes_; ++n) out[n] = a[n] * b[n];
      return;
    case Op::Scale:
      return set_scaled(out, a, x.number, lanes_);
    case Op::Power:
      if (x.number == -1) return each([](double v) { return 1 / v; });
      if (x.number == 0.5) return each([](double v) { return std::sqrt(v); });
      return each([&](double v) { return std::pow(v, x.number); });
    case Op::Exp:
      return each([](double v) { return std::exp(v); });
    case Op::Log:
      return each([](double v) { return std::log(v); });
    case Op::Sin:
      return set_sines(out, a, lanes_, false);
    case Op::Cos:
      return set_sines(out, a, lanes_, true);
    case Op::Sinh:
      return each([](double v) { return std::sinh(v); });
    case Op::Cosh:
      return each([](double v) { return std::cosh(v); });
    case Op::Tanh: {
      double* slope = at(x.b, 0);
      for (std::size_t n = 0; n < lanes_; ++n) slope[n] = 1 / (std::cosh(a[n]) * std::cosh(a[n]));
      return each([](double v) { return std::tanh(v); });
    }
    case Op::SlopeOfTanh:  // with its tanh, from the argument, which loses no digits
      return;
    case Op::Sech:
      return each([](double v) { return 1 / std::cosh(v); });
  }
}

/// The recurrences of the series: f' = x' g for f = sin x, g = cos x; a f' = r f a' for f = a^r; …
void LaneSeries::higher(std::size_t i, std::size_t k) {
  const Instruction& x = code_[i];
  if (x.op == Op::Input || x.op == Op::Constant) return;
  double* out = at(i, k);
  if (x.constant) return std::fill_n(out, lanes_, 0.0), void();
  std::vector<double>& factor = factors_;
  factor.assign(k + 1, 1);
  const double dk = static_cast<double>(k);
  const auto sum = [&](std::size_t b, std::size_t from, std::size_t to) {
    convolve(out, at(x.a, 0), at(b, 0), factor.data(), from, to, k, lanes_, lanes_);
  };
  const auto shares = [&](double sign) {
    for (std::size_t j = 1; j <= k; ++j) factor[j] = sign * static_cast<double>(j) / dk;
  };
  switch (x.op) {
    case Op::Add:
      return sum_of_two(out, at(x.a, k), at(x.b, k), lanes_);
    case Op::Scale:
      return set_scaled(out, at(x.a, k), x.number, lanes_);
    case Op::Multiply:
      if (code_[x.a].constant) return sum(x.b, 0, 0);
      return code_[x.b].constant ? sum(x.b, k, k) : sum(x.b, 0, k);
    case Op::Power:
      for (std::size_t j = 1; j <= k; ++j)
        factor[j] = (x.number * static_cast<double>(j) - static_cast<double>(k - j)) / dk;
      sum(i, 1, k);
      return divide_by(out, at(x.a, 0), lanes_);
    case Op::Exp:
      shares(1);
      return sum(i, 1, k);
    case Op::Log:
      for (std::size_t j = 1; j < k; ++j) factor[j] = -static_cast<double>(k - j) / dk;
      sum(i, 1, k - 1);
      add_to(out, at(x.a, k), 1, lanes_);
      return divide_by(out, at(x.a, 0), lanes_);
    case Op::Sin:
    case Op::Sinh:
    case Op::Cosh:
    case Op::Tanh:
      shares(1);
      return sum(x.b, 1, k);
    case Op::SlopeOfTanh:
      shares(-2);
      return sum(x.b, 1, k);
    case Op::Cos:
    case Op::Sech:
      shares(-1);
      return sum(x.b, 1, k);
    case Op::Input:
    case Op::Constant:
      return;
  }
}

void LaneSeries::advance(std::size_t order) {
  for (std::size_t i = 0; i < code_.size(); ++i) order == 0 ? first(i) : higher(i, order);
}

}  // namespace maupertuis
