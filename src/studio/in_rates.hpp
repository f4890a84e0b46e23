#pragma once
#include "studio/shapes.hpp"

#include <maupertuis/study.hpp>

namespace maupertuis::studio {

/// The equations of motion in rates, as `maup derive` shows them where no form is asked for: where the model names
/// rates, or where the angular velocities of its bodies are shorter to read than `standard`. Null where they are not.
///
///     {"equations": [line], "definitions": [line], "check": {…} as in `certificate`}
Json equations_in_rates_json(Study& study, const ReportContent& standard);

}  // namespace maupertuis::studio
