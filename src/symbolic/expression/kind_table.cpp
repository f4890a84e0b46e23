#include "symbolic/expression/kind_table.hpp"

#include <maupertuis/kind_names.hpp>
#include <maupertuis/require.hpp>

#include <array>

namespace maupertuis {
namespace {

constexpr std::array table{
    KindInfo{Kind::Number, "number", 0, Parity::None, false},
    KindInfo{Kind::Pi, "pi", 0, Parity::None, false},
    KindInfo{Kind::Symbol, "symbol", 0, Parity::None, false},
    KindInfo{Kind::Sum, "add", -1, Parity::None, false},
    KindInfo{Kind::Product, "mul", -1, Parity::None, false},
    KindInfo{Kind::Power, "pow", 2, Parity::None, false},
    KindInfo{Kind::TimeDerivative, "ddt", 1, Parity::None, false},
    KindInfo{Kind::Sin, "sin", 1, Parity::Odd, false},
    KindInfo{Kind::Cos, "cos", 1, Parity::Even, false},
    KindInfo{Kind::Tan, "tan", 1, Parity::Odd, false},
    KindInfo{Kind::Asin, "asin", 1, Parity::Odd, false},
    KindInfo{Kind::Acos, "acos", 1, Parity::None, false},
    KindInfo{Kind::Atan, "atan", 1, Parity::Odd, false},
    KindInfo{Kind::Sinh, "sinh", 1, Parity::Odd, false},
    KindInfo{Kind::Cosh, "cosh", 1, Parity::Even, false},
    KindInfo{Kind::Tanh, "tanh", 1, Parity::Odd, false},
    KindInfo{Kind::Asinh, "asinh", 1, Parity::Odd, false},
    KindInfo{Kind::Acosh, "acosh", 1, Parity::None, false},
    KindInfo{Kind::Atanh, "atanh", 1, Parity::Odd, false},
    KindInfo{Kind::Exp, "exp", 1, Parity::None, false},
    KindInfo{Kind::Log, "log", 1, Parity::None, false},
    KindInfo{Kind::Abs, "abs", 1, Parity::Even, true},
    KindInfo{Kind::Sign, "sign", 1, Parity::Odd, true},
    KindInfo{Kind::Step, "step", 1, Parity::None, true},
    KindInfo{Kind::Atan2, "atan2", 2, Parity::None, false},
    KindInfo{Kind::Min, "min", 2, Parity::None, true},
    KindInfo{Kind::Max, "max", 2, Parity::None, true},
    KindInfo{Kind::Piecewise, "piecewise", -1, Parity::None, true},
    KindInfo{Kind::Less, "<", 2, Parity::None, true},
    KindInfo{Kind::LessEqual, "<=", 2, Parity::None, true},
    KindInfo{Kind::And, "and", 2, Parity::None, false},
    KindInfo{Kind::Or, "or", 2, Parity::None, false},
};

constexpr bool in_order() {
  for (std::size_t i = 0; i < table.size(); ++i)
    if (static_cast<std::size_t>(table[i].kind) != i) return false;
  return true;
}
static_assert(in_order(), "the table follows the enumeration");

}  // namespace

const KindInfo& kind_info(Kind kind) {
  const auto index = static_cast<std::size_t>(kind);
  MAUP_REQUIRE(index < table.size());
  return table[index];
}

std::string_view name_of(Kind kind) { return kind_info(kind).name; }

}  // namespace maupertuis
