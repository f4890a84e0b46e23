#pragma once
#include "open_study.hpp"

#include <string>

namespace maupertuis::app {

/// The artifact of one stage as text: "syntax", "system", "equations", "program" or "jet" (`maup derive --emit`).
/// Empty when the model does not get that far.
std::string emit(const std::string& stage, Study& study);

}  // namespace maupertuis::app
