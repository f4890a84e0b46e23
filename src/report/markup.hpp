#pragma once
#include <maupertuis/math_markup.hpp>
#include <maupertuis/report.hpp>

#include <string>
#include <string_view>

namespace maupertuis {

/// "kg m^2/s" with raised exponents.
std::string unit_html(std::string_view unit);
/// 1.2e-15 as 1.2 × 10⁻¹⁵; other text as it is.
std::string number_html(std::string_view number);

/// A sentence: what stands between backquotes is code, names have their indices below the line.
std::string sentence_html(std::string_view sentence);

/// The model text with its comments and its statement words marked.
std::string model_html(std::string_view text);

}  // namespace maupertuis
