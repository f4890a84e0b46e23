#pragma once
#include <maupertuis/fields.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace maupertuis {

class RestingFields;

/// Fields that stay what they are: those that a model starts from where these do, else φ = 0.
///
/// A start is a rest where the residuals vanish for φ = φ(x), and what stands at the ends, proved by the zero test.
struct FieldRest {
  std::vector<Expr> fields;                       // [varied] φ at rest, a function of place
  std::shared_ptr<const RestingFields> computed;  // where no formula is known: in the place of `fields`

  /// The jets of an expression at rest, but those of given fields, and, where the rest was computed, those in space.
  ExprMap values(const FieldEquations& equations, Expr e) const;
  /// u = 0, v = tanh x
  std::string text(const FieldEquations& equations) const;
  /// Of a jet where the rest was computed; nothing for other symbols.
  std::optional<double> value(const FieldSystem& system, Expr symbol, double x, double y) const;
};
FieldRest rest_of(const FieldEquations& equations);
bool is_rest(const FieldEquations& equations, const FieldRest& rest);

}  // namespace maupertuis
