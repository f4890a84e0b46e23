#include <maupertuis/along_motion.hpp>
#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/degenerate.hpp>
#include <maupertuis/invariants.hpp>
#include <maupertuis/print.hpp>

#include "analysis/invariants/algebra.hpp"
#include "analysis/invariants/ansatz.hpp"
#include "analysis/invariants/balance.hpp"
#include "analysis/invariants/completeness.hpp"
#include "analysis/invariants/drift.hpp"
#include "analysis/invariants/linear_fit.hpp"
#include "analysis/invariants/named_constants.hpp"
#include "analysis/invariants/naming.hpp"
#include "analysis/invariants/search.hpp"
#include "analysis/invariants/symmetry.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

using namespace invariants;

class Finder {
 public:
  Finder(const Model& model, const EquationsOfMotion& equations, const InvariantsOptions& options,
         Diagnostics& diagnostics)
      : model_(model),
        equations_(equations),
        solvable_(solvable_equations(equations)),
        system_(*equations.system),
        options_(options),
        diagnostics_(diagnostics),
        rows_(motion_rows(solvable_)),
        ansatz_(make_ansatz(equations, rows_)),
        along_(equations) {
    Diagnostics unheard;
    const auto start = consistent_start(model, equations, unheard);
    if (start) along_.set_start(start->state);
    if (equations.degenerate)
      result_.freedoms = equations.degenerate->motions / 2;
    else
      result_.freedoms = system_.constrained()
                             ? analyse_constraints(equations, start ? &start->state : nullptr).configuration_freedoms
                             : system_.coordinates.size();
    const auto acts = [](const ExprVector& v) {
      return std::any_of(v.begin(), v.end(), [](const Expr& e) { return !e.is_zero(); });
    };
    hamiltonian_ = !system_.constrained() && !equations.degenerate && !acts(equations.generalized_forces) &&
                   !acts(equations.dissipative_terms);
  }

  std::optional<Invariants> carry_out() {
    const PolynomialBases polynomials =
        polynomial_bases(ansatz_, rows_, options_.velocity_degree, options_.largest_basis, options_.seed + 1);
    if (polynomials.bases.empty() && options_.velocity_degree > 2) return too_large(polynomials.needed);
    if (!find_charges()) return std::nullopt;
    find_polynomials(polynomials);
    put_in_order();
    mark_independent();
    remove_functions_of_others();
    put_shown_first();
    number_them();
    if (options_.relations) add_algebra(result_, rows_, solvable_, options_.seed + 5);
    add_balance_laws(result_, ansatz_, equations_, options_);
    if (options_.completeness && hamiltonian_)
      result_.symmetry_bound =
          symmetry_bound(equations_, ansatz_.atoms.natural, result_.noether_symmetries, options_.seed + 7);
    // Where functions are free the sizes of terms, which drift is measured by, are a matter of their choice.
    if (options_.drift && !has_free_functions(equations_)) measure_drift(result_, model_, equations_, diagnostics_);
    return std::move(result_);
  }

 private:
  std::optional<Invariants> too_large(std::size_t needed) {
    const double bytes = 8.0 * static_cast<double>(needed) * static_cast<double>(needed);
    diagnostics_.error(
        "E1001", {}, fmt::format("the basis of degree {} has {} functions", options_.velocity_degree, needed),
        fmt::format("Its matrix would take {:.0f} MB and {:.1g} multiplications; at most {} functions are allowed.",
                    bytes / 1e6, std::pow(static_cast<double>(needed), 3) / 3, options_.largest_basis),
        "A lower --degree, or --largest-basis with more functions.");
    return std::nullopt;
  }

  bool find_charges() {
    const Basis basis = noether_basis(ansatz_, rows_, options_.largest_basis, options_.seed + 2);
    if (basis.monomials.empty()) {
      result_.basis.push_back(fmt::format(
          "point symmetries: not searched, the poorest basis has more than {} functions", options_.largest_basis));
      return true;
    }
    return search_charges(basis);
  }

  bool search_charges(const Basis& basis) {
    const SearchResult found = conserved_combinations(rows_, ansatz_.generators, basis, {}, work(), options_.seed + 3);
    if (found.singular) return singular();
    result_.basis.push_back(basis.description + fmt::format(": {} functions", basis.monomials.size()) +
                            reservation(found));
    if (!found.sampled && !ansatz_.atoms.time.empty()) {  // the rates of waves are roots; others need none
      ansatz_.atoms.time.clear();
      return find_charges();
    }
    result_.noether_symmetries = hamiltonian_ ? found.dimension : 0;
    result_.too_long += found.too_long;
    for (const Combination& c : found.found) take(c.value, hamiltonian_ ? IntegralKind::Noether : IntegralKind::Direct);
    return true;
  }

  /// Nodes that the points of one search may take to evaluate: some seconds.
  std::size_t work() const { return options_.largest_basis * 100'000; }

  static std::string reservation(const SearchResult& found) {
    return found.sampled
               ? ""
               : " (not searched: its random points are too expensive, or none were found at which all roots exist)";
  }

  bool singular() {
    diagnostics_.error("E1002", {}, "the equations do not determine the accelerations",
                       "At random points the mass matrix, bordered by the constraints, was singular: conservation "
                       "along the motion has no "
                       "meaning there.",
                       "`maup check` names coordinates without inertia.");
    return false;
  }

  void find_polynomials(const PolynomialBases& polynomials) {
    if (polynomials.bases.empty())
      result_.basis.push_back(
          fmt::format("polynomials of degree {} in the velocities: not searched, the poorest basis has {} functions",
                      options_.velocity_degree, polynomials.needed));
    for (const Basis& basis : polynomials.bases) {
      const SearchResult found =
          conserved_combinations(rows_, ansatz_.generators, basis, products_of_found(), work(), options_.seed + 4);
      result_.basis.push_back(basis.description + reservation(found));
      result_.too_long += found.too_long;
      for (const Combination& c : found.found)
        take(c.value, hamiltonian_ ? IntegralKind::Hidden : IntegralKind::Direct);
    }
  }

  /// Products of what was found, up to the degree of the search: no news.
  std::vector<Expr> products_of_found() const {
    std::vector<Expr> out;
    const auto extend = [&](auto&& self, std::size_t from, Expr product, int degree) -> void {
      for (std::size_t i = from; i < result_.integrals.size(); ++i) {
        const ConservedFunction& integral = result_.integrals[i];
        const int sum = degree + std::max(1, integral.velocity_degree);
        if (sum > options_.velocity_degree || (integral.explicit_time && !ansatz_.explicit_time) || out.size() > 400)
          continue;
        const Expr next = product ? product * integral.value : integral.value;
        out.push_back(next);
        self(self, i, next, sum);
      }
    };
    extend(extend, 0, Expr(), 0);
    return out;
  }

  /// Certifies, names and keeps.
  void take(Expr value, IntegralKind kind) {
    if (equations_.degenerate && !equations_.degenerate->is_determined(value)) return;  // it moves with the gauge
    ConservedFunction integral;
    integral.certificate = along_.is_constant(value);
    if (integral.certificate.verdict != Verdict::Zero) {
      ++result_.too_long;
      return;
    }
    if (const AcrossSwitches sides = along_.across(value); sides.jump) return note_side(value, sides.jump->place);
    integral.kind = kind;
    const Namer namer(equations_, rows_, ansatz_, options_.seed + 6);
    const Naming naming = hamiltonian_ ? namer.name(value) : namer.name_by_value(value);
    integral.value = naming.scaled;
    integral.name = naming.name;
    integral.symmetry = kind == IntegralKind::Noether ? naming.symmetry : "";
    integral.readable = readable(integral.value, equations_.order);
    if (zero_test(with_intermediates(integral.readable) - integral.value).verdict != Verdict::Zero)
      integral.readable = {integral.value, {}, {}};
    integral.velocity_degree = velocity_degree(integral.value, system_).value_or(1);
    // cos²Ωt + sin²Ωt of a rotating frame is no explicit time.
    integral.explicit_time = zero_test(differentiate(integral.value, system_.context->time())).verdict != Verdict::Zero;
    if (kind == IntegralKind::Hidden) integral.characteristic = short_symmetry(integral.value);
    ranks_.emplace(integral.value, naming.rank);
    result_.integrals.push_back(std::move(integral));
  }

  /// Functions of the branch alone, as step(x) itself, are nothing to tell.
  void note_side(Expr value, const std::string& place) {
    ExprVector symbols;
    for (const Coordinate& c : system_.coordinates) symbols.insert(symbols.end(), {c.q, c.velocity});
    if (zero_test(gradient(value, symbols)).verdict != Verdict::Zero) result_.on_one_side.push_back({value, place});
  }

  /// δq of an integral without a point symmetry, where a reader can follow it.
  ExprVector short_symmetry(Expr integral) const {
    constexpr std::size_t most_coordinates = 3, most_nodes = 400;
    const auto symmetry = system_.coordinates.size() <= most_coordinates ? symmetry_of(integral, rows_) : std::nullopt;
    if (!symmetry || topological_order(*symmetry).size() > most_nodes) return {};
    ExprVector out;
    for (const Expr& e : *symmetry) {
      const ReadableForm form = readable(e, equations_.order);
      if (!form.intermediates.empty()) return {};
      out.push_back(form.value);
    }
    return out;
  }

  static Expr with_intermediates(const ReadableForm& form) {
    Expr value = form.value;
    for (auto it = form.intermediates.rbegin(); it != form.intermediates.rend(); ++it) {
      ExprMap put_in;
      put_in.emplace(it->symbol, it->value);
      value = substitute(value, put_in);
    }
    return value;
  }

  void put_in_order() {
    const auto key = [&](const ConservedFunction& i) {
      return std::make_tuple(i.kind == IntegralKind::Hidden, ranks_.at(i.value), i.explicit_time);
    };
    std::stable_sort(result_.integrals.begin(), result_.integrals.end(),
                     [&](const ConservedFunction& a, const ConservedFunction& b) {
                       return key(a) != key(b) ? key(a) < key(b) : a.name < b.name;
                     });
  }

  /// Those that depend on others stay where they are charges of their own symmetries, or have a name (the third
  /// component of a vector), or are new among those without explicit time.
  void remove_functions_of_others() {
    std::vector<Expr> autonomous;
    for (const ConservedFunction& i : result_.integrals)
      if (!i.explicit_time) autonomous.push_back(i.value);
    const auto marks = autonomous.empty()
                           ? std::vector<bool>()
                           : independent_functions_of_state(rows_, solvable_, autonomous, options_.seed + 8);
    std::size_t next = 0;
    std::vector<ConservedFunction> kept, left_out;
    for (ConservedFunction& i : result_.integrals) {
      const bool is_new = i.independent || (!i.explicit_time && marks[next]);
      next += i.explicit_time ? 0 : 1;
      const bool stays = i.kind == IntegralKind::Noether || !i.name.empty();
      (is_new || stays ? kept : left_out).push_back(std::move(i));
    }
    if (hamiltonian_) keep_what_brackets_give(kept, left_out);
    result_.integrals = std::move(kept);
  }

  /// The second component of a vector is the bracket of the first with an angular momentum (Poincaré's vector of
  /// a charge about a monopole).
  void keep_what_brackets_give(std::vector<ConservedFunction>& kept, std::vector<ConservedFunction>& left_out) const {
    constexpr std::size_t many = 10, most_coordinates = 3;
    if (kept.size() > many || left_out.size() > many || rows_.system->coordinates.size() > most_coordinates) return;
    const PoissonAlgebra poisson(rows_, solvable_);
    const auto is_given = [&](const ConservedFunction& i, std::size_t with) {
      for (std::size_t j = 0; j < with; ++j) {
        const Expr bracket = poisson.bracket(kept[j].value, kept[with].value);
        if (zero_test(bracket).verdict == Verdict::Zero) continue;
        if (fit_constants(rows_, {{{i.value, bracket}}, 1}, options_.seed + 9)) return true;
      }
      return false;
    };
    for (std::size_t with = 1; with < kept.size(); ++with)
      for (auto i = left_out.begin(); i != left_out.end();)
        if (is_given(*i, with)) {
          kept.push_back(std::move(*i));
          i = left_out.erase(i);
        } else {
          ++i;
        }
  }

  void put_shown_first() {
    const auto is_shown = [](const ConservedFunction& i) { return i.independent || !i.name.empty(); };
    const auto end = std::stable_partition(result_.integrals.begin(), result_.integrals.end(), is_shown);
    result_.shown = static_cast<std::size_t>(end - result_.integrals.begin());
  }

  /// I1, I2, …, or other letters where the model uses these names.
  void number_them() {
    for (const char* letter : {"I", "C", "K", "Int", "First"}) {
      bool is_free = true;
      for (std::size_t i = 1; i <= result_.integrals.size(); ++i) is_free &= !is_used(fmt::format("{}{}", letter, i));
      if (!is_free) continue;
      for (std::size_t i = 1; i <= result_.integrals.size(); ++i)
        result_.symbols.push_back(system_.context->symbol(fmt::format("{}{}", letter, i), Role::Auxiliary));
      return;
    }
    throw std::logic_error("no free names for the integrals; please report");
  }

  bool is_used(const std::string& name) const {
    const auto named = [&](const auto& x) { return x.name == name; };
    return std::any_of(system_.parameters.begin(), system_.parameters.end(), named) ||
           std::any_of(system_.coordinates.begin(), system_.coordinates.end(), named) ||
           std::any_of(system_.inputs.begin(), system_.inputs.end(), named) ||
           std::any_of(system_.definitions.begin(), system_.definitions.end(), named);
  }

  void mark_independent() {
    std::vector<Expr> values, autonomous;
    for (const ConservedFunction& i : result_.integrals) {
      values.push_back(i.value);
      if (!i.explicit_time) autonomous.push_back(i.value);
    }
    if (values.empty()) return;
    const auto marks = independent_functions_of_state(rows_, solvable_, values, options_.seed + 8);
    for (std::size_t i = 0; i < marks.size(); ++i) result_.integrals[i].independent = marks[i];
    result_.rank = static_cast<std::size_t>(std::count(marks.begin(), marks.end(), true));
    const auto without_time = independent_functions_of_state(rows_, solvable_, autonomous, options_.seed + 8);
    result_.autonomous_rank = static_cast<std::size_t>(std::count(without_time.begin(), without_time.end(), true));
  }

  const Model& model_;
  const EquationsOfMotion& equations_;
  const EquationsOfMotion& solvable_;  // equations of the same motion that determine all accelerations
  const MechanicalSystem& system_;
  const InvariantsOptions& options_;
  Diagnostics& diagnostics_;
  MotionRows rows_;
  Ansatz ansatz_;
  AlongMotion along_;
  bool hamiltonian_ = false;
  Invariants result_;
  std::unordered_map<Expr, int, ExprHash> ranks_;
};

}  // namespace

std::optional<Invariants> find_invariants(const Model& model, const EquationsOfMotion& equations,
                                          const InvariantsOptions& options, Diagnostics& diagnostics) {
  if (is_nonlinear_in_velocities(solvable_equations(equations))) {
    diagnostics.error(
        "E1003", {}, "a constraint is not linear in the velocities",
        "The search draws velocities that satisfy the constraints over a prime field, which needs linear equations.",
        "`expect conserved EXPR` proves a single integral of such a system.");
    return std::nullopt;
  }
  const auto named = invariants::with_named_constants(equations);
  if (!named) return Finder(model, equations, options, diagnostics).carry_out();
  InvariantsOptions without_drift = options;
  without_drift.drift = false;
  auto found = Finder(model, named->equations, without_drift, diagnostics).carry_out();
  if (!found) return std::nullopt;
  invariants::put_back(named->meaning, *found);
  if (named->related) {  // as it is written: sin² α + cos² α = 1 may be needed
    auto as_written = Finder(model, equations, without_drift, diagnostics).carry_out();
    const auto size = [](const Invariants& i) { return std::make_pair(i.autonomous_rank, i.noether_symmetries); };
    const auto seen = [](const Invariants& i) { return i.integrals.size() + i.too_long; };
    if (as_written && size(*as_written) > size(*found))
      found = std::move(as_written);
    else if (as_written && seen(*as_written) > seen(*found))  // for these numbers alone: their coefficients hold roots
      found->too_long += seen(*as_written) - seen(*found);
  }
  if (options.drift) measure_drift(*found, model, equations, diagnostics);
  return found;
}

namespace {

/// de/dt = 0 at random points of the motion over a prime field.
bool is_constant_along_motion(Expr e, const MotionRows& rows) {
  constexpr int points = 3;
  MotionSampler sampler(rows, {e}, true, 0x72617465);
  const auto roots = sampler.usable_parameters();
  for (int k = 0; k < points; ++k) {
    const auto sample = roots ? sampler.draw(*roots) : std::nullopt;
    if (!sample || sample->rates[0] != 0) return false;
  }
  return true;
}

}  // namespace

bool is_function_of(Expr e, const Invariants& found, const EquationsOfMotion& given) {
  const EquationsOfMotion& equations = solvable_equations(given);
  const MotionRows rows = motion_rows(equations);
  if (!is_constant_along_motion(e, rows)) return false;
  std::vector<Expr> functions;
  for (const ConservedFunction& i : found.integrals) functions.push_back(i.value);
  functions.push_back(e);
  return !independent_functions_of_state(rows, equations, functions, 0x657870).back();
}

std::optional<int> velocity_degree(Expr e, const MechanicalSystem& system) {
  // The degree in s of e(q, s q̇): differentiate by s until nothing is left.
  const Expr s = system.context->symbol("velocity_scale", Role::Auxiliary);
  ExprMap scaled;
  for (const Coordinate& c : system.coordinates) scaled.emplace(c.velocity, s * c.velocity);
  Expr slope = substitute(expand_time_derivatives(e), scaled);
  constexpr int most = 6;
  for (int degree = 0; degree <= most; ++degree) {
    slope = differentiate(slope, s);
    if (vanishes_identically(slope)) return degree;
  }
  return std::nullopt;
}

}  // namespace maupertuis
