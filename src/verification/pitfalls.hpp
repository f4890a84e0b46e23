#pragma once
#include "verification/row_terms.hpp"

#include <string>
#include <vector>

namespace maupertuis {

/// Equations that a known mistake would give, to compare a false claim with.
struct Pitfall {
  std::string sentence;           // "the term ∂T/∂q is missing: T depends on the coordinates as well"
  ExprVector residual;            // [n] may be free of q̈
  std::vector<TermOrigin> about;  // the terms that it changes; empty: any
  bool throughout = false;        // it is made in every term: not looked at where one term explains the claim
  bool of_part = false;           // in a part of an energy: looked at where the claim differs in several ways alone
};

std::vector<Pitfall> pitfalls(const EquationsOfMotion& equations);

}  // namespace maupertuis
