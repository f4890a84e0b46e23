#pragma once
#include "json.hpp"

#include <maupertuis/trajectory.hpp>

#include <span>
#include <string>

namespace maupertuis::app {

/// A result holds numbers, or says that there is none. NaN or an infinity in it is a failure (E0816), and which one is
/// told: in a document by its place in it, in rows by column and time. False where one was found.
bool check_numbers(const Json& document, Diagnostics& diagnostics);
/// Reactions and errors that are not determined are NaN or infinite by their definition, and stay out of this; so do
/// columns of the names `open`.
bool check_numbers(const Trajectory& rows, Diagnostics& diagnostics, std::span<const std::string> open = {});

}  // namespace maupertuis::app
