#pragma once
#include "kernel/sparse/lifted_system.hpp"

/// Parts of a system that are eliminated side by side, a lane of a vector each. The coordinates of a chain, or of any strip, stand in
/// levels by their distance from an end; single levels separate parts of equal length, and what lies at the ends belongs to no part.
/// Whether parts are alike shows in what is written down of their elimination (straight::widen).
namespace maupertuis::sparse {

/// The nearest coordinate of each column, in the graph whose edges are the entries between the columns that rows belong to.
std::vector<std::uint32_t> nearest_coordinates(const LiftedSystem& system);

/// [parts][turns] coordinates, in the order in which a part is eliminated; no parts where what separates them takes longer than they save.
/// `first`: the coordinate at the end where the elimination begins.
std::vector<std::vector<std::uint32_t>> cut_into_parts(const LiftedSystem& system, std::uint32_t first);

}  // namespace maupertuis::sparse
