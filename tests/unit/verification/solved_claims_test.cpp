#include "../model_text.hpp"
#include "../under_sanitizers.hpp"

#include <maupertuis/verification.hpp>

#include <map>
#include <span>

// Claims with the forces of constraints or the accelerations put in, and claims about these forces: one mistake that
// explains them is told, two that would together are not, and what is unknown is said to be unknown.

using namespace maupertuis;

namespace solved_claims_test {
namespace {

const std::map<std::string, std::string> kModels = {
    {"roll",  // 3/2 m s'' = m g sin β, λ = −m g sin β/3
     "param m = 1.5 kg, R = 0.3 m, β = 20 deg, g = 9.81 m/s^2\ncoord s : length, θ : angle\n"
     "T = 1/2 m s'^2 + 1/4 m R^2 θ'^2\nV = -m g s sin β\nconstraint s' = R θ' name roll\n"},
    {"ball",
     "param m = 0.1 kg, r = 0.02 m, R = 0.3 m, g = 9.81 m/s^2\ncoord θ, χ : angle\n"
     "T = 1/2 m (R - r)^2 θ'^2 + 1/5 m r^2 χ'^2\nV = -m g (R - r) cos θ\nconstraint r χ' = (R - r) θ' name roll\n"
     "start θ = 40 deg\n"},
    {"yoyo",  // λ = −m g J/(J + m b²)
     "param m = 0.2 kg, b = 1 cm, J = 1e-4 kg m^2, g = 9.81 m/s^2\ncoord y : length, θ : angle\n"
     "T = 1/2 m y'^2 + 1/2 J θ'^2\nV = -m g y\nconstraint y = b θ name string\n"},
    {"atwood",
     "param m1 = 2 kg, m2 = 3 kg, J = 0.1 kg m^2, R = 0.2 m, g = 9.81 m/s^2\ncoord y1, y2 : length, θ : angle\n"
     "T = 1/2 m1 y1'^2 + 1/2 m2 y2'^2 + 1/2 J θ'^2\nV = m1 g y1 + m2 g y2\nconstraint y1 = R θ name left\n"
     "constraint y2 = -R θ name right\n"},
    {"sled",
     "param m = 2 kg, J = 0.3 kg m^2, g = 9.81 m/s^2, δ = 10 deg\ncoord x, y : length, ψ : angle\n"
     "T = 1/2 m (x'^2 + y'^2) + 1/2 J ψ'^2\nV = -m g sin δ x\nconstraint x' sin ψ - y' cos ψ = 0 name edge\n"
     "start ψ' = 1 rad/s\n"},
    {"disk",
     "param m = 1 kg, R = 0.2 m\nlet I = 1/2 m R^2, J = 1/4 m R^2\ncoord x, y : length\ncoord φ, ψ : angle\n"
     "T = 1/2 m (x'^2 + y'^2) + 1/2 I φ'^2 + 1/2 J ψ'^2\nconstraint x' = R φ' cos ψ name a\n"
     "constraint y' = R φ' sin ψ name b\nstart φ' = 2 rad/s, ψ' = 1 rad/s\n"},
    {"twice",  // constraints that repeat each other: λ is not determined
     "param m = 1 kg, g = 9.81 m/s^2, J = 1 kg m^2, R = 1 m\ncoord y : length\ncoord θ : angle\n"
     "T = 1/2 m y'^2 + 1/2 J θ'^2\nV = -m g y\nconstraint y = R θ name a\nconstraint 2 y = 2 R θ name b\n"},
    {"springs",
     "param m = 1 kg, k = 5 N/m, κ = 3 N/m, L0 = 1 m, g = 9.81 m/s^2\ncoord a, b : length\n"
     "point P mass m at (a, 0)\npoint Q1 mass m at (b, 0)\npoint O1 at (0, 0)\nspring O1 - P stiffness k\n"
     "spring P - Q1 stiffness κ\nstart a = 1 m, b = 2 m\n"},
    {"wedge",
     "param M = 3 kg, m = 1.2 kg, α = 30 deg, g = 9.81 m/s^2\ncoord X, s : length\npoint W mass M at (X, 0)\n"
     "point B mass m at (X + s cos α, -s sin α)\ngravity (0, -g)\n"},
    {"chain",
     "param m = 1 kg, M = 2 kg, k = 5 N/m, κ = 3 N/m, c = 0.1 N s/m\ncoord x1, x2, x3 : length\n"
     "T = 1/2 m x1'^2 + 1/2 M x2'^2 + 1/2 m x3'^2\n"
     "V = 1/2 k x1^2 + 1/2 κ (x2 - x1)^2 + 1/2 κ (x3 - x2)^2 + 1/2 k x3^2\nD = 1/2 c (x2' - x1')^2\n"},
};

ExpectationResult judged(const std::string& model, const std::string& claim) {
  const ModelText m("system s\n" + kModels.at(model) + "claim " + claim + "\n");
  Diagnostics diagnostics;
  const Verification v = verify(m.model, m.equations, m.source, {}, diagnostics);
  REQUIRE(v.results.size() == 1);
  return v.results.front();
}

struct Wrong {
  const char *model, *claim, *message, *mistake;
};

void check(std::span<const Wrong> claims) {
  for (const Wrong& w : claims.first(under_sanitizers ? std::min<std::size_t>(3, claims.size()) : claims.size())) {
    const ExpectationResult r = judged(w.model, w.claim);
    INFO(std::string(w.model), ": ", std::string(w.claim), "\n  ", r.message, "\n  ", r.pitfall);
    CHECK_FALSE(r.passed);
    CHECK(r.message.find(w.message) != std::string::npos);
    if (*w.mistake)
      CHECK(r.pitfall.find(w.mistake) == 0);
    else
      CHECK(r.pitfall == "");
    CHECK((r.message.find("No known mistake has this signature.") != std::string::npos) == r.pitfall.empty());
  }
}

constexpr const char* unknown = "No known mistake has this signature.";

}  // namespace

TEST_CASE("claims about forces of constraints follow from a mistaken model, or the mistake is not told") {
  const Wrong claims[] = {
      {"yoyo", "multiplier(string) = 1000 m g", "-(1000 m b^2 + 1001 J) m g/(m b^2 + J), not 0", ""},
      {"yoyo", "reaction(string) = m g", unknown, ""},
      {"yoyo", "multiplier(string) = -3 m g", unknown, ""},
      {"yoyo", "multiplier(string) = -m g J/(J + 2 m b^2)", unknown, ""},
      {"atwood", "multiplier(left) = 3 m1 g", unknown, ""},
      {"atwood", "multiplier(left) = -2 m1 m2 g/(m1 + m2)", unknown, ""},
      {"atwood", "multiplier(left) = -multiplier(right)", unknown, ""},
      {"atwood", "multiplier(right) = 0", unknown, ""},
      {"sled", "multiplier(edge) = m g sin δ", unknown, ""},
      // Pulleys and bodies without inertia: the same force on both sides, and none.
      {"atwood", "multiplier(left) = 2 m1 m2 g/(m1 + m2)", "left side − right side",
       "the energy of rotation is missing"},
      {"atwood", "multiplier(left) = multiplier(right)", "", "the energy of rotation is missing from T"},
      {"yoyo", "multiplier(string) = 0", "", "the energy of rotation is missing from T"},
      // λ = −m g along the motion without ½ m y'².
      {"yoyo", "multiplier(string) = -m g", "missing: m y''", "the energy of the centre of mass is missing from T"},
      {"yoyo", "multiplier(string) = m g J/(J + m b^2)", "wrong sign", "λ has the wrong sign"},
      {"roll", "multiplier(roll) = m g sin β/3", "wrong sign", "λ has the wrong sign"},
      {"ball", "multiplier(roll) = 2/7 m g sin θ", "wrong sign", "λ has the wrong sign"},
      {"roll", "multiplier(roll) = -1/2 m g sin β", "1/2 m g sin β stands in the place of 1/3 m g sin β", ""},
      {"roll", "multiplier(roll) = 0", unknown, ""},
  };
  check(claims);
}

TEST_CASE("one mistake explains a claim with the forces of constraints put in, or none is told") {
  const Wrong claims[] = {
      {"roll", "s'' = 5/7 g sin β", "-5/7 g sin β stands in the place of -2/3 g sin β",
       "what stands beside the inertia is 15/14 of what it should be, or the inertia is 14/15"},
      {"roll", "s'' = 1/2 g sin β", "s''; -1/2 g sin β", "what stands beside the inertia is 3/4"},
      {"roll", "4/3 s'' = g sin β", "s''; -g sin β", "what stands beside the inertia is 9/8"},
      {"ball", "3/2 (R - r) θ'' + g sin θ = 0", "θ''; g sin θ", "what stands beside the inertia is 14/15"},
      {"ball", "7 (R - r) θ'' + 3 g sin θ = 0", "θ''; 3 g sin θ", "what stands beside the inertia is 3/5"},
      {"ball", "9/5 (R - r) θ'' + g sin θ = 0", "θ''; g sin θ", "what stands beside the inertia is 7/9"},
      {"ball", "7/5 R θ'' + g sin θ = 0", "missing: -7/5 r θ''", "a part of the inertia is missing"},
      {"roll", "s'' = -2/3 g sin β", "wrong sign: -2/3 g sin β", "V has the wrong sign"},
      {"ball", "7/5 (R - r) θ'' - g sin θ = 0", "wrong sign: g sin θ", "V has the wrong sign"},
      {"yoyo", "(m + J/b^2) y'' = -m g", "wrong sign", "V has the wrong sign"},
      {"atwood", "(m1 + m2 + J/R^2) y1'' = (m1 - m2) g", "wrong sign", "V has the wrong sign"},
      {"yoyo", "(J + 2 m b^2) θ'' = m g b", "2 m b^2 θ'' stands in the place of m b^2 θ''",
       "a part of the inertia has a factor 2 too many"},
      {"yoyo", "(m - J/b^2) y'' = m g", "wrong sign: J", "a part of the inertia has the wrong sign"},
      {"yoyo", "y'' = g/(1 + J/(2 m b^2))", "J y'' stands in the place of 2 J y''",
       "a part of the inertia lacks a factor 2"},
      {"atwood", "(m1 + m2 + 1/2 J/R^2) y1'' = (m2 - m1) g", "stands in the place of",
       "a part of the inertia lacks a factor 2"},
      {"roll", "s'' = 2/3 g cos β", "-2/3 g cos β stands in the place of -2/3 g sin β",
       "cos β stands in the place of sin β"},
      {"atwood", "y1'' = g", unknown, ""},
      {"roll", "s'' = -g sin β", unknown, ""},
      {"roll", "s'' = 2 g", unknown, ""},
      {"disk", "x'' = -2 R φ' ψ' sin ψ", "stands in the place of R sin ψ φ' ψ'", "one of its terms has a factor 2"},
      {"disk", "x'' = -R φ' ψ' cos ψ", "stands in the place of R sin ψ φ' ψ'", "cos ψ stands in the place of sin ψ"},
      {"twice", "(m + J/R^2) y'' = -m g", "Along the motion", "V has the wrong sign"},
      {"twice", "m y'' = m g", "missing", "the energy of rotation is missing"},
      {"twice", "multiplier(a) = m g", unknown, ""},
  };
  check(claims);
}

TEST_CASE("the sign of λ in one equation is told as that, though the motion of another V has it too") {
  const Wrong claims[] = {
      {"roll", "m s'' - m g sin β = -multiplier(roll)", "wrong sign: -λ_roll", "the force of the constraint roll has"},
      {"roll", "1/2 m R^2 θ'' = R multiplier(roll)", "wrong sign: R λ_roll", "the force of the constraint roll has"},
      {"sled", "m x'' = m g sin δ - sin ψ multiplier(edge)", "wrong sign", "the force of the constraint edge has"},
      {"yoyo", "J θ'' = multiplier(string)*b", "wrong sign: b λ_string", "the force of the constraint string has"},
  };
  check(claims);
}

TEST_CASE("what is left of a claim along the motion is shown with accelerations and forces put in, as one fraction") {
  const Wrong claims[] = {
      {"sled", "x'' cos ψ + y'' sin ψ = g sin δ", "stands in the place of -g sin δ cos ψ", "a factor cos ψ is missing"},
      {"sled", "x'' cos ψ + y'' sin ψ = g sin δ sin ψ", "-g sin δ sin ψ stands in the place of -g sin δ cos ψ",
       "sin ψ stands in the place of cos ψ"},
      {"sled", "m (x'' cos ψ + y'' sin ψ) = m g sin δ cos ψ + multiplier(edge)",
       "is m (cos ψ x' + sin ψ y') ψ' + m g sin δ sin ψ, not 0", ""},
      {"atwood", "m1 y1'' - m2 y2'' = (m2 - m1) g", "is (m1 - m2) J g/(m1 R^2 + m2 R^2 + J), not 0",
       "the energy of rotation is missing from T"},
      {"wedge", "s'' = (M - m) g sin α/(M + m sin(α)^2)", "wrong sign: -m g sin α",
       "one of its terms has the wrong sign"},
      {"wedge", "s'' = (M + m) g sin α/(M + m cos(α)^2)",
       "is -(M + m) (1 - 2 cos^2 α) m g sin α/((M + m cos^2 α) (M + m sin^2 α)), not 0", ""},
      {"wedge", "M X'' + m s'' = 0", "Along the motion, left side − right side is", ""},  // two mistakes
      {"chain", "M x2'' + κ (x2 - x1) + κ (x3 - x2) + c (x2' - x1') = 0", "wrong sign: -κ x3",
       "the force of 1/2 κ (x3 - x2)^2 in V has the wrong sign"},
      {"chain", "M x2'' + κ (x2 - x1) + c (x2' - x1') = 0", "", "the force of 1/2 κ (x3 - x2)^2 in V is missing"},
      {"springs", "m a'' + k a + κ (b - a) = 0", "wrong sign", "a force of the potential has the wrong"},
  };
  check(claims);
}

TEST_CASE("right claims about forces, with forces put in, and about sums of equations pass") {
  for (const auto& [model, claim] : std::vector<std::pair<std::string, std::string>>{
           {"roll", "multiplier(roll) = -1/3 m g sin β"},
           {"roll", "s'' = 2/3 g sin β"},
           {"roll", "m s'' - m g sin β = multiplier(roll)"},
           {"ball", "7/5 (R - r) θ'' + g sin θ = 0"},
           {"ball", "χ'' = -5/7 g sin θ/r"},
           {"yoyo", "multiplier(string) = -m g J/(J + m b^2)"},
           {"yoyo", "(J + m b^2) θ'' = m g b"},
           {"atwood", "(m1 + m2 + J/R^2) y1'' = (m2 - m1) g"},
           {"sled", "x'' cos ψ + y'' sin ψ = g sin δ cos ψ"},
           {"wedge", "s'' = (M + m) g sin α/(M + m sin(α)^2)"},
           {"chain", "M x2'' + κ (x2 - x1) + κ (x2 - x3) + c (x2' - x1') = 0"},
       }) {
    const ExpectationResult r = judged(model, claim);
    INFO(model, ": ", claim, "\n  ", r.message);
    CHECK(r.passed);
  }
}

}  // namespace solved_claims_test
