#pragma once
#include <maupertuis/rational.hpp>

#include <optional>
#include <string>

namespace maupertuis::app {

/// A time of the command line in seconds: "3s", "250 ms", "-2 min"; a bare number is in seconds. Also a part of π of
/// these, "pi", "2 pi/3 ms". Nothing otherwise.
std::optional<double> parse_time(const std::string& text);
/// The same, exactly.
std::optional<Rational> parse_exact_time(const std::string& text);

/// Six significant digits, as messages show numbers.
std::string brief(double value);
/// The shortest number that reads back as the same.
std::string exact(double value);

}  // namespace maupertuis::app
