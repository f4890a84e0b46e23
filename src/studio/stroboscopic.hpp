#pragma once
#include <maupertuis/equations_of_motion.hpp>

#include <string>
#include <vector>

namespace maupertuis::studio {

/// Where a driven motion is cut once in a period, as sections are written, "sin(Ω t) = 0 rising": for each frequency of
/// the sines and cosines of t in the equations, where those with a common period are one. Empty where nothing depends
/// on t, and where a sine runs at a rate that changes.
std::vector<std::string> stroboscopic_sections(const EquationsOfMotion& equations);

}  // namespace maupertuis::studio
