// Compiled with AVX-512 where the compiler knows them (cmake/InstructionSets.cmake).
#if defined(__AVX512F__)
#include "disks/many_disks_code.hpp"

std::unique_ptr<maupertuis::ManyDisks::Values> maupertuis::avx512_disks(const DiskPlan& plan) {
  return std::make_unique<OnLanes>(plan);
}
#else
#include "disks/many_disks.hpp"

std::unique_ptr<maupertuis::ManyDisks::Values> maupertuis::avx512_disks(const DiskPlan&) { return nullptr; }
#endif
