#include "simulation/matched_times.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace maupertuis {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// For each of `few` the place in `many` of its own, ascending.
std::vector<std::size_t> places_in_order(std::span<const double> few, std::span<const double> many) {
  const std::size_t n = few.size(), skips = many.size() - n, width = skips + 1;
  // The least sum of differences of the first i when at most s of `many` are left out before the last of them, and
  // whether the one at s is left out.
  std::vector<double> sums(width, 0);
  std::vector<bool> left_out(n * width);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t s = 0; s < width; ++s) {
      sums[s] += std::abs(few[i] - many[i + s]);
      if (s == 0 || sums[s] < sums[s - 1]) continue;
      sums[s] = sums[s - 1];
      left_out[i * width + s] = true;
    }
  std::vector<std::size_t> out(n);
  for (std::size_t i = n, s = skips; i-- > 0;) {
    while (left_out[i * width + s]) --s;
    out[i] = i + s;
  }
  return out;
}

/// Of what is alone the nearer of the times beside it, where one comes behind.
void fill_gaps(std::span<const double> times, std::vector<double>& out) {
  double before = infinity, behind = infinity;
  std::vector<double> behinds(out.size());
  for (std::size_t i = out.size(); i-- > 0;) behinds[i] = behind = std::isfinite(out[i]) ? out[i] : behind;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (std::isfinite(out[i])) {
      before = out[i];
    } else if (std::isfinite(behinds[i])) {
      out[i] = std::abs(before - times[i]) < std::abs(behinds[i] - times[i]) ? before : behinds[i];
    }
  }
}

}  // namespace

std::vector<double> matched_times(std::span<const double> times, std::span<const double> others) {
  constexpr std::size_t most_steps = 5'000'000;
  std::vector<double> out(times.size(), infinity);
  const bool has_more = others.size() >= times.size();
  const std::span<const double> few = has_more ? times : others, many = has_more ? others : times;
  const bool one_by_one = few.size() * (many.size() - few.size() + 1) > most_steps;
  std::vector<std::size_t> places;
  if (!one_by_one) places = places_in_order(few, many);
  for (std::size_t i = 0; i < few.size(); ++i) {
    const std::size_t place = one_by_one ? i : places[i];
    out[has_more ? i : place] = has_more ? many[place] : few[i];
  }
  fill_gaps(times, out);
  return out;
}

}  // namespace maupertuis
