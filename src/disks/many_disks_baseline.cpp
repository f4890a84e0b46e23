#include "disks/many_disks_code.hpp"

std::unique_ptr<maupertuis::ManyDisks::Values> maupertuis::baseline_disks(const DiskPlan& plan) {
  return std::make_unique<OnLanes>(plan);
}
