#include "kernel/sparse/sweep.hpp"

#include <doctest/doctest.h>

#include <random>

// Substitutions in the order of the loops against their sums one after the other.

using namespace maupertuis::sparse;

namespace {

struct Case {
  std::vector<SweepSum> sums;
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
    SweepSum sum{cell(), static_cast<std::uint32_t>(out_.inverse.size()), starts, {}};
    out_.inverse.push_back(number());
    for (const std::uint32_t operand : operands) {
      sum.products.push_back({operand, static_cast<std::uint32_t>(out_.factors.size())});
      out_.factors.push_back(number());
    }
    out_.sums.push_back(sum);
    return sum.target;
  }
  Case take() { return std::move(out_); }

 private:
  double number() { return std::uniform_real_distribution<double>(-0.6, 0.6)(random_); }
  std::mt19937 random_;
  Case out_;
};

/// As of a chain: branches and hubs, `side` sums that nothing reads, and a period that is unlike the others.
Case chain(std::size_t branches, std::size_t periods, bool starts, bool side) {
  Writer to(static_cast<unsigned>(branches * periods));
  std::vector<std::uint32_t> branch;
  for (std::size_t j = 0; j < branches; ++j) branch.push_back(to.cell());
  std::uint32_t hub = to.cell();
  for (std::size_t i = 0; i < periods; ++i) {
    std::vector<std::uint32_t> next(branches);
    for (std::size_t j = branches; j-- > 0;) next[j] = to.sum(starts, {branch[j], hub});
    branch = next;
    if (i == periods / 2) std::swap(branch.front(), branch.back());
    if (side) to.sum(false, {hub}), to.sum(true, branch);
    hub = i == periods - 3 ? to.sum(true, {}) : to.sum(true, branch);
  }
  return to.take();
}

void check(Case c) {
  for (const bool divides : {false, true}) {
    std::vector<double> expected = c.x, x = c.x;
    for (const SweepSum& sum : c.sums) {
      double value = sum.starts ? expected[sum.target] : 0;
      for (const SweepSum::Product& p : sum.products) value -= c.factors[p.factor] * expected[p.operand];
      expected[sum.target] = divides ? value * c.inverse[sum.pivot] : value;
    }
    LoopSweep sweep(c.sums, divides);
    sweep.set(c.factors.data(), c.inverse.data());
    loops().sweep(sweep.tables(), x.data());
    for (std::size_t i = 0; i < x.size(); ++i) CHECK(x[i] == doctest::Approx(expected[i]).epsilon(1e-12));
  }
}

std::size_t spines(const Case& c) {
  const LoopSweep sweep(c.sums, true);
  const SweepTables tables = sweep.tables();
  std::size_t out = 0;
  for (const SweepRun* run = tables.runs; run != tables.last_run; ++run) out += run->branches > 0;
  return out;
}

}  // namespace

TEST_CASE("spines of one to four branches, with sums beside them, broken off and begun again") {
  for (const std::size_t branches : {1, 2, 3, 4, 5})
    for (const bool starts : {false, true})
      for (const bool side : {false, true}) {
        const Case c = chain(branches, 20, starts, side);
        CHECK(spines(c) == (branches == 5 ? 0 : 1));
        check(c);
        check(chain(branches, 3, starts, side));
      }
}

TEST_CASE("sums of any shape") {
  std::mt19937 random(3);
  for (unsigned trial = 0; trial < 50; ++trial) {
    Writer to(trial);
    std::vector<std::uint32_t> cells{to.cell(), to.cell(), to.cell()};
    for (int i = 0; i < 60; ++i) {
      std::vector<std::uint32_t> operands;
      for (unsigned k = 0; k < random() % 7; ++k) operands.push_back(cells[cells.size() - 1 - random() % std::min<std::size_t>(cells.size(), 9)]);
      cells.push_back(to.sum(random() % 3 != 0, operands));
    }
    check(to.take());
  }
}
