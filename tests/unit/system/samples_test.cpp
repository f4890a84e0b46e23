#include "support.hpp"

#include <maupertuis/codes.hpp>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

using namespace maupertuis;
using namespace maupertuis::test;

namespace {

std::string read(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("the models of the gallery have no mistake") {
  int count = 0;
  for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(PROJECT_DIR) / "models")) {
    if (file.path().extension() != ".lag") continue;
    const Elaborated e(read(file.path()));
    CHECK_MESSAGE(e.fine(), file.path().filename().string() << "\n" << e.messages());
    ++count;
  }
  CHECK(count >= 10);
}

TEST_CASE("every statement of the language that is supported, in one model") {
  const Elaborated e(R"(system everything "All of it"
source "none"
param m = 1 kg, l = 60 cm, g = 9.81 m/s^2, k = 10 N/m, κ = 2 N m/rad, c = 0.1 N s/m, b = 0.2 N m s
param F0 = 1 N, ω = 2 rad/s, J = 0.1 kg m^2, wind = (1, 2) m/s
coord x : length, θ, φ : angle, s : [m^2]
let e = (cos θ, sin θ), A0 = l^2
input u : [N] = F0 cos(ω t)
frame F at (x, 0) rotation angle θ
frame G at (l, 0) rotation angle φ in F
point P mass m at (l, 0) in F
point Q mass 2 [kg] at P + l e
body B mass m inertia J at (0, l) rotation angle φ in F
gravity (0, -g)
spring P - Q stiffness k length l
spring O - (0, l) stiffness k
torsion spring θ stiffness κ rest 0.1
damper O - Q coefficient c
T += 1/2 m s'^2/A0
V += 1/2 k s^2/A0
D += 1/2 b θ'^2 + 1/2 c dot(wind, (1, 0)) x'
force on Q = (u, 0)
force on P = (0, F0) in F
torque on B from F = b φ'
force s = F0 t/(1 [s m])
start θ = 60 deg, x' = 1 m/s, s = (1/2) A0
start at 1 s
run until P.y = 0 within 10 s
output every 10 ms
draw O - P - Q, trail Q, box B 0.4 m by 0.2 m, circle P l, spring O - Q
reaction arm = release l
expect θ at 2 s = 12.3 deg ± 1e-9
expect P.x' at 2 s = 1 m/s rel 1e-6
expect freedoms = 4
expect energy conserved rel 1e-3
expect x' not conserved
claim θ'' = 0
)");
  CHECK_MESSAGE(e.fine(), e.messages());
  CHECK(e.system().coordinates.size() == 4);
  CHECK(e.system().points.size() == 2);
  CHECK(e.system().forces.size() == 4);
  CHECK(e.system().releases.size() == 1);
  CHECK(e.experiment().start.size() == 3);
  CHECK(e.experiment().drawing.size() == 5);
  CHECK(e.experiment().expectations.size() == 6);
  CHECK(e.expected<expectation::ValueAt>(0).expected.unit.name == "deg");
  CHECK(dump(e.system()).find("from torsion spring θ") != std::string::npos);
}

TEST_CASE("the examples of every code: the wrong one gives it and nothing else, the right one gives nothing") {
  for (const CodeEntry& entry : system_codes()) {
    CAPTURE(entry.code);
    if (entry.wrong.rfind("maup ", 0) == 0) continue;  // tests/cli tries command lines
    if (!entry.wrong.empty()) {
      const Elaborated wrong{std::string(entry.wrong)};
      CHECK_MESSAGE(wrong.codes() == entry.code, wrong.messages());
    }
    if (!entry.right.empty()) {
      const Elaborated right{std::string(entry.right)};
      CHECK_MESSAGE(right.fine(), right.messages());
    }
  }
}

TEST_CASE("the codes in the sources and in the catalogue are the same") {
  std::set<std::string> used, explained;
  const std::regex code("\"([EWN]0[0-9]{3})\"");
  for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(PROJECT_DIR) / "src/system")) {
    if (file.path().extension() != ".cpp" || file.path().filename() == "codes.cpp") continue;
    const std::string text = read(file.path());
    for (std::sregex_iterator i(text.begin(), text.end(), code), end; i != end; ++i) used.insert((*i)[1]);
  }
  for (const CodeEntry& entry : system_codes()) {
    CHECK(explained.insert(std::string(entry.code)).second);
    CHECK_FALSE(entry.explanation.empty());
  }
  CHECK(used == explained);
}
