// Neighbours of random coupled motions: the tangent equations against quotients of differences of the motion itself in
// 113 bits, and against the symplectic form. M(q) couples the coordinates through sines and cosines, so that its slopes
// pass through zero along the way.
#include "../unit/tangent/support.hpp"

#include "generators.hpp"

#include <fmt/format.h>
#include <boost/multiprecision/cpp_dec_float.hpp>

using namespace maupertuis;

namespace {

using Quad = boost::multiprecision::number<boost::multiprecision::cpp_dec_float<40>>;

/// L of two or three numbers as coordinates, with positive definite M: each coupling is less than what the diagonal
/// bears.
struct Coupled {
  std::string text;
  std::size_t freedoms = 2;
  double duration = 0;
};

rc::Gen<Coupled> coupled() {
  return rc::gen::map(
      rc::gen::container<std::vector<std::uint32_t>>(24,
                                                     rc::gen::resize(100, rc::gen::inRange<std::uint32_t>(0, 1000))),
      [](const std::vector<std::uint32_t>& numbers) {
        std::size_t next = 0;
        const auto between = [&](double low, double high) {
          return std::round((low + (high - low) * numbers[next++ % numbers.size()] / 1000.0) * 1000) / 1000;
        };
        Coupled out;
        out.freedoms = numbers[next++] % 4 == 0 ? 3 : 2;
        const char* const names[] = {"a", "b", "c"};
        std::string lagrangian, start;
        for (std::size_t i = 0; i < out.freedoms; ++i) {
          const std::string name = names[i];
          lagrangian += fmt::format("{} {}'^2 + {} cos {} ", between(0.6, 1.5), name, between(0.5, 4), name);
          if (i > 0) {
            const std::string before = names[i - 1];
            const char* const kinds[] = {"cos({} - {})", "cos({1} + 0 {0})", "sin({0} + 2 {1})"};
            const std::string coupling =
                fmt::format(fmt::runtime(kinds[numbers[next++ % numbers.size()] % 3]), before, name);
            lagrangian += fmt::format("+ {} {}' {}' {} ", between(0.2, 0.8), before, name, coupling);
          }
          lagrangian += i + 1 < out.freedoms ? "+ " : "";
          start += fmt::format("{}{} = {}, {}' = {}", i ? ", " : "", name, between(-1.5, 1.5), name, between(-1, 1));
        }
        out.duration = std::round(between(2, 4) * 8) / 8;
        std::string coordinates = names[0];
        for (std::size_t i = 1; i < out.freedoms; ++i) coordinates += std::string(", ") + names[i];
        out.text = fmt::format("system coupled\ndimensionless\ncoord {} : angle\nL = {}\nstart {}\n", coordinates,
                               lagrangian, start);
        return out;
      });
}

void showValue(const Coupled& c, std::ostream& out) { out << c.text << "t = " << c.duration; }

/// ∂(final)/∂(start component) by central differences: their error is h² times the third derivative.
std::vector<double> quotient(const ModelText& m, double t, std::size_t coordinate, int order) {
  const Rational h = *Rational::parse("1e-9");
  const auto above = quad_end(m, t, coordinate, order, h), below = quad_end(m, t, coordinate, order, -h);
  std::vector<double> out;
  for (std::size_t i = 0; i < above.size(); ++i)
    out.push_back(((Quad(above[i]) - Quad(below[i])) / Quad("2e-9")).convert_to<double>());
  return out;
}

}  // namespace

namespace rc {
template <>
struct Arbitrary<Coupled> {
  static Gen<Coupled> arbitrary() { return coupled(); }
};
}  // namespace rc

TEST_CASE("neighbours of random coupled motions are those that 113 bits find") {
  rc::holds("tangents", [](const Coupled& c) {
    const ModelText m(c.text);
    const TangentPoint p = carried(m, c.duration);
    const auto j = static_cast<std::size_t>(c.text.size()) % p.columns();
    const std::vector<double> column(p.column(j).begin(), p.column(j).end());
    RC_ASSERT(relative_difference(column, quotient(m, c.duration, j % c.freedoms, j < c.freedoms ? 0 : 1)) < 1e-12);
  });
}

TEST_CASE("random coupled motions preserve the symplectic form") {
  rc::holds("symplectic", [](const Coupled& c) {
    const ModelText m(c.text);
    const TangentGeometry geometry(m.equations);
    TangentFlow flow(m.equations);
    TangentPoint p = flow.all_directions(start_of(m));
    const auto before = geometry.symplectic_products(p);
    RC_ASSERT(!flow.advance(p, 5 * c.duration));
    const auto after = geometry.symplectic_products(p),
               sizes = geometry.symplectic_sizes(p, std::vector<double>(2 * c.freedoms, 1.0));
    for (std::size_t i = 0; i < before.size(); ++i)
      RC_ASSERT(std::abs(after[i] - before[i]) <= 1e-13 * (sizes[i] + std::abs(before[i])));
  });
}
