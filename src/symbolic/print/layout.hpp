#pragma once
#include <maupertuis/layout.hpp>

#include <vector>

/// What the writers ask of a layout.
namespace maupertuis::print {

/// A nonnegative rational as a reader writes it: 1/2, 9.81, 3.
Layout lay_out_number(const Rational& value);

/// True if the text of a factor would begin with a digit: 2^(3/2), 3 [J]. Not to be put right after another number.
bool starts_with_number(const Layout& layout);

/// Whether factor `i` of a product, or term `i` of a sum, stands in brackets where fractions have a bar.
bool needs_brackets(const std::vector<Layout>& parts, std::size_t i);
/// Whether a base is a letter or a number: x², not (x y)².
bool is_simple_base(const Layout& base);
/// sin θ: the argument of a circular function that needs no brackets.
bool has_bare_argument(const Layout& apply);
/// A fraction that stands on one line, in an exponent, needs brackets around what its slash would tear: b/(c x).
bool needs_brackets_above_slash(const Layout& numerator);
bool needs_brackets_below_slash(const Layout& denominator);
/// Whether brackets around it have to be larger than letters.
bool is_tall(const Layout& layout);

/// True for functions that take a bare argument and a square on the name: sin² θ.
bool is_circular(Kind kind);

}  // namespace maupertuis::print
