// Safe lengths against closed forms. A point of mass 1 flies by at speed 1, hardly moved by a force f along s whose
// Taylor series is known. Its first term left out makes the true bound of the length; Cauchy's estimate cannot allow
// more, and has to allow nearly as much.
#include "integrator/taylor/safe_length.hpp"

#include <doctest/doctest.h>
#include <maupertuis/kernel.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <functional>
#include <limits>

using namespace maupertuis;
using taylor::SafeLength;

namespace safe_length_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// x'' = force(x), through x = 0 with x' = 1, expanded to `order`.
struct Passage {
  Context context;
  KernelWorkspace work;
  int order;

  /// Of mass 10^{16 · heavy}.
  Passage(const std::function<Expr(Expr)>& force, int p, int heavy = 0)
      : work(kernel(context, force, heavy), p), order(p) {
    work.set_parameters({});
    const double at[] = {0}, rate[] = {1};
    REQUIRE(work.expand(0, at, rate) == KernelStatus::Ok);
  }
  static Kernel kernel(Context& context, const std::function<Expr(Expr)>& force, int heavy) {
    const Expr x = context.symbol("x", Role::Coordinate);
    KernelSource source;
    source.coordinates = {x};
    Expr acceleration = context.time_derivative(context.time_derivative(x)), load = force(x);
    for (int i = 0; i < heavy; ++i)
      acceleration = acceleration * Rational(10'000'000'000'000'000), load = load * Rational(10'000'000'000'000'000);
    source.residual = {acceleration - load};
    return build_kernel(source);
  }
  SlotCoefficients coefficients() const { return {work.coordinate(0), work.row_stride(), order, 1}; }

  SafeLength bounds(double tolerance, double speed = 1) const {
    SafeLength result(work.program(), order, tolerance);
    result.set_constants(work.constants());
    const double rates[] = {speed};
    if (speed > 0) result.set_momenta(rates, work);
    return result;
  }
  double longest(double tolerance, double speed = 1) const {
    return bounds(tolerance, speed).within(coefficients(), 0, infinity, 1);
  }
};

/// f = size e^{steepness x}: what a step leaves out of it is size (steepness h)^p/p!.
constexpr double steepness = 100;
Passage steep_force(Rational size, int order) {
  return Passage([size](Expr x) { return size * apply(Kind::Exp, x * Rational(100)); }, order);
}
constexpr int order = 4;
double left_out(double h) { return std::pow(steepness * h, order) / std::tgamma(order + 1); }

/// The largest h with h size e^{steepness r} x^p/(1 − x) ≤ momentum, x = h/r ≤ ½, on the best of all disks.
double by_cauchy(double size, double momentum) {
  const auto allowed = [&](double h) {
    for (double r = 2 * h; r < 1; r *= 1.01)
      if (h * size * std::exp(steepness * r) * std::pow(h / r, order) / (1 - h / r) <= momentum) return true;
    return false;
  };
  double low = 0, high = 1;
  for (int i = 0; i < 40; ++i) (allowed((low + high) / 2) ? low : high) = (low + high) / 2;
  return low;
}

/// f = size/(1 + (x/a)²), a = 1/10, singular at x = ± i a.
Passage resonance(Rational size, int p) {
  return Passage([size](Expr x) { return size / (pow(x * Rational(10), 2) + Rational(1)); }, p);
}

}  // namespace

TEST_CASE("a safe length is what Cauchy's estimate allows for the momentum") {
  const double size = 1e-3;
  const Passage passage = steep_force(Rational(1, 1000), order);
  for (const double tolerance : {1e-12, 1e-9, 1e-7}) {
    CAPTURE(tolerance);
    const double best = by_cauchy(size, tolerance);
    CHECK(tolerance >= best * size * left_out(best));  // the true error
    const double found = passage.longest(tolerance);
    CHECK(found <= best);
    CHECK(found >= 0.8 * best);
  }
}

TEST_CASE("where the momentum is small, rounding of the force is the measure") {
  const Passage passage = steep_force(Rational(1), order);
  for (const double tolerance : {1e-9, 1e-7}) {
    CAPTURE(tolerance);
    const double truly = std::pow(tolerance / left_out(1), 1.0 / order);  // left out: tolerance times the force
    const double found = passage.longest(tolerance, 0);
    CHECK(found <= truly);
    CHECK(found >= 0.55 * truly);
  }
}

TEST_CASE("the length follows momentum and tolerance by their power") {
  const Passage passage = steep_force(Rational(1, 1000), order);
  const double found = passage.longest(1e-10);
  const double factor = std::pow(2.0, order + 1);
  CHECK(passage.longest(factor * 1e-10) == doctest::Approx(2 * found).epsilon(0.2));
  CHECK(passage.longest(1e-10, factor) == doctest::Approx(2 * found).epsilon(0.2));
}

TEST_CASE("no step goes beyond half of the disk on which the force is known") {
  const Passage passage = resonance(Rational(1, 1000), 30);
  const double distance = 0.1, found = passage.longest(1e-6);
  CHECK(found <= 0.5 * distance);
  CHECK(found >= 0.3 * distance);
  CHECK(passage.bounds(1e-6).within(passage.coefficients(), 0, 0.55 * distance, 1) <= 0.5 * distance);
  // The disk that is asked first reaches beyond the singularity; a smaller one is found, and the length is kept.
  CHECK(passage.bounds(1e-6).within(passage.coefficients(), 0, 0.3 * distance, 1) == 0.3 * distance);
}

TEST_CASE("a wanted length that is safe is kept to the bit, a longer one is cut") {
  const Passage passage = steep_force(Rational(1, 1000), order);
  SafeLength bounds = passage.bounds(1e-10);
  const double found = bounds.within(passage.coefficients(), 0, infinity, 1);
  for (const double part : {0.123, 0.7, 0.97, 1.03})
    CHECK(bounds.within(passage.coefficients(), 0, part * found, 1) == part * found);
  const double best = by_cauchy(1e-3, 1e-10);
  for (const double part : {1.01, 1.5, 4.0, 1e3})
    CHECK(bounds.within(passage.coefficients(), 0, part * best, 1) <= best);
  CHECK(bounds.within(passage.coefficients(), 0, infinity, found / 2) == infinity);  // the run ends before
}

TEST_CASE("a residual that is linear in q allows any length") {
  const Passage spring([](Expr x) { return -x; }, order);
  CHECK(!spring.bounds(1e-12).is_needed());
  CHECK(spring.longest(1e-12) == infinity);
  CHECK(steep_force(Rational(1), order).bounds(1e-12).is_needed());
}

TEST_CASE("momenta follow velocities that have grown threefold; M is looked at now and then") {
  const Passage passage = steep_force(Rational(1, 1000), order);
  SafeLength bounds(passage.work.program(), order, 1e-12);
  const double slow[] = {2}, faster[] = {5.9}, fast[] = {6.1};
  CHECK(bounds.wants_momenta(slow));
  bounds.set_constants(passage.work.constants());
  bounds.set_momenta(slow, passage.work);
  const auto length = [&] { return bounds.within(passage.coefficients(), 0, infinity, 1); };
  const double at_first = length();
  CHECK(!bounds.wants_momenta(slow));
  CHECK(!bounds.wants_momenta(faster));
  CHECK(length() == at_first);
  CHECK(!bounds.wants_momenta(fast));
  CHECK(length() == passage.longest(1e-12, 6.1));
  CHECK(length() > at_first);
  int asked = 1;
  while (!bounds.wants_momenta(slow) && asked < 10000) ++asked;
  CHECK(asked > 100);
  CHECK(asked < 1000);
  bounds.set_momenta(slow, passage.work);
  bounds.forget();
  CHECK(bounds.wants_momenta(slow));
}

TEST_CASE("a momentum once reached goes on to count") {
  const Passage passage = steep_force(Rational(1, 1000), order);
  SafeLength bounds = passage.bounds(1e-10, 32);
  const double slow[] = {1};
  bounds.set_momenta(slow, passage.work);
  CHECK(bounds.within(passage.coefficients(), 0, infinity, 1) == passage.longest(1e-10, 32));
}

TEST_CASE("with a hundred digits a mass of 1e192 has the lengths of a mass of 1") {
  // The quotient of the tail and the tolerance is beyond the range of double.
  const auto force = [](Expr x) { return apply(Kind::Exp, x * Rational(100)); };
  const Passage light(force, 40), heavy(force, 40, 12);
  const double found = light.longest(1e-120);
  CHECK(found > 0);
  CHECK(heavy.longest(1e-120) == doctest::Approx(found).epsilon(0.02));
}

TEST_CASE("what is known of motions with other constants allows nothing") {
  constexpr double tolerance = 1e-4, h = 0.1;
  const auto force = [](Rational size, Rational steep) {
    return Passage([=](Expr x) { return size * apply(Kind::Exp, x * steep); }, order);
  };
  // The second force is smaller in all that the step knows of it, and 10⁵ times larger at its end.
  const Passage gentle = force(Rational(2), Rational(1, 2)), steep = force(Rational(1, 100'000'000), Rational(300));
  REQUIRE(gentle.work.program().constants.size() == steep.work.program().constants.size());
  const auto shared = SafeLength::shared_by_motions(gentle.work.program(), order, tolerance);
  const auto longest = [&](const Passage& p) {
    SafeLength bounds(p.work.program(), order, tolerance, shared);
    bounds.set_constants(p.work.constants());
    const double rates[] = {1};
    bounds.set_momenta(rates, p.work);
    return bounds.within(p.coefficients(), 0, h, 1);
  };
  CHECK(longest(gentle) == h);
  CHECK(longest(steep) < 0.9 * h);
  CHECK(longest(gentle) == h);
}

}  // namespace safe_length_test
