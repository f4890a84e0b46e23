#include "lane_systems.hpp"

#include "kernel/extended/workspace_code.hpp"

// Chains of more than 48 coordinates, whose vectors hold parts of the chain side by side, against the interpreter's
// rules on the program as it was, in 113 bits.

namespace {

using Many = extended::Real<113>;
constexpr int large_order = 22;

/// Where a link ends.
struct Link {
  Expr x, y;
};

/// `links` times what `link` adds to the Lagrangian between the end of the link before and its own.
void add_links(Systems& list, const std::string& name, int links, Link begin,
               const std::function<Expr(System&, int, Link&)>& link) {
  System& s = *list.back();
  s.name = name + ", links: " + std::to_string(links);
  Expr lagrangian = s.context.number(0);
  for (int i = 0; i < links; ++i) lagrangian = lagrangian + link(s, i, begin);
  s.from_lagrangian(lagrangian);
}

double position_of(int i, int links) { return 2 + 0.5 * i / links; }

Expr kinetic(System& s, Expr mass, const std::vector<Expr>& positions) {
  Expr sum = s.context.number(0);
  for (const Expr e : positions) sum = sum + pow(s.dot(e), 2);
  return Rational(1, 2) * mass * sum;
}

void add_points(Systems& list, int links) {
  System& s = add(list, "");
  const Expr l = s.parameter("l", 0.7), m = s.parameter("m", 1.3), g = s.parameter("g", 9.81),
             zero = s.context.number(0);
  add_links(list, "points", links, {zero, zero}, [=](System& t, int i, Link& end) {
    const Expr angle = t.coordinate("a" + std::to_string(i), position_of(i, links), 0.1 * (i % 3));
    end = {end.x + l * sin(angle), end.y - l * cos(angle)};
    return kinetic(t, m, {end.x, end.y}) - m * g * end.y;
  });
}

/// With centres, on a support that is shaken, damped, and pushed at the end.
void add_damped_rods(Systems& list, int links) {
  System& s = add(list, "");
  const Expr l = s.parameter("l", 0.7), m = s.parameter("m", 1.3), c = s.parameter("c", 0.2),
             half = s.context.number(Rational(1, 2));
  const Expr support = sin(s.context.time() * Rational(3)) * Rational(1, 5);
  add_links(list, "damped rods", links, {support, s.context.number(0)}, [=](System& t, int i, Link& end) {
    const Expr angle = t.coordinate("a" + std::to_string(i), position_of(i, links), 0.1 * (i % 3));
    const Expr across = end.x + half * l * sin(angle), down = end.y - half * l * cos(angle);
    end = {end.x + l * sin(angle), end.y - l * cos(angle)};
    return kinetic(t, m, {across, down}) + kinetic(t, m * Rational(1, 10), {angle}) - m * Rational(981, 100) * down;
  });
  Expr before = s.context.number(0);
  for (std::size_t i = 0; i < s.source.coordinates.size(); ++i) {
    const Expr rate = s.dot(s.source.coordinates[i]);
    s.source.residual[i] = s.source.residual[i] + c * (rate - before);
    before = rate;
  }
  s.source.residual.back() =
      s.source.residual.back() - sin(Rational(2) * s.context.time()) * cos(s.source.coordinates.back());
}

/// On a cart, which is declared last, links that stretch: two coordinates a level.
void add_stretching(Systems& list, int links) {
  System& s = add(list, "");
  const Expr m = s.parameter("m", 1.3), k = s.parameter("k", 40), g = s.parameter("g", 9.81),
             zero = s.context.number(0);
  const Expr cart = s.context.symbol("cart", Role::Coordinate);
  add_links(list, "stretching links", links, {cart, zero}, [=](System& t, int i, Link& end) {
    const std::string number = std::to_string(i);
    const Expr angle = t.coordinate("a" + number, 0.4 + 0.01 * i, 0.1 * (i % 3)),
               length = t.coordinate("r" + number, 1 + 0.001 * i, 0.02);
    if (i + 1 == links) t.coordinate("cart", 0.3, 0.1);
    end = {end.x + length * sin(angle), end.y - length * cos(angle)};
    return kinetic(t, m, {end.x, end.y}) - m * g * end.y - k * pow(length - Rational(1), 2) +
           (i == 0 ? kinetic(t, m, {cart}) : zero);
  });
}

/// Masses on springs with cubic forces: sums of neighbours, and no running sums.
void add_springs(Systems& list, int masses) {
  System& s = add(list, "springs: " + std::to_string(masses));
  const Expr c = s.parameter("c", 0.7);
  Expr lagrangian = s.context.number(0), before = lagrangian;
  for (int i = 0; i < masses; ++i) {
    const Expr x = s.coordinate("x" + std::to_string(i), 0.3 * std::sin(0.4 * i), 0.1), stretch = x - before;
    lagrangian =
        lagrangian + kinetic(s, s.context.number(1), {x}) - Rational(1, 2) * pow(stretch, 2) - c * pow(stretch, 4);
    before = x;
  }
  s.from_lagrangian(lagrangian);
}

/// A sum of functions of the coordinates of which one, in the middle, is another, so that half of the sum waits for
/// something that the other does not.
void add_uneven_sum(Systems& list, int members) {
  System& s = add(list, "uneven sum: " + std::to_string(members));
  Expr x = s.context.number(0), lagrangian = x;
  for (int i = 0; i < members; ++i) {
    const Expr q = s.coordinate("q" + std::to_string(i), 0.3 * std::sin(i), 0.2);
    x = x + (i == members / 2 ? sqrt(s.context.number(2) + q * q) : sin(q));
    lagrangian = lagrangian + kinetic(s, s.context.number(1), {x, q});
  }
  s.from_lagrangian(lagrangian);
}

/// Two coordinates a level, of which a sum takes the second first.
void add_crossed_sums(Systems& list, int links) {
  System& s = add(list, "crossed sums: " + std::to_string(links));
  Expr x = s.context.number(0), y = x, lagrangian = x;
  for (int i = 0; i < links; ++i) {
    const std::string number = std::to_string(i);
    const Expr a = s.coordinate("a" + number, 0.3 * std::sin(i), 0.2),
               b = s.coordinate("b" + number, 0.3 * std::cos(i), 0.2);
    x = x + sin(a) * sin(b);
    for (const Expr step : {b, -a})
      y = y + step, lagrangian = lagrangian + kinetic(s, s.context.number(1), {y}) - sin(y);
    lagrangian = lagrangian + kinetic(s, s.context.number(1), {x, a, b});
  }
  s.from_lagrangian(lagrangian);
}

struct Expected {
  std::vector<std::vector<double>> coefficients;  // [orders][coordinates]
};

Expected in_many_digits(const Kernel& kernel, const Motion& motion) {
  extended::Workspace<Many> work(kernel, large_order);
  const auto many = [](const std::vector<double>& values) { return std::vector<Many>(values.begin(), values.end()); };
  work.set_parameters(many(motion.parameters));
  REQUIRE(work.expand(Many(motion.t), many(motion.q), many(motion.v)) == KernelStatus::Ok);
  Expected out;
  for (int k = 0; k <= large_order + 1; ++k) {
    out.coefficients.emplace_back();
    for (std::size_t i = 0; i < kernel.freedoms(); ++i)
      out.coefficients.back().push_back(static_cast<double>(work.coordinate(k)[i]));
  }
  return out;
}

/// In units of rounding errors of the largest coefficient of each order, which the solutions magnify.
double worst_difference(const KernelWorkspace& work, const Expected& expected) {
  double worst = 0;
  for (int k = 0; k <= large_order + 1; ++k) {
    const auto& row = expected.coefficients[static_cast<std::size_t>(k)];
    double size = 1e-300, difference = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
      size = std::max(size, std::abs(row[i])),
      difference = std::max(difference, std::abs(work.coordinate(k)[i] - row[i]));
      if (!std::isfinite(work.coordinate(k)[i])) return std::numeric_limits<double>::infinity();
    }
    worst = std::max(worst, difference / size / (0x1p-52 * (k + 1)));
  }
  return worst;
}

/// The same motion twice, so that nothing of the expansion before is left; and one of other parameters.
void check_large(const System& s, double tolerance) {
  CAPTURE(s.name);
  const Kernel kernel = build_kernel(s.source);
  std::vector<Motion> motions{s.start, s.start};
  for (double& p : motions[1].parameters) p *= 1.25;
  motions.push_back(s.start);
  std::vector<KernelWorkspace> works;
  works.emplace_back(kernel, large_order);
  works.push_back(compiled_workspace(kernel, large_order, false, {}));
  works.push_back(compiled_workspace(kernel, large_order, true, {}));
  for (const Motion& motion : motions) {
    const Expected expected = in_many_digits(kernel, motion);
    for (KernelWorkspace& work : works) {
      work.set_parameters(motion.parameters);
      REQUIRE(work.expand(motion.t, motion.q, motion.v) == KernelStatus::Ok);
      CHECK(worst_difference(work, expected) <= tolerance);
    }
  }
}

}  // namespace

TEST_CASE("large chains of points, and of rods on a shaken support: as in 113 bits") {
  Systems list;
  for (const int links : {49, 57, 64, 75, 100, 131}) add_points(list, links);
  for (const int links : {60, 90}) add_damped_rods(list, links);
  for (const auto& s : list) check_large(*s, 1000);
}

TEST_CASE(
    "large chains of two coordinates a level, without running sums, and with sums in two pieces: as in 113 bits") {
  Systems list;
  for (const int links : {30, 52}) add_stretching(list, links);
  for (const int masses : {60, 120}) add_springs(list, masses);
  for (const int members : {60, 75}) add_uneven_sum(list, members);
  for (const int links : {43, 50}) add_crossed_sums(list, links);
  for (const auto& s : list) check_large(*s, 5000);
}
