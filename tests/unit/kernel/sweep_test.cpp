#include "kernel/sparse/sweep.hpp"

#include <doctest/doctest.h>

#include <random>

// Substitutions in the order of the loops against their sums one after the other.

using namespace maupertuis::sparse;

namespace sweep_test {
namespace {

struct Case {
  std::vector<SweepSum> sums;
  std::vector<std::uint32_t> operands;
  std::vector<double> factors, inverse, x;
};

class Writer {
 public:
  explicit Writer(unsigned seed) : random_(seed) {}
  std::uint32_t cell() {
    out_.x.push_back(number());
    return static_cast<std::uint32_t>(out_.x.size() - 1);
  }
  std::uint32_t sum(bool starts, const std::vector<std::uint32_t>& operands) {
    const auto first = static_cast<std::uint32_t>(out_.operands.size());
    for (const std::uint32_t operand : operands) out_.operands.push_back(operand), out_.factors.push_back(number());
    out_.sums.push_back({cell(), static_cast<std::uint32_t>(out_.inverse.size()), first,
                         first + static_cast<std::uint32_t>(operands.size()), starts, false});
    out_.inverse.push_back(number());
    return out_.sums.back().target;
  }
  Case take() { return std::move(out_); }

 private:
  double number() { return std::uniform_real_distribution<double>(-0.6, 0.6)(random_); }
  std::mt19937 random_;
  Case out_;
};

/// Sides and joints of a chain, sums `beside` them that nothing reads, and a link that is unlike the others.
Case chain(std::size_t sides, std::size_t links, bool starts, bool beside) {
  Writer to(static_cast<unsigned>(sides * links));
  std::vector<std::uint32_t> side;
  for (std::size_t j = 0; j < sides; ++j) side.push_back(to.cell());
  std::uint32_t joint = to.cell();
  for (std::size_t i = 0; i < links; ++i) {
    std::vector<std::uint32_t> next(sides);
    for (std::size_t j = sides; j-- > 0;) next[j] = to.sum(starts, {side[j], joint});
    side = next;
    if (i == links / 2) std::swap(side.front(), side.back());
    if (beside) to.sum(false, {joint}), to.sum(true, side);
    joint = i == links - 3 ? to.sum(true, {}) : to.sum(true, side);
  }
  return to.take();
}

void check(const Case& c) {
  for (const bool divides : {false, true}) {
    std::vector<double> expected = c.x, x = c.x;
    for (const SweepSum& sum : c.sums) {
      double value = sum.starts ? expected[sum.target] : 0;
      for (std::uint32_t k = sum.first; k < sum.last; ++k) value -= c.factors[k] * expected[c.operands[k]];
      expected[sum.target] = divides ? value * c.inverse[sum.pivot] : value;
    }
    LoopSweep sweep(c.sums, c.operands);
    sweep.set(c.factors.data(), divides ? c.inverse.data() : nullptr);
    loops().sweep(sweep.tables(), x.data());
    for (std::size_t i = 0; i < x.size(); ++i) CHECK(x[i] == doctest::Approx(expected[i]).epsilon(1e-12));
  }
}

std::size_t recurrences(const Case& c) {
  const LoopSweep sweep(c.sums, c.operands);
  const SweepTables tables = sweep.tables();
  std::size_t out = 0;
  for (const SweepRun* run = tables.runs; run != tables.last_run; ++run) out += run->sides > 0;
  return out;
}

}  // namespace

TEST_CASE("recurrences of one to four sides, with sums beside them, broken off and begun again") {
  for (const std::size_t sides : {1, 2, 3, 4, 5})
    for (const bool starts : {false, true})
      for (const bool beside : {false, true}) {
        const Case c = chain(sides, 20, starts, beside);
        CHECK(recurrences(c) == (sides == 5 ? 0 : 1));
        check(c);
        check(chain(sides, 3, starts, beside));
      }
}

TEST_CASE("sums of any shape") {
  std::mt19937 random(3);
  for (unsigned trial = 0; trial < 50; ++trial) {
    Writer to(trial);
    std::vector<std::uint32_t> cells{to.cell(), to.cell(), to.cell()};
    for (int i = 0; i < 60; ++i) {
      std::vector<std::uint32_t> operands;
      for (unsigned k = 0; k < random() % 7; ++k)
        operands.push_back(cells[cells.size() - 1 - random() % std::min<std::size_t>(cells.size(), 9)]);
      cells.push_back(to.sum(random() % 3 != 0, operands));
    }
    check(to.take());
  }
}

}  // namespace sweep_test
