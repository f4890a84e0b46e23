#pragma once
#include <maupertuis/diagnostic.hpp>
#include <maupertuis/mechanical_system.hpp>
#include <maupertuis/tangent.hpp>

#include <optional>
#include <string>

/// What several analyses of this module have to refuse; each returns false, so that a caller can return it.
namespace maupertuis::orbits {

/// E1406: a length of time that is not positive.
bool refuse_no_time(const std::string& what, Diagnostics& diagnostics);
/// E1408: the motion itself does not go on.
bool refuse_end(double t, const std::string& reason, Diagnostics& diagnostics);
/// E1403: the tangent equations end at a jump.
bool refuse_jump(const TangentStop& stop, Diagnostics& diagnostics);

/// E1413: contacts that close and friction that sticks leave fewer directions than exponents were asked for.
bool refuse_vanishing(double t, std::size_t left, Diagnostics& diagnostics);

/// The duration that was asked for, or of the model's run (`run until` counts with its limit), s; nothing with E1406.
std::optional<double> length_of_run(const Model& model, std::optional<double> asked, Diagnostics& diagnostics);

}  // namespace maupertuis::orbits
