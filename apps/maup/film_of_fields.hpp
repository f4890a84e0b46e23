#pragma once
#include "film_options.hpp"

namespace maupertuis::app {

/// A field in motion: u(x), or the plane in colours.
ExitCode animate_fields(AnimateOptions o, Study& study, Console& console);

}  // namespace maupertuis::app
