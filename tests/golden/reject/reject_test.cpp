#include <doctest/doctest.h>

#include <maupertuis/codes.hpp>
#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/study.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

using namespace maupertuis;
namespace fs = std::filesystem;

namespace {

std::string read(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::vector<fs::path> models() {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(fs::path(PROJECT_DIR) / "tests/golden/reject"))
    if (entry.path().extension() == ".lag") out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

Diagnostics check(const SourceText& source) {
  Study study(source);
  const Model* model = study.model();
  if (model && study.has_fields()) {
    study.field_equations();
    return study.diagnostics();
  }
  const EquationsOfMotion* equations = study.equations();
  if (!model || !equations) return study.diagnostics();
  Diagnostics& diagnostics = study.diagnostics();
  const auto begin = consistent_start(*model, *equations, diagnostics);
  const MotionState* start = begin ? &begin->state : nullptr;
  report_constraints(analyse_constraints(*equations, start), *equations, start, diagnostics);
  return diagnostics;
}

}  // namespace

TEST_CASE("each wrong model gives its message, to the letter") {
  const bool promote = std::getenv("MAUP_PROMOTE") != nullptr;
  for (const fs::path& path : models()) {
    CAPTURE(path.filename().string());
    const SourceText source(path.filename().string(), read(path));
    const std::string message = render(check(source), source);
    const fs::path expected = fs::path(path).replace_extension(".expected");
    if (promote) std::ofstream(expected, std::ios::binary) << message;
    CHECK(message == read(expected));
  }
}

TEST_CASE("one mistake gives one message") {
  for (const fs::path& path : models()) {
    CAPTURE(path.filename().string());
    const SourceText source(path.filename().string(), read(path));
    const Diagnostics diagnostics = check(source);
    // A model that is meant to have several mistakes says so in its first line.
    const bool several = read(path).rfind("# several", 0) == 0;
    if (several)
      CHECK(diagnostics.items().size() > 1);
    else
      CHECK(diagnostics.items().size() == 1);
  }
}

TEST_CASE("every code of the text, of the physics and of the constraints has a model here") {
  std::set<std::string> given;
  for (const fs::path& path : models()) {
    const SourceText source(path.filename().string(), read(path));
    const Diagnostics diagnostics = check(source);
    for (const Diagnostic& d : diagnostics.items()) given.insert(d.code);
  }
  const std::span<const CodeEntry> catalogues[] = {syntax_codes(), system_codes(), equations_codes()};
  for (const auto codes : catalogues)
    for (const CodeEntry& entry : codes) {
      // Others are given by commands that do more: tests/cli/examples_of_codes.cpp.
      const bool by_check = entry.wrong.find("maup ") > 2 || entry.wrong.rfind("# maup check", 0) == 0;
      if (entry.wrong.empty() || !by_check) continue;
      CAPTURE(entry.code);
      CHECK(given.count(std::string(entry.code)) == 1);
    }
}
