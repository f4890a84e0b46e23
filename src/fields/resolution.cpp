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

using Place = std::vector<double>;  // [space variables]

/// The elements of a mesh with their nodes.
struct Elements {
  const Lobatto& rule;
  Place from, width;
  std::vector<int> cells;

  std::size_t directions() const { return cells.size(); }
  std::size_t count() const {
    return counted([](int n) { return n; });
  }
  std::size_t nodes() const {
    return counted([this](int) { return rule.order + 1; });
  }
  Place corner(std::size_t element) const {
    Place out = from;
    for (std::size_t i = 0; i < directions(); element /= static_cast<std::size_t>(cells[i++]))
      out[i] += width[i] * static_cast<double>(element % static_cast<std::size_t>(cells[i]));
    return out;
  }
  Place node(const Place& corner, std::size_t n) const {
    Place out = corner;
    for (std::size_t i = 0; i < directions(); ++i, n /= rule.x.size())
      out[i] += width[i] * 0.5 * (1 + rule.x[n % rule.x.size()]);
    return out;
  }
  /// The polynomial through the values at the nodes.
  double between(const std::vector<double>& values, const Place& corner, const Place& at) const {
    std::vector<std::vector<double>> factor(directions());
    std::vector<double> slope;
    for (std::size_t i = 0; i < directions(); ++i) rule.at(2 * (at[i] - corner[i]) / width[i] - 1, factor[i], slope);
    double sum = 0;
    for (std::size_t n = 0; n < values.size(); ++n) {
      double product = values[n];
      for (std::size_t i = 0, rest = n; i < directions(); ++i, rest /= rule.x.size())
        product *= factor[i][rest % rule.x.size()];
      sum += product;
    }
    return sum;
  }

 private:
  template <class F>
  std::size_t counted(F&& f) const {
    std::size_t out = 1;
    for (const int n : cells) out *= static_cast<std::size_t>(f(n));
    return out;
  }
};

/// One function of places and parameters.
class Scan {
 public:
  Scan(Expr f, const std::vector<Expr>& x, const std::vector<Expr>& parameters, const std::vector<double>& values)
      : kernel_(build_function({x, parameters, {f}})), work_(kernel_), disks_(kernel_, values) {
    work_.set_parameters(values);
  }

  /// From now on a value that is no number is something found too.
  Scan& with_poles() { return poles_ = true, *this; }

  /// The largest distance from these polynomials beside the largest value, at places between the nodes.
  double left_out(const Elements& mesh) {
    constexpr std::size_t looks = 13;  // in an element, along each direction
    std::size_t in_all = 1;
    for (std::size_t i = 0; i < mesh.directions(); ++i) in_all *= looks;
    double worst = 0, size = 0;
    for (std::size_t e = 0; e < mesh.count(); ++e) {
      const Place corner = mesh.corner(e);
      const std::vector<double>& nodes = values_at_nodes(mesh, corner);
      for (std::size_t k = 0; k < in_all; ++k) {
        Place x = corner;
        for (std::size_t i = 0, rest = k; i < x.size(); ++i, rest /= looks)
          x[i] += mesh.width[i] * (static_cast<double>(rest % looks) + 0.5) / looks;
        const double f = at(x);
        size = std::max(size, std::abs(f));
        worst = std::max(worst, std::abs(f - mesh.between(nodes, corner, x)));
      }
    }
    return size > 0 ? worst / size : 0;
  }

  /// The place of what the polynomials through the nodes do not follow; nothing where there is none.
  std::optional<Place> find(const Elements& mesh) {
    size_ = 0;
    for (std::size_t e = 0; e < mesh.count(); ++e) {
      const std::vector<double>& values = values_at_nodes(mesh, mesh.corner(e));
      for (std::size_t n = 0; n < values.size(); ++n) {
        if (poles_ && !std::isfinite(values[n])) return mesh.node(mesh.corner(e), n);
        size_ = std::max(size_, std::abs(values[n]));
      }
    }
    for (std::size_t e = 0; e < mesh.count(); ++e)
      if (const auto place = find_in(mesh, mesh.corner(e))) return place;
    return std::nullopt;
  }

 private:
  double at(const Place& x) {
    double out = 0;
    work_.evaluate(x, {&out, 1});
    return out;
  }
  const std::vector<double>& values_at_nodes(const Elements& mesh, const Place& corner) {
    nodes_.resize(mesh.nodes());
    for (std::size_t n = 0; n < nodes_.size(); ++n) nodes_[n] = at(mesh.node(corner, n));
    return nodes_;
  }

  struct Piece {
    Place middle, half;
    int halvings;
  };

  std::optional<Place> find_in(const Elements& mesh, const Place& corner) {
    const std::vector<double>& nodes = values_at_nodes(mesh, corner);
    Piece whole{corner, mesh.width, 0};
    for (std::size_t i = 0; i < corner.size(); ++i) whole.middle[i] += whole.half[i] /= 2;
    std::vector<Piece> open{whole};
    for (int seen = 0; !open.empty() && seen < most_pieces; ++seen) {
      const Piece piece = open.back();
      open.pop_back();
      const double f = at(piece.middle);
      if (poles_ && !std::isfinite(f)) return piece.middle;
      if (std::abs(f - mesh.between(nodes, corner, piece.middle)) > unresolved * std::max(size_, std::abs(f)))
        return piece.middle;
      disks_.set_centre(piece.middle);
      disks_.evaluate(piece.half);
      if (disks_.reach(0) <= settled * size_ || piece.halvings == most_halvings) continue;
      for (std::size_t part = 0; part < std::size_t(1) << corner.size(); ++part) {
        Piece smaller{piece.middle, piece.half, piece.halvings + 1};
        for (std::size_t i = 0; i < corner.size(); ++i)
          smaller.middle[i] += (part >> i & 1 ? 1 : -1) * (smaller.half[i] /= 2);
        open.push_back(std::move(smaller));
      }
    }
    return std::nullopt;
  }

  FunctionKernel kernel_;
  FunctionWorkspace work_;
  FunctionDisks disks_;
  std::vector<double> nodes_;
  double size_ = 0;  // largest modulus at the nodes
  bool poles_ = false;
};

bool stands_in(Expr symbol, Expr e) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::find(symbols.begin(), symbols.end(), symbol) != symbols.end();
}

struct ParameterValues {
  explicit ParameterValues(const FieldModel& model) {
    for (const Parameter& p : model.parameters) {
      symbols.push_back(p.symbol);
      values.push_back(p.si_value);
      known[p.symbol] = p.si_value;
    }
  }
  std::vector<Expr> symbols;
  std::vector<double> values;
  Bindings known;
};

std::vector<Expr> space_of(const FieldEquations& equations) {
  std::vector<Expr> out;
  for (const SpaceVariable& one : equations.system().space) out.push_back(one.symbol);
  return out;
}

Elements elements_of(const FieldEquations& equations, const ParameterValues& parameters, const Lobatto& rule,
                     const std::vector<int>& cells) {
  const FieldSystem& s = equations.system();
  Elements out{rule, {}, {}, cells};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    out.from.push_back(evaluate(s.expanded(s.space[i].from), parameters.known));
    out.width.push_back((evaluate(s.expanded(s.space[i].to), parameters.known) - out.from.back()) / cells[i]);
  }
  return out;
}

}  // namespace

std::optional<double> unresolved_moment(const FieldEquations& equations, const PointForm& form, double step,
                                        double begin, double duration) {
  constexpr double most_steps = 200'000;
  if (!(step > 0) || duration / step > most_steps) return std::nullopt;
  const FieldSystem& s = equations.system();
  Context& context = *s.context;
  const Expr time = context.time(), number = context.number(Rational(618034, 1000000));
  const ParameterValues parameters(*equations.model);
  const Lobatto rule(2);
  const Elements steps{rule, {begin}, {step}, {static_cast<int>(std::ceil(duration / step))}};
  const auto look = [&](Expr f) -> std::optional<double> {
    if (!stands_in(time, f)) return std::nullopt;
    const auto found = Scan(f, {time}, parameters.symbols, parameters.values).with_poles().find(steps);
    return found ? std::optional((*found)[0]) : std::nullopt;
  };
  for (const EndForce& force : s.end_forces)
    if (const auto found = look(s.expanded(force.value))) return found;
  for (const int part : {13, 29, 50, 83}) {  // hundredths of the domain
    ExprMap fixed;
    for (const SpaceVariable& x : s.space)
      fixed.emplace(x.symbol, s.expanded(x.from) + Rational(part, 100) * (s.expanded(x.to) - s.expanded(x.from)));
    for (const BoundaryCondition& b : s.boundary)  // along a side
      if (b.value)
        if (const auto found = look(substitute(s.expanded(b.value), fixed))) return found;
    for (const Expr& input : form.inputs)
      if (input != time) fixed.emplace(input, number);
    for (const auto* list : {&form.a, &form.g, &form.s})
      for (const Expr& f : *list)
        if (const auto found = look(substitute(f, fixed))) return found;
  }
  return std::nullopt;
}

double left_out_of_start(const FieldEquations& equations, const std::vector<int>& cells, int order) {
  const ParameterValues parameters(*equations.model);
  const Lobatto rule(order);
  const Elements mesh = elements_of(equations, parameters, rule, cells);
  double out = 0;
  for (const FieldStart& start : equations.model->start)
    out = std::max(
        out, Scan(equations.system().expanded(start.value), space_of(equations), parameters.symbols, parameters.values)
                 .left_out(mesh));
  return out;
}

std::optional<Unresolved> unresolved_feature(const FieldEquations& equations, const PointForm& form,
                                             const std::vector<int>& cells, int order) {
  const FieldSystem& s = equations.system();
  Context& context = *s.context;
  const std::vector<Expr> x = space_of(equations);
  const ParameterValues parameters(*equations.model);
  const Lobatto rule(order);
  const Elements mesh = elements_of(equations, parameters, rule, cells);
  const auto look = [&](Expr f, bool of_start) -> std::optional<Unresolved> {
    if (std::none_of(x.begin(), x.end(), [&](Expr one) { return stands_in(one, f); })) return std::nullopt;
    const auto place = Scan(f, x, parameters.symbols, parameters.values).find(mesh);
    return place ? std::optional(Unresolved{*place, mesh.width, of_start}) : std::nullopt;
  };
  for (const FieldStart& start : equations.model->start)
    if (const auto found = look(s.expanded(start.value), true)) return found;
  ExprMap fixed{{context.time(), context.number(0)}};
  const Expr number = context.number(Rational(618034, 1000000));  // any value of φ, φ', φ_x, φ_tx
  for (const Expr& input : form.inputs)
    if (std::find(x.begin(), x.end(), input) == x.end() && input != context.time()) fixed.emplace(input, number);
  for (const auto* part : {&form.a, &form.g, &form.s})
    for (const Expr& f : *part)
      if (const auto found = look(substitute(f, fixed), false)) return found;
  return std::nullopt;
}

}  // namespace maupertuis
