// Which equilibria are shown, in which order, and families as one.
#include "support.hpp"

using namespace maupertuis;

namespace {

std::string pendulum_from(const char* start) {
  return std::string(
             "system pendulum\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ1, θ2 : angle\n"
             "V = -m g l (cos θ1 + cos θ2)\nT = 1/2 m l^2 (θ1'^2 + θ2'^2)\nstart θ1 = ") +
         start + "\n";
}

/// A potential of r in the plane, in units of 1 m and 1 J, given in `s` = r².
std::string in_the_plane(const char* potential, const char* start) {
  return std::string(
             "system troughs\nparam m = 1 kg, a = 1 m, E = 1 J\ncoord x, y : length\n"
             "let s = (x^2 + y^2)/a^2\nT = 1/2 m (x'^2 + y'^2)\nV = E ") +
         potential + "\nstart " + start + "\n";
}

std::vector<double> radii(const ModalStudy& study) {
  std::vector<double> out;
  for (const ModalEntry& e : study.entries)
    out.push_back(std::hypot(e.equilibrium.point.q[0], e.equilibrium.point.q[1]));
  return out;
}

}  // namespace

TEST_CASE("The equilibrium nearest to the start comes first, the others by energy") {
  Linearized low(pendulum_from("0.2 rad"));
  const ModalStudy from_low = low.study();
  REQUIRE(from_low.entries.size() == 4);
  CHECK(point_text(*low.system, from_low.entries[0].equilibrium, {}) == "θ1 = 0, θ2 = 0");
  Linearized high(pendulum_from("-3 rad"));  // the shorter way to π goes through −π
  const ModalStudy from_high = high.study();
  REQUIRE(from_high.entries.size() == 4);
  CHECK(point_text(*high.system, from_high.entries[0].equilibrium, {}) == "θ1 = π, θ2 = 0");
  CHECK(point_text(*high.system, from_high.entries[1].equilibrium, {}) == "θ1 = 0, θ2 = 0");
  CHECK(point_text(*high.system, from_high.entries[3].equilibrium, {}) == "θ1 = π, θ2 = π");
}

TEST_CASE("A ring of equilibria is one family, and two rings are two") {
  Linearized one(in_the_plane("(s - 1)^2", "x = 1.1 m, y = 0.1 m"));
  const ModalStudy ring = one.study();
  REQUIRE(ring.entries.size() == 2);
  const Equilibrium& first = ring.entries[0].equilibrium;
  CHECK(near(std::hypot(first.point.q[0], first.point.q[1]), 1, 1e-9));
  CHECK(first.family == 1);
  CHECK(first.family_along == std::vector<std::size_t>{0, 1});
  CHECK(std::abs(first.point.q[1]) < 0.3);  // the member near the start
  CHECK(ring.entries[1].equilibrium.family == 0);
  // Minima at r = 1 and 2 of one energy, a ridge between them at r² = 5/2, and the hill in the middle.
  Linearized two(in_the_plane("(s - 1)^2 (s - 4)^2", "x = 1.9 m, y = 0 m"));
  const ModalStudy rings = two.study();
  std::vector<double> found = radii(rings);
  REQUIRE(found.size() == 4);
  CHECK(near(found[0], 2, 1e-9));
  std::sort(found.begin(), found.end());
  CHECK(found[0] < 1e-9);
  CHECK(near(found[1], 1, 1e-9));
  CHECK(near(found[2], std::sqrt(2.5), 1e-9));
  CHECK(near(found[3], 2, 1e-9));
}

TEST_CASE("The straight ways of a rolling disk, of any heading and speed, are one family") {
  // Nothing acts on any of them: what rounding leaves of the forces compares with nothing.
  Linearized disk(
      "system d\nparam m = 1 kg, R = 20 cm\ncoord x, y : length, φ, ψ : angle\n"
      "T = 1/2 m (x'^2 + y'^2) + 1/4 m R^2 φ'^2 + 1/8 m R^2 ψ'^2\n"
      "constraint x' = R φ' cos ψ name along_x\nconstraint y' = R φ' sin ψ name along_y\nstart φ' = 2 rad/s, ψ' = 1 "
      "rad/s\n");
  const ModalStudy study = disk.study();
  REQUIRE(study.entries.size() == 2);
  CHECK(study.entries[0].equilibrium.at_rest);
  CHECK(study.entries[0].equilibrium.family == 1);
  CHECK(study.entries[1].equilibrium.family == 2);
}

TEST_CASE("A ring at the bottom of a high power is one family, and no accident of rounding makes it stable or not") {
  // V = (r² − 1)ᵖ: the hill or the bottom in the middle, and the ring. Its Hessian vanishes for p > 2.
  for (const char* power : {"3", "4", "5", "6"}) {
    CAPTURE(power);
    Linearized m(in_the_plane((std::string("(s - 1)^") + power).c_str(), "x = 1.1 m, y = 0.1 m"));
    const ModalStudy study = m.study();
    REQUIRE(study.entries.size() == 2);
    CHECK(near(radii(study)[0], 1, 1e-9));
    CHECK(study.entries[0].equilibrium.family == 1);
    CHECK(study.entries[0].analysis.stability.verdict == Stability::Undecided);
    CHECK(radii(study)[1] < 1e-9);
    CHECK(study.entries[1].equilibrium.family == 0);
  }
  // Two rings of high powers are two.
  Linearized two(in_the_plane("(s - 1)^4 (s - 4)^4", "x = 1.9 m, y = 0 m"));
  std::vector<double> found = radii(two.study());
  std::sort(found.begin(), found.end());
  REQUIRE(found.size() == 4);
  CHECK(near(found[1], 1, 1e-9));
  CHECK(near(found[2], std::sqrt(2.5), 1e-9));
  CHECK(near(found[3], 2, 1e-9));
}

TEST_CASE("A family whose members lie as far apart as one likes is one, and found soon") {
  // At rest at y = 0, wherever z is; searches that slide down y²/(2 z) end anywhere.
  Linearized trough(
      "dimensionless\nparam m = 2\ncoord y, z : number\nT = 1/2 m (y'^2 + z'^2)\nV = y^2/(2 z)\nstart y = 0.3, z = "
      "1\n");
  const ModalStudy study = trough.study();
  REQUIRE_FALSE(study.entries.empty());
  CHECK(std::abs(study.entries[0].equilibrium.point.q[0]) < 1e-6);
  CHECK(study.entries[0].equilibrium.family == 1);
}

TEST_CASE("A potential that repeats in a length: those near the start are shown, the others counted") {
  Linearized m(
      "system lattice\nparam m = 1 kg, E = 1 J, a = 1 m\ncoord x : length\nT = 1/2 m x'^2\n"
      "V = E cos(2 pi x/a) + E (x/a)^2/10^5\nstart x = 0.4 m\n");
  const ModalStudy study = m.study();
  REQUIRE(study.entries.size() > 2);
  CHECK(near(study.entries[0].equilibrium.point.q[0], 0.5, 1e-3));
  for (const ModalEntry& e : study.entries) CHECK(std::abs(e.equilibrium.point.q[0] - 0.4) < 25);
}
