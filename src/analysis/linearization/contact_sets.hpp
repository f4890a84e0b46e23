#pragma once
#include <maupertuis/linearization.hpp>

#include <vector>

namespace maupertuis {

/// Sets of closed contacts, those in which rest is looked for.
struct ContactSets {
  std::vector<std::vector<bool>> chosen;  // [contacts] each
  double all = 1;                         // how many there are
};

/// All of them where there are at most 64, the smaller ones first. Of more contacts 64: those that touch at the start,
/// those that touch where the potential is lowest, downhill from there, all together, then the smaller ones.
ContactSets contact_sets(const MechanicalSystem& system, const MotionState& start);

}  // namespace maupertuis
