#pragma once
#include "../model_text.hpp"
#include "../under_sanitizers.hpp"

#include <maupertuis/action.hpp>

#include <cmath>
#include <numbers>
#include <string>

inline constexpr double pi = std::numbers::pi;

inline maupertuis::ActionEnds fixed_ends(std::vector<double> from, double start, std::vector<double> to, double end) {
  maupertuis::ActionEnds out;
  for (const double x : from) out.from.emplace_back(x);
  for (const double x : to) out.to.emplace_back(x);
  out.start = start;
  out.end = end;
  return out;
}

inline maupertuis::PathSearch paths_of(const ModelText& m, const maupertuis::ActionEnds& ends,
                                       maupertuis::ActionOptions options = {}) {
  maupertuis::Diagnostics diagnostics;
  auto result = maupertuis::stationary_paths(m.model, m.equations, ends, options, diagnostics);
  INFO(maupertuis::render(diagnostics, m.source));
  REQUIRE(result);
  CHECK(diagnostics.items().empty());
  return std::move(*result);
}

inline std::string code_of_search(const ModelText& m, const maupertuis::ActionEnds& ends) {
  maupertuis::Diagnostics diagnostics;
  CHECK_FALSE(maupertuis::stationary_paths(m.model, m.equations, ends, {}, diagnostics));
  REQUIRE(diagnostics.items().size() == 1);
  return diagnostics.items().front().code;
}
