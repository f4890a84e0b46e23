#pragma once
#include "json.hpp"

#include <maupertuis/diagnostic.hpp>
#include <maupertuis/trajectory.hpp>

#include <map>
#include <span>
#include <string>

namespace maupertuis::app {

/// Where the formulas of columns stand among the texts of options.
using WrittenColumns = std::map<std::string, Span>;

/// A result holds numbers, or says that there is none. NaN or an infinity in it is a failure (E0816), and which one is
/// told: in a document by its place in it, in rows by column and time. False where one was found.
bool check_numbers(const Json& document, Diagnostics& diagnostics);
/// Reactions and errors that are not determined are NaN or infinite by their definition, and stay out of this; so do
/// columns of the names `open`. `further`: what is told beside it. `written`: where columns that are formulas of
/// options were written.
bool check_numbers(const Trajectory& rows, Diagnostics& diagnostics, std::span<const std::string> open = {},
                   const std::string& further = {}, const WrittenColumns& written = {});
/// The same of a picture: a formula that was asked for and has a value in some row leaves a gap where it has none
/// (N0819).
bool check_picture(const Trajectory& rows, Diagnostics& diagnostics, const WrittenColumns& written);
/// The columns that hold numbers alone, and those that may be open; with each that is left out goes the column of its
/// errors.
Trajectory columns_of_numbers(const Trajectory& rows, std::span<const std::string> open = {});

}  // namespace maupertuis::app
