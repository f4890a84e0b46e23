#pragma once
#include <maupertuis/expression.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace maupertuis::invariants {

/// Π generators^exponents, generators ascending, exponents positive; empty: 1.
struct Factor {
  std::uint32_t generator = 0;
  int exponent = 1;
  friend bool operator==(const Factor&, const Factor&) = default;
};
using Monomial = std::vector<Factor>;
Monomial product(const Monomial& a, const Monomial& b);
int degree(const Monomial& m);

/// The functions whose products a basis is made of: q_i, q̇_i, p_i, h_E, t, sines, inverse powers, …
class Generators {
 public:
  explicit Generators(Context& context) : context_(context) {}
  Monomial add(Expr value);  // the generator alone, made at first use
  /// The factors of a product that are no numbers and no parameters; base^(−k/d) is a power of base^(−1/d).
  Monomial add_factors(Expr product_of_atoms);
  const std::vector<Expr>& values() const { return values_; }
  Expr expression(const Monomial& m) const;
  Context& context() const { return context_; }

 private:
  Context& context_;
  std::vector<Expr> values_;
  std::unordered_map<Expr, std::uint32_t, ExprHash> index_;
};

/// Functions B_k of (q, q', t), simple ones first: a combination is looked for among them.
struct Basis {
  std::vector<Monomial> monomials;
  std::string description;
};

bool is_parametric(Expr e);           // holds no coordinate and no time
bool depends_on_coordinates(Expr e);  // of order 0
bool depends_on_velocities(Expr e);   // of order 1
bool depends_on_time_itself(Expr e);  // on the symbol t

}  // namespace maupertuis::invariants
