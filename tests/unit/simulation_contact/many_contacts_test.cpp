// Many contacts at once: closed forms, forces by complementarity, events that end no step.
#include "../under_sanitizers.hpp"
#include "simulation/contact/contact_forces.hpp"

#include "run_text.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace maupertuis;

namespace {

std::string sum_over(std::size_t n, const std::string& term) {
  std::string out;
  for (std::size_t i = 0; i < n; ++i) out += (i == 0 ? "" : " + ") + fmt::format(fmt::runtime(term), fmt::arg("i", i));
  return out;
}

std::string names(std::size_t n) {
  std::string out;
  for (std::size_t i = 0; i < n; ++i) out += fmt::format("{}x{}", i == 0 ? "" : ", ", i);
  return out;
}

/// Discs on a rail above each other, x_i the place of number i, each d above the one below when they touch.
std::string stack(std::size_t n, double e) {
  std::string out = "param m = 1 kg, g = 9.81 m/s^2, d = 0.1 m\ncoord " + names(n) +
                    " : length\nT = " + sum_over(n, "1/2 m x{i}'^2") + "\nV = " + sum_over(n, "m g x{i}") +
                    fmt::format("\ncontact x0 >= 0 restitution {} name floor\n", e);
  for (std::size_t i = 1; i < n; ++i)
    out += fmt::format("contact x{} - x{} >= d restitution {} name c{}\n", i, i - 1, e, i);
  for (std::size_t i = 0; i < n; ++i)
    out += fmt::format("{}x{} = {} m", i == 0 ? "start " : ", ", i,
                       1 + 0.1 * static_cast<double>(i) + 0.01 * static_cast<double>(i * i));
  return out + "\n";
}

}  // namespace

TEST_CASE("a stack comes to rest at its heights, and its impacts took what it had above them") {
  constexpr double g = 9.81;
  for (const double e : {0.0, 0.5, 0.7})
    for (const std::size_t n : {std::size_t{3}, std::size_t{10}}) {
      CAPTURE(e);
      CAPTURE(n);
      const auto r = run_text(stack(n, e), 12);
      double energy = 0;
      for (std::size_t i = 0; i < n; ++i) {
        const double k = static_cast<double>(i);
        CHECK(r.final.q[i] == doctest::Approx(0.1 * k).epsilon(1e-12));
        CHECK(std::abs(r.final.v[i]) < 1e-12);
        energy += g * (1 + 0.01 * k * k);
      }
      CHECK(r.books->impacts == doctest::Approx(energy).epsilon(1e-11));
      CHECK(r.happenings.back().mode.find("floor") == 0);
    }
}

TEST_CASE("a plate on a hundred legs stands, and its motion is that without redundant ones") {
  std::string text =
      "param m = 1 kg, g = 9.81 m/s^2, J = 0.1 kg m^2\ncoord z : length, a, b : angle\n"
      "T = 1/2 m z'^2 + 1/2 J (a'^2 + b'^2)\nV = m g z\n";
  for (int i = 0; i < 100; ++i)
    text += fmt::format("contact z + {:.9f} [m] sin a + {:.9f} [m] sin b >= 0\n", std::cos(0.0628318530718 * i),
                        std::sin(0.0628318530718 * i));
  const auto r = run_text(text, 1);
  CHECK(r.happenings.empty());
  CHECK(std::abs(r.final.q[0]) < 1e-13);
  CHECK(std::abs(r.final.q[1]) < 1e-13);
}

namespace {

using NineSpeeds = std::array<std::array<double, 2>, 9>;

/// Nine discs that begin as a square and fall between x = 0 and a wall: no gap is violated at the end, and the books
/// close.
void check_heap(const NineSpeeds& speeds, double wall, bool lid) {
  std::string text = "dimensionless\ncoord ", energy, potential, contacts, start;
  for (std::size_t i = 0; i < 9; ++i) {
    const char* const comma = i > 0 ? ", " : "";
    text += fmt::format("{0}x{1}, y{1}", comma, i);
    energy += fmt::format("{0}1/2 (x{1}'^2 + y{1}'^2)", i > 0 ? " + " : "", i);
    potential += fmt::format("{}9.81 y{}", i > 0 ? " + " : "", i);
    start +=
        fmt::format("{0}x{1} = {2}, y{1} = {3}, x{1}' = {4}, y{1}' = {5}", comma, i, static_cast<double>(i % 3) + 0.5,
                    static_cast<double>(i / 3) + 0.5, speeds[i][0], speeds[i][1]);
    contacts += fmt::format("contact x{0} >= 0.3 restitution 0.3\ncontact x{0} <= {1} restitution 0.3\n", i, wall);
    contacts += fmt::format("contact y{} >= 0.3 restitution 0.3\n", i);
    if (lid) contacts += fmt::format("contact y{} <= 9 restitution 0.3\n", i);
    for (std::size_t j = 0; j < i; ++j)
      contacts += fmt::format("contact sqrt((x{0} - x{1})^2 + (y{0} - y{1})^2) >= 0.6 restitution 0.3\n", i, j);
  }
  const auto r = run_text(
      text + " : number\nT = " + energy + "\nV = " + potential + "\n" + contacts + "start " + start + "\n", 1.6);
  CHECK(r.statistics.energy_drift < 1e-9);
  double closest = 1;
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < i; ++j)
      closest = std::min(
          closest, std::hypot(r.final.q[2 * i] - r.final.q[2 * j], r.final.q[2 * i + 1] - r.final.q[2 * j + 1]) - 0.6);
  CHECK(closest > -1e-10);
}

}  // namespace

TEST_CASE("nine discs fall into a box, settle to a heap, and the floor carries them" *
          doctest::skip(under_sanitizers)) {
  check_heap({{{-0.731272, 0.694867},
               {0.527549, -0.489862},
               {-0.009130, -0.101018},
               {0.303186, 0.577447},
               {-0.812281, -0.943305},
               {0.671530, -0.134466},
               {0.524560, -0.995788},
               {-0.109226, 0.443080},
               {-0.542476, 0.890541}}},
             2.8, true);
}

TEST_CASE("a gap that others move through zero as they are closed is hit with them") {
  check_heap({{{0.245803, 0.483574},
               {0.590387, 0.884901},
               {0.479797, 0.84465},
               {-0.94199, -0.0687547},
               {0.886713, 0.297949},
               {0.801801, -0.773588},
               {-0.0618619, -0.506854},
               {0.0875217, 0.147882},
               {-0.973772, -0.56654}}},
             2.6, false);
}

TEST_CASE("sixty equal beads without loss go through each other but for their names") {
  constexpr std::size_t n = 60;
  constexpr double end = 3;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> speed(-1, 1);
  std::string text = "dimensionless\ncoord " + names(n) + " : number\nT = " + sum_over(n, "1/2 x{i}'^2") + "\n";
  std::vector<double> free;
  std::string start;
  for (std::size_t i = 0; i < n; ++i) {
    const double v = speed(random);
    if (i > 0) text += fmt::format("contact x{} >= x{} restitution 1\n", i, i - 1);
    start += fmt::format("{}x{} = {}, x{}' = {:.17g}", i == 0 ? "start " : ", ", i, i, i, v);
    free.push_back(static_cast<double>(i) + v * end);
  }
  const auto r = run_text(text + start + "\n", end);
  std::size_t meetings = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < i; ++k) meetings += free[k] > free[i];
  CHECK(r.happenings.size() == meetings);
  std::sort(free.begin(), free.end());
  for (std::size_t i = 0; i < n; ++i) CHECK(r.final.q[i] == doctest::Approx(free[i]).epsilon(1e-12));
  CHECK(meetings > 30);
}

namespace {

/// Rows and M⁻¹ rows of a system with M = 1, at random.
ContactForceProblem random_problem(std::mt19937& random, std::size_t n, std::size_t contacts, bool rubs) {
  std::uniform_real_distribution<double> number(-1, 1);
  ContactForceProblem p;
  p.response = p.tangent_response = Eigen::MatrixXd::Zero(at(n), at(contacts));
  for (std::size_t c = 0; c < contacts; ++c) {
    ContactForceProblem::Contact contact;
    for (std::size_t i = 0; i < n; ++i) {
      contact.normal.emplace_back(i, number(random));
      p.response(at(i), at(c)) = contact.normal.back().second;
      if (!rubs) continue;
      contact.tangent.emplace_back(i, number(random));
      p.tangent_response(at(i), at(c)) = contact.tangent.back().second;
    }
    contact.gap_acceleration = number(random);
    contact.slip_acceleration = number(random);
    contact.friction = 0.05;
    if (rubs && c % 3 == 2) contact.sliding = c % 2 == 0 ? 1 : -1;
    p.contacts.push_back(contact);
  }
  return p;
}

}  // namespace

TEST_CASE("forces of contacts: they press or open, stick within friction or slide against it") {
  std::mt19937 random(11);
  for (const bool rubs : {false, true})
    for (int turn = 0; turn < 40; ++turn) {
      const std::size_t n = 12, contacts = 1 + static_cast<std::size_t>(turn) % 8;
      const ContactForceProblem p = random_problem(random, n, contacts, rubs);
      const auto forces = contact_forces(p);
      REQUIRE(forces);
      // Accelerations anew from what it says: normal forces, and μ λ where it slides; sticking ones are solved for.
      Eigen::VectorXd a = Eigen::VectorXd::Zero(at(n));
      std::vector<std::size_t> sticking;
      for (std::size_t c = 0; c < contacts; ++c) {
        const double force = forces->normal[c];
        a += force * p.response.col(at(c));
        if (!rubs || !(force > 0)) continue;
        if (forces->friction[c] == FrictionState::Stick) sticking.push_back(c);
        if (forces->friction[c] == FrictionState::Forward) a -= 0.05 * force * p.tangent_response.col(at(c));
        if (forces->friction[c] == FrictionState::Backward) a += 0.05 * force * p.tangent_response.col(at(c));
      }
      Eigen::MatrixXd w(at(sticking.size()), at(sticking.size()));
      Eigen::VectorXd missing(at(sticking.size()));
      for (std::size_t i = 0; i < sticking.size(); ++i) {
        missing(at(i)) = -p.contacts[sticking[i]].slip_acceleration - dot(p.contacts[sticking[i]].tangent, a);
        for (std::size_t j = 0; j < sticking.size(); ++j)
          w(at(i), at(j)) = dot(p.contacts[sticking[i]].tangent, p.tangent_response.col(at(sticking[j])));
      }
      Eigen::VectorXd hold;
      if (!sticking.empty()) hold = Eigen::FullPivLU<Eigen::MatrixXd>(w).solve(missing);
      for (std::size_t i = 0; i < sticking.size(); ++i) {
        a += hold(at(i)) * p.tangent_response.col(at(sticking[i]));
        CHECK(std::abs(hold(at(i))) <= 0.05 * forces->normal[sticking[i]] * (1 + 1e-9));
      }
      for (std::size_t c = 0; c < contacts; ++c) {
        const double opens = p.contacts[c].gap_acceleration + dot(p.contacts[c].normal, a);
        const double slides = p.contacts[c].slip_acceleration + dot(p.contacts[c].tangent, a);
        CHECK(forces->normal[c] >= 0);
        CHECK(opens >= -1e-9);
        CHECK(std::min(forces->normal[c], opens) < 1e-9);
        if (p.contacts[c].sliding != 0) continue;  // it may slow down
        if (forces->normal[c] > 1e-9 && forces->friction[c] == FrictionState::Forward) CHECK(slides >= -1e-9);
        if (forces->normal[c] > 1e-9 && forces->friction[c] == FrictionState::Backward) CHECK(slides <= 1e-9);
      }
    }
}

namespace {

const std::string oscillator = "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\n";

}

TEST_CASE("recorded events end no step: the motion is the one without them, to the bit") {
  const std::string start = "start x' = 1\n";
  const auto without = run_text(oscillator + start, 20);
  const auto with = run_text(oscillator +
                                 "event zero when x = 0 rising : record\nevent half when x = 0.5 : record\n"
                                 "event peak when x = 1 : record\n" +
                                 start,
                             20);
  CHECK(with.statistics.steps == without.statistics.steps);
  CHECK(with.final.q[0] == without.final.q[0]);
  CHECK(with.final.v[0] == without.final.v[0]);
  const double pi = std::acos(-1.0);
  std::vector<double> zero, half, peak;
  for (const Happening& h : with.happenings) (h.name == "zero" ? zero : h.name == "half" ? half : peak).push_back(h.t);
  CHECK(std::is_sorted(with.happenings.begin(), with.happenings.end(),
                       [](const Happening& a, const Happening& b) { return a.t < b.t; }));
  REQUIRE(zero.size() == 4);  // at 0 too
  for (std::size_t k = 0; k < zero.size(); ++k)
    CHECK(zero[k] == doctest::Approx(2 * pi * static_cast<double>(k)).epsilon(1e-13));
  REQUIRE(half.size() == 7);
  for (std::size_t k = 0; k < half.size(); ++k) {
    const double turn = 2 * pi * static_cast<double>(k / 2);
    CHECK(half[k] == doctest::Approx(turn + (k % 2 == 0 ? pi / 6 : 5 * pi / 6)).epsilon(1e-13));
  }
  REQUIRE(peak.size() == 3);  // a double root, where x comes to 1 and goes back
  for (std::size_t k = 0; k < peak.size(); ++k)
    CHECK(peak[k] == doctest::Approx(pi / 2 + 2 * pi * static_cast<double>(k)).epsilon(1e-7));
}

TEST_CASE("an event that holds as the motion begins is told, and acts when it is met again") {
  const auto r = run_text(oscillator + "event back when x = 0 : stop\nstart x' = 1\n", 20);
  REQUIRE(r.happenings.size() == 2);
  CHECK(r.happenings[0].t == 0);
  CHECK(r.final.t == doctest::Approx(std::acos(-1.0)).epsilon(1e-14));
  REQUIRE(r.remarks.size() == 1);
  CHECK(r.remarks[0].find("acts when it is met again") != std::string::npos);
}

TEST_CASE("a contact that is hit as the run ends is told") {
  const std::string ball =
      "dimensionless\ncoord z : number\nT = 1/2 z'^2\nV = 2 z\ncontact z >= 0 name floor\nstart z = 1\n";
  const auto r = run_text(ball, 1);
  CHECK(r.final.v[0] == doctest::Approx(-2).epsilon(1e-14));
  CHECK(r.happenings.empty());
  REQUIRE(r.remarks.size() == 1);
  CHECK(r.remarks[0].find("before the impact") != std::string::npos);
}

TEST_CASE("friction that is not determined and sticks to what moves has its work in the books") {
  const auto drift = [](const std::string& slip, const std::string& floor) {
    const std::string foot = " friction 0.3 slip P";
    const auto r = run_text(
        "param m = 1 kg, g = 9.81 m/s^2, a = 0.5 m, h = 0.3 m, J = 0.1 kg m^2, k = 10 N/m, v = 0.1 m/s, b = 0.2 "
        "m/s^2\n"
        "coord x, y : length, w : angle\nbody B mass m inertia J at (x, y) rotation angle w\ngravity (0, -g)\n"
        "V += 1/2 k x^2\npoint P1 at (a, -h) in B\npoint P2 at (-a, -h) in B\ncontact P1.y >= " +
            floor + foot + "1.x' - " + slip + " name l1\ncontact P2.y >= " + floor + foot + "2.x' - " + slip +
            " name l2\nstart y = h, x' = v\n",
        1.5);
    CHECK(r.first_mode == "l1 sticking, l2 sticking");
    return r.statistics.energy_drift;
  };
  CHECK(drift("v", "0 m") < 1e-14);
  CHECK(drift("(v + b t)", "0 m") < 1e-14);
  CHECK(drift("v", "1/2 b t^2") < 1e-14);
}

TEST_CASE("a disc in a rough corner turns when it has to, whatever its radius is rounded to") {
  // Both contacts at their limits, N = P + μ₁ (m g − μ₂ N) at the wall: M = R (μ₁ N₁ + μ₂ N₂).
  const double weight = 9.81, push = 5, floor = 0.4, wall = 0.3;
  const double up = (weight - wall * push) / (1 + floor * wall), along = push + floor * up;
  const double most = floor * up + wall * along;
  for (const std::string radius : {"0.1", "0.1000000000000001", "0.09999999999999999", "0.2", "1.1"}) {
    CAPTURE(radius);
    const auto r = run_text("param m = 1 kg, R = " + radius +
                                " m, g = 9.81 m/s^2, P = 5 N, k = 1 N/s\ncoord x, y : length, φ : angle\n"
                                "body D mass m inertia 1/2 m R^2 at (x, y) rotation angle φ\ngravity (0, -g)\n"
                                "force on D = (-P, 0)\ntorque on D = k R t\n"
                                "contact y >= R friction 0.4 slip x' + R φ' name floor\n"
                                "contact x >= R friction 0.3 slip y' - R φ' name wall\nstart x = R, y = R\n",
                            6);
    REQUIRE(r.happenings.size() == 2);
    CHECK(r.happenings[0].t == doctest::Approx(most).epsilon(1e-10));
    CHECK(r.statistics.steps < 300);
  }
}
