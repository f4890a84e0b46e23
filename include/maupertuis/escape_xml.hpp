#pragma once
#include <string>
#include <string_view>

namespace maupertuis {

/// Text as it stands in an element or, between quotation marks, in an attribute of XML, SVG, MathML and HTML. Control
/// characters, which none of them can hold, become U+FFFD.
std::string escape_xml(std::string_view text);

}  // namespace maupertuis
