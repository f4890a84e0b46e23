#pragma once
#include <maupertuis/language_services.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace language_test {

using namespace maupertuis;
using namespace maupertuis::language;

inline Document document(const std::string& text) { return Document(SourceText("test.lag", text)); }

/// A text with the place that is asked about, marked by `|`, taken out of it.
struct Marked {
  explicit Marked(std::string with_mark) : text(std::move(with_mark)) {
    offset = static_cast<std::uint32_t>(text.find('|'));
    text.erase(offset, 1);
  }
  std::string text;
  std::uint32_t offset = 0;
};

inline std::string slice(const std::string& text, Span span) { return text.substr(span.begin, span.end - span.begin); }

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

inline std::vector<std::filesystem::path> models_in(const std::string& folder) {
  std::vector<std::filesystem::path> out;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(PROJECT_DIR) + "/" + folder))
    if (entry.path().extension() == ".lag") out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

inline const char* const pendulum =
    "system pendulum \"Simple pendulum\"\n"
    "param m = 500 g, l = 1 m, g = 9.81 m/s^2   # the bob's mass\n"
    "coord θ : angle\n"
    "let ω0 = sqrt(g/l)\n"
    "point bob mass m at l (sin θ, -cos θ)\n"
    "gravity (0, -g)\n"
    "start θ = 60 deg\n"
    "run 10 s\n";

}  // namespace language_test
