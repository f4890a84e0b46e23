#pragma once
#include "kernel/program/program.hpp"
#include "machine_code/backend.hpp"
#include "machine_code/digest.hpp"

#include <maupertuis/kernel.hpp>

/// Machine code of a program: what it depends on, and how its compilation went.
namespace maupertuis {

/// Everything of a program that code made from it depends on; names are left out.
machine_code::Digest digest_of(const Program& program);

CompileReport report_of(const machine_code::Compiled& made);

}  // namespace maupertuis
