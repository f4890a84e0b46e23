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
};

/// `of_parts`: of single springs and terms of V as well, two derivations for each.
std::vector<Pitfall> pitfalls(const EquationsOfMotion& equations, bool of_parts);

}  // namespace maupertuis
