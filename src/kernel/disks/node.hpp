#pragma once
#include "kernel/program/program.hpp"

#include <maupertuis/disks.hpp>

namespace maupertuis {

/// An instruction, and the number that belongs to it.
struct Disks::Node {
  Instruction instruction;
  double exponent;  // Op::Power
};

}  // namespace maupertuis
