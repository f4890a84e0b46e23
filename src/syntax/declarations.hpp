#pragma once
#include "syntax/token.hpp"

#include <string>
#include <unordered_map>
#include <vector>

namespace maupertuis::syntax {

/// The names that a model declares, found before parsing: they decide what `2e1` and `T = …` mean, and that an
/// unknown name before a bracket is no product.
class Declarations {
 public:
  enum class Kind { None, Parameter, Coordinate, Angle, Definition, Input, Place, Field, Space };

  Declarations(const TokenList& list, const std::vector<StatementTokens>& statements);

  Kind kind(std::string_view name) const;
  bool contains(std::string_view name) const { return kind(name) != Kind::None; }
  std::vector<std::string> names() const;
  /// field ψ(x) : complex: conj, re and im are functions then.
  bool complex() const { return complex_; }
  bool dimensionless() const { return dimensionless_; }
  /// What stands in the place of t: `independent x`.
  const std::string& independent() const { return independent_; }
  /// The names that one statement declares, for messages and recovery.
  static std::vector<Name> of(const TokenList& list, const StatementTokens& statement);
  /// The names that a statement with a mistake was to declare: of `param m = 1 kg l = 1 m`, without a comma, l too.
  static std::vector<Name> lost_with(const TokenList& list, const StatementTokens& statement);

 private:
  std::unordered_map<std::string, Kind> names_;
  bool dimensionless_ = false, complex_ = false;
  std::string independent_ = "t";
};

}  // namespace maupertuis::syntax
