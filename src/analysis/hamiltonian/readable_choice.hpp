#pragma once
#include <maupertuis/transform.hpp>

#include <cstddef>
#include <span>
#include <vector>

/// The choice between equal forms of a Hamiltonian. Unlike `readable`, nothing here multiplies a completed square out.
namespace maupertuis::phase_space {

/// Letters of the plain text, and some more for every fraction inside brackets; `unreadable` where there would be more
/// than some thousand names, of which nothing is printed.
std::size_t length_of(Expr e, const ReadingOrder& order);
constexpr std::size_t unreadable = ~std::size_t{0};

/// Whether it would fill a page and more.
bool is_long(Expr e);

/// The shortest of equal forms, the first of several; empty handles do not take part.
Expr shortest(std::span<const Expr> candidates, const ReadingOrder& order);

/// The shorter of e and its readable form; e itself where that would need named intermediates.
Expr tidy(Expr e, const ReadingOrder& order);

/// Σ of parts whose own terms join.
Expr flat_sum(std::span<const Expr> parts, Context& context);

/// numerator / denominator, factor by factor, so that the printers see one bar.
Expr over(Expr numerator, Expr denominator);

/// a − b, −e: sums stay flat.
Expr difference(Expr a, Expr b);
Expr negative(Expr e);

/// e as one fraction without fractions in it; the numerator is readable.
struct Cleared {
  Expr numerator, denominator;
};
Cleared cleared(Expr e, const ReadingOrder& order);

/// ∂e/∂symbol of a sum in which squares of sums stay factors: s (2 c ∂s + s ∂c) for a term c s².
Expr slope(Expr e, Expr symbol, const ReadingOrder& order);

}  // namespace maupertuis::phase_space
