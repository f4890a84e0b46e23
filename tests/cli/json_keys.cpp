// What documents hold is told in the manual, key by key.
#include "json.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>

using namespace cli_test;

namespace {

const std::string models = std::string(PROJECT_DIR) + "/models/";

bool is_of_word(char c) { return (c >= 'a' && c <= 'z') || c == '_'; }

/// Every word of small letters in the manual.
std::set<std::string> words_of_the_manual() {
  std::set<std::string> out;
  for (const auto& page : std::filesystem::directory_iterator(std::string(PROJECT_DIR) + "/docs/manual")) {
    if (page.path().extension() != ".md") continue;
    const std::string text = read(page.path().string());
    for (auto begin = text.begin(); begin != text.end();) {
      begin = std::find_if(begin, text.end(), is_of_word);
      const auto end = std::find_if_not(begin, text.end(), is_of_word);
      out.emplace(begin, end);
      begin = end;
    }
  }
  return out;
}

/// Names of the model are keys too, and so are sections of pages: those that are no words of small letters.
void for_each_key(const Json& value, const std::function<void(const std::string&)>& tell) {
  if (value.is_object())
    for (const auto& [key, member] : value.items()) {
      if (key.size() > 2 && std::all_of(key.begin(), key.end(), is_of_word)) tell(key);
      for_each_key(member, tell);
    }
  else if (value.is_array())
    for (const Json& member : value) for_each_key(member, tell);
}

}  // namespace

TEST_CASE("every key of a document is told in the manual") {
  const std::set<std::string> words = words_of_the_manual();
  const Folder folder;
  const std::string pendulum = models + "pendulum.lag", ball = models + "bouncing_ball.lag",
                    disk = models + "rolling_disk.lag", membrane = models + "fields/membrane.lag",
                    beam = models + "fields/beam_tip_mass.lag";
  const std::vector<std::vector<std::string>> commands{
      {"check", ball},
      {"derive", pendulum, "--steps"},
      {"derive", ball, "--modes"},
      {"derive", disk},
      {"derive", beam},
      {"simulate", pendulum},
      {"simulate", ball},
      {"simulate", pendulum, "--precision", "quad"},
      {"simulate", membrane, "--no-errors"},
      {"simulate", beam, "--no-errors"},
      {"test", pendulum},
      {"hamiltonian", pendulum, "--integrate"},
      {"compare", pendulum, pendulum},
      {"invariants", models + "kepler.lag"},
      {"modes", models + "cart_pendulum.lag"},
      {"modes", models + "bead_on_hoop.lag", "--sweep", "Ω = 1 .. 6 rad/s steps 6"},
      {"modes", ball},
      {"modes", beam},
      {"orbits", pendulum, "--floquet"},
      {"orbits", models + "henon_heiles.lag", "--section", "x = 0 rising", "--crossings", "3"},
      {"orbits", pendulum, "--lyapunov", "--duration", "20s", "--transient", "2s", "--interval", "1s"},
      {"action", models + "oscillator_path.lag"},
      {"action", pendulum, "--motion"},
      {"reduce", models + "four_bar.lag"},
      {"report", pendulum, "--sections", "equations", "-o", folder.path("page.html")},
      {"plot", pendulum, "-o", folder.path("plot.svg")},
      {"animate", pendulum, "-o", folder.path("film.svg")},
      {"new", "pendulum", "-o", folder.path("new.lag")},
      {"fmt", pendulum},
      {"explain"},
      {"explain", "E0101"},
      {"doctor"},
  };
  for (std::vector<std::string> command : commands) {
    command.push_back("--json");
    std::string line;
    for (const std::string& word : command) line += word + " ";
    CAPTURE(line);
    const Outcome outcome = maup(command);
    REQUIRE_MESSAGE(!outcome.out.empty(), outcome.err);
    for_each_key(json_of(outcome), [&](const std::string& key) { CHECK_MESSAGE(words.count(key) == 1, key); });
  }
}
