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
/// columns of the names `open`. `further`: what is told beside it.
bool check_numbers(const Trajectory& rows, Diagnostics& diagnostics, std::span<const std::string> open = {},
                   const std::string& further = {});
/// The columns that hold numbers alone, and those that may be open; with each that is left out goes the column of its
/// errors.
Trajectory columns_of_numbers(const Trajectory& rows, std::span<const std::string> open = {});

}  // namespace maupertuis::app
