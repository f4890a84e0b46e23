#pragma once
#include "kernel/disks/many_disks.hpp"
#include "kernel/disks/roundings.hpp"
#include "kernel/disks/values.hpp"

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
