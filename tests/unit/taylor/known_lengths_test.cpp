// What is known of lengths belongs to motions that are no larger, and to no others.
#include "integrator/taylor/known_lengths.hpp"

#include <doctest/doctest.h>
#include <cmath>
#include <maupertuis/kernel.hpp>
#include <maupertuis/transform.hpp>

#include <memory>
#include <vector>

using namespace maupertuis;
using taylor::KnownLengths;

namespace {

constexpr int order = 20;
constexpr double ratio = 5;
using enum KnownLengths::Answer;
using enum KnownLengths::Limits;

/// x'' + 1/(x + 2) + y² sin 3x = 0, y'' + x y = 0, with a motion through (x, y) = (0.3, 0.5). Driven: x sin 2t = 0
/// instead of 1/(x + 2) = 0.
struct Motion {
  Context context;
  Kernel kernel;
  KernelWorkspace work;
  std::vector<double> rows;
  explicit Motion(bool driven = false, double t = 0) : kernel(make(context, driven)), work(kernel, order) {
    work.set_parameters({});
    const double q[] = {0.3, 0.5}, v[] = {0.2, -0.1};
    REQUIRE(work.expand(t, q, v) == KernelStatus::Ok);
    rows.assign(work.coordinate(0), work.coordinate(0) + (order + 2) * work.row_stride());
  }
  static Kernel make(Context& context, bool driven) {
    KernelSource source;
    const Expr x = context.symbol("x", Role::Coordinate), y = context.symbol("y", Role::Coordinate);
    const auto second = [&](const Expr& q) { return context.time_derivative(context.time_derivative(q)); };
    source.coordinates = {x, y};
    source.residual = {second(x) + (driven ? x * sin(context.time() * Rational(2)) : pow(x + Rational(2), -1)) +
                           y * y * sin(x * Rational(3)),
                       second(y) + x * y};
    return build_kernel(source);
  }
  SlotCoefficients coefficients() const { return {rows.data(), work.row_stride(), order, 1}; }
  double& coefficient(int k, std::size_t i) { return rows[static_cast<std::size_t>(k) * work.row_stride() + i]; }
};

struct Known {
  std::unique_ptr<Disks> disks;
  KnownLengths lengths;
  explicit Known(const Motion& m, bool for_several = false)
      : disks(std::make_unique<Disks>(m.work.program())),
        lengths(m.work.program(), disks->degrees(), ratio, for_several) {
    lengths.adopt(m.work.constants());
  }
  KnownLengths::Answer ask(const Motion& m, const std::vector<double>& allowed, double h = 0.05, double t = 0) {
    return lengths.ask(m.coefficients(), t, h, allowed);
  }
  /// Asks about the motion at time t and bounds its like.
  void bound(const Motion& m, const std::vector<double>& allowed, KnownLengths::Limits limits, double t = 0) {
    ask(m, allowed, 0.05, t);
    lengths.bound(limits);
  }
};

const std::vector<double> much = {1, 1}, nothing = {0, 0};

}  // namespace

TEST_CASE("a length that was learned is known for the motion itself, and not for one that is larger anywhere") {
  Motion m;
  Known known(m);
  CHECK(known.ask(m, much) == Unknown);
  known.lengths.bound(Widened);
  REQUIRE(known.lengths.accept(much));
  CHECK(known.ask(m, much) == Safe);
  for (const int k : {1, 2, 3, order + 1})
    for (const std::size_t i : {0, 1}) {
      Motion other;
      other.coefficient(k, i) = k > 3 ? 1e12 : 2 * other.coefficient(k, i) + 1;
      CAPTURE(k);
      CAPTURE(i);
      CHECK(known.ask(other, much) != Safe);
    }
  Motion farther;
  farther.coefficient(0, 1) *= 2;  // y stands in products
  CHECK(known.ask(farther, much) != Safe);
  CHECK(known.ask(m, much) == Safe);
}

TEST_CASE("a denominator that comes nearer to zero is another motion") {
  Motion m;
  Known known(m);
  known.bound(m, much, Widened);
  REQUIRE(known.lengths.accept(much));
  const Slot denominator = [&] {
    for (const Instruction& i : m.work.program().instructions)
      if (i.op == Op::Quotient || i.op == Op::Power) return i.op == Op::Quotient ? i.b : i.a;
    return no_slot;
  }();
  REQUIRE(denominator != no_slot);
  m.rows[denominator] *= 0.5;
  CHECK(known.ask(m, much) != Safe);
}

TEST_CASE("an angle that grows with time is bounded as one at any time") {
  Motion m(true);
  Known early(m), late(m);
  early.bound(m, much, Exact, 0.001);  // sin 2t is 0.002, and 0.985
  late.bound(m, much, Exact, 0.7);
  for (double allowed = 1; allowed > 1e-30; allowed /= 1.02) {
    CAPTURE(allowed);
    REQUIRE(early.lengths.accept({{allowed, 1}}) == late.lengths.accept({{allowed, 1}}));
  }
}

TEST_CASE("what is allowed counts, also when it shrinks later") {
  Motion m;
  Known known(m);
  known.bound(m, much, Exact);
  CHECK(!known.lengths.accept(nothing));
  REQUIRE(known.lengths.accept(much));
  CHECK(known.ask(m, much) == Safe);
  CHECK(known.ask(m, nothing) != Safe);
}

TEST_CASE("a longer step is another question, one of the same bin is not") {
  Motion m;
  Known known(m);
  known.bound(m, much, Widened);
  REQUIRE(known.lengths.accept(much));
  CHECK(known.ask(m, much, 0.0501) == Safe);
  CHECK(known.ask(m, much, 0.06) != Safe);
  const double h = 0.053, r = known.lengths.disk_radius(h);
  CHECK(r >= ratio * h);
  CHECK(r <= 1.125 * ratio * h);
}

TEST_CASE("rounding allows one motion a step, and is remembered for it alone") {
  for (const bool for_several : {false, true}) {
    Motion m;
    Known known(m, for_several);
    known.bound(m, nothing, Exact);
    CHECK(known.lengths.accept(nothing, much));
    CHECK((known.ask(m, nothing) == Safe) == !for_several);
  }
}

TEST_CASE("lengths belong to constants, up to their last digits") {
  Motion m;
  Known known(m, true);
  std::vector<double> constants(m.work.constants(), m.work.constants() + m.work.program().constants.size());
  CHECK(known.lengths.belongs_to(constants.data()));
  constants[0] *= 1 + 1e-14;
  CHECK(known.lengths.belongs_to(constants.data()));
  for (double& c : constants) c *= 1.01;
  CHECK(!known.lengths.belongs_to(constants.data()));
}

TEST_CASE("what a step leaves out is h d x^p/(1 - x)") {
  Motion m;
  Known known(m);
  known.bound(m, much, Exact);
  const double r = known.lengths.radius(), h = known.lengths.length(), x = h / r;
  CHECK(r == doctest::Approx(ratio * h));
  std::vector<double> sizes[4];
  for (std::size_t i = 0; i < 2; ++i) {
    double sums[3] = {0, 0, 0};
    for (int k = 1; k <= order + 1; ++k)
      for (int d = 0; d < 3; ++d)
        sums[d] += std::abs(m.coefficient(k, i)) * std::pow(r, k - d) * (d == 0 ? 1 : d == 1 ? k : k * (k - 1));
    sizes[0].push_back(std::abs(m.coefficient(0, i)));
    for (std::size_t d = 0; d < 3; ++d) sizes[d + 1].push_back(sums[d]);
  }
  Envelope envelope(m.work.program(), known.disks->degrees());
  std::vector<double> observed;
  for (const Slot slot : envelope.observed()) observed.push_back(m.rows[slot]);
  envelope.evaluate(m.work.constants(), {sizes[0], sizes[1], sizes[2], sizes[3], observed, observed, 0}, r, order);
  std::vector<double> enough, short_of;
  for (std::size_t j = 0; j < 2; ++j) {
    const double left_out = h * envelope.residual_tail(j) * std::pow(x, order) / (1 - x);
    CHECK(left_out > 0);
    enough.push_back(left_out * (1 + 1e-9)), short_of.push_back(left_out * (1 - 1e-9));
  }
  CHECK(known.lengths.accept(enough));
  CHECK(!known.lengths.accept(short_of));
}
