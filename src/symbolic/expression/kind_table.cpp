#include "symbolic/expression/kind_table.hpp"

#include <maupertuis/kinds.hpp>

#include <array>
#include <string>

namespace maupertuis {
namespace {

constexpr KindInfo structure(Kind kind, std::string_view name, int arity) {
  return {kind, name, arity, Parity::None, {}, {}, false};
}

constexpr std::array before_functions{
    structure(Kind::Number, "number", 0),      structure(Kind::Pi, "pi", 0),
    structure(Kind::Symbol, "symbol", 0),      structure(Kind::Sum, "add", -1),
    structure(Kind::Product, "mul", -1),       structure(Kind::Power, "pow", 2),
    structure(Kind::TimeDerivative, "ddt", 1),
};
constexpr std::array after_functions{
    KindInfo{Kind::Abs, "abs", 1, Parity::Even, {}, {}, false},
    KindInfo{Kind::Sign, "sign", 1, Parity::Odd, "\\operatorname{sgn}", "sgn", false},
    KindInfo{Kind::Step, "step", 1, Parity::None, "\\operatorname{step}", "step", false},
    KindInfo{Kind::Atan2, "atan2", 2, Parity::None, "\\operatorname{atan2}", "atan2", false},
    KindInfo{Kind::Min, "min", 2, Parity::None, "\\min", "min", false},
    KindInfo{Kind::Max, "max", 2, Parity::None, "\\max", "max", false},
    structure(Kind::Piecewise, "piecewise", -1),
    structure(Kind::Less, "less", 2),
    structure(Kind::LessEqual, "less_equal", 2),
    structure(Kind::And, "and", 2),
    structure(Kind::Or, "or", 2),
};

constexpr std::size_t count = before_functions.size() + functions::count + after_functions.size();

constexpr std::array<KindInfo, count> make_table() {
  std::array<KindInfo, count> table{};
  std::size_t next = 0;
  for (const KindInfo& info : before_functions) table[next++] = info;
  std::apply(
      [&](const auto&... row) {
        ((table[next++] = {row.kind, row.name, 1, row.parity, row.latex, row.mathml, row.bare}), ...);
      },
      functions::rows);
  for (const KindInfo& info : after_functions) table[next++] = info;
  return table;
}
constexpr std::array table = make_table();

constexpr bool in_order() {
  for (std::size_t i = 0; i < table.size(); ++i)
    if (static_cast<std::size_t>(table[i].kind) != i) return false;
  return true;
}
static_assert(in_order(), "the table follows the enumeration");
static_assert(table.size() == static_cast<std::size_t>(Kind::Or) + 1, "a row for every kind");

}  // namespace

const KindInfo& kind_info(Kind kind) {
  const auto index = static_cast<std::size_t>(kind);
  if (index >= table.size()) throw unknown_kind(kind, "the table of kinds");
  return table[index];
}

std::string_view name_of(Kind kind) { return kind_info(kind).name; }

std::logic_error unknown_kind(Kind kind, std::string_view who) {
  const auto index = static_cast<std::size_t>(kind);
  std::string text(who);
  text += " met ";
  text += index < table.size() ? table[index].name : std::string_view("an unknown kind");
  text += ", for which it has no rule; please report";
  return std::logic_error(text);
}

}  // namespace maupertuis
