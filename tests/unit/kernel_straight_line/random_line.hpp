#pragma once
#include "kernel/straight_line/builder.hpp"

#include <algorithm>
#include <random>
#include <vector>

/// Sums of earlier nodes, of every kind, none of which leaves the numbers around 1.
inline maupertuis::straight::StraightLine random_line(unsigned seed, int length) {
  using namespace maupertuis;
  using namespace maupertuis::straight;
  std::mt19937 random(seed);
  Builder to;
  std::vector<Value> values;
  for (std::uint32_t i = 0; i < 6; ++i) values.push_back(to.given(0, i));
  const auto any = [&] { return values[values.size() - 1 - random() % std::min<std::size_t>(values.size(), 40)]; };
  const auto bounded = [&](Value v) { return to.sines({v})[0].first; };
  const auto factor = [&] { return std::vector<double>{1, -1, 0.5, -0.25}[random() % 4]; };
  for (int i = 0; i < length; ++i) switch (random() % 9) {
      case 0:
        values.push_back(
            bounded(to.sum({{factor(), any(), any()}, {factor(), any()}, {factor(), any(), any(), any()}})));
        break;
      case 1:
        values.push_back(bounded(to.sum({{factor(), any()}, {factor()}}, any(), to.sum({{1, any(), any()}, {2}}))));
        break;
      case 2:
        values.push_back(bounded(to.magnitudes({{factor(), any(), any()}, {factor(), any()}})));
        break;
      case 3:
        values.push_back(to.larger(any(), any()));
        break;
      case 4:
        values.push_back(to.choose(to.sum({{1, any()}, {-1, any()}}), any(), any()));
        break;
      case 5:
        values.push_back(bounded(to.root(to.sum({{1, any(), any()}, {3}}))));
        break;
      case 6:
        values.push_back(bounded(to.call(Kind::Exp, any())));
        break;
      case 7: {
        std::vector<Value> angles;
        for (unsigned k = 0; k <= random() % 8; ++k) angles.push_back(k < 6 && random() % 2 ? to.given(0, k) : any());
        for (const auto& [sine, cosine] : to.sines(angles)) values.push_back(sine), values.push_back(cosine);
        break;
      }
      default: {
        const Value wide =
            to.wide({{factor(), any(), none, to.unit(random() % 8)}, {factor(), none, none, to.unit(3)}});
        const Value next = to.wide({{0.5, any(), none, wide}, {factor(), any(), none, to.unit(5)}});
        values.push_back(bounded(to.lane(next, 3))), values.push_back(to.lane(next, random() % 8));
      }
    }
  for (std::uint32_t i = 0; i < 30; ++i) to.store(values[values.size() - 1 - 3 * i % values.size()], 1, i);
  to.check({to.larger(values.back(), values[2]), to.literal(1), 1e-3});
  to.require_finite(values.back());
  return to.finish(2, 8, values[values.size() / 2]);
}
