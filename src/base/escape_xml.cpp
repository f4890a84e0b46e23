#include <maupertuis/escape_xml.hpp>

namespace maupertuis {

std::string escape_xml(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' && c != '\r')
      result += "\uFFFD";
    else
      result += c;
  }
  return result;
}

}  // namespace maupertuis
