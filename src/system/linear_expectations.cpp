#include "system/elaboration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

/// Expectations about the neighbours of a point or of a periodic motion: eigenvalues, matrices, critical parameters,
/// return maps.
namespace maupertuis::elaboration {
namespace {

using expectation::MatrixVariable;
using syntax::Expression;

/// Real and imaginary parts of one dimension; shown in the unit of the last that has one.
std::optional<expectation::Spectrum> spectrum(Elaboration& e, const written::Spectrum& x, const Dimension& dimension,
                                              const char* what) {
  expectation::Spectrum out;
  bool good = true;
  const auto part = [&](const syntax::ExpressionPtr& value) {
    if (!value) return e.number(0);
    const Value v = expected_constant_of(e, *value, dimension, what);
    good = good && !v.poisoned;
    if (const auto unit = display_unit(e, *value, dimension)) out.unit = *unit;
    return v.poisoned ? e.number(0) : v.scalar();
  };
  for (std::size_t i = 0; i < x.real.size(); ++i) {
    out.real.push_back(part(x.real[i]));
    out.imaginary.push_back(part(x.imaginary[i]));
  }
  if (!good) return std::nullopt;
  const auto tolerance = tolerance_of(e, x.tolerance, dimension, out.unit);
  if (!tolerance) return std::nullopt;
  out.tolerance = *tolerance;
  return out;
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
    if (input != system.inputs.end() && x.primes == 0)
      return MatrixVariable{static_cast<std::size_t>(input - system.inputs.begin()), -1};
  } else if (x.primes <= (allowed.rates ? 1 : 0)) {
    if (const auto component = quaternion_component(e, x)) return MatrixVariable{*component, x.primes};
    const auto q = std::find_if(system.coordinates.begin(), system.coordinates.end(), by_name);
    if (q != system.coordinates.end())
      return MatrixVariable{static_cast<std::size_t>(q - system.coordinates.begin()), x.primes};
    const auto rate = std::find_if(system.rates.begin(), system.rates.end(), by_name);
    if (allowed.rates && rate != system.rates.end() && x.primes == 0)
      return MatrixVariable{static_cast<std::size_t>(rate - system.rates.begin()), 2};
  }
  refuse_matrix(
      e, x.span,
      fmt::format("`{}` is no {} of this matrix", e.texts.slice(x.span), allowed.inputs ? "column" : "variable"),
      allowed.inputs  ? "The columns of B belong to the inputs of the model."
      : allowed.rates ? "The states are coordinates and their velocities, or the rates of the model in place of these."
                      : "Its rows and columns belong to coordinates.",
      "");
  return std::nullopt;
}

/// As written, or all.
bool matrix_variables(Elaboration& e, const std::vector<syntax::ExpressionPtr>& written, Allowed allowed,
                      std::vector<MatrixVariable>& out) {
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
  if (v.order == 2) return e.model.system.rates[v.index].dimension;
  const Dimension& q = e.model.system.coordinates[v.index].dimension;
  return v.order == 0 ? q : q / e.time();
}

/// M q̈ + (C + G) q̇ + (K + N) q is a force; A x + B u is a rate of x.
Dimension dimension_of_entry(const Elaboration& e, char letter, const MatrixVariable& row,
                             const MatrixVariable& column) {
  const Dimension i = dimension_of(e, row), j = dimension_of(e, column), t = e.time();
  if (letter == 'A' || letter == 'B') return i / (t * j);
  const Dimension k = e.model.system.lagrangian_dimension / (i * j);
  return letter == 'M' ? k * t * t : letter == 'C' || letter == 'G' ? k * t : k;
}

/// Numbers without a unit are in SI, as in papers on robots; others have the dimension of their place.
bool entries(Elaboration& e, expectation::Matrix& out, const written::Matrix& m) {
  bool good = true, one_unit = true;
  Dimension dimension;
  for (std::size_t k = 0; k < m.entries.size(); ++k) {
    const Expression& x = *m.entries[k];
    const bool bare = unsigned_quantity(x).kind == Expression::Kind::Number;
    dimension = dimension_of_entry(e, out.letter, out.rows[k / m.width], out.columns[k % m.width]);
    const Value v = constant_of(e, x, bare ? Dimension{} : dimension, fmt::format("this entry of {}", out.letter));
    good = good && !v.poisoned;
    out.entries.push_back(v.poisoned ? e.number(0) : v.scalar());
    const double factor = out.unit.factor;
    out.unit = bare ? expectation::DisplayUnit{} : display_unit(e, x, dimension).value_or(expectation::DisplayUnit{});
    one_unit = one_unit && (k == 0 || out.unit.factor == factor);
  }
  if (!one_unit) out.unit = {};
  if (!good) return false;
  const auto tolerance = tolerance_of(e, m.tolerance, dimension, out.unit);
  if (tolerance) out.tolerance = *tolerance;
  return tolerance.has_value();
}

/// What the rows and columns belong to: as written, or all. False, and a message, where there are not as many.
bool variables(Elaboration& e, expectation::Matrix& out, const written::Matrix& m) {
  const bool states = out.letter == 'A' || out.letter == 'B', inputs = out.letter == 'B';
  if (!matrix_variables(e, m.rows, {states, false}, out.rows)) return false;
  if (m.columns.empty() && !inputs)
    out.columns = out.rows;
  else if (!matrix_variables(e, m.columns, {states && !inputs, inputs}, out.columns))
    return false;
  const std::size_t rows = m.entries.size() / m.width;
  if (rows == out.rows.size() && m.width == out.columns.size()) return true;
  const Span span = cover(m.entries.front()->span, m.entries.back()->span);
  refuse_matrix(e, span,
                fmt::format("this matrix is {} by {}, and {} is {} by {}", rows, m.width, out.letter, out.rows.size(),
                            out.columns.size()),
                states ? "Its rows belong to the states: coordinates, then velocities."
                       : "Its rows belong to the coordinates, in the order of their declaration.",
                "Name the rows after `in` and the columns after `by` where only some are meant.");
  return false;
}

/// The parameter of a critical value; null, and a message, if it is none.
const Parameter* critical_parameter(Elaboration& e, const Expression& x) {
  const auto& parameters = e.system().parameters;
  const auto p = std::find_if(parameters.begin(), parameters.end(), [&](const Parameter& p) {
    return x.kind == Expression::Kind::Name && x.primes == 0 && p.name == x.text;
  });
  if (p == parameters.end()) {
    e.diagnostics.error("E0248", x.span, fmt::format("`{}` is no parameter", e.texts.slice(x.span)),
                        "A critical value is one of a parameter, at which the stability changes.",
                        "Make it a `param`.");
    return nullptr;
  }
  if (Declaration* d = e.table.find(p->name)) d->used = true;
  return &*p;
}

}  // namespace

Expected meaning_of(Elaboration& e, const written::Eigenvalues& x, Span) {
  auto point = point_of_expectation(e, x.at);
  if (!point) return std::nullopt;
  auto expected = spectrum(e, x.expected, e.dimension(Dimension{}) / e.time(), "an eigenvalue");
  return expected ? Expected(expectation::Eigenvalues{std::move(*point), std::move(*expected)}) : std::nullopt;
}

Expected meaning_of(Elaboration& e, const written::Matrix& x, Span) {
  expectation::Matrix out;
  out.letter = x.letter.text[0];
  if (out.letter != 'M' && x.rows.empty() && e.system().constrained()) {
    refuse_matrix(
        e, x.letter.span, fmt::format("it is not said which rows of {} these are", out.letter),
        "With constraints the equations are linearized in independent coordinates, which the program chooses.",
        "Name them after `in`, for example A in (θ, θ') at θ = 0 : …; `maup modes` shows which there are.");
    return std::nullopt;
  }
  if (!variables(e, out, x)) return std::nullopt;
  auto point = point_of_expectation(e, x.at);
  if (!point || !entries(e, out, x)) return std::nullopt;
  out.at = std::move(*point);
  return out;
}

Expected meaning_of(Elaboration& e, const written::Stable& x, Span) {
  const Parameter* p = critical_parameter(e, *x.parameter);
  if (!p) return std::nullopt;
  const auto critical = expected_number(e, x.critical, p->dimension, fmt::format("`{}`", p->name));
  if (!critical) return std::nullopt;
  auto point = point_of_expectation(e, x.at);
  if (!point) return std::nullopt;
  return expectation::Stable{x.word.text == "stable", static_cast<std::size_t>(p - e.system().parameters.data()),
                             x.above, *critical, std::move(*point)};
}

namespace {

/// `over` a time that is a period, or nearly one; empty where none is written. Nothing after a mistake.
std::optional<Expr> time_of_period(Elaboration& e, const syntax::ExpressionPtr& over) {
  if (!over) return Expr();
  const Value time = constant_of(e, *over, e.time(), in_words(e, "the time of a period"));
  return time.poisoned ? std::nullopt : std::optional(time.scalar());
}

}  // namespace

Expected meaning_of(Elaboration& e, const written::Multipliers& x, Span) {
  const auto over = time_of_period(e, x.over);
  if (!over) return std::nullopt;
  auto expected = spectrum(e, x.expected, Dimension{}, "a multiplier");
  return expected ? Expected(expectation::Multipliers{*over, std::move(*expected)}) : std::nullopt;
}

Expected meaning_of(Elaboration& e, const written::Trace& x, Span) {
  const auto over = time_of_period(e, x.over);
  if (!over) return std::nullopt;
  const auto expected = expected_number(e, x.expected, Dimension{}, "the trace of a return map");
  return expected ? Expected(expectation::Trace{*over, *expected}) : std::nullopt;
}

Expected meaning_of(Elaboration& e, const written::Period& x, Span) {
  const auto over = time_of_period(e, x.over);
  if (!over) return std::nullopt;
  const auto expected = expected_number(e, x.expected, e.time(), "a period");
  return expected ? Expected(expectation::Period{*over, *expected}) : std::nullopt;
}

}  // namespace maupertuis::elaboration
