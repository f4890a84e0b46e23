#pragma once
#include <maupertuis/expression.hpp>

#include <functional>

#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

/// Passes over expressions. Each is memoized by node: shared sub-expressions are visited once.
namespace maupertuis {

using ExprMap = std::unordered_map<Expr, Expr, ExprHash>;

/// ∂e/∂symbol, every other symbol (also those of other orders, and t) held fixed.
/// Precondition: no TimeDerivative node in e (expand_time_derivatives first).
Expr differentiate(Expr e, Expr symbol);

/// (∂e/∂s for s in symbols) by one reverse sweep; cost O(nodes of e), not O(nodes · symbols).
/// Precondition as for differentiate.
std::vector<Expr> gradient(Expr e, std::span<const Expr> symbols);

/// d/dt e by the chain rule through q, q', q'', u and t, with every TimeDerivative node in e carried out.
Expr total_time_derivative(Expr e);
/// Replaces every TimeDerivative node by the chain rule; the result is an expression of q, q', q'', u, u', t alone.
std::vector<Expr> expand_time_derivatives(std::span<const Expr> roots);
Expr expand_time_derivatives(Expr e);

/// δL/δq with the sign of the residual: R_i = d/dt(∂L/∂q̇_i) − ∂L/∂q_i, d/dt kept as an operator: a reverse sweep in
/// which the adjoint of d/dt u passes −d/dt(adjoint) to u, so that −(adjoint of q_i) is R_i. Cost O(nodes of L).
/// `coordinates` are the symbols of order 0. L may hold TimeDerivative nodes and symbols of order 1.
std::vector<Expr> variational_residual(Expr lagrangian, std::span<const Expr> coordinates);

/// Replaces symbols (or whole sub-expressions) at once, and rebuilds what stands above them.
Expr substitute(Expr e, const ExprMap& replacements);
std::vector<Expr> substitute(std::span<const Expr> roots, const ExprMap& replacements);

/// Whether it is nowhere below 0 where it has a value, seen by its form alone: even powers and even roots, |x|, exp and
/// cosh, and sums and products of these and of numbers. False says nothing. Cost O(nodes).
bool is_never_negative(Expr e);

/// Sums in sums, with their coefficients, become one, so that equal terms join: x − (x + r) is −r. Nothing else is
/// multiplied out. Cost O(nodes).
Expr with_flat_sums(Expr e);

/// Distributes products over sums and integer powers of sums, flattens sums, collects like terms. No trigonometry.
/// Stops at `term_budget` terms and returns nothing (an empty handle).
Expr expand(Expr e, std::size_t term_budget = 20000);

/// For evaluation in floating point: quotients and logarithms of sums of exponentials of one argument, 1/(1 + exp(u)),
/// sinh u/cosh³ u, log(1 + exp(u)), written so that they are finite where exp(u) is not. They differ from the given
/// ones by less than 1e-60 of their largest value (1e-130 where coefficients are near 1), and have switches at |u| =
/// 300. `value_of` tells what does not move, as parameters; without it sums that hold such are left as they are.
/// Exponentials of more than `largest_exponent` do not arise on the way: for series in double, whose coefficients grow
/// with the order, 400.
/// Cost: O(nodes).
std::vector<Expr> without_overflow(std::span<const Expr> roots, const std::function<double(Expr)>& value_of = {},
                                   double largest_exponent = 600);

struct ReadingPlaces;

/// The order in which a reader expects names: factors of a product and terms of a sum are printed by it. Symbols
/// first in the list come first in a product; symbols that are missing come after, by order of creation.
struct ReadingOrder {
  std::vector<Expr> parameters;   // masses before g before lengths before rates, then as declared
  std::vector<Expr> coordinates;  // order 0, as declared
  Expr own;                       // the coordinate whose equation this is: its terms stand first; empty: none
  /// The places of the names, found at the first use and shared by copies. Lists that change later are looked up anew.
  mutable std::shared_ptr<const ReadingPlaces> places = {};
};

/// A named intermediate that stands for a large sub-expression in a readable form.
struct Intermediate {
  Expr symbol;  // Role::Auxiliary, named c1, s2, k3, …
  Expr value;
};

struct ReadableForm {
  Expr value;                               // as it is to be printed: printers keep its structure, they only order it
  std::vector<Intermediate> intermediates;  // in order of use; empty for most systems
  Expr own;                                 // of an equation: the coordinate of its row, for ReadingOrder::own
};

struct ReadableOptions {
  std::size_t term_budget = 4000;  // of the Fourier form; beyond it named intermediates appear
};

/// The cheapest of several equal candidates (Fourier form, power form with Pythagoras, factored), counted as a reader
/// would: terms, factors, function arguments. Equality of the candidates is by construction; the caller certifies it.
ReadableForm readable(Expr e, const ReadingOrder& order, const ReadableOptions& options = {});

/// The readable form of an equation `e = 0`, collected by accelerations, then velocities, then the rest; each
/// coefficient readable. One set of intermediates for all rows. TimeDerivative nodes are expanded first.
std::vector<ReadableForm> readable_equations(std::span<const Expr> residuals, const ReadingOrder& order,
                                             const ReadableOptions& options = {});

/// The canonical Fourier form of a trigonometric polynomial: products of sines and cosines to sums, arguments over a
/// common basis. Two trigonometric polynomials are equal if and only if their forms are the same expression.
/// An empty handle beyond the budget.
Expr fourier_form(Expr e, std::size_t term_budget = 4000);

}  // namespace maupertuis
