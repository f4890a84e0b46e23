#include "../processors.hpp"
#include "kernel/program/program.hpp"
#include "lane_systems.hpp"

#include <array>

// One motion in straight-line code, the whole expansion at once, against the engine of packs: coefficients, M, and what
// a step asks of the rows besides. compiled_lanes_test.cpp has every instruction.

namespace {

constexpr int straight_order = 20;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

KernelWorkspace straight_workspace(const Kernel& kernel, const std::string& processor = {}) {
  return compiled_workspace(kernel, straight_order, true, processor);
}

void expand_both(KernelWorkspace& code, KernelWorkspace& engine, const Motion& m) {
  code.set_parameters(m.parameters), engine.set_parameters(m.parameters);
  REQUIRE(code.expand(m.t, m.q, m.v) == KernelStatus::Ok);
  REQUIRE(engine.expand(m.t, m.q, m.v) == KernelStatus::Ok);
}

/// What bounds on disks read at the centre: every value, and the first coefficients of what is differentiated. Sums
/// that hold q̈ and enter R alone, R itself too, may be left as they were before q̈ was there: no product reads them, and
/// their rounding is bounded by that of their terms.
void check_centre(const KernelWorkspace& code, const KernelWorkspace& engine) {
  const Program& program = engine.program();
  const auto check = [&](Slot slot, int k) {
    if (slot == no_slot || (slot >= program.stored_end[2] && program.lags[slot] - k == 2 &&
                            program.tangent_lags[slot] != Program::unmoved))
      return;
    CAPTURE(slot);
    CHECK(code.coordinate(k)[slot] == doctest::Approx(engine.coordinate(k)[slot]).epsilon(1e-11).scale(100));
  };
  for (const Run& run : program.runs[Dynamics])
    for (std::uint32_t at = run.first; at < run.last; ++at) {
      const Instruction& i = program.instructions[at];
      check(i.out, 0), check(i.second, 0);
      for (std::uint32_t t = i.first_term; t < i.last_term; ++t)
        check(program.terms[t].a, static_cast<int>(program.terms[t].shift));
    }
}

/// Rounding errors are magnified by functions near their singularities and by the solution.
void check_coefficients(const KernelWorkspace& code, const KernelWorkspace& engine, std::size_t n, double tolerance,
                        int orders = straight_order) {
  for (int k = 0; k <= orders + 1; ++k) {
    CAPTURE(k);
    double size = 1e-300;
    for (std::size_t i = 0; i < n; ++i) size = std::max(size, std::abs(engine.coordinate(k)[i]));
    for (std::size_t i = 0; i < n; ++i)
      CHECK(std::abs(code.coordinate(k)[i] - engine.coordinate(k)[i]) <= tolerance * (k + 1) * epsilon * size);
  }
  check_centre(code, engine);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      CHECK(code.mass(i, j) == doctest::Approx(engine.mass(i, j)).epsilon(1e-12).scale(1e-12));
}

/// The definition of KernelWorkspace::radius, term by term.
double radius_by_definition(const KernelWorkspace& work, std::size_t n, double h) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    const auto speed = [&](int k) { return (k + 1) * std::abs(work.coordinate(k + 1)[i]); };
    double size = epsilon * std::abs(work.coordinate(0)[i]) / h;
    for (int k = 0; k <= 3; ++k) size = std::max(size, speed(k) * std::pow(h, k));
    for (int k = straight_order - 5; k <= straight_order; ++k)
      if (speed(k) > 0)
        least = std::min(least, std::pow(size / speed(k), 1.0 / k) * (k < straight_order - 1 ? 1.25 : 1));
  }
  return least;
}

std::array<std::vector<double>, 2> increments_of(const KernelWorkspace& work, std::size_t n, double tau) {
  std::array<std::vector<double>, 2> out{std::vector<double>((n + 7) / 8 * 8), std::vector<double>((n + 7) / 8 * 8)};
  work.polynomials().increments(work.coordinate(0), work.row_stride(), n, straight_order + 1, tau, out[0].data(),
                                out[1].data());
  return out;
}

/// Against Horner's rule, of a copy with rows of another length.
void check_accelerations(const KernelWorkspace& work, std::size_t n, double tau) {
  const std::size_t stride = (n + 7) / 8 * 8;
  std::vector<double> copy((straight_order + 2) * stride), a(stride);
  for (int k = 0; k <= straight_order + 1; ++k)
    std::copy_n(work.coordinate(k), n, copy.begin() + static_cast<std::ptrdiff_t>(k * stride));
  work.polynomials().accelerations(copy.data(), stride, n, straight_order + 1, tau, a.data());
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0, terms = 0;
    for (int k = straight_order + 1; k >= 2; --k) {
      const double c = k * (k - 1) * work.coordinate(k)[i];
      sum = sum * tau + c, terms = terms * std::abs(tau) + std::abs(c);
    }
    CHECK(std::abs(a[i] - sum) <= 8 * epsilon * terms);
  }
}

/// Term by term.
void check_sizes(const KernelWorkspace& work, std::size_t n) {
  constexpr double radius = 0.3;
  std::vector<double> sizes(4 * n);
  const auto measure = work.polynomials().sizes;
  REQUIRE((measure != nullptr));
  measure(work.coordinate(0), radius, sizes.data());
  for (std::size_t i = 0; i < n; ++i) {
    double value = 0, rate = 0, acceleration = 0;
    for (int k = 1; k <= straight_order + 1; ++k) {
      const double c = std::abs(work.coordinate(k)[i]);
      value += c * std::pow(radius, k);
      rate += k * c * std::pow(radius, k - 1);
      acceleration += k * (k - 1) * c * std::pow(radius, k - 2);
    }
    CHECK(sizes[i] == doctest::Approx(value).epsilon(1e-14));
    CHECK(sizes[n + i] == doctest::Approx(rate).epsilon(1e-14));
    CHECK(sizes[2 * n + i] == doctest::Approx(acceleration).epsilon(1e-14));
  }
}

/// Both ways to the radius, sizes, and polynomials against Horner's rule.
void check_step(const KernelWorkspace& code, const KernelWorkspace& engine, std::size_t n) {
  const double h = 0.1 * radius_by_definition(engine, n, 0.1);
  for (const KernelWorkspace* work : {&code, &engine})
    CHECK(work->radius(h) == doctest::Approx(radius_by_definition(*work, n, h)).epsilon(2e-4));
  check_sizes(code, n);
  for (const double tau : {h, -0.3 * h})
    for (const KernelWorkspace* work : {&code, &engine}) {
      check_accelerations(*work, n, tau);
      const auto [dq, dv] = increments_of(*work, n, tau);
      for (std::size_t i = 0; i < n; ++i) {
        double q = 0, v = 0, terms = 0;
        for (int k = straight_order + 1; k >= 2; --k) {
          const double c = work->coordinate(k)[i];
          q = (q + c) * tau, v = (v + k * c) * tau, terms = (terms + k * std::abs(c)) * std::abs(tau);
        }
        CHECK(std::abs(dq[i] - q) <= 8 * epsilon * terms);
        CHECK(std::abs(dv[i] - v) <= 8 * epsilon * terms);
      }
    }
}

void check_straight(const System& s, double tolerance, const std::string& processor = {}) {
  CAPTURE(s.name);
  const Kernel kernel = build_kernel(s.source);
  KernelWorkspace code = straight_workspace(kernel, processor), engine(kernel, straight_order);
  for (const Motion& m : motions_near(s.start, 3)) {
    expand_both(code, engine, m);
    check_coefficients(code, engine, kernel.freedoms(), tolerance);
    check_step(code, engine, kernel.freedoms());
  }
}

}  // namespace

TEST_CASE("straight-line code: chains of every size that it takes, which look ahead and which do not") {
  Systems list;
  for (const int links : {1, 2, 3, 4, 5, 6, 7, 8, 9, 13, 16}) add_chain(list, links);
  for (const auto& s : list) check_straight(*s, 4000);
}

TEST_CASE("machine code of one motion: functions of t ahead of it, sums with t, functions, random programs") {
  constexpr int orders = 10;
  Systems list;
  add_friction(list), add_driven(list), add_shaken_pendulum(list), add_mixed_angles(list);
  add_function(list, "quotient", 0.6, [](Expr u) { return sin(u) / (u + Rational(2)); });
  add_function(list, "power", 0.9, [](Expr u) { return pow(u, Rational(-3, 2)); });
  add_function(list, "cosh", 0.4, [](Expr u) { return apply(Kind::Cosh, u); });
  add_function(list, "power of itself", 0.9, [](Expr u) { return u.context().power(u, u); });
  for (unsigned seed = 1; seed <= 4; ++seed) make_random(add(list, "random " + std::to_string(seed)), seed);
  for (const auto& s : list) {
    CAPTURE(s->name);
    const Kernel kernel = build_kernel(s->source);
    KernelWorkspace engine(kernel, orders);
    for (const bool long_run : {true, false}) {
      CAPTURE(long_run);
      KernelWorkspace code = compiled_workspace(kernel, orders, long_run, {});
      for (const Motion& m : motions_near(s->start, 2)) {
        expand_both(code, engine, m);
        check_coefficients(code, engine, kernel.freedoms(), 1e5, orders);
      }
    }
  }
}

TEST_CASE("straight-line code for other processors") {
  Systems list;
  for (const int links : {4, 5}) add_chain(list, links);
  for (const auto& s : list)
    for (const std::string& processor : levels_here({"x86-64", "x86-64-v3"})) check_straight(*s, 4000, processor);
}

TEST_CASE("straight-line code: angles beyond those whose sines are written out") {
  Systems list;
  for (const int links : {1, 2, 4}) add_chain(list, links);
  for (const auto& s : list) {
    for (double& q : s->start.q) q += 0x1p21;
    check_straight(*s, 4000);
  }
}

TEST_CASE("straight-line code: a matrix that has to be pivoted goes another way") {
  Systems list;
  System& s = add(list, "indefinite");
  const Expr x = s.coordinate("x", 0.4, 0.3), y = s.coordinate("y", -0.2, 0.5), k = s.parameter("k", 2.0);
  // The Lagrangian ẋ ẏ − k x y − x⁴ − y⁴: M has zeros on its diagonal.
  s.from_lagrangian(s.dot(x) * s.dot(y) - k * x * y - pow(x, 4) - pow(y, 4));
  check_straight(s, 4000);
}

TEST_CASE("straight-line code: of a matrix that is nearly singular the engine has the last word") {
  Systems list;
  System& s = add(list, "nearly singular");
  const Expr x = s.coordinate("x", 0.4, 0.3), y = s.coordinate("y", -0.2, 0.5), m = s.parameter("m", 1e-13);
  // The second pivot is 2e-13 of its diagonal entry.
  s.from_lagrangian(Rational(1, 2) * pow(s.dot(x) + s.dot(y), 2) + m * pow(s.dot(y), 2) - pow(x, 4) - pow(y, 4));
  const Kernel kernel = build_kernel(s.source);
  KernelWorkspace code = straight_workspace(kernel), engine(kernel, straight_order);
  expand_both(code, engine, s.start);
  for (int k = 0; k <= straight_order + 1; ++k)
    for (std::size_t i = 0; i < 2; ++i) CHECK(code.coordinate(k)[i] == engine.coordinate(k)[i]);
}

TEST_CASE("the radius where a coordinate begins to move late is left to those who look at all its coefficients") {
  Systems list;
  System& s = add(list, "late");
  const Expr x = s.coordinate("x", 0.5, 0.3);
  s.coordinate("y", 0.0, 0.0);
  s.source.residual = {s.acceleration("x") + x, s.acceleration("y") - pow(s.context.time(), 8)};
  const Kernel kernel = build_kernel(s.source);
  KernelWorkspace code = straight_workspace(kernel), engine(kernel, straight_order);
  s.start.t = 0;
  expand_both(code, engine, s.start);
  // y_10 = 1/90 alone is not zero, and is not among the last six: x alone counts.
  for (const KernelWorkspace* work : {&code, &engine}) CHECK(work->radius(0.5) > 0);
  s.source.residual[1] = s.acceleration("y") - pow(s.context.time(), 16);  // y_18 is
  const Kernel later = build_kernel(s.source);
  KernelWorkspace late_code = straight_workspace(later), late_engine(later, straight_order);
  expand_both(late_code, late_engine, s.start);
  for (const KernelWorkspace* work : {&late_code, &late_engine}) CHECK(std::isnan(work->radius(0.5)));
}
