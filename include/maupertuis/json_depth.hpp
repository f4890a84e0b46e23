#pragma once
#include <cstddef>
#include <string_view>

namespace maupertuis {

/// Whether brackets of a JSON text stand in each other deeper than any message has them, and than values are copied and
/// written without end of the stack. Cost: a scan.
inline bool is_too_deep(std::string_view json) {
  constexpr int most = 200;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    if (quoted && json[i] == '\\')
      ++i;
    else if (json[i] == '"')
      quoted = !quoted;
    else if (!quoted && (json[i] == '[' || json[i] == '{') && ++depth > most)
      return true;
    else if (!quoted && (json[i] == ']' || json[i] == '}'))
      --depth;
  }
  return false;
}

}  // namespace maupertuis
