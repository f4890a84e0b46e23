#pragma once
#include <maupertuis/plot.hpp>

#include <string>

namespace maupertuis {

inline constexpr double radian_in_degrees = 57.295779513082323;

/// The content of a picture's own <style> element.
std::string own_style(PlotTheme theme);

/// The class of the curve number `index` of `count`, and where the palette does not reach, its colour.
std::string series_attributes(std::size_t index, std::size_t count);

/// Serif faces with mathematical letters, as systems have them; no face is loaded.
inline constexpr std::string_view serif_faces =
    "'STIX Two Text','Latin Modern Roman','Latin Modern Math','Cambria','Times New Roman','DejaVu Serif',serif";

}  // namespace maupertuis
