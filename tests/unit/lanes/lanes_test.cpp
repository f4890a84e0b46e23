#include "lane_systems.hpp"

// Lanes against the reference interpreter, coefficient by coefficient; and against themselves at every width and on
// every instruction set, to the bit.

TEST_CASE("every instruction in lanes agrees with the reference interpreter") {
  for (const auto& system : systems()) {
    CAPTURE(system->name);
    const Kernel kernel = build_kernel(system->source);
    REQUIRE(fits_lanes(kernel));
    const auto motions = motions_near(system->start, 3);
    const Expansion found = expand(kernel, motions, 4, InstructionSet::Best);
    for (std::size_t i = 0; i < motions.size(); ++i) {
      CHECK(found.quality[i] > 1e-5);
      CHECK(found.quality[i] <= 1);
      check_against_reference(kernel, motions[i], found.coefficients[i], found.quality[i]);
    }
  }
}

namespace {

std::vector<InstructionSet> sets_here() {
  std::vector<InstructionSet> out{InstructionSet::Baseline};
  for (const auto& [set, name] : {std::pair{InstructionSet::Avx2, "AVX2"}, {InstructionSet::Avx512, "AVX-512"}})
    if (has_instruction_set(set))
      out.push_back(set);
    else
      MESSAGE("skipped: this processor has no ", name);
  return out;
}

}  // namespace

TEST_CASE("lanes give the same bits at every width and on every instruction set") {
  const auto sets = sets_here();
  for (const auto& system : systems()) {
    CAPTURE(system->name);
    const Kernel kernel = build_kernel(system->source);
    const auto motions = motions_near(system->start, 19);
    const Expansion expected = expand(kernel, motions, 1, InstructionSet::Baseline);
    for (const InstructionSet set : sets) {
      for (const int width : widths) {
        CAPTURE(width);
        CAPTURE(static_cast<int>(set));
        const Expansion found = expand(kernel, motions, width, set);
        CHECK(same_bits(found.quality, expected.quality));
        for (std::size_t i = 0; i < motions.size(); ++i)
          CHECK(same_bits(found.coefficients[i], expected.coefficients[i]));
      }
    }
  }
}

TEST_CASE("sine and cosine in lanes are right to one unit in the last place, for angles of any size") {
  System s;
  const Expr x = s.coordinate("x", 0, 0), y = s.coordinate("y", 0, 0);
  s.source.residual = {s.acceleration("x") - sin(x), s.acceleration("y") - cos(y)};
  const Kernel kernel = build_kernel(s.source);
  std::vector<Motion> motions;
  const auto with_angle = [&](double angle) { motions.push_back({0, {angle, angle}, {0, 0}, {}}); };
  for (int i = -2000; i <= 2000; ++i) with_angle(i * 0.00371 + 1e-9 * i * i);
  for (int i = 0; i < 1000; ++i)
    with_angle(i * (std::acos(-1.0) / 2)), with_angle(-i * 3.14159265358979), with_angle(i * 1e3 + 0.1);
  for (const double big : {1048575.9, 1048576.0, 1e9, -3e15, 1e22, 1e-300, -0.0}) with_angle(big);
  const Expansion found = expand(kernel, motions, 8, InstructionSet::Best);
  double worst = 0;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const long double angle = motions[i].q[0], expected[] = {std::sin(angle), std::cos(angle)};
    for (std::size_t j = 0; j < 2; ++j) {
      const double got = 2 * found.coefficients[i][2 * 2 + j];
      const double unit = std::nextafter(std::abs(got), 1e300) - std::abs(got);
      worst = std::max(worst, static_cast<double>(std::abs(static_cast<long double>(got) - expected[j])) / unit);
    }
  }
  CHECK(worst < 1);
}

TEST_CASE("a lane that fails says so and leaves the others as they are") {
  System s;  // Kepler's problem
  const Expr x = s.coordinate("x", 1, 0), y = s.coordinate("y", 0, 1);
  s.from_lagrangian(Rational(1, 2) * (pow(s.dot(x), 2) + pow(s.dot(y), 2)) +
                    pow(pow(x, 2) + pow(y, 2), Rational(-1, 2)));
  const Kernel kernel = build_kernel(s.source);
  auto motions = motions_near(s.start, 8);
  const Expansion undisturbed = expand(kernel, motions, 8, InstructionSet::Best);
  motions[2].q = {0, 0};
  motions[5].q = {std::numeric_limits<double>::quiet_NaN(), 1};
  motions[6].v = {std::numeric_limits<double>::infinity(), 1};
  const Expansion found = expand(kernel, motions, 8, InstructionSet::Best);
  for (const std::size_t i : {0, 1, 3, 4, 7}) CHECK(same_bits(found.coefficients[i], undisturbed.coefficients[i]));
  for (const std::size_t i : {2, 5, 6}) CHECK(std::isnan(found.quality[i]));
}

TEST_CASE("the quality is the smallest pivot of the scaled mass matrix") {
  const auto quality_of = [](double coupling) {
    System s;  // M = [1 c; c 1] and [4 2c; 2c 1]: pivots 1 and 1 − c², whatever the units
    const Expr x = s.coordinate("x", 0.1, 0), y = s.coordinate("y", 0.2, 0), c = s.parameter("c", coupling);
    s.from_lagrangian(Rational(2) * pow(s.dot(x), 2) + Rational(1, 2) * pow(s.dot(y), 2) +
                      Rational(2) * c * s.dot(x) * s.dot(y) - x * y);
    return expand(build_kernel(s.source), {s.start}, 1, InstructionSet::Best).quality[0];
  };
  CHECK(quality_of(0) == 1);
  CHECK(quality_of(0.6) == doctest::Approx(0.64).epsilon(1e-14));
  CHECK_FALSE(quality_of(1) > 1e-15);
  CHECK(quality_of(1.5) == doctest::Approx(-1.25).epsilon(1e-14));
}

TEST_CASE("a mass matrix that is not symmetric, or has a zero diagonal, is for the reference interpreter") {
  System s;
  s.coordinate("x", 0.1, 0), s.coordinate("y", 0.2, 0);
  const Expr a = s.acceleration("x"), b = s.acceleration("y");
  s.source.residual = {a + Rational(1, 2) * b + Rational(1), b - Rational(1, 4) * a};
  CHECK(expand(build_kernel(s.source), {s.start}, 1, InstructionSet::Best).quality[0] == 0);
  s.source.residual = {b + Rational(1), a - Rational(1)};
  CHECK_FALSE(expand(build_kernel(s.source), {s.start}, 1, InstructionSet::Best).quality[0] > 0);
}

TEST_CASE("kernels with switches, events or constraints do not fit into lanes") {
  const auto fits = [](const std::function<void(System&, Expr)>& change) {
    System s;
    const Expr x = s.coordinate("x", 1, 0);
    s.from_lagrangian(pow(s.dot(x), 2) - pow(x, 2));
    change(s, x);
    return fits_lanes(build_kernel(s.source));
  };
  CHECK(fits([](System&, Expr) {}));
  CHECK_FALSE(fits([](System& s, Expr x) { s.source.residual[0] = s.source.residual[0] + apply(Kind::Abs, x); }));
  CHECK_FALSE(fits([](System& s, Expr x) { s.source.events = {x}; }));
  CHECK_FALSE(fits([](System& s, Expr x) {
    const Expr force = s.context.symbol("λ", Role::Multiplier);
    s.source.multipliers = {force};
    s.source.constraints = {{x, 0, "x"}};
    s.source.residual[0] = s.source.residual[0] - force;
  }));
}
