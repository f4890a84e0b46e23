#pragma once
#include <maupertuis/fields.hpp>

#include <string>
#include <vector>

namespace maupertuis {

/// Fields that stay what they are: those that a model starts from where these do, else φ = 0.
///
/// A start is a rest where the residuals vanish for φ = φ(x), and what stands at the ends, proved by the zero test.
struct FieldRest {
  std::vector<Expr> fields;  // [varied] φ at rest, a function of place

  /// The jets of an expression at rest, but those of given fields.
  ExprMap values(const FieldEquations& equations, Expr e) const;
  /// u = 0, v = tanh x
  std::string text(const FieldEquations& equations) const;
};
FieldRest rest_of(const FieldEquations& equations);
bool is_rest(const FieldEquations& equations, const FieldRest& rest);

}  // namespace maupertuis
