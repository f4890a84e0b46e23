// How far a state is from its constraints: against closed forms.
#include "integrator/taylor/constraint_error.hpp"

#include <doctest/doctest.h>
#include <maupertuis/kernel.hpp>
#include <maupertuis/transform.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

using namespace maupertuis;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A free point (x, y) of these masses under one constraint of positions.
struct Tied {
  Context context;
  Expr x = context.symbol("x", Role::Coordinate), y = context.symbol("y", Role::Coordinate);
  KernelWorkspace work;

  Tied(const std::function<Expr(Expr, Expr)>& constraint, int mass_x, int mass_y, std::vector<double> q,
       std::vector<double> v)
      : work(kernel(constraint(x, y), mass_x, mass_y), 4) {
    work.set_parameters({});
    REQUIRE(work.evaluate(0, q, v) == KernelStatus::Ok);
  }
  Kernel kernel(Expr phi, int mass_x, int mass_y) {
    const auto second = [&](const Expr& e) { return context.time_derivative(context.time_derivative(e)); };
    const Expr multiplier = context.symbol("λ", Role::Multiplier);
    KernelSource source;
    source.coordinates = {x, y};
    source.multipliers = {multiplier};
    source.residual = {Rational(mass_x) * second(x) - multiplier * differentiate(phi, x),
                       Rational(mass_y) * second(y) - multiplier * differentiate(phi, y)};
    source.constraints = {{phi, 0, "tie"}};
    return build_kernel(source);
  }
};

}  // namespace

TEST_CASE("a coordinate without inertia counts by its own speed") {
  // φ = y − 2 x with a massless y: dφ/dt = v_y − 2 v_x, over |v_y| + 2 |v_x| of its terms and as much of their motion.
  const Tied tied([](Expr x, Expr y) { return y - Rational(2) * x; }, 3, 0, {1, 2}, {5, 10.001});
  const double terms = 10.001 + 2 * 5, motion = 10.001 + std::sqrt(3 * 25 * 4.0 / 3);
  CHECK(tied.work.acceleration(0) == 0);
  CHECK(taylor::constraint_error(tied.work, 2, 1, 0) == doctest::Approx(1e-3 / (terms + motion)).epsilon(1e-6));
  const taylor::UsualSizes usual{{0, 0}, {3, 4}, {}};  // a motion that is known to have been larger
  CHECK(taylor::constraint_error(tied.work, 2, 1, 0, usual) < taylor::constraint_error(tied.work, 2, 1, 0));
}

TEST_CASE("a rate that moves the constraint by less than the rounding of far coordinates does not count") {
  // A rod of length 1 about a pivot 10⁶ away: rounding of x moves φ by 64 ε 2·10⁶ and more.
  const auto rod = [](Expr x, Expr y) { return pow(x - Rational(1'000'000), 2) + pow(y, 2) - Rational(1); };
  const double h = 0.1, unseen = 64 * epsilon * 2e6 / h;
  const Tied slow(rod, 1, 1, {1'000'001, 0}, {0.45 * unseen, 0}), fast(rod, 1, 1, {1'000'001, 0}, {0.6 * unseen, 0});
  CHECK(slow.work.constraint_rate(0) == doctest::Approx(0.9 * unseen));
  CHECK(taylor::constraint_error(slow.work, 2, 1, h) == 0);
  CHECK(taylor::constraint_error(fast.work, 2, 1, h) > 0);
}

TEST_CASE("corrections are measured by what moves, in the metric of M") {
  const Tied tied([](Expr, Expr y) { return y; }, 2, 1, {0, 0}, {3, 0});
  const std::vector<double> none{0, 0};
  CHECK(taylor::correction_size(tied.work, 1, none, std::vector<double>{0, 0.03}, 1) ==
        doctest::Approx(0.03 / (3 * std::sqrt(2.0))));
  CHECK(taylor::correction_size(tied.work, 1, std::vector<double>{0, 0.03}, none, 0.5) ==
        doctest::Approx(0.03 / (0.5 * 3 * std::sqrt(2.0))));
  CHECK(taylor::correction_size(tied.work, 1, none, none, 1) == 0);
}
