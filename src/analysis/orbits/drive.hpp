#pragma once
#include "analysis/orbits/survey.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/motion_kernel.hpp>

#include <array>
#include <optional>
#include <vector>

namespace maupertuis::orbits {

/// Whether the equations of motion, the constraints, the contacts or the friction are others at another time.
bool depends_on_time(const EquationsOfMotion& equations);

/// Whether the motion keeps h_E: its equations do, and there are neither friction, nor restitution below 1, nor
/// contacts that move, nor events that set the state.
bool keeps_energy(const Model& model, const EquationsOfMotion& equations);

/// Whether a bounce on any of its contacts loses velocity, so that bouncing ends.
bool bounces_end(const MechanicalSystem& system);

/// The common period of the sines and cosines of t in the equations, if t stands in their arguments linearly and they
/// have one. s
std::optional<double> period_of_drive(const EquationsOfMotion& equations);

/// Whether the accelerations, the gaps and the slip velocities at the states of a motion and beside them are the same
/// when t is later by `period`, and when coordinate i is larger by 2π: to rounding.
bool repeats_in_time(const MechanicalSystem& system, const MotionKernel& motion, const Survey& seen, double period,
                     int periods);
/// Whether t stands in sines and cosines alone: then what repeats over some periods repeats for ever. A switch of t may
/// stand still for longer than the period that is asked for, and a pulse come late.
bool stands_in_waves_alone(const EquationsOfMotion& equations);
bool repeats_in_angle(const MechanicalSystem& system, const MotionKernel& motion, const Survey& seen,
                      std::size_t coordinate);

/// Whether the equations are the same at −q as at q, as they are for a body that nothing but its orientation acts on.
bool repeats_with_other_sign(const MechanicalSystem& system, const MotionKernel& motion, const Survey& seen,
                             const std::array<std::size_t, 4>& quaternion);

}  // namespace maupertuis::orbits
