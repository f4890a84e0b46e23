#include "../../unit/model_text.hpp"
#include "models.hpp"

#include <maupertuis/extended_simulation.hpp>
#include <maupertuis/simulation.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>

/// How good stated errors are, against runs of 113 bits. MAUP_CERTAIN_DIGITS=N in the environment takes N models, and
/// MAUP_CERTAIN_DIGITS_FROM another first seed (docs/design/certain_digits.md has the numbers).
namespace maupertuis::property {
namespace {

struct Count {
  std::size_t values = 0, covered = 0, within_hundred = 0, saturated = 0;
  void add(double stated, double off) {
    if (std::isinf(stated)) {
      ++saturated;
      return;
    }
    ++values;
    covered += off <= stated;
    within_hundred += stated <= 100 * off;
  }
  double part_covered() const { return static_cast<double>(covered) / static_cast<double>(values); }
  double part_within() const { return static_cast<double>(within_hundred) / static_cast<double>(values); }
};

/// |x − right| to more digits than double has: the leading part of the difference cancels.
double distance(double x, const AgreedNumber& right) {
  if (right.digits < 18) return std::nan("");
  const Rational difference = Rational::from_double(x) - *Rational::parse(right.text);
  return std::abs(difference.to_double());
}

/// States at four times of one model.
void compare(const std::string& text, Count& count) {
  const ModelText m(text);
  SimulationOptions in_double;
  ExtendedSimulationOptions in_quad;
  in_quad.tolerance = 1e-27;
  for (const int quarter : {1, 2, 3, 4}) {
    const Rational t(3 * quarter);
    in_double.at.push_back(t.to_double());
    in_quad.at.push_back(t);
  }
  Diagnostics diagnostics;
  const auto run = simulate(m.model, m.equations, in_double, diagnostics);
  const auto right = simulate_extended(m.model, m.equations, in_quad, diagnostics);
  INFO(text);
  REQUIRE(run);
  REQUIRE(right);
  if (!run->ok() || !right->ok()) return;
  for (std::size_t k = 0; k < run->at.size(); ++k)
    for (std::size_t i = 0; i < m.system->coordinates.size(); ++i) {
      const State& s = run->at[k];
      const double off_q = distance(s.q[i], right->at[k].q[i]), off_v = distance(s.v[i], right->at[k].v[i]);
      if (!std::isnan(off_q)) count.add(s.errors->q[i], off_q);
      if (!std::isnan(off_v)) count.add(s.errors->v[i], off_v);
      if (off_q > s.errors->q[i] || off_v > s.errors->v[i])
        std::printf("not covered: coordinate %zu at %g: %.2g > %.2g or %.2g > %.2g in\n%s\n", i, s.t, off_q,
                    s.errors->q[i], off_v, s.errors->v[i], text.c_str());
    }
}

Count measure(int models, std::uint64_t first_seed, int least_unknowns, int most_unknowns) {
  Count count;
  for (int i = 0; i < models; ++i) {
    RandomModel random(first_seed + static_cast<std::uint64_t>(i));
    compare(random.text(least_unknowns + i % (most_unknowns - least_unknowns + 1), 12), count);
  }
  std::printf("%d to %d unknowns, %d models: %zu values, %zu saturated; covered %.3f %%, within a factor 100 %.2f %%\n",
              least_unknowns, most_unknowns, models, count.values, count.saturated, 100 * count.part_covered(),
              100 * count.part_within());
  return count;
}

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* const text = std::getenv(name);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

TEST_CASE("stated errors cover the true ones, seven companions side by side") {
  const auto models = static_cast<int>(from_environment("MAUP_CERTAIN_DIGITS", 24));
  const Count count = measure(models, from_environment("MAUP_CERTAIN_DIGITS_FROM", 1), 1, 4);
  CHECK(count.values > static_cast<std::size_t>(models));
  CHECK(count.part_covered() >= 0.999);
  CHECK(count.part_within() >= 0.9);
}

TEST_CASE("stated errors cover the true ones, three companions one after the other") {
  // 20 models give 880 values, and a share of 0.91 to a hundredth; with 8 it was read as anything from 0.89 to 0.93.
  const auto models = static_cast<int>(from_environment("MAUP_CERTAIN_DIGITS", 40)) / 2;
  const Count count = measure(models, 500'000 + from_environment("MAUP_CERTAIN_DIGITS_FROM", 1), 5, 6);
  CHECK(count.values > static_cast<std::size_t>(models));
  CHECK(count.part_covered() >= 0.999);
  CHECK(count.part_within() >= 0.9);
}

}  // namespace
}  // namespace maupertuis::property
