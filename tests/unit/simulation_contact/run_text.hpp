#pragma once
#include <maupertuis/simulation.hpp>

#include "../model_text.hpp"

#include <doctest/doctest.h>

#include <string>

/// A run of a model in text that has to go well.
inline maupertuis::SimulationResult run_text(const std::string& text, double end) {
  ModelText m(text);
  maupertuis::SimulationOptions options;
  options.duration = end;
  options.errors = maupertuis::ErrorEstimates::None;
  auto result = maupertuis::simulate(m.model, m.equations, options, m.diagnostics);
  INFO(render(m.diagnostics, m.source));
  REQUIRE(result);
  INFO(result->reason);
  REQUIRE(result->ok());
  return std::move(*result);
}
