// Compiled with AVX2 and FMA where the compiler knows them (cmake/InstructionSets.cmake).
#if defined(__AVX2__) && defined(__FMA__)
#include "disks/many_disks_code.hpp"

std::unique_ptr<maupertuis::ManyDisks::Values> maupertuis::avx2_disks(const DiskPlan& plan) {
  return std::make_unique<OnLanes>(plan);
}
#else
#include "disks/many_disks.hpp"

std::unique_ptr<maupertuis::ManyDisks::Values> maupertuis::avx2_disks(const DiskPlan&) { return nullptr; }
#endif
