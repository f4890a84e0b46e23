#include "fields/resolution.hpp"

#include "fields/lobatto.hpp"

#include <maupertuis/function_disks.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr int most_halvings = 24;    // of an element: 6e-8 of its width
constexpr int most_pieces = 4096;    // of an element
constexpr double settled = 0.125;    // change within a piece, of the function's size
constexpr double unresolved = 0.25;  // off from the polynomial, of the function's size

/// One function of x and parameters.
class Scan {
 public:
  Scan(Expr f, Expr x, const std::vector<Expr>& parameters, const std::vector<double>& values)
      : kernel_(build_function({{x}, parameters, {f}})), work_(kernel_), disks_(kernel_, values) {
    work_.set_parameters(values);
  }

  double at(double x) {
    double out = 0;
    work_.evaluate({&x, 1}, {&out, 1});
    return out;
  }

  /// The place of what the polynomials through the nodes do not follow; nothing where there is none.
  std::optional<double> find(double left, double width, int cells, const Lobatto& rule) {
    const auto points = static_cast<std::size_t>(rule.order) + 1;
    std::vector<double> nodes(points);
    size_ = 0;
    for (int e = 0; e < cells; ++e)
      for (std::size_t j = 0; j < points; ++j) size_ = std::max(size_, std::abs(at(node(left, width, e, rule.x[j]))));
    for (int e = 0; e < cells; ++e) {
      for (std::size_t j = 0; j < points; ++j) nodes[j] = at(node(left, width, e, rule.x[j]));
      if (const auto place = find_in(left + width * e, width, nodes, rule)) return place;
    }
    return std::nullopt;
  }

 private:
  static double node(double left, double width, int e, double xi) { return left + width * (e + 0.5 * (1 + xi)); }

  struct Piece {
    double middle, half;
    int halvings;
  };

  std::optional<double> find_in(double left, double width, const std::vector<double>& nodes, const Lobatto& rule) {
    std::vector<Piece> open{{left + width / 2, width / 2, 0}};
    std::vector<double> value, slope;
    for (int seen = 0; !open.empty() && seen < most_pieces; ++seen) {
      const Piece piece = open.back();
      open.pop_back();
      const double f = at(piece.middle);
      rule.at(2 * (piece.middle - left) / width - 1, value, slope);
      double polynomial = 0;
      for (std::size_t j = 0; j < nodes.size(); ++j) polynomial += value[j] * nodes[j];
      if (std::abs(f - polynomial) > unresolved * std::max(size_, std::abs(f))) return piece.middle;
      disks_.set_centre({&piece.middle, 1});
      disks_.evaluate({&piece.half, 1});
      if (disks_.reach(0) <= settled * size_ || piece.halvings == most_halvings) continue;
      for (const double side : {-0.5, 0.5})
        open.push_back({piece.middle + side * piece.half, piece.half / 2, piece.halvings + 1});
    }
    return std::nullopt;
  }

  FunctionKernel kernel_;
  FunctionWorkspace work_;
  FunctionDisks disks_;
  double size_ = 0;  // largest modulus at the nodes
};

bool stands_in(Expr symbol, Expr e) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::find(symbols.begin(), symbols.end(), symbol) != symbols.end();
}

}  // namespace

std::optional<Unresolved> unresolved_feature(const FieldEquations& equations, const PointForm& form, int cells,
                                             int order) {
  const FieldSystem& s = equations.system();
  Context& context = *s.context;
  const Expr x = s.space.front().symbol;
  std::vector<Expr> parameters;
  std::vector<double> values;
  Bindings known;
  for (const Parameter& p : equations.model->parameters) {
    parameters.push_back(p.symbol);
    values.push_back(p.si_value);
    known[p.symbol] = p.si_value;
  }
  const double left = evaluate(s.expanded(s.space.front().from), known);
  const double width = (evaluate(s.expanded(s.space.front().to), known) - left) / cells;
  const Lobatto rule(order);
  const auto look = [&](Expr f, bool of_start) -> std::optional<Unresolved> {
    if (!stands_in(x, f)) return std::nullopt;
    const auto place = Scan(f, x, parameters, values).find(left, width, cells, rule);
    return place ? std::optional(Unresolved{*place, width, of_start}) : std::nullopt;
  };
  for (const FieldStart& start : equations.model->start)
    if (const auto found = look(s.expanded(start.value), true)) return found;
  ExprMap fixed{{context.time(), context.number(0)}};
  const Expr number = context.number(Rational(618034, 1000000));  // any value of φ, φ', φ_x, φ_tx
  for (const Expr& input : form.inputs)
    if (input != x && input != context.time()) fixed.emplace(input, number);
  for (const auto* part : {&form.a, &form.g, &form.s})
    for (const Expr& f : *part)
      if (const auto found = look(substitute(f, fixed), false)) return found;
  return std::nullopt;
}

}  // namespace maupertuis
