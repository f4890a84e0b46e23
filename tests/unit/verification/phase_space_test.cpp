#include "../model_text.hpp"

#include <maupertuis/verification.hpp>

// What is expected of momenta, H, the Routhian and brackets, against the closed forms of the spherical pendulum.

using namespace maupertuis;

namespace phase_space_test {
namespace {

const std::string spherical =
    "system spherical\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ, φ : angle\n"
    "point P mass m at l (sin θ cos φ, sin θ sin φ, -cos θ)\ngravity (0, 0, -g)\n"
    "start θ = 1 rad, φ' = 2 rad/s\nrun 1 s\n";

ExpectationResult only(const std::string& line) {
  const ModelText m(spherical + line + "\n");
  Diagnostics diagnostics;
  const Verification v = verify(m.model, m.equations, m.source, {}, diagnostics);
  REQUIRE(v.results.size() == 1);
  return v.results.front();
}

}  // namespace

TEST_CASE("momenta in expectations have their values in q and q'") {
  // m l² sin² 1 · 2 rad/s
  CHECK(only("expect p_φ at 0 s = 1.4161468365471424 kg m^2/s ± 1e-15").passed);
  CHECK_FALSE(only("expect p_φ at 0 s = 1.41614683654715 kg m^2/s ± 1e-15").passed);
}

TEST_CASE("H, the Routhian and brackets: the closed forms hold, and no others") {
  struct Line {
    const char *text, *message;  // "": it holds
  };
  for (const Line& line :
       {Line{"expect hamiltonian = p_θ^2/(2 m l^2) + p_φ^2/(2 m l^2 sin^2 θ) - m g l cos θ", ""},
        {"expect hamiltonian = p_θ^2/(2 m l^2) + p_φ^2/(2 m l^2 sin^2 θ) + m g l cos θ", "The hamiltonian is"},
        {"expect routhian of φ = 1/2 m l^2 θ'^2 - p_φ^2/(2 m l^2 sin^2 θ) + m g l cos θ", ""},
        {"expect routhian of φ = 1/2 m l^2 θ'^2 + p_φ^2/(2 m l^2 sin^2 θ) + m g l cos θ", "The routhian is"},
        {"expect bracket (θ, p_θ) = 1", ""},
        {"expect bracket (p_θ, θ) = 1", "The bracket is"},
        {"expect bracket (θ, p_φ) = 0", ""}}) {
    const ExpectationResult r = only(line.text);
    INFO(line.text, " | ", r.message);
    CHECK(r.passed == (*line.message == '\0'));
    if (!r.passed) CHECK(r.message.find(line.message) == 0);
    CHECK(r.actual == (r.passed ? r.expected : "another function"));
  }
}

TEST_CASE("identities of roots hold for the signs that the parameters have, and these are told") {
  const auto decided = [](const std::string& parameters, const std::string& line) {
    const ModelText m("system relativistic\n" + parameters +
                      "coord x : length\nL = -m c^2 sqrt(1 - x'^2/c^2) - 1/2 k x^2\nstart x = 1 m\nrun 1 s\n" + line);
    Diagnostics diagnostics;
    return verify(m.model, m.equations, m.source, {}, diagnostics).results.at(0);
  };
  const std::string positive = "param m = 1 kg, c = 3 m/s, k = 2 N/m\n",
                    negative = "param m = 1 kg, c = -3 m/s, k = 2 N/m\n";
  const std::string h = "expect hamiltonian = sqrt(p_x^2 c^2 + m^2 c^4) + 1/2 k x^2\n",
                    of_gamma = "expect equation m c^3 x'' = -k x (c^2 - x'^2)^(3/2)\n",
                    other_sign = "expect equation m c^3 x'' = k x (c^2 - x'^2)^(3/2)\n",
                    energy = "expect conserved m c^3/sqrt(c^2 - x'^2) + 1/2 k x^2\n";
  for (const std::string& line : {h, of_gamma, energy}) {
    const ExpectationResult r = decided(positive, line);
    INFO(line, r.message);
    CHECK(r.passed);
    CHECK(r.message.find("c > 0") != std::string::npos);
  }
  CHECK(decided(negative, h).passed);  // holds for |c|
  CHECK(decided(negative, other_sign).passed);
  CHECK(decided(negative, other_sign).message.find("c < 0") != std::string::npos);
  for (const std::string& line : {of_gamma, energy}) CHECK_FALSE(decided(negative, line).passed);
  CHECK_FALSE(decided(positive, other_sign).passed);
}

}  // namespace phase_space_test
