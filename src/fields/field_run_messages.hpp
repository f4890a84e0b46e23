#pragma once
#include "fields/field_method.hpp"
#include "fields/semi_discrete.hpp"

#include <maupertuis/field_run.hpp>

#include <vector>

/// What a run of fields says of its model before it begins, or where it cannot go on.
namespace maupertuis {

/// By `mesh.trouble()`: why it cannot begin or go on.
void refuse_mesh(const FieldMotion& mesh, const FieldEquations& equations, Diagnostics& diagnostics);
void refuse_infinite_density(const FieldEquations& equations, Diagnostics& diagnostics);
/// E0649 before anything of a mesh is made that the machine has no room for.
bool refuse_large_mesh(const FieldEquations& equations, const FieldMethod& method, const Cells& cells,
                       Diagnostics& diagnostics);
/// E0705: rows of values at so many places, or moments at which steps end, that do not fit into memory.
bool refuse_too_many_rows(const FieldEquations& equations, const FieldRunOptions& options,
                          const std::vector<std::vector<double>>& rows, Diagnostics& diagnostics);
/// What a mesh of more than a gigabyte takes is said before it is made.
void announce_memory(const FieldRunOptions& options, double bytes);
/// W0646: the end of the mesh is put to its condition, and what the start says beside it runs in as a wave.
void warn_of_clashes(const std::vector<FieldMotion::StartClash>& clashes, const FieldEquations& equations,
                     Diagnostics& diagnostics);
/// N0662: fields without inertia that begin at rest, and so otherwise than written.
void tell_moved_starts(const std::vector<SemiDiscrete::MovedStart>& moved, const FieldEquations& equations,
                       Diagnostics& diagnostics);
/// W0650: what acts for less than a step; whether there is such.
bool warn_of_short_action(const FieldEquations& equations, const std::vector<double>& switching, double step,
                          const FieldRunOptions& options, Diagnostics& diagnostics);
/// N0648: what no equation says of a potential.
void tell_what_is_fixed(const FieldMotion& mesh, const FieldEquations& equations, Diagnostics& diagnostics);

}  // namespace maupertuis
