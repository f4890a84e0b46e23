#pragma once
#include <maupertuis/layout.hpp>

#include <string>

/// Formulas as MathML in a page of HTML (src/report/markup.cpp).
namespace maupertuis {

/// One <math> element in the line of text; nothing for an empty layout.
std::string inline_math(const Layout& formula);
/// left = right as a block of display mathematics. A long sum becomes several <math> elements, between which lines may
/// break: one element would run out of a narrow window, and off the paper.
std::string display_math(const Layout& left, const Layout& right);

}  // namespace maupertuis
