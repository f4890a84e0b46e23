#include <maupertuis/diagnostic.hpp>

#include <algorithm>
#include <numeric>

namespace maupertuis {
namespace {

std::u32string code_points(std::string_view text) {
  std::u32string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0u) == 0x80u && !out.empty())
      out.back() = (out.back() << 6) | (byte & 0x3Fu);
    else
      out.push_back(byte);
  }
  return out;
}

/// Damerau-Levenshtein distance (adjacent transpositions), Wagner-Fischer with three rows.
std::size_t edit_distance(const std::u32string& a, const std::u32string& b) {
  std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
  std::iota(previous.begin(), previous.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = previous[j - 1] + (a[i - 1] != b[j - 1]);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        current[j] = std::min(current[j], before[j - 2] + 1);
    }
    std::swap(before, previous);
    std::swap(previous, current);
  }
  return previous[b.size()];
}

}  // namespace

std::string did_you_mean(std::string_view name, std::span<const std::string> candidates) {
  const std::u32string wanted = code_points(name);
  if (wanted.size() > 64) return {};
  const std::size_t limit = std::max<std::size_t>(1, wanted.size() / 3);
  std::size_t best = limit + 1;
  std::string answer;
  for (const std::string& candidate : candidates) {
    const std::u32string other = code_points(candidate);
    if (other.size() > wanted.size() + limit || wanted.size() > other.size() + limit) continue;
    const std::size_t distance = edit_distance(wanted, other);
    const bool trivial = distance >= std::max(wanted.size(), other.size());  // nothing in common
    if (distance < best && distance > 0 && !trivial) {
      best = distance;
      answer = candidate;
    }
  }
  return answer;
}

}  // namespace maupertuis
