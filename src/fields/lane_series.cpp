#include "fields/lane_series.hpp"

#include <maupertuis/kinds.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {

// The same instructions with wider vectors where the processor has them. Without contraction the numbers are the same.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define MAUP_LANES __attribute__((target_clones("arch=x86-64-v3", "default"), optimize("O3")))
#else
#define MAUP_LANES
#endif

namespace {

/// out += factor · a · b
MAUP_LANES void add_product(double* __restrict out, const double* __restrict a, const double* __restrict b, double factor,
                            std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] += factor * (a[i] * b[i]);
}
MAUP_LANES void add_to(double* __restrict out, const double* __restrict a, double factor, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) out[i] += factor * a[i];
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
  std::unordered_map<Expr, std::size_t, ExprHash> done;
  using Op = LaneSeries::Op;

  std::size_t push(LaneSeries::Instruction i) {
    out.code_.push_back(i);
    return out.code_.size() - 1;
  }
  bool constant(std::size_t i) const { return out.code_[i].constant; }
  std::size_t number(double value) { return push({Op::Constant, 0, 0, value, true}); }
  std::size_t binary(Op op, std::size_t a, std::size_t b) { return push({op, a, b, 0, constant(a) && constant(b)}); }
  std::size_t unary(Op op, std::size_t a, double n = 0) { return push({op, a, 0, n, constant(a)}); }
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
      const std::size_t base = visit(e[0]);
      if (!e[1].is_number()) {
        trouble = "a power with a variable exponent";
        return base;
      }
      const Rational& r = e[1].number();
      if (r == Rational(2)) return binary(Op::Multiply, base, base);
      return unary(Op::Power, base, r.to_double());
    }
    const bool sum = e.is(Kind::Sum);
    std::size_t total = visit(e[0]);
    for (std::size_t i = 1; i < e.size(); ++i) total = combine(sum, total, visit(e[i]));
    return total;
  }
  std::size_t combine(bool sum, std::size_t a, std::size_t b) {
    if (sum) return binary(Op::Add, a, b);
    if (out.code_[a].op == Op::Constant) return unary(Op::Scale, b, out.code_[a].number);
    if (out.code_[b].op == Op::Constant) return unary(Op::Scale, a, out.code_[b].number);
    return binary(Op::Multiply, a, b);
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
    if (kind == Kind::Tanh) {
      const std::size_t s = pair(Op::Sinh, Op::Sinh, Op::Cosh, a);
      return binary(Op::Multiply, s, unary(Op::Power, out.code_[s].b, -1));
    }
    trouble = std::string(name_of(kind));
    return a;
  }
};

std::optional<LaneSeries> LaneSeries::make(const std::vector<Expr>& roots, const std::vector<Expr>& inputs,
                                           const std::unordered_map<Expr, double, ExprHash>& constants,
                                           std::string& trouble) {
  LaneSeries out;
  LaneCompiler compiler{out, inputs, constants, trouble, {}};
  for (const Expr& input : inputs) {
    out.inputs_.push_back(out.code_.size());
    compiler.done.emplace(input, compiler.push({Op::Input, 0, 0, 0, false}));
  }
  for (const Expr& root : roots) out.roots_.push_back(compiler.visit(root));
  return trouble.empty() ? std::optional(std::move(out)) : std::nullopt;
}

void LaneSeries::resize(std::size_t lanes, std::size_t orders) {
  lanes_ = lanes, orders_ = orders;
  data_.assign(code_.size() * lanes * orders, 0);
  for (std::size_t i = 0; i < code_.size(); ++i)
    if (code_[i].op == Op::Constant) std::fill_n(at(i, 0), lanes, code_[i].number);
}

void LaneSeries::first(std::size_t i) {
  const Instruction& x = code_[i];
  double* out = at(i, 0);
  const double* a = at(x.a, 0);
  const double* b = at(x.b, 0);
  for (std::size_t n = 0; n < lanes_; ++n) switch (x.op) {
      case Op::Input:
      case Op::Constant:
        return;
      case Op::Add:
        out[n] = a[n] + b[n];
        break;
      case Op::Multiply:
        out[n] = a[n] * b[n];
        break;
      case Op::Scale:
        out[n] = x.number * a[n];
        break;
      case Op::Power:
        out[n] = x.number == -1 ? 1 / a[n] : x.number == 0.5 ? std::sqrt(a[n]) : std::pow(a[n], x.number);
        break;
      case Op::Exp:
        out[n] = std::exp(a[n]);
        break;
      case Op::Log:
        out[n] = std::log(a[n]);
        break;
      case Op::Sin:
        out[n] = std::sin(a[n]);
        break;
      case Op::Cos:
        out[n] = std::cos(a[n]);
        break;
      case Op::Sinh:
        out[n] = std::sinh(a[n]);
        break;
      case Op::Cosh:
        out[n] = std::cosh(a[n]);
        break;
    }
}

/// The recurrences of the series: f' = x' g for f = sin x, g = cos x; a f' = r f a' for f = a^r; …
void LaneSeries::higher(std::size_t i, std::size_t k) {
  const Instruction& x = code_[i];
  if (x.op == Op::Input || x.op == Op::Constant) return;
  double* out = at(i, k);
  const double dk = static_cast<double>(k);
  if (x.op == Op::Add) {
    set_scaled(out, at(x.a, k), 1, lanes_);
    return add_to(out, at(x.b, k), 1, lanes_);
  }
  if (x.op == Op::Scale) return set_scaled(out, at(x.a, k), x.number, lanes_);
  std::fill_n(out, lanes_, 0.0);
  if (x.constant) return;
  switch (x.op) {
    case Op::Multiply:
      for (std::size_t j = 0; j <= k; ++j) add_product(out, at(x.a, j), at(x.b, k - j), 1, lanes_);
      return;
    case Op::Power:
      for (std::size_t j = 1; j <= k; ++j)
        add_product(out, at(x.a, j), at(i, k - j), (x.number * static_cast<double>(j) - static_cast<double>(k - j)) / dk, lanes_);
      return divide_by(out, at(x.a, 0), lanes_);
    case Op::Exp:
      for (std::size_t j = 1; j <= k; ++j) add_product(out, at(x.a, j), at(i, k - j), static_cast<double>(j) / dk, lanes_);
      return;
    case Op::Log:
      set_scaled(out, at(x.a, k), 1, lanes_);
      for (std::size_t j = 1; j < k; ++j) add_product(out, at(i, j), at(x.a, k - j), -static_cast<double>(j) / dk, lanes_);
      return divide_by(out, at(x.a, 0), lanes_);
    case Op::Sin:
    case Op::Cos:
    case Op::Sinh:
    case Op::Cosh: {
      const double sign = x.op == Op::Cos ? -1 : 1;
      for (std::size_t j = 1; j <= k; ++j) add_product(out, at(x.a, j), at(x.b, k - j), sign * static_cast<double>(j) / dk, lanes_);
      return;
    }
    case Op::Input:
    case Op::Constant:
    case Op::Add:
    case Op::Scale:
      return;
  }
}

void LaneSeries::advance(std::size_t order) {
  for (std::size_t i = 0; i < code_.size(); ++i) order == 0 ? first(i) : higher(i, order);
}

}  // namespace maupertuis
