#include "../processors.hpp"
#include "lane_systems.hpp"

// One motion in rolled code, stage by stage, against the engine of packs: coefficients, multipliers, integrands.

namespace {

/// More than four groups of stages, the last one begun and not ended.
constexpr int rolled_order = 22;

/// Damped at its joints, pushed at its end.
void add_damped_chain(Systems& list, int links) {
  add_chain(list, links);
  System& s = *list.back();
  s.name = "damped chain of " + std::to_string(links);
  const Expr c = s.parameter("c", 0.3);
  Expr before = s.context.number(0);
  for (std::size_t i = 0; i < s.source.coordinates.size(); ++i) {
    const Expr rate = s.dot(s.source.coordinates[i]);
    s.source.residual[i] = s.source.residual[i] + c * (rate - before);
    before = rate;
    s.start.q[i] = 2 + 0.5 * static_cast<double>(i) / links, s.start.v[i] = 0.1 * static_cast<double>(i % 3);
  }
  s.source.residual.back() =
      s.source.residual.back() - sin(Rational(2) * s.context.time()) * cos(s.source.coordinates.back());
  s.source.integrands = {pow(s.dot(s.source.coordinates.back()), 2) * c};
}

/// Points of mass m in the plane, each on a rod from the one before: constraints in place of angles.
void add_rods(Systems& list, int rods) {
  System& s = add(list, "rods: " + std::to_string(rods));
  const Expr m = s.parameter("m", 1.3), l = s.parameter("l", 1), g = s.parameter("g", 9.81);
  Expr before_x = s.context.number(0), before_y = before_x, lagrangian = before_x;
  double x0 = 0, y0 = 0, u0 = 0, v0 = 0;
  for (int i = 0; i < rods; ++i) {
    const double angle = 0.4 + 0.3 * i, rate = 0.5 - 0.05 * i;
    x0 += std::sin(angle), y0 -= std::cos(angle), u0 += rate * std::cos(angle), v0 += rate * std::sin(angle);
    const std::string number = std::to_string(i);
    const Expr x = s.coordinate("x" + number, x0, u0), y = s.coordinate("y" + number, y0, v0);
    const Expr multiplier = s.context.symbol("lambda" + number, Role::Multiplier);
    const Expr length = pow(x - before_x, 2) + pow(y - before_y, 2) - l * l;
    s.source.multipliers.push_back(multiplier);
    s.source.constraints.push_back({length, 0, "rod " + number});
    lagrangian =
        lagrangian + Rational(1, 2) * m * (pow(s.dot(x), 2) + pow(s.dot(y), 2)) - m * g * y + multiplier * length;
    before_x = x, before_y = y;
  }
  s.from_lagrangian(lagrangian);
}

/// Bodies in space that attract each other, with a ring of springs through velocities besides: code in several parts.
void add_bodies(Systems& list, int count) {
  System& s = add(list, "bodies: " + std::to_string(count));
  const Expr g = s.parameter("g", 0.7), c = s.parameter("c", 0.1);
  std::vector<std::array<Expr, 3>> places;
  Expr lagrangian = s.context.number(0);
  for (int i = 0; i < count; ++i) {
    const std::string n = std::to_string(i);
    const double a = 2.4 * i;
    places.push_back({s.coordinate("x" + n, (1 + 0.1 * i) * std::cos(a), -0.3 * std::sin(a)),
                      s.coordinate("y" + n, (1 + 0.1 * i) * std::sin(a), 0.3 * std::cos(a)),
                      s.coordinate("z" + n, 0.3 * std::sin(3 * a), 0.1)});
    for (const Expr& x : places.back())
      lagrangian = lagrangian + Rational(i + 2, 4) * pow(s.dot(x), 2) + c * pow(s.dot(x), 2) * cos(x);
    for (int j = 0; j < i; ++j) {
      Expr square = s.context.number(0);
      for (std::size_t k = 0; k < 3; ++k)
        square = square + pow(places.back()[k] - places[static_cast<std::size_t>(j)][k], 2);
      lagrangian = lagrangian + Rational((i + 2) * (j + 2), 4) * g * pow(square, Rational(-1, 2));
    }
  }
  s.from_lagrangian(lagrangian);
}

/// Formulas that switch with the motion: dry friction, a one-sided spring, and a choice between two.
void add_switches(Systems& list) {
  System& s = add(list, "switches");
  const Expr x = s.coordinate("x", 0.5, 0.8), y = s.coordinate("y", 0.7, 0.3), k = s.parameter("k", 2.5);
  const std::vector<Expr> either{x * y, sin(x)};
  s.source.residual = {s.acceleration("x") + apply(Kind::Sign, s.dot(x)) + k * apply(Kind::Abs, x) * x,
                       (sin(x) + Rational(2)) * s.acceleration("y") + y + s.context.function(Kind::Max, either)};
}

/// Accelerations divided by functions of velocities, which are known an order further when the first stage divides.
void add_velocity_quotients(Systems& list, int count) {
  System& s = add(list, "quotients by velocities: " + std::to_string(count));
  for (int i = 0; i < count; ++i) {
    const std::string word = "q" + std::to_string(i);
    const Expr q = s.coordinate(word, 0.3 + 0.1 * i, 0.4 - 0.05 * i), a = s.acceleration(word);
    s.source.residual.push_back(Rational(3) * a + sin(q) + (a + q) / (pow(s.dot(q), 2) + Rational(2)));
  }
}

/// The largest difference of coefficients of order k in units of (k + 1) ε and of the largest of them.
double difference(const KernelWorkspace& found, const KernelWorkspace& expected, std::size_t count, int k) {
  double size = 1e-300, worst = 0;
  for (std::size_t i = 0; i < count; ++i) {
    size = std::max(size, std::abs(expected.coordinate(k)[i]));
    worst = std::max(worst, std::abs(found.coordinate(k)[i] - expected.coordinate(k)[i]));
    if (std::isnan(found.coordinate(k)[i])) return std::numeric_limits<double>::infinity();
  }
  return worst / size / (0x1p-52 * (k + 1));
}

KernelWorkspace rolled_workspace(const Kernel& kernel, bool long_run = false, const std::string& processor = {},
                                 int orders = rolled_order) {
  return compiled_workspace(kernel, orders, long_run, processor);
}

/// Oscillators beside it, so that it is too large to be written out stage by stage.
void make_larger(System& s, int oscillators) {
  for (int i = 0; i < oscillators; ++i) {
    const std::string word = "z" + std::to_string(i);
    const Expr z = s.coordinate(word, 0.1 * i, 0.3);
    s.source.residual.push_back(s.acceleration(word) + Rational(i + 1, 2) * z);
  }
}

/// `tolerance`: in units of rounding errors, which the solution magnifies.
void check_rolled(const System& s, double tolerance, bool long_run = false, const std::string& processor = {},
                  int orders = rolled_order) {
  CAPTURE(s.name);
  CAPTURE(orders);
  const Kernel kernel = build_kernel(s.source);
  KernelWorkspace rolled = rolled_workspace(kernel, long_run, processor, orders), engine(kernel, orders);
  const std::size_t unknowns = kernel.freedoms() + kernel.constraints();
  for (const Motion& m :
       s.source.constraints.empty() ? motions_near(s.start, 3) : std::vector<Motion>{s.start, s.start}) {
    rolled.set_parameters(m.parameters), engine.set_parameters(m.parameters);
    REQUIRE(engine.expand(m.t, m.q, m.v) == KernelStatus::Ok);
    CHECK(rolled.expand(m.t, m.q, m.v) == KernelStatus::Ok);
    for (int k = 0; k <= orders + 1; ++k) {
      CAPTURE(k);
      CHECK(difference(rolled, engine, unknowns, k) <= tolerance);
    }
    for (std::size_t i = 0; i < s.source.integrands.size(); ++i)
      for (int k = 0; k < orders; ++k)
        CHECK(rolled.integrand(i, k) == doctest::Approx(engine.integrand(i, k)).epsilon(1e-9).scale(1e-9));
  }
}

}  // namespace

TEST_CASE("rolled code: chains of many links, damped and pushed") {
  Systems list;
  for (const int links : {4, 9, 17, 40}) add_damped_chain(list, links);
  for (const auto& s : list) check_rolled(*s, 1000), check_rolled(*s, 1000, true);
}

TEST_CASE(
    "rolled code: every instruction, in systems too large to be written out, solved by a matrix and by its sparse "
    "factors") {
  for (const int oscillators : {9, 16}) {  // 11 unknowns are written out in long runs
    Systems list = systems();
    for (unsigned seed = 1; seed <= 6; ++seed) make_random(add(list, "random " + std::to_string(seed)), seed);
    for (const auto& s : list) {
      make_larger(*s, oscillators);
      const bool is_ill_conditioned = s->name == "power 5/1";  // M has 15² beside 1
      s->name += " beside " + std::to_string(oscillators);
      const double tolerance = is_ill_conditioned ? 50'000 : 1000;
      check_rolled(*s, tolerance);
      if (oscillators > 9) check_rolled(*s, tolerance, true);
    }
  }
}

TEST_CASE("rolled code: all stages in one loop, where nothing is asked for besides coordinates") {
  Systems list;
  for (const int links : {17, 24, 33, 48}) add_chain(list, links);
  for (const int links : {18, 31}) add_damped_chain(list, links);
  for (const int count : {17, 40}) add_velocity_quotients(list, count);
  for (unsigned seed = 11; seed <= 16; ++seed) {
    make_random(add(list, "random " + std::to_string(seed)), seed);
    make_larger(*list.back(), 17);
  }
  for (const auto& s : list) {
    s->source.integrands.clear(), s->source.events.clear(), s->source.observables.clear();
    check_rolled(*s, 1000, true);
  }
  for (const int orders : {1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 13})
    check_rolled(*list[1], 1000, true, {}, orders), check_rolled(*list[4], 1000, true, {}, orders);
  for (const std::string& processor : levels_here({"x86-64", "x86-64-v3"}))
    check_rolled(*list[1], 1000, true, processor), check_rolled(*list[6], 1000, true, processor);
}

TEST_CASE("rolled code: M that becomes unsymmetric with a parameter, at a state of no forces") {
  for (const int count : {8, 10, 16, 18, 30}) {  // up to 16: written out
    Systems list;
    System& s = add(list, "unsymmetric " + std::to_string(count));
    const Expr c = s.parameter("c", 0);
    for (int i = 0; i < count; ++i) {
      const std::string word = "q" + std::to_string(i);
      const Expr q = s.coordinate(word, 0, i == 4 ? 1 : 0);
      s.source.residual.push_back(Rational(2) * s.acceleration(word) + q +
                                  (i > 0 ? c * s.acceleration("q" + std::to_string(i - 1)) : c * Rational(0)));
    }
    const Kernel kernel = build_kernel(s.source);
    KernelWorkspace rolled = rolled_workspace(kernel, true), engine(kernel, rolled_order);
    for (const double value : {0.0, 0.7, 1e-7}) {
      CAPTURE(value);
      rolled.set_parameters({{value}}), engine.set_parameters({{value}});
      REQUIRE(engine.expand(0, s.start.q, s.start.v) == KernelStatus::Ok);
      REQUIRE(rolled.expand(0, s.start.q, s.start.v) == KernelStatus::Ok);
      for (int k = 2; k <= rolled_order + 1; ++k)
        CHECK(difference(rolled, engine, static_cast<std::size_t>(count), k) <= 1000);
      double before = 0;  // 2 a_i + q_i + c a_{i−1} = 0
      for (std::size_t i = 0; i < s.start.q.size(); ++i) {
        before = -(s.start.q[i] + value * before) / 2;
        CHECK(2 * engine.coordinate(2)[i] == doctest::Approx(before));
      }
    }
  }
}

TEST_CASE("rolled code: an expansion that is not finite leaves nothing behind") {
  Systems list;
  System& s = add(
      list, "points on a line by the distances between them");  // sums of coordinates up, and of what moves them down
  Expr x = s.context.number(0), lagrangian = x;
  for (int i = 0; i < 19; ++i) {
    x = x + s.coordinate("q" + std::to_string(i), 0.1 + 0.01 * i, 0.3 - 0.02 * i);
    lagrangian = lagrangian + Rational(1, 2) * pow(s.dot(x), 2) - Rational(1, 2) * pow(x, 2) - cos(x);
  }
  s.from_lagrangian(lagrangian);
  const Kernel kernel = build_kernel(s.source);
  for (const bool long_run : {false, true}) {
    KernelWorkspace rolled = rolled_workspace(kernel, long_run), engine(kernel, rolled_order);
    for (KernelWorkspace* const work : {&rolled, &engine}) {
      work->set_parameters(s.start.parameters);
      CHECK(work->expand(s.start.t, s.start.q, s.start.v) == KernelStatus::Ok);
      std::vector<double> v = s.start.v;
      v[7] = std::numeric_limits<double>::quiet_NaN();
      CHECK(work->expand(s.start.t, s.start.q, v) == KernelStatus::NonFinite);
      v[7] = 1e300;
      CHECK(work->expand(s.start.t, s.start.q, v) == KernelStatus::NonFinite);
      CHECK(work->expand(s.start.t, s.start.q, s.start.v) == KernelStatus::Ok);
    }
    for (int k = 2; k <= rolled_order + 1; ++k) CHECK(difference(rolled, engine, 19, k) <= 1000);
  }
}

TEST_CASE("rolled code: pairs of bodies, so many that a stage is several functions") {
  Systems list;
  for (const int count : {5, 14}) add_bodies(list, count);
  for (const auto& s : list) {
    check_rolled(*s, 1000);
    for (const std::string& processor : levels_here({"x86-64", "x86-64-v3"})) check_rolled(*s, 1000, false, processor);
  }
}

TEST_CASE("rolled code: constraints and switches") {
  Systems list;
  for (const int rods : {1, 3, 12}) add_rods(list, rods);
  add_switches(list);
  for (const auto& s : list) check_rolled(*s, 1000), check_rolled(*s, 1000, true);
}

TEST_CASE("rolled code: quotients whose denominators are known an order further") {
  Systems list;
  for (const int count : {9, 17, 24}) add_velocity_quotients(list, count);
  for (const auto& s : list) check_rolled(*s, 1000), check_rolled(*s, 1000, true);
}

TEST_CASE("without coordinates there is nothing to compile, and the interpreter goes on") {
  Systems list;
  System& s = add(list, "no coordinates");
  s.source.integrands = {sin(s.parameter("p", 1.5) * s.context.time())};
  const Kernel kernel = build_kernel(s.source);
  KernelWorkspace work(kernel, rolled_order);
  const CompileReport report = work.compile();
  CHECK_FALSE(report.compiled);
  CHECK(report.trouble == "there are no coordinates, and so no equations to compile");
  work.set_parameters(s.start.parameters);
  REQUIRE(work.expand(0.5, {}, {}) == KernelStatus::Ok);
  CHECK(work.integrand(0, 2) == doctest::Approx(-1.125 * std::sin(0.75)));
}

TEST_CASE("rolled code: expansions of a few stages between those of all") {
  Systems list;
  add_damped_chain(list, 17);
  const System& s = *list.back();
  const Kernel kernel = build_kernel(s.source);
  KernelWorkspace rolled = rolled_workspace(kernel), engine(kernel, rolled_order);
  for (const Motion& m : motions_near(s.start, 3)) {
    rolled.set_parameters(m.parameters), engine.set_parameters(m.parameters);
    REQUIRE(rolled.evaluate(m.t, m.q, m.v) == KernelStatus::Ok);
    REQUIRE(engine.evaluate(m.t, m.q, m.v) == KernelStatus::Ok);
    CHECK(difference(rolled, engine, kernel.freedoms(), 2) <= 1000);
    CHECK(rolled.expand(m.t, m.q, m.v) == KernelStatus::Ok);
    REQUIRE(engine.expand(m.t, m.q, m.v) == KernelStatus::Ok);
    CHECK(difference(rolled, engine, kernel.freedoms(), rolled_order + 1) <= 1000);
  }
}

TEST_CASE("rolled code for other processors") {
  Systems list;
  add_damped_chain(list, 9);
  add_rods(list, 3);
  for (const auto& s : list)
    for (const std::string& processor : levels_here({"x86-64", "x86-64-v3"}))
      check_rolled(*s, 1000, false, processor), check_rolled(*s, 1000, true, processor);
}
