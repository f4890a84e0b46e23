#include "../model_text.hpp"
#include "../under_sanitizers.hpp"

#include <maupertuis/verification.hpp>

#include <map>
#include <span>

// Wrong claims over many models: each is told against the equation that it resembles, with its accelerations left in,
// and names the mistake that was made in it. Right claims in disguise pass.

using namespace maupertuis;

namespace {

const std::map<std::string, std::string> kModels = {
    {"turning",
     "param m = 1 kg, A = 1 kg m^2, B = 2 kg m^2, C = 3 kg m^2\ncoord x : length\n"
     "body b mass m inertia diag(A, B, C) at (x, 0, 0) rotation quaternion\nrates ω1, ω2, ω3 = b.ω\n"},
    {"oscillator",
     "dimensionless\nparam m = 1.5, c = 0.3, k = 2, F = 0.7, w = 1.1\ncoord x : number\nT = 1/2 m x'^2\nV = 1/2 k "
     "x^2\nD = 1/2 c x'^2\nforce x = F cos(w t)\n"},
    {"pendulum", "param m = 1 kg, l = 2 m, g = 9.81 m/s^2\ncoord θ : angle\nT = 1/2 m l^2 θ'^2\nV = -m g l cos θ\n"},
    {"double",
     "param m1 = 1 kg, m2 = 2 kg, l1 = 1 m, l2 = 3 m, g = 9.81 m/s^2\ncoord θ1, θ2 : angle\npoint A mass m1 at l1 (sin "
     "θ1, -cos θ1)\n"
     "point B mass m2 at A + l2 (sin θ2, -cos θ2)\ngravity (0, -g)\n"},
    {"cart",
     "param M = 2 kg, m = 0.5 kg, l = 0.6 m, g = 9.81 m/s^2, b = 0.4 N s/m, c = 0.01 N m s, F0 = 3 N, w = 2 "
     "rad/s\ncoord x : length, θ : angle\n"
     "point cart mass M at (x, 0)\npoint bob mass m at cart + l (sin θ, -cos θ)\ngravity (0, -g)\nD = 1/2 b x'^2 + 1/2 "
     "c θ'^2\nforce on cart = (F0 cos(w t), 0)\n"},
    {"spherical",
     "param m = 1 kg, l = 2 m, g = 9.81 m/s^2\ncoord θ, φ : angle\npoint P mass m at l (sin θ cos φ, sin θ sin φ, -cos "
     "θ)\ngravity (0, 0, -g)\n"},
    {"kepler", "dimensionless\nparam m = 2, k = 3\ncoord r, φ : number\nT = 1/2 m (r'^2 + r^2 φ'^2)\nV = -k/r\n"},
    {"hoop",
     "param m = 0.1 kg, R = 0.3 m, Ω = 8 rad/s, g = 9.81 m/s^2\ncoord θ : angle\nlet φ = Ω t\npoint bead mass m at R "
     "(sin θ cos φ, sin θ sin φ, -cos θ)\ngravity (0, 0, -g)\n"},
    {"elastic",
     "param m = 1 kg, k = 30 N/m, l0 = 1 m, g = 9.81 m/s^2\ncoord r : length, θ : angle\nT = 1/2 m (r'^2 + r^2 "
     "θ'^2)\nV = 1/2 k (r - l0)^2 - m g r cos θ\n"},
    {"atwood",
     "param m1 = 1 kg, m2 = 2 kg, g = 9.81 m/s^2, L0 = 3 m\ncoord x1, x2 : length\nT = 1/2 m1 x1'^2 + 1/2 m2 x2'^2\nV "
     "= -m1 g x1 - m2 g x2\n"
     "constraint x1 + x2 = L0 name rope\nstart x1 = 1 m, x2 = 2 m\n"},
    {"rod",
     "param m = 1 kg, l = 1 m, g = 9.81 m/s^2, c = 0.2 N s/m\ncoord x, y : length\npoint P mass m at (x, y)\ngravity "
     "(0, -g)\nD = 1/2 c (x'^2 + y'^2)\n"
     "constraint x^2 + y^2 = l^2 name rod\nstart x = 0.6 m, y = -0.8 m\n"},
    {"disk",
     "param m = 1 kg, R = 0.2 m\nlet I = 1/2 m R^2, J = 1/4 m R^2\ncoord x, y : length\ncoord φ, ψ : angle\nT = 1/2 m "
     "(x'^2 + y'^2) + 1/2 I φ'^2 + 1/2 J ψ'^2\n"
     "constraint x' = R φ' cos ψ name a\nconstraint y' = R φ' sin ψ name b\nstart φ' = 2 rad/s, ψ' = 1 rad/s\n"},
    {"top",
     "param m = 1 kg, h = 0.3 m, g = 9.81 m/s^2, I1 = 2 kg m^2, I3 = 1 kg m^2\ncoord φ, θ, ψ : angle\nbody top inertia "
     "diag(I1, I1, I3) rotation euler zxz (φ, θ, ψ)\nV = m g h cos θ\n"},
    {"motor",
     "param Lm = 0.1 H, Rm = 1 ohm, K = 0.05 N m/A, U0 = 12 V, J = 0.02 kg m^2, b = 0.02 N m s\ncoord q : charge, θ : "
     "angle\nT = 1/2 Lm q'^2 + 1/2 J θ'^2\n"
     "L = T - V + K θ q'\nD = 1/2 Rm q'^2 + 1/2 b θ'^2\nforce q = U0\n"},
    {"charge",
     "dimensionless\nparam m = 2, q = 1.5, B = 0.7, E = 0.4\ncoord x, y, z : number\nL = 1/2 m (x'^2 + y'^2 + z'^2) + "
     "1/2 q B (x y' - y x') + q E z\n"},
    {"chain",
     "param m = 1 kg, k = 10 N/m, K = 3 N/m, d = 0.1 N s/m\ncoord x1, x2, x3 : length\nT = 1/2 m (x1'^2 + x2'^2 + "
     "x3'^2)\nV = 1/2 k (x1^2 + x3^2) + 1/2 K ((x2 - x1)^2 + (x3 - x2)^2)\n"
     "D = 1/2 d (x2' - x1')^2\n"},
    {"foucault",
     "dimensionless\nparam m = 2, w = 1.3, Ω = 0.4\ncoord x, y : number\nT = 1/2 m ((x' - Ω y)^2 + (y' + Ω x)^2)\nV = "
     "1/2 m w^2 (x^2 + y^2)\n"},
    {"arm",
     "param m1 = 1 kg, m2 = 1 kg, l1 = 1 m, l2 = 1 m, g = 9.81 m/s^2, τ = 2 N m\ncoord q1, q2 : angle\npoint A mass m1 "
     "at l1 (cos q1, sin q1)\n"
     "point B mass m2 at A + l2 (cos(q1 + q2), sin(q1 + q2))\ngravity (0, -g)\nforce q1 = τ\n"},
    {"cone",
     "dimensionless\nparam m = 1.2, g = 9.81, a = 0.5\ncoord r, φ : number\nT = 1/2 m ((1 + a^2) r'^2 + r^2 φ'^2)\nV = "
     "m g a r\n"},
};

ExpectationResult result_of(const std::string& model, const std::string& claim) {
  const ModelText m("system s\n" + kModels.at(model) + "claim " + claim + "\n");
  Diagnostics diagnostics;
  const Verification v = verify(m.model, m.equations, m.source, {}, diagnostics);
  REQUIRE(v.results.size() == 1);
  return v.results.front();
}

struct Wrong {
  const char *model, *claim, *message, *mistake;
};

const Wrong kWrong[] = {
    // missing terms
    {"double", "(m1 + m2) l1^2 θ1'' + m2 l1 l2 cos(θ1 - θ2) θ2'' + (m1 + m2) g l1 sin θ1 = 0",
     "missing: m2 l1 l2 sin(θ1 - θ2) θ2'^2", "velocities is missing"},
    {"double", "m2 l2^2 θ2'' + m2 l1 l2 cos(θ1 - θ2) θ1'' + m2 g l2 sin θ2 = 0",
     "missing: -m2 l1 l2 sin(θ1 - θ2) θ1'^2", "velocities is missing"},
    {"double", "l2 θ2'' + l1 cos(θ1 - θ2) θ1'' + g sin θ2 = 0", "missing: -m2 l1 l2 sin(θ1 - θ2) θ1'^2",
     "velocities is missing"},
    {"double", "m2 l2^2 θ2'' - m2 l1 l2 sin(θ1 - θ2) θ1'^2 + m2 g l2 sin θ2 = 0", "missing: m2 l1 l2 cos(θ1 - θ2) θ1''",
     "coupling with θ1 is missing"},
    {"cart", "(M + m) x'' + m l cos θ θ'' + b x' = F0 cos(w t)", "missing: -m l sin θ θ'^2", "total time derivative"},
    {"cart", "(M + m) x'' + m l cos θ θ'' - m l sin θ θ'^2 = F0 cos(w t)", "missing: b x'", "dissipation"},
    {"cart", "(M + m) x'' + m l cos θ θ'' - m l sin θ θ'^2 + b x' = 0", "missing: -F0 cos(w t)", "force"},
    {"cart", "(M + m) x'' - m l sin θ θ'^2 + b x' = F0 cos(w t)", "missing: m l cos θ θ''",
     "coupling with θ is missing"},
    {"cart", "M x'' + m l cos θ θ'' - m l sin θ θ'^2 + b x' = F0 cos(w t)", "missing: m x''", "inertia is missing"},
    {"spherical", "m l^2 θ'' + m g l sin θ = 0", "missing: -m l^2 sin θ cos θ φ'^2", "∂T/∂q"},
    {"spherical", "m l^2 sin^2 θ φ'' = 0", "missing: 2 m l^2 sin θ cos θ θ' φ'", "total time derivative"},
    {"kepler", "m r'' + k/r^2 = 0", "missing: -m r φ'^2", "∂T/∂q"},
    {"kepler", "m r^2 φ'' = 0", "missing: 2 m r r' φ'", "total time derivative"},
    {"hoop", "m R^2 θ'' + m g R sin θ = 0", "missing: -m R^2 Ω^2 sin θ cos θ", "∂T/∂q"},
    {"elastic", "m r'' + k (r - l0) - m g cos θ = 0", "missing: -m r θ'^2", "∂T/∂q"},
    {"elastic", "m r^2 θ'' + m g r sin θ = 0", "missing: 2 m r r' θ'", "total time derivative"},
    {"elastic", "m r'' - m r θ'^2 + k (r - l0) = 0", "missing: -m g cos θ", "potential is missing"},
    {"atwood", "m1 x1'' = m1 g", "missing: -λ_rope", "force of the constraint rope is missing"},
    {"rod", "m x'' + c x' = 0", "missing: -2 x λ_rod", "force of the constraint rod is missing"},
    {"rod", "m y'' + m g = 2 multiplier(rod) y", "missing: c y'", "dissipation"},
    {"disk", "m x'' = 0", "missing: -λ_a", "force of the constraint a is missing"},
    {"motor", "Lm q'' + Rm q' = U0", "missing: K θ'", "total time derivative"},
    {"motor", "J θ'' - K q' = 0", "missing: b θ'", "dissipation"},
    {"charge", "m x'' = 0", "missing: -q B y'", "velocities is missing"},
    {"charge", "m z'' = 0", "missing: -q E", "potential is missing"},
    {"foucault", "m x'' + m w^2 x - 2 m Ω y' = 0", "missing: -m Ω^2 x", "prescribed motion is missing"},
    {"arm", "m2 l2^2 q2'' + m2 l2^2 q1'' + m2 l1 l2 cos q2 q1'' + m2 g l2 cos(q1 + q2) = 0",
     "missing: m2 l1 l2 sin q2 q1'^2", "velocities is missing"},
    {"chain", "m x2'' + K (2 x2 - x1 - x3) = 0", "missing: ", "dissipation"},
    {"cone", "(1 + a^2) m r'' + m g a = 0", "missing: -m r φ'^2", "∂T/∂q"},
    // wrong signs
    {"pendulum", "m l^2 θ'' = m g l sin θ", "wrong sign: m g l sin θ", "V has the wrong sign"},
    {"kepler", "m r'' + m r φ'^2 + k/r^2 = 0", "wrong sign: -m r φ'^2", "momentum of φ was put into L"},
    {"double", "m2 l2^2 θ2'' + m2 l1 l2 cos(θ1 - θ2) θ1'' + m2 l1 l2 sin(θ1 - θ2) θ1'^2 + m2 g l2 sin θ2 = 0",
     "wrong sign: -m2 l1 l2 sin(θ1 - θ2) θ1'^2", "velocities has the wrong sign"},
    {"atwood", "m2 x2'' - m2 g = -multiplier(rope)", "wrong sign: -λ_rope", "rope has the wrong sign"},
    {"charge", "m y'' = q B x'", "wrong sign: q B x'", "velocities has the wrong sign"},
    {"cart", "(M + m) x'' + m l cos θ θ'' - m l sin θ θ'^2 - b x' = F0 cos(w t)", "wrong sign: b x'",
     "dissipation has the wrong sign"},
    // wrong factors
    {"pendulum", "m l^2 θ'' + 2 m g l sin θ = 0", "2 m g l sin θ stands in the place of m g l sin θ",
     "V has a factor 2 too many"},
    {"pendulum", "m l^2 θ'' + m g sin θ * (3 [m]) = 0", "stands in the place of m g l sin θ", "factor of"},
    {"pendulum", "m l^2 θ'' + m g sin θ * (2 [m]) = 0", "stands in the place of m g l sin θ",
     "numbers stand in the place of symbols"},
    {"kepler", "m r^2 φ'' + m r r' φ' = 0", "m r r' φ' stands in the place of 2 m r r' φ'",
     "velocities lacks a factor 2"},
    {"elastic", "m r'' - m r θ'^2 + 2 k (r - l0) - m g cos θ = 0", "stands in the place of", "factor 2 too many"},
    // wrong functions, arguments, powers
    {"pendulum", "m l^2 θ'' + m g l cos θ = 0", "m g l cos θ stands in the place of m g l sin θ",
     "cos θ stands in the place of sin θ"},
    {"pendulum", "m l^2 θ'' + m g l θ = 0", "stands in the place of m g l sin θ", "small angles"},
    {"double", "m2 l2^2 θ2'' + m2 l1 l2 cos(θ1 - θ2) θ1'' - m2 l1 l2 cos(θ1 - θ2) θ1'^2 + m2 g l2 sin θ2 = 0",
     "stands in the place of", "cos(θ1 - θ2) stands in the place of sin(θ1 - θ2)"},
    {"double", "m2 l2^2 θ2'' + m2 l1 l2 cos(θ1 + θ2) θ1'' - m2 l1 l2 sin(θ1 - θ2) θ1'^2 + m2 g l2 sin θ2 = 0",
     "stands in the place of", "cos(θ1 + θ2) stands in the place of cos(θ1 - θ2)"},
    {"double", "m2 l2^2 θ2'' + m2 l1 l2 cos(θ1 - θ2) θ1'' - m2 l1 l2 sin(θ1 - θ2) θ2'^2 + m2 g l2 sin θ2 = 0",
     "stands in the place of", "θ2' stands in the place of θ1'"},
    {"hoop", "m R^2 θ'' + m g R sin θ = m R^2 Ω^2 sin θ", "-m R^2 Ω^2 sin θ stands in the place of",
     "a factor cos θ is missing"},
    {"hoop", "m R^2 θ'' + m g R sin θ = m R^2 Ω^2 cos θ", "-m R^2 Ω^2 cos θ stands in the place of",
     "a factor sin θ is missing"},
    {"kepler", "m r'' - m r φ' + k/r^2 = 0", "stands in the place of -m r φ'^2", "power too few"},
    {"oscillator", "m x'' + c x + k x = F cos(w t)", "c x stands in the place of c x'", "x stands in the place of x'"},
    {"top", "m g h sin θ + I1 θ'' = 0", "wrong sign: -m g h sin θ", "velocities is missing"},
    {"oscillator", "m x'' + c x' + k x = F cos(w t) + k", "on its left side stands more: -k", ""},
};

}  // namespace

TEST_CASE("wrong claims are told against the equation that they resemble") {
  for (const Wrong& w : std::span(kWrong).first(under_sanitizers ? 12 : std::size(kWrong))) {
    const ExpectationResult r = result_of(w.model, w.claim);
    INFO(std::string(w.model), ": ", std::string(w.claim), "\n  ", r.message, "\n  ", r.pitfall);
    CHECK_FALSE(r.passed);
    CHECK(r.message.find(w.message) != std::string::npos);
    if (*w.mistake)
      CHECK(r.pitfall.find(w.mistake) != std::string::npos);
    else
      CHECK(r.pitfall == "");
  }
  CHECK(std::size(kWrong) >= 40);
}

TEST_CASE("wrong claims about rates are told against the equations in rates") {
  for (const auto& [claim, message] : std::vector<std::pair<std::string, std::string>>{
           {"A ω1' = (C - B) ω2 ω3", "the equation for ω1; wrong sign: -(B - C) ω2 ω3."},
           {"A ω1' = 0", "the equation for ω1; missing: -(B - C) ω2 ω3."},
           {"ω2' = 2 (C - A)/B ω1 ω3", "the equation for ω2, times 1/B; 2 times (A - C) ω1 ω3 stands in its place."},
           {"C ω3' = (A + B) ω1 ω2", "the equation for ω3; wrong sign: B ω1 ω2."},
       }) {
    const ExpectationResult r = result_of("turning", claim);
    INFO(claim, "\n  ", r.message);
    CHECK_FALSE(r.passed);
    CHECK(r.message.find(message) != std::string::npos);
  }
}

TEST_CASE("right claims in disguise pass") {
  for (const auto& [model, claim] : std::vector<std::pair<std::string, std::string>>{
           {"pendulum", "θ'' = -g/l sin θ"},
           {"pendulum", "0 = 3 m g l sin θ + 3 m l^2 θ''"},
           {"double", "l2 θ2'' + l1 cos(θ1 - θ2) θ1'' - l1 sin(θ1 - θ2) θ1'^2 + g sin θ2 = 0"},
           {"kepler", "r φ'' + 2 r' φ' = 0"},
           {"kepler", "r'' = r φ'^2 - k/(m r^2)"},
           {"cart", "cos θ x'' + l θ'' + g sin θ + c/(m l) θ' = 0"},
           {"atwood", "(m1 + m2) x2'' = (m2 - m1) g"},
           {"foucault", "x'' = (Ω^2 - w^2) x + 2 Ω y'"},
       }) {
    const ExpectationResult r = result_of(model, claim);
    INFO(model, ": ", claim, "\n  ", r.message);
    CHECK(r.passed);
  }
}
