#include "system/elaboration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// Expectations about the neighbours of a point or of a periodic motion: eigenvalues, matrices, critical parameters, return maps.
namespace maupertuis::elaboration {
namespace {

using syntax::ExpectStatement;
using syntax::Expression;
using Kind = ExpectStatement::Kind;

const Expression& without_sign(const Expression& x) { return x.kind == Expression::Kind::Unary ? without_sign(*x.arguments[0]) : x; }

/// Real and imaginary parts of one dimension; shown in the unit of the last that has one.
bool complex_values(Elaboration& e, Expectation& out, const ExpectStatement& s, const Dimension& dimension, const char* what) {
  bool good = true;
  out.dimension = dimension;
  const auto part = [&](const syntax::ExpressionPtr& x) {
    if (!x) return e.number(0);
    const Value v = constant_of(e, *x, dimension, what);
    good = good && !v.poisoned;
    if (without_sign(*x).kind == Expression::Kind::Quantity) set_display_unit(e, out, *x);
    return v.poisoned ? e.number(0) : v.scalar();
  };
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    out.values.push_back(part(s.values[i]));
    out.imaginary.push_back(part(s.imaginary[i]));
  }
  return good && tolerance_of(e, out, s, dimension);
}

/// multipliers, trace, period: `over` a time that is a period, or nearly one.
bool return_map(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  if (s.time) {
    const Value time = constant_of(e, *s.time, e.time(), in_words(e, "the time of a period"));
    if (time.poisoned) return false;
    out.time = time.scalar();
  }
  if (s.kind == Kind::Multipliers) return complex_values(e, out, s, Dimension{}, "a multiplier");
  out.dimension = s.kind == Kind::Trace ? Dimension{} : e.time();
  const Value v = constant_of(e, *s.value, out.dimension, s.kind == Kind::Trace ? "the trace of a return map" : "a period");
  if (v.poisoned) return false;
  out.value = v.scalar();
  set_display_unit(e, out, *s.value);
  return tolerance_of(e, out, s, out.dimension);
}

// ------------------------------------------------------------------------------------------------------------ matrices

void refuse_matrix(Elaboration& e, Span span, std::string message, std::string reason, std::string help) {
  e.diagnostics.error("E0247", span, std::move(message), std::move(reason), std::move(help));
}

/// What rows or columns of each letter may be: q; q and q'; inputs.
struct Allowed {
  bool rates = false, inputs = false;
};

std::optional<MatrixVariable> matrix_variable(Elaboration& e, const Expression& x, Allowed allowed) {
  const MechanicalSystem& system = e.system();
  const auto by_name = [&](const auto& item) { return x.kind == Expression::Kind::Name && item.name == x.text; };
  if (allowed.inputs) {
    const auto input = std::find_if(system.inputs.begin(), system.inputs.end(), by_name);
    if (input != system.inputs.end() && x.primes == 0) return MatrixVariable{static_cast<std::size_t>(input - system.inputs.begin()), -1};
  } else if (x.primes <= (allowed.rates ? 1 : 0)) {
    if (const auto component = quaternion_component(e, x)) return MatrixVariable{*component, x.primes};
    const auto q = std::find_if(system.coordinates.begin(), system.coordinates.end(), by_name);
    if (q != system.coordinates.end()) return MatrixVariable{static_cast<std::size_t>(q - system.coordinates.begin()), x.primes};
  }
  refuse_matrix(e, x.span, fmt::format("`{}` is no {} of this matrix", e.source.slice(x.span), allowed.inputs ? "column" : "variable"),
                allowed.inputs   ? "The columns of B belong to the inputs of the model."
                : allowed.rates ? "The states are coordinates and their velocities."
                                : "Its rows and columns belong to coordinates.",
                "");
  return std::nullopt;
}

/// As written, or all.
bool matrix_variables(Elaboration& e, const std::vector<syntax::ExpressionPtr>& written, Allowed allowed, std::vector<MatrixVariable>& out) {
  for (const auto& x : written) {
    const auto v = matrix_variable(e, *x, allowed);
    if (!v) return false;
    out.push_back(*v);
  }
  if (!written.empty()) return true;
  const MechanicalSystem& system = e.system();
  for (int order = 0; order <= (allowed.rates ? 1 : 0) && !allowed.inputs; ++order)
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) out.push_back({i, order});
  for (std::size_t i = 0; i < system.inputs.size() && allowed.inputs; ++i) out.push_back({i, -1});
  return true;
}

Dimension dimension_of(const Elaboration& e, const MatrixVariable& v) {
  if (v.order < 0) return e.model.system.inputs[v.index].dimension;
  const Dimension& q = e.model.system.coordinates[v.index].dimension;
  return v.order == 0 ? q : q / e.time();
}

/// M q̈ + (C + G) q̇ + (K + N) q is a force; A x + B u is a rate of x.
Dimension dimension_of_entry(const Elaboration& e, char letter, const MatrixVariable& row, const MatrixVariable& column) {
  const Dimension i = dimension_of(e, row), j = dimension_of(e, column), t = e.time();
  if (letter == 'A' || letter == 'B') return i / (t * j);
  const Dimension k = e.model.system.lagrangian_dimension / (i * j);
  return letter == 'M' ? k * t * t : letter == 'C' || letter == 'G' ? k * t : k;
}

/// Numbers without a unit are in SI, as in papers on robots; others have the dimension of their place.
bool entries(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  bool good = true, one_unit = true;
  double factor = 0;
  for (std::size_t k = 0; k < s.values.size(); ++k) {
    const Expression& x = *s.values[k];
    const bool bare = without_sign(x).kind == Expression::Kind::Number;
    const Dimension dimension = dimension_of_entry(e, out.name[0], out.rows[k / s.width], out.columns[k % s.width]);
    const Value v = constant_of(e, x, bare ? Dimension{} : dimension, fmt::format("this entry of {}", out.name));
    good = good && !v.poisoned;
    out.values.push_back(v.poisoned ? e.number(0) : v.scalar());
    out.dimension = dimension;
    out.display_factor = 1;
    out.display_unit.clear();
    if (!bare) set_display_unit(e, out, x);
    one_unit = one_unit && (k == 0 || out.display_factor == factor);
    factor = out.display_factor;
  }
  if (!one_unit) out.display_unit.clear(), out.display_factor = 1;
  return good && tolerance_of(e, out, s, out.dimension);
}

bool matrix(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  const char letter = s.name.text[0];
  const bool states = letter == 'A' || letter == 'B', inputs = letter == 'B';
  if (letter != 'M' && s.rows.empty() && e.system().constrained()) {
    refuse_matrix(e, s.name.span, fmt::format("it is not said which rows of {} these are", letter),
                  "With constraints the equations are linearized in independent coordinates, which the program chooses.",
                  "Name them after `in`, for example A in (θ, θ') at θ = 0 : …; `maup modes` shows which there are.");
    return false;
  }
  out.width = s.width;
  if (!matrix_variables(e, s.rows, {states, false}, out.rows)) return false;
  if (s.columns.empty() && !inputs) out.columns = out.rows;
  else if (!matrix_variables(e, s.columns, {states && !inputs, inputs}, out.columns)) return false;
  const std::size_t rows = s.values.size() / s.width;
  if (rows != out.rows.size() || s.width != out.columns.size()) {
    const Span span = cover(s.values.front()->span, s.values.back()->span);
    refuse_matrix(e, span, fmt::format("this matrix is {} by {}, and {} is {} by {}", rows, s.width, letter, out.rows.size(), out.columns.size()),
                  states ? "Its rows belong to the states: coordinates, then velocities." : "Its rows belong to the coordinates, in the order of their declaration.",
                  "Name the rows after `in` and the columns after `by` where only some are meant.");
    return false;
  }
  return point_of_expectation(e, out, s) && entries(e, out, s);
}

// ------------------------------------------------------------------------------------------------- critical parameters

bool stable(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  const Expression& x = *s.subject;
  const auto& parameters = e.system().parameters;
  const auto p = std::find_if(parameters.begin(), parameters.end(),
                              [&](const Parameter& p) { return x.kind == Expression::Kind::Name && x.primes == 0 && p.name == x.text; });
  if (p == parameters.end()) {
    e.diagnostics.error("E0248", x.span, fmt::format("`{}` is no parameter", e.source.slice(x.span)),
                        "A critical value is one of a parameter, at which the stability changes.", "Make it a `param`.");
    return false;
  }
  if (Declaration* d = e.table.find(p->name)) d->used = true;
  out.parameter = static_cast<std::size_t>(p - parameters.begin());
  out.above = s.above;
  out.dimension = p->dimension;
  const Value v = constant_of(e, *s.value, p->dimension, fmt::format("`{}`", p->name));
  if (v.poisoned) return false;
  out.value = v.scalar();
  set_display_unit(e, out, *s.value);
  return tolerance_of(e, out, s, out.dimension) && point_of_expectation(e, out, s);
}

}  // namespace

bool expect_of_neighbours(Elaboration& e, Expectation& out, const ExpectStatement& s) {
  const bool about_point = s.kind == Kind::Eigenvalues || s.kind == Kind::Matrix || s.kind == Kind::Stable;
  if (s.kind == Kind::Eigenvalues)
    return point_of_expectation(e, out, s) && complex_values(e, out, s, e.dimension(Dimension{}) / e.time(), "an eigenvalue");
  if (about_point) return s.kind == Kind::Matrix ? matrix(e, out, s) : stable(e, out, s);
  return return_map(e, out, s);
}

}  // namespace maupertuis::elaboration
