#include "../model_text.hpp"

#include <maupertuis/verification.hpp>

// Every classic mistake, made once in a closed form, is named by its own sentence and no other.

using namespace maupertuis;

namespace pitfalls_test {
namespace {

std::string mistake_of(const std::string& system, const std::string& claim) {
  const ModelText m(system + "claim " + claim + "\n");
  Diagnostics diagnostics;
  const Verification v = verify(m.model, m.equations, m.source, {}, diagnostics);
  REQUIRE(v.results.size() == 1);
  return v.results.front().passed ? "none" : v.results.front().pitfall;
}

bool begins_with(const std::string& text, const std::string& words) {
  return text.compare(0, words.size(), words) == 0;
}

struct Mistake {
  const char *claim, *sentence;
};

/// m x'' + c x' + k x = F.
const std::string oscillator =
    "system oscillator\ndimensionless\nparam m = 1.5, c = 0.3, k = 2, F = 0.7\ncoord x : number\n"
    "T = 1/2 m x'^2\nV = 1/2 k x^2\nD = 1/2 c x'^2\nforce x = F\n";

}  // namespace

TEST_CASE("each mistake in the energies and forces of an oscillator is told from all others") {
  CHECK(mistake_of(oscillator, "m x'' = F - c x' - k x") == "none");
  for (const Mistake& mistake : {Mistake{"m x'' = F - c x' + k x", "V has the wrong sign"},
                                 {"2 m x'' = F - c x' - k x", "T has no factor ½"},
                                 {"m/2 x'' = F - c x' - k x", "T has a factor ½ too many"},
                                 {"m x'' = F - c x' - 2 k x", "V has a factor 2 too many"},
                                 {"m x'' = F - c x' - k/2 x", "V has a factor ½ too many"},
                                 {"m x'' = F - k x", "the dissipation was left out"},
                                 {"m x'' = F + c x' - k x", "the dissipation has the wrong sign"},
                                 {"m x'' = F - 2 c x' - k x", "D has no factor ½"},
                                 {"m x'' = F - c/2 x' - k x", "D has a factor ½ too many"},
                                 {"m x'' = -c x' - k x", "a force was left out"},
                                 {"m x'' = -F - c x' - k x", "a force has the wrong sign"},
                                 {"m x = k x + c x' - F", "a velocity was written as its coordinate"}}) {
    const std::string found = mistake_of(oscillator, mistake.claim);
    INFO(mistake.claim, " | ", found);
    CHECK(begins_with(found, mistake.sentence));
  }
  CHECK(begins_with(mistake_of(oscillator, "m x'' = 3 F - c x' - k x"),
                    "a generalized force has a factor 3"));           // by none of them
  CHECK(mistake_of(oscillator, "m x'' = F - c x' - k x + k") == "");  // wrong, and nobody knows why
}

TEST_CASE("a momentum put into L whose velocity also stands linearly, as in a magnetic field") {
  // p = m r² φ' + b r²/2; L with φ' = (p − b r²/2)/(m r²) is ½ m r'² + p²/(2 m r²) − b² r²/(8 m) + const.
  const std::string charge =
      "system charge\ndimensionless\nparam m = 1.5, b = 0.8\ncoord r, φ : number\n"
      "L = 1/2 m (r'^2 + r^2 φ'^2) + 1/2 b r^2 φ'\n";
  CHECK(mistake_of(charge, "m r'' = m r φ'^2 + b r φ'") == "none");
  CHECK(begins_with(mistake_of(charge, "m r'' = -m r φ'^2 - b r φ' - b^2 r/(2 m)"),
                    "the conserved momentum of φ was put into L"));
  CHECK(mistake_of(charge, "m r'' = -m r φ'^2 - b r φ' + b^2 r/(2 m)") == "");
}

}  // namespace pitfalls_test
