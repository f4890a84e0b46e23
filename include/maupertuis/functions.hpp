#pragma once
#include <maupertuis/error_function.hpp>
#include <maupertuis/kinds.hpp>
#include <maupertuis/lambert_w.hpp>

#include <cmath>
#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>

/// The smooth functions of one argument, a row each: all that the passes ask of one. A new function is a Kind, its row
/// here, its word in the grammar, and the two rules that are kept apart on purpose, so that a wrong row cannot certify
/// itself: its image in a prime field (symbolic/evaluate/field_numbers) and its series in the certificate
/// (symbolic/evaluate/jet_numbers).
namespace maupertuis {

enum class Parity : std::uint8_t { None, Odd, Even };

/// Dimensions of argument and value, where one of them is an angle.
enum class Angles : std::uint8_t { Argument, Value, Neither };

template <class ValueOf>
struct FunctionRow {
  Kind kind;
  std::string_view name;           // in the model language and in dumps
  std::string_view latex, mathml;  // what stands before the argument
  bool bare;                       // sin θ, sin² θ: needs no brackets around a name, and carries its exponent
  Parity parity;
  Angles angles;
  int at, exactly;         // the number whose value is known: f(at) = exactly
  std::string_view sleef;  // the stem of SLEEF's name; empty: SLEEF has none, and compiled code calls `value_of`
  Expr (*derivative)(Expr x, Expr f);  // f'(x), written with x and with f = f(x)
  ValueOf value_of;                    // f(x) of any real type, by the functions found beside it
};

namespace functions {

template <class ValueOf>
constexpr FunctionRow<ValueOf> row(Kind kind, std::string_view name, std::string_view latex, std::string_view mathml,
                                   bool bare, Parity parity, Angles angles, int at, int exactly, std::string_view sleef,
                                   Expr (*derivative)(Expr, Expr), ValueOf value_of) {
  return {kind, name, latex, mathml, bare, parity, angles, at, exactly, sleef, derivative, value_of};
}

inline Expr square(Expr e) { return pow(e, Rational(2)); }
inline Expr inverse(Expr e) { return pow(e, Rational(-1)); }
inline Expr inverse_root(Expr e) { return pow(e, Rational(-1, 2)); }
inline Expr one_minus(Expr e) { return e.context().number(1) - e; }

// clang-format off
inline constexpr std::tuple rows{
    row(Kind::Sin, "sin", "\\sin", "sin", true, Parity::Odd, Angles::Argument, 0, 0, "sin",
        [](Expr x, Expr) { return cos(x); },
        [](const auto& x) { using std::sin; return sin(x); }),
    row(Kind::Cos, "cos", "\\cos", "cos", true, Parity::Even, Angles::Argument, 0, 1, "cos",
        [](Expr x, Expr) { return -sin(x); },
        [](const auto& x) { using std::cos; return cos(x); }),
    row(Kind::Tan, "tan", "\\tan", "tan", true, Parity::Odd, Angles::Argument, 0, 0, "tan",
        [](Expr, Expr f) { return square(f) + Rational(1); },
        [](const auto& x) { using std::tan; return tan(x); }),
    row(Kind::Asin, "asin", "\\arcsin", "arcsin", false, Parity::Odd, Angles::Value, 0, 0, "asin",
        [](Expr x, Expr) { return inverse_root(one_minus(square(x))); },
        [](const auto& x) { using std::asin; return asin(x); }),
    row(Kind::Acos, "acos", "\\arccos", "arccos", false, Parity::None, Angles::Value, 1, 0, "acos",
        [](Expr x, Expr) { return -inverse_root(one_minus(square(x))); },
        [](const auto& x) { using std::acos; return acos(x); }),
    row(Kind::Atan, "atan", "\\arctan", "arctan", false, Parity::Odd, Angles::Value, 0, 0, "atan",
        [](Expr x, Expr) { return inverse(square(x) + Rational(1)); },
        [](const auto& x) { using std::atan; return atan(x); }),
    row(Kind::Sinh, "sinh", "\\sinh", "sinh", true, Parity::Odd, Angles::Neither, 0, 0, "sinh",
        [](Expr x, Expr) { return apply(Kind::Cosh, x); },
        [](const auto& x) { using std::sinh; return sinh(x); }),
    row(Kind::Cosh, "cosh", "\\cosh", "cosh", true, Parity::Even, Angles::Neither, 0, 1, "cosh",
        [](Expr x, Expr) { return apply(Kind::Sinh, x); },
        [](const auto& x) { using std::cosh; return cosh(x); }),
    row(Kind::Tanh, "tanh", "\\tanh", "tanh", true, Parity::Odd, Angles::Neither, 0, 0, "tanh",
        [](Expr, Expr f) { return one_minus(square(f)); },
        [](const auto& x) { using std::tanh; return tanh(x); }),
    row(Kind::Asinh, "asinh", "\\operatorname{arsinh}", "arsinh", false, Parity::Odd, Angles::Neither, 0, 0, "asinh",
        [](Expr x, Expr) { return inverse_root(square(x) + Rational(1)); },
        [](const auto& x) { using std::asinh; return asinh(x); }),
    row(Kind::Acosh, "acosh", "\\operatorname{arcosh}", "arcosh", false, Parity::None, Angles::Neither, 1, 0, "acosh",
        [](Expr x, Expr) { return inverse_root(square(x) - Rational(1)); },
        [](const auto& x) { using std::acosh; return acosh(x); }),
    row(Kind::Atanh, "atanh", "\\operatorname{artanh}", "artanh", false, Parity::Odd, Angles::Neither, 0, 0, "atanh",
        [](Expr x, Expr) { return inverse(one_minus(square(x))); },
        [](const auto& x) { using std::atanh; return atanh(x); }),
    row(Kind::Exp, "exp", "\\exp", "exp", false, Parity::None, Angles::Neither, 0, 1, "exp",
        [](Expr, Expr f) { return f; },
        [](const auto& x) { using std::exp; return exp(x); }),
    row(Kind::Log, "log", "\\ln", "ln", false, Parity::None, Angles::Neither, 1, 0, "log",
        [](Expr x, Expr) { return inverse(x); },
        [](const auto& x) { using std::log; return log(x); }),
    row(Kind::Erf, "erf", "\\operatorname{erf}", "erf", false, Parity::Odd, Angles::Neither, 0, 0, "erf",
        [](Expr x, Expr) { return Rational(2) * inverse_root(x.context().pi()) * apply(Kind::Exp, -square(x)); },
        [](const auto& x) { return error_function(x); }),
    row(Kind::LambertW, "lambert_w", "W_0", "W\u2080", false, Parity::None, Angles::Neither, 0, 0, "",
        [](Expr x, Expr f) { return inverse(x + apply(Kind::Exp, f)); },
        [](const auto& x) { return lambert_w(x); }),
};
// clang-format on

inline constexpr std::size_t count = std::tuple_size_v<decltype(rows)>;

template <std::size_t... I>
constexpr bool in_order(std::index_sequence<I...>) {
  constexpr auto first = static_cast<std::size_t>(Kind::Sin);
  return ((static_cast<std::size_t>(std::get<I>(rows).kind) == first + I && is_function(std::get<I>(rows).kind)) &&
          ...) &&
         !is_function(static_cast<Kind>(first + sizeof...(I)));
}
static_assert(in_order(std::make_index_sequence<count>()), "a row for every function, in the order of the enumeration");

/// f(row) of the row of `kind`. Throws std::logic_error if it is no function.
template <std::size_t I = 0, class F>
auto of_row(Kind kind, F&& f) -> decltype(f(std::get<0>(rows))) {
  if constexpr (I == count)
    throw unknown_kind(kind, "the table of functions");
  else
    return std::get<I>(rows).kind == kind ? f(std::get<I>(rows)) : of_row<I + 1>(kind, f);
}

/// f(x). Real: double, or any type with the functions of <cmath> found beside it.
template <class Real>
Real value(Kind kind, const Real& x) {
  return of_row(kind, [&](const auto& row) { return Real(row.value_of(x)); });
}

/// f'(x) of f = f(x).
inline Expr derivative(Kind kind, Expr x, Expr f) {
  return of_row(kind, [&](const auto& row) { return row.derivative(x, f); });
}

}  // namespace functions
}  // namespace maupertuis
