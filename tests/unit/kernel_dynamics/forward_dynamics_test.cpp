#include "dynamics_case.hpp"

#include <maupertuis/motion_kernel.hpp>

#include <stdexcept>

namespace {

const char* double_pendulum = R"(system double_pendulum
param m1 = 1 kg, m2 = 2 kg, l1 = 1.5 m, l2 = 0.5 m, g = 9.81 m/s^2
coord a, b : angle
input u : [N m] = 1 [N m]
input w : [N m] = 1 [N m]
point A mass m1 at l1 (sin a, -cos a)
point B mass m2 at A + l2 (sin b, -cos b)
gravity (0, -g)
force a = u
force b = w
)";

}  // namespace

TEST_CASE("a double pendulum with torques: accelerations in closed form") {
  Dynamics d(double_pendulum);
  REQUIRE(d.source.inputs.size() == 2);
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Numbers q = random_numbers(2, 3, random), v = random_numbers(2, 4, random), u = random_numbers(2, 10, random);
    Numbers a(2);
    REQUIRE(d.dynamics.accelerations(0, q, v, u, a) == KernelStatus::Ok);
    const double m1 = 1, m2 = 2, l1 = 1.5, l2 = 0.5, g = 9.81, c = std::cos(q[0] - q[1]), s = std::sin(q[0] - q[1]);
    const double m11 = (m1 + m2) * l1 * l1, m12 = m2 * l1 * l2 * c, m22 = m2 * l2 * l2;
    const double f1 = u[0] - m2 * l1 * l2 * s * v[1] * v[1] - (m1 + m2) * g * l1 * std::sin(q[0]);
    const double f2 = u[1] + m2 * l1 * l2 * s * v[0] * v[0] - m2 * g * l2 * std::sin(q[1]);
    const double determinant = m11 * m22 - m12 * m12;
    CHECK(a[0] == doctest::Approx((m22 * f1 - m12 * f2) / determinant).epsilon(1e-12));
    CHECK(a[1] == doctest::Approx((m11 * f2 - m12 * f1) / determinant).epsilon(1e-12));
  }
}

TEST_CASE("models of the gallery: as a workspace; forces undo accelerations; M and h make up the residual") {
  int checked = 0;
  for (const char* folder : {"models", "tests/problems"})
    for (const auto& file : std::filesystem::directory_iterator(std::string(PROJECT_DIR "/") + folder)) {
      if (file.path().extension() != ".lag") continue;
      ModelText model(text_of(file.path()));
      if (model.system->constrained() || !model.system->inputs.empty() || model.system->has_modes()) continue;
      Dynamics d(model.equations);
      if (d.n() == 0) continue;
      CAPTURE(file.path().filename().string());
      KernelWorkspace work(d.kernel, 1);
      work.set_parameters(d.source.parameters);
      std::mt19937 random(7);
      for (int trial = 0; trial < 3; ++trial) {
        const Numbers q = random_numbers(d.n(), 1, random), v = random_numbers(d.n(), 1, random);
        Numbers a(d.n()), zero(d.n(), 0.0), f(d.n()), h(d.n()), mass(d.n() * d.n());
        if (!work.choose_branches(0.3, q, v) || work.evaluate(0.3, q, v) != KernelStatus::Ok) continue;
        REQUIRE(d.dynamics.accelerations(0.3, q, v, {}, a) == KernelStatus::Ok);
        d.dynamics.mass(0.3, q, v, mass);
        d.dynamics.bias(0.3, q, v, {}, h);
        d.dynamics.forces(0.3, q, v, a, {}, f);
        for (std::size_t i = 0; i < d.n(); ++i) {
          double size = std::abs(h[i]), product = h[i];
          for (std::size_t j = 0; j < d.n(); ++j) {
            size += std::abs(mass[i * d.n() + j] * a[j]);
            product += mass[i * d.n() + j] * a[j];
            CHECK(mass[i * d.n() + j] == doctest::Approx(work.mass(i, j)).epsilon(1e-12).scale(largest(mass)));
            CHECK(mass[i * d.n() + j] == doctest::Approx(mass[j * d.n() + i]).epsilon(1e-12).scale(largest(mass)));
          }
          CHECK(std::abs(product) <= 1e-11 * size);
          CHECK(std::abs(f[i]) <= 1e-10 * size);
          CHECK(std::abs(a[i] - work.acceleration(i)) <= 1e-9 * largest(a));
        }
        ++checked;
      }
    }
  CHECK(checked > 60);
}

TEST_CASE("inverse dynamics at any acceleration is M a + h, and its power is that of the energy") {
  Dynamics d(text_of(PROJECT_DIR "/tests/problems/arm_seven_joints.lag"));
  std::mt19937 random(3);
  const std::size_t n = d.n();
  const Numbers q = random_numbers(n, 2, random), v = random_numbers(n, 2, random), a = random_numbers(n, 5, random);
  Numbers f(n), h(n), mass(n * n);
  d.dynamics.forces(0, q, v, a, {}, f);
  d.dynamics.bias(0, q, v, {}, h);
  d.dynamics.mass(0, q, v, mass);
  for (std::size_t i = 0; i < n; ++i) {
    double sum = h[i];
    for (std::size_t j = 0; j < n; ++j) sum += mass[i * n + j] * a[j];
    CHECK(f[i] == doctest::Approx(sum).epsilon(1e-11));
  }
  for (std::size_t k = 1; k <= n; ++k) {  // all leading blocks are positive: Cholesky goes through
    std::vector<double> l(mass);
    double pivot = 0;
    for (std::size_t j = 0; j < k; ++j) {
      pivot = l[j * n + j];
      REQUIRE(pivot > 0);
      for (std::size_t i = j + 1; i < k; ++i)
        for (std::size_t c = j + 1; c < k; ++c) l[i * n + c] -= l[i * n + j] * l[j * n + c] / pivot;
    }
  }
  // d/dt (½ q̇ M q̇) by a difference quotient along the motion q + v s + ½ a s², against the power of f and of gravity
  // and damping.
  const auto kinetic = [&](double s) {
    Numbers qs(n), vs(n), ms(n * n);
    for (std::size_t i = 0; i < n; ++i) qs[i] = q[i] + v[i] * s + a[i] * s * s / 2, vs[i] = v[i] + a[i] * s;
    d.dynamics.mass(0, qs, vs, ms);
    double twice = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) twice += vs[i] * ms[i * n + j] * vs[j];
    return twice / 2;
  };
  const double s = 1e-4, rate = (8 * (kinetic(s) - kinetic(-s)) - (kinetic(2 * s) - kinetic(-2 * s))) / (12 * s);
  Numbers weight(n), rest(n, 0.0);
  d.dynamics.bias(0, q, rest, {}, weight);  // gravity alone
  double power = 0;
  for (std::size_t i = 0; i < n; ++i) power += (f[i] - weight[i] - 0.02 * v[i]) * v[i];
  CHECK(power == doctest::Approx(rate).epsilon(1e-8));
}

TEST_CASE("with constraints the accelerations obey them") {
  Dynamics d(text_of(PROJECT_DIR "/models/cartesian_pendulum.lag"));
  KernelWorkspace work(d.kernel, 1);
  work.set_parameters(d.source.parameters);
  const Numbers q{0.6, -0.8}, v{0.8, 0.6};
  Numbers a(2);
  REQUIRE(d.dynamics.accelerations(0, q, v, {}, a) == KernelStatus::Ok);
  REQUIRE(work.evaluate(0, q, v) == KernelStatus::Ok);
  CHECK(a[0] == work.acceleration(0));
  CHECK(q[0] * a[0] + q[1] * a[1] == doctest::Approx(-1).epsilon(1e-12));  // d²(x² + y²)/dt² = 0 at |v| = 1
}

TEST_CASE("a singular M is told, with the coordinate, and other states work on") {
  Dynamics d(
      "system s\nparam m = 1 kg, k = 1 N\ncoord r : length, φ : angle\npoint P mass m at r (cos φ, sin φ)\nV = k r\n");
  Numbers a(2);
  REQUIRE(d.dynamics.accelerations(0, Numbers{0.0, 1.0}, Numbers{0.0, 0.0}, {}, a) == KernelStatus::SingularMass);
  CHECK(d.dynamics.singular_coordinate() == 1);
  REQUIRE(d.dynamics.accelerations(0, Numbers{2.0, 1.0}, Numbers{0.0, 3.0}, {}, a) == KernelStatus::Ok);
  CHECK(a[0] == doctest::Approx(2 * 9 - 1).epsilon(1e-13));
  CHECK(std::abs(a[1]) < 1e-13);
}

TEST_CASE("an input that L depends on: a pendulum on a moving pivot, with the input's rates") {
  Dynamics d(
      "system s\nparam m = 1 kg, l = 2 m, g = 9.81 m/s^2\ncoord θ : angle\ninput u : [m] = 1 [m]\n"
      "point P mass m at (u + l sin θ, -l cos θ)\ngravity (0, -g)\n");
  REQUIRE(d.source.inputs.size() == 3);
  Numbers a(1);
  const double q = 0.7, acceleration = 3;
  REQUIRE(d.dynamics.accelerations(0, Numbers{q}, Numbers{1.5}, Numbers{5, -2, acceleration}, a) == KernelStatus::Ok);
  CHECK(a[0] == doctest::Approx(-(9.81 * std::sin(q) + acceleration * std::cos(q)) / 2).epsilon(1e-13));
}

TEST_CASE("abs, max and sign: each call is answered on the sides that hold at its point") {
  const char* text =
      "system f\ndimensionless\nparam k = 1\ncoord x : number\nT = 1/2 (2 + sign(x)) x'^2\n"
      "force x = -k max(0, x - 1) - sign(x') - 0.5 abs(x)\n";
  for (const Backend backend : {Backend::Interpreter, Backend::Compiled}) {
    Dynamics d(text, {.backend = backend});
    for (const auto& [x, v] : {std::pair{-2.0, 1.0}, {2.0, -1.0}, {2.0, 1.0}, {0.5, -3.0}, {-2.0, -1.0}, {3.0, 0.0}}) {
      CAPTURE(x);
      CAPTURE(v);
      const double mass = x > 0 ? 3 : 1;
      const double force = -std::max(0.0, x - 1) - (v > 0 ? 1 : v < 0 ? -1 : 0) - 0.5 * std::abs(x);
      Numbers q{x}, speed{v}, a(1), h(1), f(1), m(1);
      REQUIRE(d.dynamics.accelerations(0, q, speed, {}, a) == KernelStatus::Ok);
      CHECK(a[0] == doctest::Approx(force / mass).epsilon(1e-15));
      d.dynamics.bias(0, q, speed, {}, h);
      CHECK(h[0] == doctest::Approx(-force).epsilon(1e-15));
      d.dynamics.forces(0, q, speed, a, {}, f);
      CHECK(std::abs(f[0]) < 1e-15);
      d.dynamics.mass(0, q, speed, m);
      CHECK(m[0] == mass);
    }
    // Sides that are given stay: x < 0 with the formula of x > 1 and x' > 0.
    Numbers q{-2}, v{1}, a(1);
    d.dynamics.set_branches(std::vector<std::int8_t>(d.kernel.switches().size(), 1));
    REQUIRE(d.dynamics.accelerations(0, q, v, {}, a) == KernelStatus::Ok);
    CHECK(a[0] == doctest::Approx((3.0 - 1 + 1) / 3).epsilon(1e-15));
    d.dynamics.set_branches({});
    REQUIRE(d.dynamics.accelerations(0, q, v, {}, a) == KernelStatus::Ok);
    CHECK(a[0] == doctest::Approx(-2).epsilon(1e-15));
  }
}

TEST_CASE("a force that has no value is no number of an earlier call") {
  Dynamics d("system f\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nforce x = -log(x)\n");
  Numbers q{-1}, v{0}, a{0}, out{7};
  d.dynamics.forces(0, q, v, a, {}, out);
  CHECK(std::isnan(out[0]));
  CHECK(d.dynamics.accelerations(0, q, v, {}, a) == KernelStatus::NonFinite);
}

TEST_CASE("contacts and friction are no part of a kernel") {
  const std::string body =
      "system f\nparam m = 1 kg, g = 9.81 m/s^2\ncoord x : length\npoint P mass m at (x, 0)\ngravity (0, -g)\n";
  const ModelText rubbed(body + "friction x coefficient 0.3 normal m g\nstart x' = 2 m/s\n");
  CHECK_THROWS_WITH_AS(dynamics_source(rubbed.equations), doctest::Contains("friction (x)"), std::invalid_argument);
  CHECK_THROWS_AS(motion_kernel(rubbed.equations), std::invalid_argument);
  const ModelText bounded(body + "contact x >= 0 restitution 0.5 name wall\nstart x = 2 m\n");
  CHECK_THROWS_WITH_AS(dynamics_source(bounded.equations), doctest::Contains("contacts (wall)"), std::invalid_argument);
  CHECK_THROWS_AS(motion_kernel(bounded.equations), std::invalid_argument);
}

TEST_CASE("an input that moves a place has rates, one that is a force has none") {
  Dynamics d(
      "system f\nparam m = 2 kg\ncoord x : length\ninput s : [m] = 1 [m] sin(t/1 [s])\ninput τ : [N] = 3 [N]\n"
      "point P mass m at (x + s, 0)\nforce x = τ\n");
  REQUIRE(d.source.inputs.size() == 4);  // s, s', s'', τ
  Numbers q{0}, v{0}, u{0, 0, 5, 3}, a(1);
  REQUIRE(d.dynamics.accelerations(0, q, v, u, a) == KernelStatus::Ok);
  CHECK(a[0] == doctest::Approx(3.0 / 2 - 5));
}

TEST_CASE("lists of a wrong length are told by name") {
  const ModelText m(double_pendulum);
  Dynamics d(m.equations);
  Numbers two(2), one(1), four(4);
  const auto wrong = [&](auto&& call, const char* what) {
    CHECK_THROWS_WITH_AS(call(), doctest::Contains(what), std::invalid_argument);
  };
  wrong([&] { static_cast<void>(d.dynamics.accelerations(0, two, one, two, two)); }, "v has");
  wrong([&] { static_cast<void>(d.dynamics.accelerations(0, two, two, one, two)); }, "u has");
  wrong([&] { d.dynamics.forces(0, one, two, two, two, two); }, "q has");
  wrong([&] { d.dynamics.mass(0, two, two, two); }, "`out`");
  wrong([&] { d.dynamics.set_parameters(one); }, "`values`");
  KernelSource source = d.source.kernel;
  source.parameters.pop_back();
  wrong([&] { build_kernel(source); }, "is no coordinate, multiplier or parameter");
}
