#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace maupertuis {

/// An element of presentation MathML; a leaf has text (entities as they stand), others have children.
struct MathElement {
  std::string name, attributes;   // attributes with their leading space, as they stand
  std::string text;
  std::vector<MathElement> children;
};
using MathRow = std::vector<MathElement>;

/// Elements side by side, and back. What is no MathML comes back as one element <mtext>.
MathRow parse_mathml(std::string_view fragment);
std::string to_string(const MathRow& row);

/// What printers leave to the eye of a typesetter, and browsers do not do by themselves: θ₁² with the exponent above the
/// index; brackets of plain height as letters, which otherwise carry the sides of their large forms; a thin space
/// between a factor and sin, and between sin and an argument without brackets.
void typeset(MathRow& row);

/// The terms of a sum, each with its sign; an outer <mrow> is opened.
std::vector<MathRow> signed_terms(MathRow row);

/// A term in pieces that end inside its longest bracket, before the signs there; one piece where there is no bracket
/// that holds a sum. The two brackets then stand in different pieces, at the height of what they enclose.
std::vector<MathRow> open_longest_bracket(MathRow term);

/// Characters that a reader sees.
std::size_t letters_in(const MathRow& row);

}  // namespace maupertuis
