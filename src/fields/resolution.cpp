#include "fields/resolution.hpp"

#include "fields/given_fields.hpp"
#include "linear_algebra/quadrature.hpp"

#include <maupertuis/function_disks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <queue>

namespace maupertuis {
namespace {

constexpr int most_halvings = 24;    // of an element: 6e-8 of its width
constexpr int most_pieces = 4096;    // of an element
constexpr double settled = 0.125;    // change within a piece, of the function's size
constexpr double unresolved = 0.25;  // off from the polynomial, of the function's size

using Place = std::vector<double>;  // [space variables]

/// An element: an interval, or a rectangle.
struct Box {
  Place corner, width;
};

/// The elements of a mesh with their nodes.
struct Elements {
  const Lobatto& rule;
  Borders borders;
  double inside = 0;  // of nodes off the borders between elements, in widths: a function may jump there

  std::size_t directions() const { return borders.size(); }
  std::size_t count() const {
    std::size_t out = 1;
    for (const std::vector<double>& along : borders) out *= along.size() - 1;
    return out;
  }
  std::size_t nodes() const {
    std::size_t out = 1;
    for (std::size_t i = 0; i < directions(); ++i) out *= rule.x.size();
    return out;
  }
  Box box(std::size_t element) const {
    Box out;
    for (const std::vector<double>& along : borders) {
      const std::size_t cells = along.size() - 1, k = element % cells;
      out.corner.push_back(along[k]), out.width.push_back(along[k + 1] - along[k]);
      element /= cells;
    }
    return out;
  }
  Place node(const Box& box, std::size_t n) const {
    Place out = box.corner;
    for (std::size_t i = 0; i < directions(); ++i, n /= rule.x.size()) {
      const double first = box.corner[i] > borders[i].front() ? inside : 0,
                   last = box.corner[i] + box.width[i] < borders[i].back() ? 1 - inside : 1;
      out[i] += box.width[i] * std::clamp(0.5 * (1 + rule.x[n % rule.x.size()]), first, last);
    }
    return out;
  }
  /// The polynomial through the values at the nodes.
  double between(const std::vector<double>& values, const Box& box, const Place& at) const {
    std::vector<std::vector<double>> factor(directions());
    std::vector<const double*> lagrange;
    std::vector<double> slope;
    for (std::size_t i = 0; i < directions(); ++i) {
      rule.at(2 * (at[i] - box.corner[i]) / box.width[i] - 1, factor[i], slope);
      lagrange.push_back(factor[i].data());
    }
    return between(values, lagrange);
  }
  /// Where Lagrange's polynomials have these values along each direction.
  double between(const std::vector<double>& values, const std::vector<const double*>& lagrange) const {
    double sum = 0;
    for (std::size_t n = 0; n < values.size(); ++n) {
      double product = values[n];
      for (std::size_t i = 0, rest = n; i < directions(); ++i, rest /= rule.x.size())
        product *= lagrange[i][rest % rule.x.size()];
      sum += product;
    }
    return sum;
  }
};

struct Unseen {
  Place place, element;  // the widths of the element that it lies in
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
    const auto share = [](std::size_t look) { return (static_cast<double>(look) + 0.5) / looks; };
    std::vector<double> lagrange[looks], slope;
    for (std::size_t look = 0; look < looks; ++look) mesh.rule.at(2 * share(look) - 1, lagrange[look], slope);
    std::vector<const double*> here(mesh.directions());
    double worst = 0, size = 0;
    for (std::size_t e = 0; e < mesh.count(); ++e) {
      const Box box = mesh.box(e);
      const std::vector<double>& nodes = values_at_nodes(mesh, box);
      for (std::size_t k = 0; k < in_all; ++k) {
        Place x = box.corner;
        for (std::size_t i = 0, rest = k; i < x.size(); ++i, rest /= looks)
          x[i] += box.width[i] * share(rest % looks), here[i] = lagrange[rest % looks].data();
        const double f = at(x);
        size = std::max(size, std::abs(f));
        worst = std::max(worst, std::abs(f - mesh.between(nodes, here)));
      }
    }
    return size > 0 ? worst / size : 0;
  }

  /// What the polynomials through the nodes do not follow; nothing where there is none.
  std::optional<Unseen> find(const Elements& mesh) {
    size_ = 0;
    for (std::size_t e = 0; e < mesh.count(); ++e) {
      const Box box = mesh.box(e);
      const std::vector<double>& values = values_at_nodes(mesh, box);
      for (std::size_t n = 0; n < values.size(); ++n) {
        if (poles_ && !std::isfinite(values[n])) return Unseen{mesh.node(box, n), box.width};
        size_ = std::max(size_, std::abs(values[n]));
      }
    }
    for (std::size_t e = 0; e < mesh.count(); ++e)
      if (const auto place = find_in(mesh, mesh.box(e))) return Unseen{*place, mesh.box(e).width};
    return std::nullopt;
  }

  /// Where the function is largest between two corners, and how large: the piece that may be largest is halved along
  /// its longest side until none may exceed what was found. Nothing where the function is 0 wherever it was looked at.
  std::optional<Place> strongest(const Place& from, const Place& to) {
    constexpr int looks = 20'000;
    struct Ranked {
      double most = 0;
      Place middle, half;
      bool operator<(const Ranked& other) const { return most < other.most; }
    };
    std::priority_queue<Ranked> open;
    double largest = 0;
    std::optional<Place> out;
    const auto look = [&](Place middle, Place half) {
      const double f = std::abs(at(middle));
      if (std::isfinite(f) && f > largest) largest = f, out = middle;
      disks_.set_centre(middle);
      disks_.evaluate(half);
      const double reach = disks_.reach(0), most = std::isfinite(f + reach) ? f + reach : HUGE_VAL;
      if (most > largest) open.push({most, std::move(middle), std::move(half)});
    };
    Place middle = from, half = to;
    for (std::size_t i = 0; i < from.size(); ++i) half[i] = (to[i] - from[i]) / 2, middle[i] = from[i] + half[i];
    const Place whole = half;
    look(middle, half);
    for (int seen = 0; !open.empty() && seen < looks; ++seen) {
      Ranked piece = open.top();
      open.pop();
      if (!(piece.most > 2 * largest)) break;  // what is left is no stronger by far
      std::size_t along = 0;
      for (std::size_t i = 1; i < whole.size(); ++i)
        if (piece.half[i] * whole[along] > piece.half[along] * whole[i]) along = i;
      piece.half[along] /= 2;
      for (const int side : {-1, 1}) {
        Place part = piece.middle;
        part[along] += side * piece.half[along];
        look(std::move(part), piece.half);
      }
    }
    return out;
  }

 private:
  double at(const Place& x) {
    double out = 0;
    work_.evaluate(x, {&out, 1});
    return out;
  }
  const std::vector<double>& values_at_nodes(const Elements& mesh, const Box& box) {
    nodes_.resize(mesh.nodes());
    for (std::size_t n = 0; n < nodes_.size(); ++n) nodes_[n] = at(mesh.node(box, n));
    return nodes_;
  }

  struct Piece {
    Place middle, half;
    int halvings;
  };

  std::optional<Place> find_in(const Elements& mesh, const Box& box) {
    const std::vector<double>& nodes = values_at_nodes(mesh, box);
    Piece whole{box.corner, box.width, 0};
    for (std::size_t i = 0; i < mesh.directions(); ++i) whole.middle[i] += whole.half[i] /= 2;
    std::vector<Piece> open{whole};
    for (int seen = 0; !open.empty() && seen < most_pieces; ++seen) {
      const Piece piece = open.back();
      open.pop_back();
      const double f = at(piece.middle);
      if (poles_ && !std::isfinite(f)) return piece.middle;
      if (std::abs(f - mesh.between(nodes, box, piece.middle)) > unresolved * std::max(size_, std::abs(f)))
        return piece.middle;
      disks_.set_centre(piece.middle);
      disks_.evaluate(piece.half);
      if (disks_.reach(0) <= settled * size_ || piece.halvings == most_halvings) continue;
      for (std::size_t part = 0; part < std::size_t(1) << mesh.directions(); ++part) {
        Piece smaller{piece.middle, piece.half, piece.halvings + 1};
        for (std::size_t i = 0; i < mesh.directions(); ++i)
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

/// A function of places and t, and what it is a part of.
struct Acting {
  Expr value;
  const char* of;
};

/// ∂ℒ and ∂𝒟 by each jet and the force densities, for one set of values of the field.
std::vector<Acting> what_acts(const FieldEquations& equations) {
  const FieldSystem& s = equations.system();
  std::vector<Acting> out;
  const auto add_slopes = [&](Expr density, const char* of) {
    if (!density) return;
    const Expr e = with_given_fields(s, density);
    for (const Expr& jet : s.jets_in(e)) out.push_back({differentiate(e, jet), of});
  };
  add_slopes(s.density, "the density");
  add_slopes(s.dissipation, "the dissipation density");
  for (const Expr& force : s.forces)
    if (force) out.push_back({with_given_fields(s, force), "a force density"});
  for (Acting& one : out) {
    ExprMap values;
    for (const Expr& jet : s.jets_in(one.value)) values.emplace(jet, s.context->number(Rational(618034, 1000000)));
    one.value = substitute(one.value, values);
  }
  return out;
}

std::string place_text(const FieldSystem& s, const Unseen& found) {
  std::string out;
  for (std::size_t i = 0; i < found.place.size(); ++i)
    out += fmt::format("{}{} = {:.6g}", i ? ", " : "", s.space[i].name, found.place[i]);
  return out;
}

/// E0647 where both meshes of an error estimate would pass something by, and their difference would tell nothing of it.
void refuse(const FieldEquations& equations, const Unseen& found, Span span, const char* of, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  std::string width;
  for (std::size_t i = 0; i < found.element.size(); ++i)
    width += fmt::format("{}{:.3g}", i ? " × " : "", found.element[i]);
  diagnostics.error("E0647", span,
                    fmt::format("the mesh is too coarse for what {} has at {}", of, place_text(s, found)),
                    fmt::format("Elements are {} wide (SI units), and what lies between their nodes is not seen by a "
                                "second mesh either: no value of this run could be trusted.",
                                width),
                    "Take more `cells`, or make it wider.");
}

}  // namespace

Borders even_borders(const FieldEquations& equations, const std::vector<int>& cells) {
  const FieldSystem& s = equations.system();
  const ParameterValues parameters(*equations.model);
  Borders out;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double from = evaluate(s.expanded(s.space[i].from), parameters.known),
                 to = evaluate(s.expanded(s.space[i].to), parameters.known);
    out.emplace_back();
    for (int k = 0; k <= cells[i]; ++k) out.back().push_back(from + (to - from) / cells[i] * k);
  }
  return out;
}

namespace {

/// Where f(x, t) is strongest in each of some equal parts of the run, as (x, t): what is narrow in both is 0 wherever
/// it is looked at along one of them alone.
std::vector<Place> strongest_moments(const FieldEquations& equations, const ParameterValues& parameters, Expr f,
                                     const RunTime& run, int parts) {
  const FieldSystem& s = equations.system();
  std::vector<Place> out;
  std::vector<Expr> variables = space_of(equations);
  variables.push_back(s.context->time());
  Scan scan(f, variables, parameters.symbols, parameters.values);
  Place from, to;
  for (const SpaceVariable& x : s.space) {
    from.push_back(evaluate(s.expanded(x.from), parameters.known));
    to.push_back(evaluate(s.expanded(x.to), parameters.known));
  }
  from.push_back(0), to.push_back(0);
  for (int part = 0; part < parts; ++part) {
    from.back() = run.begin + run.duration * part / parts, to.back() = run.begin + run.duration * (part + 1) / parts;
    if (auto found = scan.strongest(from, to)) out.push_back(std::move(*found));
  }
  return out;
}

/// Borders of steps: of all, or of those next to a moment where there are more than can be looked at.
std::vector<double> borders_of_steps(const RunTime& run, double step, const std::vector<double>& switching,
                                     std::optional<double> near) {
  constexpr double most_steps = 200'000, beside = 1000;
  const double count = std::ceil(run.duration / step);
  double first = 0, last = count;
  if (count > most_steps) {
    const double middle = near ? std::floor((*near - run.begin) / step) : 0;
    first = std::clamp(middle - beside, 0.0, count), last = std::clamp(middle + beside, 0.0, count);
  }
  std::vector<double> out;
  for (double k = first; k <= last; ++k) out.push_back(run.begin + step * k);
  for (const double t : switching)
    if (t > out.front() && t < out.back()) out.push_back(t);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

std::optional<double> unresolved_moment(const FieldEquations& equations, const std::vector<double>& switching,
                                        double step, const RunTime& run) {
  constexpr int parts = 8;
  if (!(step > 0) || !(run.duration > 0)) return std::nullopt;
  const FieldSystem& s = equations.system();
  const Expr time = s.context->time();
  const ParameterValues parameters(*equations.model);
  const Lobatto rule(2);
  const auto look = [&](Expr f, std::optional<double> near) -> std::optional<double> {
    if (!stands_in(time, f)) return std::nullopt;
    const Elements steps{rule, {borders_of_steps(run, step, switching, near)}, 1e-9};
    if (steps.borders[0].size() < 2) return std::nullopt;
    const auto found = Scan(f, {time}, parameters.symbols, parameters.values).with_poles().find(steps);
    return found ? std::optional(found->place[0]) : std::nullopt;
  };
  // Of what holds t and places: at some places, and where it is strongest.
  const auto look_everywhere = [&](Expr f) -> std::optional<double> {
    if (!stands_in(time, f)) return std::nullopt;
    const std::vector<Place> strongest = strongest_moments(equations, parameters, f, run, parts);
    for (const int part : {13, 29, 50, 83}) {  // hundredths of the domain
      ExprMap fixed;
      for (const SpaceVariable& x : s.space)
        fixed.emplace(x.symbol, s.expanded(x.from) + Rational(part, 100) * (s.expanded(x.to) - s.expanded(x.from)));
      if (const auto found = look(substitute(f, fixed), std::nullopt)) return found;
    }
    for (const Place& at : strongest) {
      ExprMap fixed;
      for (std::size_t i = 0; i < s.space.size(); ++i)
        fixed.emplace(s.space[i].symbol, s.context->number(Rational::from_double(at[i])));
      if (const auto found = look(substitute(f, fixed), at.back())) return found;
    }
    return std::nullopt;
  };
  for (const EndForce& force : s.end_forces)
    if (const auto found = look_everywhere(s.expanded(force.value))) return found;
  for (const BoundaryCondition& b : s.boundary)  // along a side
    if (b.value)
      if (const auto found = look_everywhere(s.expanded(b.value))) return found;
  for (const Acting& f : what_acts(equations))
    if (const auto found = look_everywhere(f.value)) return found;
  return std::nullopt;
}

double left_out_of_start(const FieldEquations& equations, const std::vector<int>& cells, int order) {
  const ParameterValues parameters(*equations.model);
  const Lobatto rule(order);
  const Elements mesh{rule, even_borders(equations, cells)};
  double out = 0;
  for (const FieldStart& start : equations.model->start)
    out = std::max(
        out, Scan(equations.system().expanded(start.value), space_of(equations), parameters.symbols, parameters.values)
                 .left_out(mesh));
  return out;
}

namespace {

/// What lies between the nodes of a mesh in functions of places.
class SpaceScan {
 public:
  SpaceScan(const FieldEquations& equations, const Borders& borders, int order)
      : equations_(equations),
        x_(space_of(equations)),
        parameters_(*equations.model),
        rule_(order),
        mesh_{rule_, borders, 1e-13} {}

  std::optional<Unseen> find(Expr f) const {
    if (std::none_of(x_.begin(), x_.end(), [&](Expr one) { return stands_in(one, f); })) return std::nullopt;
    return Scan(f, x_, parameters_.symbols, parameters_.values).find(mesh_);
  }

  /// Of the density, the dissipation and force densities, as they are when the run begins and when they are strongest.
  std::optional<std::pair<Unseen, const char*>> find_in_what_acts(const RunTime& run) const {
    constexpr int parts = 8;
    Context& context = *equations_.system().context;
    for (const Acting& f : what_acts(equations_)) {
      std::vector<double> moments{run.begin};
      if (run.duration > 0 && stands_in(context.time(), f.value))
        for (const Place& at : strongest_moments(equations_, parameters_, f.value, run, parts))
          moments.push_back(at.back());
      for (const double t : moments)
        if (const auto found = find(substitute(f.value, {{context.time(), context.number(Rational::from_double(t))}})))
          return std::pair(*found, f.of);
    }
    return std::nullopt;
  }

 private:
  const FieldEquations& equations_;
  std::vector<Expr> x_;
  ParameterValues parameters_;
  Lobatto rule_;
  Elements mesh_;
};

}  // namespace

bool refuse_unresolved(const FieldEquations& equations, const Borders& borders, int order, const RunTime& run,
                       Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  const SpaceScan scan(equations, borders, order);
  for (const FieldStart& start : equations.model->start)
    if (const auto found = scan.find(s.expanded(start.value))) {
      refuse(equations, *found, start.span, "the start", diagnostics);
      return true;
    }
  const auto found = scan.find_in_what_acts(run);
  if (found) refuse(equations, found->first, s.density_span, found->second, diagnostics);
  return found.has_value();
}

std::optional<std::string> passed_by(const FieldEquations& equations, const Borders& borders, int order) {
  const auto found = SpaceScan(equations, borders, order).find_in_what_acts({});
  if (!found) return std::nullopt;
  return fmt::format("{} has at {}", found->second, place_text(equations.system(), found->first));
}

}  // namespace maupertuis
