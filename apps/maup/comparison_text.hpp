#pragma once
#include <maupertuis/comparison.hpp>

#include <string>

namespace maupertuis::app {

/// On what ground the equations of two models are taken to agree: "proved (…)".
std::string ground_text(const Comparison& comparison);

}  // namespace maupertuis::app
