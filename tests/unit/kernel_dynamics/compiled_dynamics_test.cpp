#include "dynamics_case.hpp"

// Compiled accelerations and forces against the interpreter's.

namespace {

constexpr ForwardDynamicsOptions compiled{.backend = Backend::Compiled, .cache = false};
constexpr ForwardDynamicsOptions interpreted{.backend = Backend::Interpreter};

std::string chain(int links, const std::string& rest = "") {
  std::string names, points;
  for (int i = 1; i <= links; ++i) {
    const std::string k = std::to_string(i);
    names += (i > 1 ? ", q" : "q") + k;
    points += "point P" + k + " mass m at " + (i > 1 ? "P" + std::to_string(i - 1) + " + " : "") + "l (sin q" + k +
              ", -cos q" + k + ")\n";
  }
  return "system chain\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord " + names + " : angle\n" + points +
         "gravity (0, -g)\n" + rest;
}

/// Both at random points: to rounding, in units of what the sums are made of.
int compare(Dynamics& a, Dynamics& b, double size, const Numbers& u = {}) {
  const std::size_t n = a.n();
  std::mt19937 random(11);
  int compared = 0;
  for (int trial = 0; trial < 4; ++trial) {
    const Numbers q = random_numbers(n, size, random), v = random_numbers(n, 1, random),
                  given = random_numbers(n, 3, random);
    Numbers x(n), y(n), rest(n, 0.0), weight(n), mass(n * n);
    if (b.dynamics.accelerations(0.3, q, v, u, y) != KernelStatus::Ok) continue;
    REQUIRE(a.dynamics.accelerations(0.3, q, v, u, x) == KernelStatus::Ok);
    for (std::size_t i = 0; i < n; ++i) CHECK(std::abs(x[i] - y[i]) <= 1e-9 * largest(y));
    b.dynamics.bias(0.3, q, v, u, weight);
    b.dynamics.mass(0.3, q, v, mass);
    const double scale = largest(weight) + 3 * largest(mass) * static_cast<double>(n);
    a.dynamics.forces(0.3, q, v, given, u, x);
    b.dynamics.forces(0.3, q, v, given, u, y);
    for (std::size_t i = 0; i < n; ++i) CHECK(std::abs(x[i] - y[i]) <= 1e-13 * scale);
    a.dynamics.bias(0.3, q, v, u, x);
    for (std::size_t i = 0; i < n; ++i) CHECK(std::abs(x[i] - weight[i]) <= 1e-13 * scale);
    Numbers same(n * n);
    a.dynamics.mass(0.3, q, v, same);
    CHECK(same == mass);
    ++compared;
  }
  return compared;
}

}  // namespace

TEST_CASE("models of the gallery: as the interpreter") {
  int models = 0, points = 0;
  for (const char* folder : {"models", "tests/problems"})
    for (const auto& file : std::filesystem::directory_iterator(std::string(PROJECT_DIR "/") + folder)) {
      if (file.path().extension() != ".lag") continue;
      ModelText model(text_of(file.path()));
      const std::string name = file.path().filename().string();
      // Their mass matrix alone does not determine the motion.
      if (name.starts_with("degen_") || name.starts_with("field_") || !model.system->higher.empty()) continue;
      if (model.system->has_modes()) continue;  // refused: these equations are without contacts and friction
      Dynamics a(model.equations, compiled);
      CAPTURE(file.path().filename().string());
      if (model.system->constrained() || a.n() == 0) {
        CHECK_FALSE(a.dynamics.compile_report().compiled);
        continue;
      }
      REQUIRE_MESSAGE(a.dynamics.compile_report().compiled, a.dynamics.compile_report().trouble);
      Dynamics b(model.equations, interpreted);
      points += compare(a, b, 1, Numbers(a.source.inputs.size(), 0.7));
      ++models;
    }
  CHECK(models >= 55);
  CHECK(points > 200);
}

TEST_CASE("chains: a full matrix, the elimination, and code cut into several functions") {
  for (const int links : {1, 2, 3, 5, 8, 9, 20, 100}) {
    CAPTURE(links);
    Dynamics a(chain(links), compiled), b(chain(links), interpreted);
    REQUIRE(a.dynamics.compile_report().compiled);
    CHECK(compare(a, b, 2) == 4);
  }
}

TEST_CASE("inputs of the call, and parameters that are set anew without another compilation") {
  const std::string text = chain(12, "input u : [N m] = 1 [N m]\nforce q3 = u\n");
  Dynamics a(text, compiled), b(text, interpreted);
  REQUIRE(a.dynamics.compile_report().compiled);
  CHECK(compare(a, b, 2, {5.0}) == 4);
  CHECK(compare(a, b, 2, {-3.0}) == 4);
  for (double& p : a.source.parameters) p *= 1.5;
  a.dynamics.set_parameters(a.source.parameters);
  b.dynamics.set_parameters(a.source.parameters);
  CHECK(a.dynamics.compile_report().compiled);
  CHECK(compare(a, b, 2, {2.0}) == 4);
}

TEST_CASE("other pivots, other code: masses of one end or the other that nearly vanish") {
  const std::string text =
      "system s\nparam m1 = 1 kg, m2 = 1e-9 kg, l = 1 m, g = 9.81 m/s^2\ncoord a, b, c : angle, x : length\n"
      "point A mass m1 at (x + l sin a, -l cos a)\npoint B mass m2 at A + l (sin b, -cos b)\npoint C mass m1 at B + l "
      "(sin c, -cos c)\n"
      "gravity (0, -g)\n";
  Dynamics a(text, compiled), b(text, interpreted);
  REQUIRE(a.dynamics.compile_report().compiled);
  for (const double heavy : {1e-9, 1.0, 1e9}) {
    std::vector<double> values = a.source.parameters;
    values[0] = heavy;
    a.dynamics.set_parameters(values);
    b.dynamics.set_parameters(values);
    REQUIRE(a.dynamics.compile_report().compiled);
    const Numbers q{0.3, 0.5, -0.4, 0.2}, v{0.1, -0.2, 0.3, 0.4};
    Numbers x(4), y(4);
    REQUIRE(a.dynamics.accelerations(0, q, v, {}, x) == KernelStatus::Ok);
    REQUIRE(b.dynamics.accelerations(0, q, v, {}, y) == KernelStatus::Ok);
    for (std::size_t i = 0; i < 4; ++i) CHECK(x[i] == doctest::Approx(y[i]).epsilon(1e-6).scale(largest(y)));
  }
}

TEST_CASE("small pivots are left to the interpreter, which tells what is singular") {
  Dynamics d(
      "system s\nparam m = 1 kg, k = 1 N\ncoord r : length, φ : angle\npoint P mass m at r (cos φ, sin φ)\nV = k r\n",
      compiled);
  REQUIRE(d.dynamics.compile_report().compiled);
  Numbers a{7, 7};
  REQUIRE(d.dynamics.accelerations(0, Numbers{0.0, 1.0}, Numbers{0.0, 0.0}, {}, a) == KernelStatus::SingularMass);
  CHECK(d.dynamics.singular_coordinate() == 1);
  REQUIRE(d.dynamics.accelerations(0, Numbers{2.0, 1.0}, Numbers{0.0, 3.0}, {}, a) == KernelStatus::Ok);
  CHECK(a[0] == doctest::Approx(2 * 9 - 1).epsilon(1e-13));
  CHECK(d.dynamics.accelerations(0, Numbers{std::nan(""), 1.0}, Numbers{0.0, 0.0}, {}, a) != KernelStatus::Ok);
}

TEST_CASE("who declines says so in a sentence, and the interpreter goes on") {
  const std::string constrained = text_of(PROJECT_DIR "/models/cartesian_pendulum.lag");
  Dynamics d(constrained, compiled);
  CHECK_FALSE(d.dynamics.compile_report().compiled);
  CHECK(d.dynamics.compile_report().trouble == "the accelerations of systems with constraints are not compiled");
  Numbers a(2);
  CHECK(d.dynamics.accelerations(0, Numbers{0.6, -0.8}, Numbers{0.8, 0.6}, {}, a) == KernelStatus::Ok);
}

TEST_CASE("a residual by hand, whose mass matrix is not symmetric") {
  Context context;
  KernelSource source;
  ExprVector accelerations;
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g", "h"}) {
    source.coordinates.push_back(context.symbol(name, Role::Coordinate));
    accelerations.push_back(context.time_derivative(context.time_derivative(source.coordinates.back())));
  }
  // Row i is Σ_j (1 + 4 δ_ij + i/8) cos a q̈_j − 1.
  const Expr factor = cos(source.coordinates[0]);
  for (int i = 0; i < 8; ++i) {
    ExprVector terms{context.number(Rational(-1))};
    for (int j = 0; j < 8; ++j)
      terms.push_back(Rational(8 + (i == j ? 32 : 0) + i, 8) * factor * accelerations[static_cast<std::size_t>(j)]);
    source.residual.push_back(context.sum(terms));
  }
  const Kernel kernel = build_kernel(source);
  ForwardDynamics dynamics(kernel, {}, compiled), other(kernel, {}, interpreted);
  dynamics.set_parameters({});
  other.set_parameters({});
  Numbers a(8), b(8);
  const Numbers at{0.5, 0, 0, 0, 0, 0, 0, 0}, rest(8, 0.0);
  REQUIRE(dynamics.accelerations(0, at, rest, {}, a) == KernelStatus::Ok);
  REQUIRE(other.accelerations(0, at, rest, {}, b) == KernelStatus::Ok);
  for (int i = 0; i < 8; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < 8; ++j)
      sum += (1 + (static_cast<int>(j) == i ? 4 : 0) + i / 8.0) * std::cos(0.5) * a[j];
    CHECK(sum == doctest::Approx(1).epsilon(1e-14));
  }
  for (std::size_t i = 0; i < 8; ++i) CHECK(a[i] == doctest::Approx(b[i]).epsilon(1e-13));
}

TEST_CASE("left to itself: compiled where the expected calls pay for it") {
  CHECK_FALSE(Dynamics(chain(4)).dynamics.compile_report().compiled);
  CHECK_FALSE(Dynamics(chain(4), {.expected_calls = 100, .cache = false}).dynamics.compile_report().compiled);
  CHECK(Dynamics(chain(4), {.expected_calls = 1e7, .cache = false}).dynamics.compile_report().compiled);
}
