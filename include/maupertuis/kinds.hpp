#pragma once
#include <maupertuis/expression.hpp>

#include <stdexcept>
#include <string_view>

namespace maupertuis {

/// Kinds that most passes treat alike. A pass that asks for the family and no further takes a new function as it comes;
/// no pass has a `default` for the kinds that it was not written for.
enum class Family : std::uint8_t {
  Leaf,     // Number, Pi, Symbol
  Algebra,  // Sum, Product, Power
  TimeDerivative,
  Function,  // smooth, of one argument: the rows of functions.hpp
  Angle,     // Atan2
  Switch,    // Abs, Sign, Step
  Extremum,  // Min, Max
  Piecewise,
  Comparison,  // Less, LessEqual
  Logic,       // And, Or
};

/// The word for a kind in dumps, and of functions in the model language ("add", "less", "sin").
std::string_view name_of(Kind kind);

/// Thrown where a pass meets a kind that it has no rule for: what it would make up instead could be certified.
std::logic_error unknown_kind(Kind kind, std::string_view who);

/// Throws std::logic_error on what is no kind.
constexpr Family family_of(Kind kind) {
  switch (kind) {
    case Kind::Number:
    case Kind::Pi:
    case Kind::Symbol:
      return Family::Leaf;
    case Kind::Sum:
    case Kind::Product:
    case Kind::Power:
      return Family::Algebra;
    case Kind::TimeDerivative:
      return Family::TimeDerivative;
    case Kind::Sin:
    case Kind::Cos:
    case Kind::Tan:
    case Kind::Asin:
    case Kind::Acos:
    case Kind::Atan:
    case Kind::Sinh:
    case Kind::Cosh:
    case Kind::Tanh:
    case Kind::Asinh:
    case Kind::Acosh:
    case Kind::Atanh:
    case Kind::Exp:
    case Kind::Log:
    case Kind::Erf:
    case Kind::LambertW:
      return Family::Function;
    case Kind::Abs:
    case Kind::Sign:
    case Kind::Step:
      return Family::Switch;
    case Kind::Atan2:
      return Family::Angle;
    case Kind::Min:
    case Kind::Max:
      return Family::Extremum;
    case Kind::Piecewise:
      return Family::Piecewise;
    case Kind::Less:
    case Kind::LessEqual:
      return Family::Comparison;
    case Kind::And:
    case Kind::Or:
      return Family::Logic;
  }
  throw unknown_kind(kind, "the table of families");
}

constexpr bool is_function(Kind kind) { return family_of(kind) == Family::Function; }
/// A value that jumps or has a kink where its switch function vanishes.
constexpr bool has_switch(Kind kind) {
  const Family family = family_of(kind);
  return family == Family::Switch || family == Family::Extremum || family == Family::Piecewise;
}

}  // namespace maupertuis
