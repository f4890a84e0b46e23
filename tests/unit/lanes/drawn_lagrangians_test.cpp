#include "lane_systems.hpp"

#include <cstdlib>

// Lagrangians as people write them, drawn at random: masses that depend on positions in one row and not in another,
// couplings of velocities that are there or not, forces by velocities. What one motion is expanded by has to agree for
// each: the engine of packs, rolled code, straight-line code, and the instructions one after the other.

namespace {

constexpr int drawn_order = order;

/// Positions stay below 1 and each mass above 2, so that M is definite.
class DrawnLagrangian {
 public:
  DrawnLagrangian(System& s, unsigned seed) : s_(s), random_(seed) {
    const int count = seed % 5 == 0 ? 5 + draw(8) : 1 + draw(4);  // few are written out, more are a loop over stages
    for (int i = 0; i < count; ++i)
      q_.push_back(s.coordinate("q" + std::to_string(i), between(-0.9, 0.9), between(-0.9, 0.9)));
    c_ = s.parameter("c", between(0.5, 1.5));
  }

  void make() {
    Expr lagrangian = s_.context.number(0);
    for (std::size_t i = 0; i < q_.size(); ++i) {
      lagrangian = lagrangian + ((draw(2) ? pow(function(), 2) : s_.context.number(0)) + Rational(2)) *
                                    pow(s_.dot(q_[i]), 2) * Rational(1, 2);
      for (std::size_t j = 0; j < i; ++j)
        if (draw(3) == 0) lagrangian = lagrangian + Rational(1, 4) * c_ * function() * s_.dot(q_[i]) * s_.dot(q_[j]);
    }
    for (int terms = draw(3); terms >= 0; --terms) lagrangian = lagrangian - function() * function();
    s_.from_lagrangian(lagrangian);
    for (int forces = draw(3); forces > 0; --forces) {
      Expr& row = s_.source.residual[static_cast<std::size_t>(draw(static_cast<int>(q_.size())))];
      row = row - force();
    }
    s_.start.t = 0.3;
  }

 private:
  int draw(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
  double between(double low, double high) { return low + (high - low) * (random_() % 10007) / 10007.0; }
  Expr position() { return q_[static_cast<std::size_t>(draw(static_cast<int>(q_.size())))]; }

  /// At most 1.
  Expr function() {
    const Expr x = position(), y = position();
    switch (draw(9)) {
      case 0:
        return x;
      case 1:
        return x * x;
      case 2:
        return x * y;
      case 3:
        return sin(x);
      case 4:
        return cos(x - y);
      case 5:
        return sin(Rational(2) * x) * y;
      case 6:
        return x / (y + Rational(2));
      case 7:
        return sqrt(x + Rational(2)) * Rational(1, 2);
      default:
        return apply(Kind::Exp, -(x * x)) * cos(y);
    }
  }

  Expr force() {
    const Expr u = s_.dot(position()), v = s_.dot(position());
    switch (draw(6)) {
      case 0:
        return c_ * u;
      case 1:
        return function() * u * v;
      case 2:
        return function() * pow(u, 2);
      case 3:
        return u / (v * v + Rational(2));
      case 4:
        return sqrt(u * u + Rational(1)) * function();
      default:
        return sin(Rational(3) * s_.context.time()) * function() + u * function();
    }
  }

  System& s_;
  std::mt19937 random_;
  std::vector<Expr> q_;
  Expr c_;
};

/// Of coefficients of order k in units of (k + 1) ε and of the largest of them.
double worst_difference(const KernelWorkspace& found, const KernelWorkspace& expected, std::size_t n) {
  double worst = 0;
  for (int k = 2; k <= drawn_order + 1; ++k) {
    double size = 1e-3, difference = 0;
    for (std::size_t i = 0; i < n; ++i) {
      size = std::max(size, std::abs(expected.coordinate(k)[i]));
      difference = std::max(difference, std::abs(found.coordinate(k)[i] - expected.coordinate(k)[i]));
      if (std::isnan(found.coordinate(k)[i])) return std::numeric_limits<double>::infinity();
    }
    worst = std::max(worst, difference / size / (0x1p-52 * (k + 1)));
  }
  return worst;
}

KernelWorkspace code_for(const Kernel& kernel, bool straight) {
  KernelWorkspace work(kernel, drawn_order);
  const CompileReport report =
      work.compile({.cache = false, .long_run = straight, .in_tiers = straight, .processor = {}});
  REQUIRE_MESSAGE(report.compiled, report.trouble);
  return work;
}

/// Code of several motions side by side takes longer to compile.
constexpr unsigned seeds_for_lanes = 8;

/// MAUP_DRAWN: how many, for a long run.
unsigned count_of_draws() {
  const char* const count = std::getenv("MAUP_DRAWN");
  return count ? static_cast<unsigned>(std::strtoul(count, nullptr, 10)) : 60;
}

}  // namespace

TEST_CASE("drawn Lagrangians: one motion by the engine, by rolled and by straight-line code, and by the reference") {
  constexpr double roundings = 1e4;  // M may have a condition of a hundred, and coefficients grow by cancelling terms
  for (unsigned seed = 1; seed <= count_of_draws(); ++seed) {
    CAPTURE(seed);
    System s;
    DrawnLagrangian(s, seed).make();
    const Kernel kernel = build_kernel(s.source);
    KernelWorkspace engine(kernel, drawn_order), rolled = code_for(kernel, false), straight = code_for(kernel, true);
    for (const Motion& m : motions_near(s.start, 2)) {
      for (KernelWorkspace* const work : {&engine, &rolled, &straight}) {
        work->set_parameters(m.parameters);
        REQUIRE(work->expand(m.t, m.q, m.v) == KernelStatus::Ok);
      }
      CHECK(worst_difference(rolled, engine, kernel.freedoms()) <= roundings);
      CHECK(worst_difference(straight, engine, kernel.freedoms()) <= roundings);
      const Expansion reference = expand(kernel, {m}, 1, InstructionSet::Best);
      check_against_reference(kernel, m, reference.coefficients[0], 1e-2 * reference.quality[0]);
    }
    if (seed % seeds_for_lanes != 0) continue;
    const CompiledLanes lanes = compiled_lanes(kernel, 4, {.cache = false, .processor = {}});
    REQUIRE_MESSAGE(lanes.expansion, lanes.trouble);
    const std::vector<Motion> motions = motions_near(s.start, 4);
    const Expansion side_by_side = expand(kernel, motions, lanes.expansion);
    for (std::size_t i = 0; i < motions.size(); ++i)
      check_against_reference(kernel, motions[i], side_by_side.coefficients[i], 1e-2 * side_by_side.quality[i]);
  }
}
