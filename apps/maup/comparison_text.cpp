#include "comparison_text.hpp"

#include <fmt/format.h>

namespace maupertuis::app {

std::string ground_text(const Comparison& comparison) {
  using Parameters = Comparison::Parameters;
  const ZeroTest& test = comparison.ground;
  std::string text;
  if (test.points == 0)
    text = "proved (the equations are one expression)";
  else if (test.error_bound < 1 && test.error_bound >= 1e-6)
    text = fmt::format("holds at {} random points, error bound {:.1e}", test.points, test.error_bound);
  else if (test.error_bound < 1)
    text = fmt::format("proved (at {} random points, error bound {:.1e})", test.points, test.error_bound);
  else
    text = fmt::format("holds to 60 digits at {} states of the second model", test.points);
  if (comparison.parameters == Parameters::TheseAlone) text += ", for these values of the parameters alone";
  if (comparison.parameters == Parameters::NearThese) text += ", for parameters near these values";
  return text;
}

}  // namespace maupertuis::app
