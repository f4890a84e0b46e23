#pragma once
#include "disks/many_disks.hpp"
#include "disks/roundings.hpp"
#include "disks/values.hpp"

namespace maupertuis {

struct Disks::Parts {
  DiskPlan plan;
  DiskValues<double> one;
  std::unique_ptr<ManyDisks> many;  // where the residual has bases
  FormulaRoundings roundings;

  Parts(const Program& program, std::span<const std::uint32_t> slots)
      : plan(program, slots), one(plan), roundings(plan) {}
};

}  // namespace maupertuis
