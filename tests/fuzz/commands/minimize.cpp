#include "minimize.hpp"

#include <chrono>
#include <sstream>

namespace maupertuis::fuzz {
namespace {

using Parts = std::vector<std::string>;

Parts lines_of(const std::string& text) {
  Parts out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line + "\n");
  return out;
}

std::string joined(const Parts& parts) {
  std::string out;
  for (const std::string& part : parts) out += part;
  return out;
}

/// Leaves out runs of parts, long ones first, as long as `fails` says that what is left fails as before.
template <class Fails>
Parts fewer(Parts parts, const Fails& fails) {
  for (std::size_t length = std::max<std::size_t>(parts.size() / 2, 1);; length /= 2) {
    for (std::size_t at = 0; at < parts.size();) {
      Parts rest(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(at));
      rest.insert(rest.end(), parts.begin() + static_cast<std::ptrdiff_t>(std::min(at + length, parts.size())),
                  parts.end());
      if (fails(rest))
        parts = std::move(rest);
      else
        at += length;
    }
    if (length <= 1) return parts;
  }
}

}  // namespace

Input minimized(Input input, const std::string& wrong, const Program& program, const Supervisor::Judge& judge) {
  const auto begin = std::chrono::steady_clock::now();
  Limits limits;
  const auto fails = [&](const Input& candidate) {
    if (std::chrono::steady_clock::now() - begin > std::chrono::minutes(2)) return false;
    bool same = false;
    Supervisor(program, limits)
        .run(
            0, 1, [&](std::uint64_t) { return candidate; }, judge,
            [&](std::uint64_t, const std::string& found, const Outcome&) { same = found == wrong; },
            [] { return false; });
    return same;
  };
  input.arguments = fewer(input.arguments, [&](const Parts& parts) { return fails({parts, input.model}); });
  input.model = joined(fewer(lines_of(input.model), [&](const Parts& parts) {
    return fails({input.arguments, joined(parts)});
  }));
  // Within a line: single bytes would take long, so words.
  Parts words;
  for (const char c : input.model)
    if (words.empty() || c == ' ' || c == '\n' || words.back().back() == ' ' || words.back().back() == '\n')
      words.emplace_back(1, c);
    else
      words.back() += c;
  if (words.size() < 400)
    input.model = joined(fewer(std::move(words), [&](const Parts& parts) {
      return fails({input.arguments, joined(parts)});
    }));
  return input;
}

}  // namespace maupertuis::fuzz
