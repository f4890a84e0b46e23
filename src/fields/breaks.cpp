#include "fields/breaks.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/function_kernel.hpp>
#include <maupertuis/kinds.hpp>

#include "fields/resting_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_set>

namespace maupertuis {
namespace {

constexpr int samples_a_cell = 8, most_samples = 4096, halvings_of_a_break = 24;
constexpr double small = 1e-6;  // a jump, beside the function

struct FieldBreak {
  bool seam = false;  // of a periodic domain
  std::size_t start = 0, direction = 0;
  int derivative = 0;  // along the direction: 0 a jump, 1 a kink
  double place = 0;    // along the direction
  double before = 0, behind = 0;
};

bool may_break(Expr e, std::unordered_set<Expr, ExprHash>& seen) {
  if (!seen.insert(e).second) return false;
  const Family family = family_of(e.kind());
  if (family == Family::Switch || family == Family::Extremum || family == Family::Piecewise) return true;
  if (e.is(Kind::Power) && e[1].is_number() && !e[1].number().is_integer()) return true;
  for (std::size_t i = 0; i < e.size(); ++i)
    if (may_break(e[i], seen)) return true;
  return false;
}

/// A function along a line.
class Line {
 public:
  Line(Expr f, Expr x, const std::vector<Expr>& parameters, const std::vector<double>& values)
      : kernel_(build_function({{x}, parameters, {f}})), work_(kernel_) {
    work_.set_parameters(values);
  }
  double at(double x) {
    double out = 0;
    work_.evaluate({&x, 1}, {&out, 1});
    return out;
  }

 private:
  FunctionKernel kernel_;
  FunctionWorkspace work_;
};

/// A little inside of the domain: sign(0) = 0 at an end is no jump.
struct Range {
  double from = 0, to = 0;
  int cells = 1;
  double cell() const { return (to - from) / cells; }
};

/// A difference of at least `least` that stays as the piece around it becomes small.
std::optional<FieldBreak> find_jump(Line& f, const Range& range, double least) {
  const int n = std::min(samples_a_cell * range.cells + 1, most_samples);
  double x = range.from, y = f.at(x);
  for (int i = 1; i <= n; ++i) {
    const double next_x = range.from + (range.to - range.from) * i / n, next_y = f.at(next_x);
    double a = x, b = next_x, fa = y, fb = next_y;
    x = next_x, y = next_y;
    if (!(std::abs(fb - fa) > least)) continue;
    const double whole = std::abs(fb - fa);
    int k = 0;
    for (; k < halvings_of_a_break && std::abs(fb - fa) > std::max(least, 0.25 * whole); ++k) {
      const double middle = (a + b) / 2, fm = f.at(middle);
      if (std::abs(fm - fa) > std::abs(fb - fm))
        b = middle, fb = fm;
      else
        a = middle, fa = fm;
    }
    if (k < halvings_of_a_break) continue;
    FieldBreak out;
    const double near = 1e-6 * range.cell();  // sign(0) = 0 belongs to neither side
    out.place = std::round((a + b) / 2 / near) * near;
    out.before = f.at(out.place - near), out.behind = f.at(out.place + near);
    return out;
  }
  return std::nullopt;
}

class Search {
 public:
  Search(const FieldEquations& equations, const std::vector<int>& cells) : equations_(equations) {
    const FieldSystem& s = equations.system();
    for (const Parameter& p : equations.model->parameters) {
      parameters_.push_back(p.symbol), values_.push_back(p.si_value);
      known_[p.symbol] = p.si_value;
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double from = evaluate(s.expanded(s.space[i].from), known_),
                   to = evaluate(s.expanded(s.space[i].to), known_);
      const double inside = 1e-9 * (to - from);
      ranges_.push_back({from + inside, to - inside, cells[i]});
    }
  }

  void look_at_start(std::size_t line) {
    const FieldSystem& s = equations_.system();
    const FieldStart& start = equations_.model->start[line];
    const Expr value = s.expanded(start.value);
    std::unordered_set<Expr, ExprHash> seen;
    const bool inside = may_break(value, seen);
    for (std::size_t i = 0; i < ranges_.size(); ++i) {
      const double size = size_of(value, i);
      for (int k = 0; k <= (start.order == 0 ? 1 : 0); ++k) {
        const Expr f = along(k == 0 ? value : differentiate(value, s.space[i].symbol), i);
        Line g(f, s.space[i].symbol, parameters_, values_);
        const double least = small * size / std::pow(ranges_[i].cell(), k);
        std::optional<FieldBreak> found;
        if (inside) found = find_jump(g, ranges_[i], least);
        if (!found && s.periodic(i) && std::abs(g.at(ranges_[i].from) - g.at(ranges_[i].to)) > least)
          found = seam(g, ranges_[i]);
        if (!found) continue;
        found->start = line, found->direction = i, found->derivative = k;
        out.push_back(*found);
        return;
      }
    }
  }

  std::vector<FieldBreak> out;

 private:
  static FieldBreak seam(Line& g, const Range& range) {
    FieldBreak out;
    out.seam = true, out.place = range.from;
    out.before = g.at(range.to), out.behind = g.at(range.from);
    return out;
  }
  /// With the other variables in the midst, a little off what is symmetric.
  Expr along(Expr f, std::size_t direction) const {
    const FieldSystem& s = equations_.system();
    ExprMap fixed{{s.context->time(), s.context->number(0)}};
    for (std::size_t j = 0; j < s.space.size(); ++j)
      if (j != direction)
        fixed.emplace(s.space[j].symbol,
                      s.expanded(s.space[j].from) +
                          Rational(37, 100) * (s.expanded(s.space[j].to) - s.expanded(s.space[j].from)));
    return substitute(f, fixed);
  }
  double size_of(Expr f, std::size_t direction) {
    Line line(along(f, direction), equations_.system().space[direction].symbol, parameters_, values_);
    const Range& range = ranges_[direction];
    constexpr int places = 64;
    double out = 0;
    for (int i = 0; i <= places; ++i) {
      const double value = std::abs(line.at(range.from + (range.to - range.from) * i / places));
      if (std::isfinite(value)) out = std::max(out, value);
    }
    return out;
  }

  const FieldEquations& equations_;
  std::vector<Expr> parameters_;
  std::vector<double> values_;
  Bindings known_;
  std::vector<Range> ranges_;
};

void warn(const FieldBreak& b, const FieldEquations& equations, Diagnostics& diagnostics) {
  const FieldSystem& s = equations.system();
  const FieldStart& start = equations.model->start[b.start];
  std::vector<int> space(s.space.size(), 0);
  space[b.direction] = b.derivative;
  const std::string name = s.jet_name({start.field, std::move(space), start.order});
  const std::string reason =
      "Waves of every length come from there, and a mesh follows the long ones alone: values converge slowly.";
  if (b.seam)
    diagnostics.warning("W0651", start.span,
                        fmt::format("the start does not close: {} = {:.6g} at one end of the periodic domain, {:.6g} "
                                    "at the other (SI units)",
                                    name, b.behind, b.before),
                        reason, "Give a start that repeats with the domain, or conditions at its ends.");
  else
    diagnostics.warning(
        "W0651", start.span,
        fmt::format("the start has a {} at {} = {:.6g}: {} goes from {:.6g} to {:.6g} (SI units)",
                    b.derivative == 0 ? "jump" : "kink", s.space[b.direction].name, b.place, name, b.before, b.behind),
        reason, "Round it over some cells where digits count.");
}

}  // namespace

bool warn_of_breaks(const FieldEquations& equations, const std::vector<int>& cells, Diagnostics& diagnostics) {
  Search search(equations, cells);
  for (std::size_t i = 0; i < equations.model->start.size(); ++i)
    if (moves(equations, equations.model->start[i].field)) search.look_at_start(i);
  for (const FieldBreak& b : search.out) warn(b, equations, diagnostics);
  return !search.out.empty();
}

}  // namespace maupertuis
