#include "syntax/words.hpp"

#include <maupertuis/spelling.hpp>

#include <algorithm>
#include <limits>
#include <unordered_set>

/// What people type who write mechanics on paper or in other languages: mgl, sinθ, thetadot, arctan.
namespace maupertuis::syntax {
namespace {

using Names = std::unordered_set<std::string>;

bool names_something(const Names& names, std::string_view word) {
  const std::string name = normalize_name(std::string(word));
  return names.count(name) > 0 || name == "pi" || name == "t";
}

bool begins_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0u) != 0x80u; }

// ------------------------------------------------------------------------------------------------- derivatives

/// θ' for what stands before and after the word `dot`: thetadot, θ_dot, xddot, thetadot1, dot_x.
std::string derivative(const Names& names, std::string_view before, std::string_view after) {
  int count = 1;
  if (after.substr(0, 3) == "dot") after.remove_prefix(3), ++count;
  const auto known = [&](std::string_view stem) -> std::string {
    if (!stem.empty() && stem.back() == '_') stem.remove_suffix(1);
    const std::string name = normalize_name(std::string(stem) + std::string(after));
    return names.count(name) ? name : "";
  };
  if (before.empty() || before == "d") {
    count += before == "d";
    if (!after.empty() && after.front() == '_') after.remove_prefix(1);
    return names_something(names, after)
               ? normalize_name(std::string(after)) + std::string(static_cast<std::size_t>(count), '\'')
               : "";
  }
  if (!after.empty() && after.front() != '_' && after.find_first_not_of("0123456789") != std::string_view::npos)
    return "";
  std::string name = known(before);
  if (name.empty() && before.back() == 'd') name = known(before.substr(0, before.size() - 1)), ++count;
  return name.empty() ? "" : name + std::string(static_cast<std::size_t>(count), '\'');
}

std::string derivative_in_words(const Names& names, std::string_view word) {
  for (std::size_t at = word.find("dot"); at != std::string_view::npos; at = word.find("dot", at + 1))
    if (std::string found = derivative(names, word.substr(0, at), word.substr(at + 3)); !found.empty()) return found;
  return "";
}

// ------------------------------------------------------------------------------------------- products run together

/// The fewest names that make up the word, with blanks; empty if it is not made of names.
std::string names_apart(const Names& names, std::string_view word) {
  constexpr std::size_t longest = 64;
  if (word.empty() || word.size() > longest) return "";
  constexpr int none = std::numeric_limits<int>::max();
  std::vector<int> parts(word.size() + 1, none);
  std::vector<std::size_t> from(word.size() + 1, 0);
  parts[0] = 0;
  for (std::size_t end = 1; end <= word.size(); ++end)
    for (std::size_t begin = 0; begin < end; ++begin) {
      if (parts[begin] == none || parts[begin] + 1 >= parts[end]) continue;
      if (!begins_character(word[begin]) || (end < word.size() && !begins_character(word[end]))) continue;
      if (!names_something(names, word.substr(begin, end - begin))) continue;
      parts[end] = parts[begin] + 1;
      from[end] = begin;
    }
  if (parts.back() == none) return "";
  std::string out;
  for (std::size_t end = word.size(); end > 0; end = from[end])
    out = normalize_name(std::string(word.substr(from[end], end - from[end]))) + (out.empty() ? "" : " ") + out;
  return out;
}

/// `sin 2θ`, `cos(ω t)`, `sqrt(x)`: a function with what follows it in the word.
std::string applied_to(const Names& names, const Function& function, std::string_view argument) {
  const std::size_t digits = std::min(argument.find_first_not_of("0123456789"), argument.size());
  const std::string apart = names_apart(names, argument.substr(digits));
  if (apart.empty()) return "";
  const std::string number(argument.substr(0, digits));
  const bool one_name = apart.find(' ') == std::string::npos;
  if (function.bare && one_name) return std::string(function.name) + " " + number + apart;
  return std::string(function.name) + "(" + number + (digits > 0 && !one_name ? " " : "") + apart + ")";
}

/// `l sin θ` for lsinθ.
std::string function_run_together(const Names& names, std::string_view word) {
  for (std::size_t at = 0; at < word.size(); ++at) {
    const Function* best = nullptr;
    for (const Function& function : functions()) {
      const bool here = function.least == 1 && word.substr(at, function.name.size()) == function.name;
      if (here && (!best || function.name.size() > best->name.size())) best = &function;
    }
    if (!best) continue;
    const std::string factors = at == 0 ? "" : names_apart(names, word.substr(0, at));
    if (at > 0 && factors.empty()) continue;
    const std::string_view after = word.substr(at + best->name.size());
    const std::string applied =
        after.empty() ? (at > 0 ? std::string(best->name) : "") : applied_to(names, *best, after);
    if (!applied.empty()) return factors.empty() ? applied : factors + " " + applied;
  }
  return "";
}

}  // namespace

Spelling right_spelling(std::string_view word, std::span<const std::string> list) {
  const Names names(list.begin(), list.end());
  if (const std::string_view function = function_of_habit(word); !function.empty())
    return {std::string(function) + "(…)", "The language has one spelling for each function."};
  if (std::string text = derivative_in_words(names, word); !text.empty())
    return {std::move(text), "A derivative by the time is written with a prime."};
  if (std::string text = function_run_together(names, word); !text.empty())
    return {std::move(text),
            "Letters without a blank between them are one name; a function and its argument stand apart."};
  if (std::string text = names_apart(names, word); !text.empty())
    return {std::move(text),
            "Letters without a blank between them are one name; the factors of a product stand apart."};
  return {};
}

}  // namespace maupertuis::syntax
