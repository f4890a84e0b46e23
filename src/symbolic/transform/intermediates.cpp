#include "symbolic/transform/intermediates.hpp"

namespace maupertuis::terms {

std::vector<ReadableForm> with_intermediates(std::span<const Expr> rows, const ReadingOrder&) {
  std::vector<ReadableForm> forms;
  for (const Expr& row : rows) forms.push_back({row, {}, {}});
  return forms;
}

}  // namespace maupertuis::terms
