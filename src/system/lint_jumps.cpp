#include "system/lint.hpp"

#include <maupertuis/kinds.hpp>
#include <maupertuis/switch_text.hpp>
#include <maupertuis/switches.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_set>

/// What jumps at a switch gives an impulse, which the equations of motion do not contain.
///
/// Let L = L₀ + J H(g), where H is the step. What Lagrange's equations have at g = 0 beside functions is
///
///     δ(g) (ġ ∂J/∂q̇_i − J ∂g/∂q_i) + d/dt (J δ(g) ∂g/∂q̇_i)
///
/// So a switch in t alone may let V jump, which is a force that is switched on, but no T; and step(x) x' is harmless,
/// as the time derivative that it is. The bracket is evaluated at points of g = 0.
namespace maupertuis::lint_rules {
namespace {

/// So many are all put in numbers: what is looked at does not change the order in which nodes are made.
constexpr std::size_t few_positions = 64;
constexpr double cancelled = 1e-9;  // of two parts of an impulse

/// One part of L or D: its value as it enters, and where it comes from.
struct Part {
  Expr value;
  const EnergyTerm* term = nullptr;
  const char* letter = "";  // what the sum that it belongs to is called
};

std::string number(double x) { return fmt::format("{:.6g}", x); }

class Continuity {
 public:
  explicit Continuity(Subject& s) : s_(s), context_(*s.system.context) {
    for (const Parameter& p : s.system.parameters) values_.emplace(p.symbol, p.value);
    for (const Input& u : s.system.inputs) {
      Expr formula = u.formula;
      for (int order = 0; order <= 2; ++order, formula = total_time_derivative(formula))
        formulas_.emplace(context_.symbol(u.name, Role::Input, order), formula);
    }
    center();
  }

  /// E0431: before the energies, which jump where the points do.
  bool positions() {
    bool jumps = false;
    struct Placed {
      ExprVector components;
      std::string what;
      Span span;
    };
    std::vector<Placed> all;
    for (const Point& p : s_.system.points)
      if (p.mass) all.push_back({p.position, fmt::format("the position of {}", p.name), p.span});
    for (const Body& b : s_.system.bodies) {
      if (b.mass) all.push_back({b.position, fmt::format("the position of {}", b.name), b.span});
      all.push_back({b.rotation.entries, fmt::format("the orientation of {}", b.name), b.span});
    }
    ExprVector together;  // what stands below many positions is walked once
    for (const Placed& x : all) together.insert(together.end(), x.components.begin(), x.components.end());
    together = moving(together);
    const auto switched = above_switches(together);
    auto next = together.begin();
    for (const Placed& x : all) {
      const ExprVector functions(next, next + static_cast<std::ptrdiff_t>(x.components.size()));
      next += static_cast<std::ptrdiff_t>(x.components.size());
      if (all.size() <= few_positions ||
          std::any_of(functions.begin(), functions.end(), [&](Expr e) { return switched.count(e.id()) != 0; }))
        jumps |= position_jumps(functions, x.what, x.span);
    }
    return jumps;
  }

  /// E0430 and E0432.
  void lagrangian() {
    std::vector<Part> parts;
    const auto add = [&](const std::vector<EnergyTerm>& terms, int sign, const char* letter) {
      const ExprVector values = moving(values_of(terms));
      for (std::size_t i = 0; i < terms.size(); ++i) parts.push_back({sign * values[i], &terms[i], letter});
    };
    if (s_.system.lagrangian_given) {
      parts.push_back({moving(s_.system.lagrangian_given->value), &*s_.system.lagrangian_given, "L"});
    } else {
      add(s_.system.kinetic, 1, "T");
      add(s_.system.potential, -1, "V");
      add(s_.system.generalized_potential, -1, "U");
    }
    add(s_.system.lagrangian_extra, 1, "L");
    for (const Part& p : parts) whole_.push_back(p.value);
    const Expr lagrangian = context_.sum(whole_);
    ExprVector functions{lagrangian};
    for (const Expr& p : gradient(lagrangian, s_.velocities)) functions.push_back(p);
    examine(functions, parts, [&](const SwitchSample& x, const Slopes& g) { return has_impulse(x, g); });
  }

  /// E0430: the force is ∂D/∂q̇.
  void dissipation() {
    std::vector<Part> parts;
    const std::vector<EnergyTerm>& terms = s_.system.dissipation;
    const ExprVector moved = moving(values_of(terms));
    for (std::size_t i = 0; i < terms.size(); ++i) parts.push_back({moved[i], &terms[i], "D"});
    ExprVector values;
    for (const Part& p : parts) values.push_back(p.value);
    if (!values.empty())
      examine({context_.sum(values)}, parts,
              [](const SwitchSample& x, const Slopes& g) { return g.has_velocity && std::abs(x.jump[0]) > 0; });
  }

 private:
  /// The first derivatives of a switch at a point.
  struct Slopes {
    std::vector<double> by_position;  // [n]
    double rate = 0;                  // ġ, without accelerations
    bool has_velocity = false;

    struct Formulas {
      ExprVector values;              // those that are not 0
      std::vector<std::size_t> rows;  // [values] by q, by q̇, by t
    };
  };

  void center() {
    Bindings& b = search_.center;
    const Bindings numbers = parameter_numbers();
    for (const Coordinate& c : s_.system.coordinates)
      for (const Expr& e : {c.q, c.velocity}) b[e] = 1, search_.moving.push_back(e);
    for (const StartValue& v : s_.model.experiment.start) {
      const Coordinate& c = s_.system.coordinates[v.coordinate];
      const double x = evaluate(v.value, numbers);
      if (v.order < 2 && x != 0 && std::isfinite(x)) b[v.order == 0 ? c.q : c.velocity] = x;
    }
    b[context_.time()] = 1;
    search_.moving.push_back(context_.time());
  }

  Bindings parameter_numbers() const {
    Bindings out;
    for (const Parameter& p : s_.system.parameters) out.emplace(p.symbol, p.si_value);
    return out;
  }

  static ExprVector values_of(const std::vector<EnergyTerm>& terms) {
    ExprVector out;
    for (const EnergyTerm& t : terms) out.push_back(t.value);
    return out;
  }

  /// In q, q̇, t and parameters.
  Expr moving(Expr e) const { return moving(ExprVector{e}).front(); }
  ExprVector moving(const ExprVector& list) const { return substitute(expand_time_derivatives(list), formulas_); }

  /// The nodes below the roots from which one that switches can be reached.
  static std::unordered_set<NodeId> above_switches(const ExprVector& roots) {
    std::unordered_set<NodeId> out;
    for (const Expr& node : topological_order(roots)) {
      const auto arguments = node.argument_ids();
      if (has_switch(node.kind()) ||
          std::any_of(arguments.begin(), arguments.end(), [&](NodeId id) { return out.count(id) != 0; }))
        out.insert(node.id());
    }
    return out;
  }

  /// The parameters as the exact numbers that they are: pieces that meet for 0.1 and 0.3 meet to the last digit.
  ExprVector in_numbers(std::span<const Expr> expressions) const { return substitute(expressions, values_); }

  /// The switches of the functions that something moves through.
  ExprVector switches_in(const ExprVector& functions) const {
    ExprVector out;
    for (const Expr& g : switches_of(functions)) {
      const std::vector<Expr> symbols = symbols_of({&g, 1});
      if (std::any_of(symbols.begin(), symbols.end(), [&](Expr e) { return search_.center.count(e) != 0; }))
        out.push_back(g);
    }
    return out;
  }

  /// What a switch decides: the terms that hold it, of those functions and parts that do.
  struct Decided {
    std::vector<std::size_t> rows;  // [functions of the sampler] of functions, then parts
    SwitchSampler sampler;
  };

  /// Samples of functions and parts on each switch; the first that `wrong` finds is reported, one a switch. Who reads
  /// of twenty has read enough: the others, thousands of a table, are counted alone.
  template <class Wrong>
  void examine(const ExprVector& functions, const std::vector<Part>& parts, Wrong wrong) {
    const ExprVector switches = switches_in(functions);
    if (switches.empty()) return;
    ExprVector all = functions;
    for (const Part& p : parts) all.push_back(p.value);
    const ExprVector values = in_numbers(all), places = in_numbers(switches);
    const SwitchUses uses(values);
    std::optional<Decided> decided;
    constexpr std::size_t most_told = 20;
    for (std::size_t k = 0, told = 0; k < switches.size() && told < most_told; ++k) {
      decide(uses.terms_with(places[k]), decided);
      if (decided->rows.empty()) continue;  // times a factor that is 0 for these parameters
      const Slopes::Formulas slopes = slope_formulas(places[k]);
      std::vector<SwitchSample> found;
      const auto take = [&](SwitchSample x) {
        std::vector<double> jump(values.size(), 0.0);
        for (std::size_t i = 0; i < decided->rows.size(); ++i) jump[decided->rows[i]] = x.jump[i];
        x.jump = std::move(jump);
        x.at.insert(search_.center.begin(), search_.center.end());
        if (wrong(x, slopes_at(slopes, x.at))) found.push_back(std::move(x));
      };
      std::vector<SwitchSample> samples = decided->sampler.sample(places[k]);
      const bool met = !samples.empty();
      for (SwitchSample& x : samples) take(std::move(x));
      if (found.empty())
        for (SwitchSample& x : where_the_zero_test_points(decided->sampler, places[k], met)) take(std::move(x));
      if (found.empty()) continue;
      const Span place = report(switches[k], found, functions.size(), parts);
      if (++told == most_told && k + 1 < switches.size()) leave_unlooked(switches.size() - k - 1, place);
    }
  }

  /// Keeps what was prepared for the switch before where both stand in the same terms, as the pieces of one function
  /// do.
  void decide(const ExprVector& terms, std::optional<Decided>& decided) const {
    ExprVector values;
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < terms.size(); ++i)
      if (!terms[i].is_zero()) values.push_back(terms[i]), rows.push_back(i);
    if (decided && decided->rows == rows && decided->sampler.functions() == values) return;
    SwitchSearch search = search_;
    search.center.clear();
    const std::vector<Expr> symbols = symbols_of(values);
    for (const Expr& e : symbols)
      if (const auto at = search_.center.find(e); at != search_.center.end()) search.center.insert(*at);
    std::erase_if(search.moving, [&](Expr e) { return search.center.count(e) == 0; });
    decided.emplace(Decided{std::move(rows), SwitchSampler(std::move(values), std::move(search))});
  }

  /// Where g = 0 can be solved for a symbol the jump is a function of the others, which the zero test decides: what the
  /// samples did not meet has a witness. Where nothing else moves, samples have met all there is; without any, nothing.
  static std::vector<SwitchSample> where_the_zero_test_points(const SwitchSampler& sampler, Expr g, bool met) {
    if (met && sampler.search().moving.size() < 2) return {};
    for (const Expr& x : sampler.search().moving) {
      const Expr slope = differentiate(g, x);
      if (!slope.is_number() || slope.is_zero()) continue;
      const Expr solved = x - g / slope;
      const ZeroTest test = zero_test(substitute(jump_across(sampler.functions(), g), {{x, solved}}));
      if (test.verdict != Verdict::Nonzero) return {};
      SwitchSearch there = sampler.search();
      for (const auto& [symbol, value] : test.witness) there.center[symbol] = value;
      // However far away the switch is: from beyond it.
      const double root = evaluate(solved, there.center);
      there.center[x] = root + std::copysign(1 + std::abs(root) / 2, root);
      there.points = 1;
      return sample_switches(sampler.functions(), {&g, 1}, there);
    }
    return {};
  }

  Slopes::Formulas slope_formulas(Expr g) const {
    ExprVector symbols = s_.order.coordinates;
    symbols.insert(symbols.end(), s_.velocities.begin(), s_.velocities.end());
    symbols.push_back(context_.time());
    Slopes::Formulas out;
    const ExprVector d = in_numbers(gradient(g, symbols));
    for (std::size_t i = 0; i < d.size(); ++i)
      if (!d[i].is_zero()) out.values.push_back(d[i]), out.rows.push_back(i);
    return out;
  }

  Slopes slopes_at(const Slopes::Formulas& formulas, const Bindings& at) const {
    const std::vector<double> d = evaluate(formulas.values, at);
    const std::size_t n = s_.freedoms();
    Slopes out{std::vector<double>(n, 0.0), 0, false};
    for (std::size_t k = 0; k < d.size(); ++k) {
      const std::size_t row = formulas.rows[k];
      if (row < n)
        out.by_position[row] = d[k], out.rate += d[k] * at.at(s_.velocities[row]);
      else if (row < 2 * n)
        out.has_velocity |= d[k] != 0;
      else
        out.rate += d[k];
    }
    return out;
  }

  /// jump = (ΔL, Δp_1, …, Δp_n, …)
  bool has_impulse(const SwitchSample& x, const Slopes& g) const {
    const double jump = x.jump[0];
    for (std::size_t i = 0; i < s_.freedoms(); ++i) {
      const double momentum = x.jump[i + 1];
      if (g.has_velocity ? std::abs(jump) > 0 || std::abs(momentum) > 0
                         : std::abs(g.rate * momentum - jump * g.by_position[i]) >
                               cancelled * (std::abs(g.rate * momentum) + std::abs(jump * g.by_position[i])))
        return true;
    }
    return false;
  }

  /// The sample whose numbers are nearest to 0 and ±1 is the one that a reader can check.
  /// Returns where it was told.
  Span report(Expr g, std::vector<SwitchSample>& found, std::size_t first_part, const std::vector<Part>& parts) {
    const auto size = [](const SwitchSample& x) {
      double sum = 0;
      for (const auto& [symbol, value] : x.at) sum += value == 0 ? 0 : std::abs(std::log(std::abs(value)));
      return sum;
    };
    std::stable_sort(found.begin(), found.end(), [&](const auto& x, const auto& y) { return size(x) < size(y); });
    for (const SwitchSample& x : found) {
      std::size_t worst = 0;
      for (std::size_t k = 0; k < parts.size(); ++k)
        if (std::abs(x.jump[first_part + k]) > std::abs(x.jump[first_part + worst])) worst = k;
      if (std::abs(x.jump[first_part + worst]) > 0) return report_energy(g, found, first_part + worst, parts[worst], x);
    }
    return report_momentum(g, found.front(), parts);
  }

  Span report_energy(Expr g, const std::vector<SwitchSample>& found, std::size_t column, const Part& part,
                     const SwitchSample& x) {
    const double jump = std::abs(x.jump[column]);
    const bool same = std::all_of(found.begin(), found.end(), [&](const SwitchSample& y) {
      return std::abs(std::abs(y.jump[column]) - jump) <= 1e-9 * jump;
    });
    const std::string what =
        part.term->origin.size() == 1 ? part.letter : fmt::format("the energy of {}", part.term->origin);
    const Dimension power = s_.system.lagrangian_dimension / s_.system.independent_dimension;
    const std::string amount = with_unit(jump, *part.letter == 'D' ? power : s_.system.lagrangian_dimension);
    const ExprVector concerned{same ? g : g + part.value};
    const std::string example = state(concerned, x.at), where = place(g, example);
    s_.diagnostics.error(
        "E0430", part.term->span,
        same || example == where ? fmt::format("{} jumps by {} where {}", what, amount, where)
                                 : fmt::format("{} jumps where {}: by {} at {}", what, where, amount, example),
        *part.letter == 'D'
            ? "Its derivative by the velocity is a force without bound there, which the equations of motion do not "
              "contain."
            : "A jump gives an impulse, a force without bound for no time, which the equations of motion do not "
              "contain: a motion would pass it as if nothing were there.",
        "Let the pieces meet there, or give the step a width: 1/2 (1 + tanh(u/d)) for step(u). Forces may jump.");
    return part.term->span;
  }

  void leave_unlooked(std::size_t count, Span place) {
    s_.diagnostics.error("E0430", place, fmt::format("{} more switches are not looked at", count),
                         "Enough of those that were jump.", "Mend these first.");
  }

  Span report_momentum(Expr g, const SwitchSample& x, const std::vector<Part>& parts) {
    std::size_t i = 0;
    for (std::size_t k = 0; k < s_.freedoms(); ++k)
      if (std::abs(x.jump[k + 1]) > std::abs(x.jump[i + 1])) i = k;
    const Coordinate& c = s_.system.coordinates[i];
    const auto has = [&](const Part& p) {  // both sides are one formula where it does not know g
      return on_side({&p.value, 1}, g, true) != on_side({&p.value, 1}, g, false);
    };
    const auto part = std::find_if(parts.begin(), parts.end(), has);
    const Span place_of_part = part == parts.end() ? parts.front().term->span : part->term->span;
    s_.diagnostics.error(
        "E0432", place_of_part,
        fmt::format("the momentum ∂L/∂{}' jumps by {} where {}", c.name,
                    with_unit(std::abs(x.jump[i + 1]),
                              s_.system.lagrangian_dimension * s_.system.independent_dimension / c.dimension),
                    place(g, state({g}, x.at))),
        "A momentum changes by forces alone: it is the velocity that would have to jump, which the equations of motion "
        "do not contain.",
        "Let ∂L/∂q' pass the switch without a jump, for example sqrt(v^2 + d^2) for abs(v).");
    return place_of_part;
  }

  bool position_jumps(const ExprVector& functions, const std::string& what, Span span) {
    const ExprVector switches = switches_in(functions);
    for (const SwitchSample& x : sample_switches(in_numbers(functions), in_numbers(switches), search_))
      for (const double jump : x.jump)
        if (std::abs(jump) > 0) {
          const Expr g = switches[x.which];
          s_.diagnostics.error("E0431", span, fmt::format("{} jumps where {}", what, place(g, state({g}, x.at))),
                               "A mass that is elsewhere from one moment to the next has no velocity in between.",
                               "Let the pieces meet there.");
          return true;
        }
    return false;
  }

  std::string place(Expr g, const std::string& example) const {
    const std::string text = switch_text(g, s_.order);
    return text.empty() ? example : text;
  }

  /// x = 1 m, y = 0.3 m: what stands in the expressions.
  std::string state(const ExprVector& expressions, const Bindings& at) const {
    constexpr std::size_t most = 6;
    std::vector<std::string> out;
    const std::vector<Expr> symbols = symbols_of(expressions);
    const auto add = [&](Expr e, const std::string& name, const Dimension& dimension) {
      if (std::find(symbols.begin(), symbols.end(), e) != symbols.end() && out.size() < most)
        out.push_back(fmt::format("{} = {}", name, with_unit(at.at(e), dimension)));
    };
    for (const Coordinate& c : s_.system.coordinates) {
      add(c.q, c.name, c.dimension);
      add(c.velocity, c.name + "'", c.dimension / s_.system.independent_dimension);
    }
    add(context_.time(), s_.system.independent, s_.system.independent_dimension);
    return fmt::format("{}", fmt::join(out, ", "));
  }

  std::string with_unit(double value, const Dimension& dimension) const {
    const std::string unit = s_.system.dimensionless ? "" : to_string(dimension);
    return unit.empty() || unit == "1" ? number(value) : number(value) + " " + unit;
  }

  Subject& s_;
  Context& context_;
  ExprMap values_, formulas_;
  SwitchSearch search_;
  ExprVector whole_;
};

}  // namespace

void jumps(Subject& s) {
  Continuity continuity(s);
  if (continuity.positions()) return;
  continuity.lagrangian();
  continuity.dissipation();
}

}  // namespace maupertuis::lint_rules
