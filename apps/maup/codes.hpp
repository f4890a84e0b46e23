#pragma once
#include <maupertuis/diagnostic.hpp>

#include <span>

namespace maupertuis::app {

/// The catalogue of every message of this program, by code: those of the stages and those of the command line.
std::span<const CodeEntry> all_codes();

}  // namespace maupertuis::app
