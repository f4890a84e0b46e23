#pragma once
#include <maupertuis/functions.hpp>

#include <string_view>

namespace maupertuis {

/// What every pass may ask of a node kind.
struct KindInfo {
  Kind kind;
  std::string_view name;           // in dumps, and of functions in the model language
  int arity;                       // −1: any number
  Parity parity;                   // of what has one argument
  std::string_view latex, mathml;  // before the arguments of what is written as a function
  bool bare;                       // sin θ, sin² θ
};

const KindInfo& kind_info(Kind kind);

}  // namespace maupertuis
