#pragma once
#include <maupertuis/expression.hpp>

#include <string_view>

namespace maupertuis {

enum class Parity : std::uint8_t { None, Odd, Even };

/// What every pass may ask of a node kind. Derivatives stand in transform/derivative_rules, jets in kernel/jet.
struct KindInfo {
  Kind kind;
  std::string_view name;   // in the model language and in dumps
  int arity;               // −1: any number
  Parity parity;           // of functions of one argument
  bool has_switch;         // not smooth where its switch function vanishes
};

const KindInfo& kind_info(Kind kind);

}  // namespace maupertuis
