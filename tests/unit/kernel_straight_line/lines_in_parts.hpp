#pragma once
#include "evaluate_line.hpp"

#include "kernel/straight_line/widen.hpp"

#include <numeric>
#include <random>

/// A line of random sums in parts that are alike: each part has numbers of its own in arrays 0 and 2, reads some that
/// all parts know, and is added up by what belongs to none; then parts go on with that. Results go to array 1, and some
/// to array 3.
struct LineInParts {
  static constexpr std::uint32_t given = 64, stored = 40, factors = 128;
  maupertuis::straight::StraightLine line;
};

/// `odd`: one part has a term more.
inline LineInParts line_in_parts(unsigned seed, std::uint32_t parts, int length, bool odd = false) {
  using namespace maupertuis::straight;
  Builder to;
  LineInParts out;
  std::vector<Value> totals{to.given(0, 60), to.literal(0.25)};
  std::uint32_t store = 0;
  for (int round = 0; round < 2; ++round) {
    std::vector<Value> ends;
    for (std::uint32_t part = 1; part <= parts; ++part) {
      std::mt19937 random(seed + static_cast<unsigned>(round));  // the same for each part
      const auto bounded = [&](Value v) { return to.sum({{1, v}}, none, to.sum({{1, to.magnitudes({{1, v}})}, {1}})); };
      std::vector<Value> values{to.given(0, 7 * part), to.given(0, 7 * part + 1), totals[random() % totals.size()]};
      to.set_part(part);
      for (int i = 0; i < length; ++i) {
        const auto any = [&] {
          return values[values.size() - 1 - random() % std::min<std::size_t>(values.size(), 20)];
        };
        const auto factor = [&] {
          return to.given(2, (3 * static_cast<std::uint32_t>(i) + round) % 12 * parts + (5 * part) % parts);
        };
        std::vector<Term> terms{{1, factor(), any()}, {-1, any(), any()}, {0.5, any()}, {0.25}};
        if (odd && part == 2 && i == length / 2) terms.push_back({2, any()});
        const Value sum = random() % 4 ? to.sum(terms) : to.sum(terms, any(), to.larger(any(), to.literal(2)));
        values.push_back(bounded(sum));
      }
      to.check({to.magnitudes({{1, values.back()}}), to.larger(values[values.size() - 2], to.literal(1)), 1e-3});
      to.store(values.back(), 1, round * 20 + part), to.store(values[values.size() - 2], 3, store++);
      ends.push_back(values.back());
      to.set_part(0);
    }
    std::vector<Term> all;
    for (const Value end : ends) all.push_back({1, end, to.given(0, 61)});
    totals.push_back(to.sum(all));
    to.store(totals.back(), 1, round * 20);
  }
  out.line = to.finish(4, 1, 0);
  return out;
}

inline std::vector<std::vector<double>> arrays_of_parts() {
  std::vector<std::vector<double>> arrays{
      std::vector<double>(LineInParts::given), std::vector<double>(LineInParts::stored, 0.0),
      std::vector<double>(LineInParts::factors), std::vector<double>(LineInParts::stored, 0.0)};
  for (std::size_t i = 0; i < LineInParts::given; ++i) arrays[0][i] = std::sin(1.0 + static_cast<double>(i));
  for (std::size_t i = 0; i < LineInParts::factors; ++i) arrays[2][i] = std::cos(2.0 + static_cast<double>(i));
  return arrays;
}
