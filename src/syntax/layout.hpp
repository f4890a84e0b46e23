#pragma once
#include "syntax/token.hpp"

#include <span>
#include <string>

namespace maupertuis::syntax {

/// The canonical blanks: whether one stands before tokens[i], i > 0.
bool blank_before(std::span<const Token> tokens, std::size_t i);
/// The tokens from `begin` on one line; those before are the context of its blanks.
std::string lay_out(std::span<const Token> tokens, std::size_t begin = 0);

/// dot(θ) → θ', dot(a + b) → (a + b)'.
std::vector<Token> with_primes(std::span<const Token> tokens);

}  // namespace maupertuis::syntax
