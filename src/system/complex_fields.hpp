#pragma once
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/syntax_tree.hpp>

#include <optional>

namespace maupertuis::elaboration {

/// The model in real fields: `field ψ(x) : complex` becomes ψ_r and ψ_i, and each formula of the fields' statements its
/// real and imaginary part, by i, conj, re, im, abs and exp. The imaginary part of a density is kept beside it, to be
/// shown to vanish. Spans are those of the text. Nothing where the model has no complex field.
/// Errors: E0294 where a complex value stands in a place for real ones or in a function without a rule.
std::optional<syntax::SyntaxTree> in_real_fields(const syntax::SyntaxTree& tree, Diagnostics& diagnostics);

}  // namespace maupertuis::elaboration
