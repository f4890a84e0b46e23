#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/mechanical_system.hpp>

#include <span>

namespace maupertuis {

struct RunPlan;

/// E0735 where a coordinate rests at the start, nothing sets it in motion, and yet a force grows beside it as a power
/// below 1 of the displacement, away from the place: then there are motions that leave after any time (Norton's dome,
/// V = −⅔ g s^{3/2}, with s = 0 for ever and s = g² (t − T)⁴/144 from any T on). A force of that kind that draws back
/// is in order. By values of the accelerations at four displacements on each side.
bool start_has_one_motion(const Model& model, const EquationsOfMotion& equations, const RunPlan& plan,
                          Diagnostics& diagnostics);

}  // namespace maupertuis
