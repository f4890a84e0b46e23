#include "starters.hpp"

#include <fmt/format.h>

namespace maupertuis::app {
namespace {

/// "θ1, θ2, …" from one formatted name a link; a new, indented line after every eighth.
template <typename Name>
std::string list(int links, const char* separator, Name name) {
  std::string out;
  for (int i = 1; i <= links; ++i) {
    if (i > 1) out += i % 8 == 1 ? fmt::format("{}\n    ", separator) : fmt::format("{} ", separator);
    out += name(i);
  }
  return out;
}

}  // namespace

std::string chain_starter(int links) {
  std::string text = fmt::format("system chain_{0} \"Chain of {0} pendulums\"\n", links);
  text += "param m = 1 kg, l = 1 m, g = 9.81 m/s^2     # of each link\n";
  text += "coord " + list(links, ",", [](int i) { return fmt::format("θ{}", i); }) + " : angle\n";
  for (int i = 1; i <= links; ++i) {
    const std::string from = i == 1 ? std::string() : fmt::format("P{} + ", i - 1);
    text += fmt::format("point P{0} mass m at {1}l (sin θ{0}, -cos θ{0})\n", i, from);
  }
  text += "gravity (0, -g)\n";
  text += "start " + list(links, ",", [](int i) { return fmt::format("θ{} = 60 deg", i); }) + "\n";
  text += "run 10 s\n";
  // A line that ends with the sign that joins it to the next needs no bracket to go on.
  text += "draw O - " + list(links, " -", [](int i) { return fmt::format("P{}", i); }) + ", " +
          fmt::format("trail P{}\n", links);
  return text;
}

}  // namespace maupertuis::app
