#pragma once
#include <maupertuis/extended.hpp>

namespace maupertuis::extended {

/// run_extended over one number type; each type is instantiated in a file of its own, since Boost is slow to compile.
template <class T>
ExtendedMotion run_motion(const ExtendedProblem& problem, const ExtendedOptions& options);

}  // namespace maupertuis::extended
