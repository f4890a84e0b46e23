#include "../model_text.hpp"

#include <maupertuis/integral_symbol.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/rates.hpp>

using namespace maupertuis;

namespace rates_test {
namespace {

EquationsInRates in_rates(const ModelText& m) {
  RatesResult result = equations_in_rates(m.equations);
  INFO(result.reason);
  REQUIRE(result.equations);
  CHECK(result.equations->certificate.verdict == Verdict::Zero);
  return *std::move(result.equations);
}

std::string row(const EquationsInRates& e, std::size_t a) { return to_plain(e.rows.at(a).form, e.order) + " = 0"; }

std::string velocity(const EquationsInRates& e, std::size_t k) { return to_plain(e.kinematics.at(k).form, e.order); }

std::string body(const std::string& rotation, const std::string& rest) {
  return "system top\nparam A = 1 kg m^2, B = 2 kg m^2, C = 3 kg m^2, k = 1 N m s\n" + rotation + rest;
}

}  // namespace

TEST_CASE("Euler's equations come from Euler angles and from a quaternion, and are the same") {
  const std::string rates = "rates p, q, r = top.ω\nD = 1/2 k (p^2 + q^2 + r^2)\n";
  for (const std::string rotation :
       {"coord φ, θ, ψ : angle\nbody top inertia diag(A, B, C) rotation euler zxz (φ, θ, ψ)\n",
        "coord φ, θ, ψ : angle\nbody top inertia diag(A, B, C) rotation rpy (φ, θ, ψ)\n",
        "body top inertia diag(A, B, C) rotation quaternion\n"}) {
    const ModelText m(body(rotation, rates));
    const EquationsInRates e = in_rates(m);
    REQUIRE(e.rows.size() == 3);
    CHECK(row(e, 0) == "A p' - (B - C) q r + k p = 0");
    CHECK(row(e, 1) == "B q' + (A - C) p r + k q = 0");
    CHECK(row(e, 2) == "C r' - (A - B) p q + k r = 0");
  }
}

TEST_CASE("A quaternion turns by half of q ω") {
  const ModelText m(body("body top inertia diag(A, B, C) rotation quaternion\n", "rates p, q, r = top.ω\n"));
  const EquationsInRates e = in_rates(m);
  REQUIRE(e.kinematics.size() == 4);
  CHECK(velocity(e, 0) == "-1/2 (top.qx p + top.qy q + top.qz r)");
}

TEST_CASE("The weight of a top acts in its rows by the vertical on body axes") {
  const ModelText m(
      "system top\nparam A = 1 kg m^2, C = 1.5 kg m^2, m = 2 kg, h = 0.3 m, g = 9.81 m/s^2\n"
      "frame F rotation quaternion\nbody top mass m inertia diag(A, A, C) at (0, 0, h) in F\ngravity (0, 0, -g)\n"
      "rates p, q, r = top.ω\n");
  const EquationsInRates e = in_rates(m);
  CHECK(row(e, 0) == "(A + m h^2) p' - (A - C + m h^2) q r - 2 m g h (F.qw F.qx + F.qy F.qz) = 0");
  CHECK(row(e, 2) == "C r' = 0");
}

TEST_CASE("Constraints leave the equations: the sleigh of Chaplygin") {
  const ModelText m(
      "system sleigh\nparam m = 1 kg, I = 1 kg m^2, a = 0.3 m\ncoord x, y : length, ψ : angle\n"
      "T = 1/2 m (x'^2 + y'^2) + 1/2 I ψ'^2\nconstraint -x' sin ψ + y' cos ψ = a ψ'\n"
      "rates v = x' cos ψ + y' sin ψ, w = ψ'\n");
  const EquationsInRates e = in_rates(m);
  REQUIRE(e.rows.size() == 2);
  CHECK(row(e, 0) == "m v' - m a w^2 = 0");
  CHECK(row(e, 1) == "(m a^2 + I) w' + m a v w = 0");
  CHECK(velocity(e, 0) == "v cos ψ - a w sin ψ");
}

TEST_CASE("Velocities that no rate names stay; rates may depend on t") {
  const ModelText m(
      "system cart\nparam m = 1 kg, I = 1 kg m^2, Ω = 2 rad/s\ncoord x, y : length, ψ : angle\n"
      "T = 1/2 m (x'^2 + y'^2) + 1/2 I ψ'^2\n"
      "rates v = x' cos(Ω t) + y' sin(Ω t) + Ω x, u = -x' sin(Ω t) + y' cos(Ω t)\n");
  const EquationsInRates e = in_rates(m);
  REQUIRE(e.rows.size() == 3);
  CHECK(e.rows[2].rate == "ψ'");
  CHECK(row(e, 2) == "I ψ'' = 0");
  CHECK(e.kinematics.size() == 2);
}

TEST_CASE("A constraint that is not linear in the velocities is told") {
  const ModelText m(
      "system wind\nparam m = 1 kg, c = 1 m/s\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\n"
      "constraint x'^2 + y'^2 = c^2\nrates v = z'\n");
  const RatesResult result = equations_in_rates(m.equations);
  CHECK_FALSE(result.equations);
  CHECK(result.reason ==
        "A constraint is not linear in the velocities, so that they are no linear functions of rates.");
}

}  // namespace rates_test
