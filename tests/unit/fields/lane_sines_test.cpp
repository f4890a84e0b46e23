#include "fields/lane_sines.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace maupertuis;

namespace {

/// The largest difference to the standard library, whose sines are right to half a unit of the last place or so.
double worst(const std::vector<double>& x) {
  std::vector<double> sine(x.size()), cosine(x.size());
  set_sines(sine.data(), x.data(), x.size(), false);
  set_sines(cosine.data(), x.data(), x.size(), true);
  double out = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    out = std::max({out, std::abs(sine[i] - std::sin(x[i])), std::abs(cosine[i] - std::cos(x[i]))});
  return out;
}

}  // namespace

TEST_CASE("sines of lanes: everywhere, next to multiples of π/2, far out") {
  std::mt19937_64 random(5);
  for (const double size : {1e-3, 1.0, 10.0, 1e3, 9.9e5, 1e7}) {
    std::uniform_real_distribution<double> uniform(-size, size);
    std::vector<double> x(4099);
    for (double& v : x) v = uniform(random);
    CAPTURE(size);
    CHECK(worst(x) < 4e-16);
  }
  std::vector<double> near;
  for (int k = -600; k <= 600; ++k)
    for (const double beside : {0.0, 1e-9, -1e-9, 0.78539816339, -0.78539816340})
      near.push_back(k * 1.5707963267948966192 + beside);
  CHECK(worst(near) < 4e-16);
}

TEST_CASE("sines of lanes keep zero, its sign, and what is no number") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  const std::vector<double> x{0.0, -0.0, 1e-300, nan, infinite, 1.0};
  std::vector<double> out(x.size());
  set_sines(out.data(), x.data(), 3, false);
  CHECK(out[0] == 0);
  CHECK(out[2] == 1e-300);
  set_sines(out.data(), x.data(), x.size(), false);
  CHECK(std::isnan(out[3]));
  CHECK(std::isnan(out[4]));
  CHECK(out[5] == std::sin(1.0));
}
