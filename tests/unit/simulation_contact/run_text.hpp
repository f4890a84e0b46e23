#pragma once
#include <maupertuis/simulation.hpp>

#include "../model_text.hpp"

#include <doctest/doctest.h>

#include <algorithm>
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

/// The same, which need not go well.
inline maupertuis::SimulationResult run(ModelText& m, double end, maupertuis::SimulationOptions options = {}) {
  options.duration = end;
  options.errors = maupertuis::ErrorEstimates::None;
  auto result = maupertuis::simulate(m.model, m.equations, options, m.diagnostics);
  INFO(render(m.diagnostics, m.source));
  REQUIRE(result);
  return std::move(*result);
}

inline std::size_t count(const maupertuis::SimulationResult& r, maupertuis::Happening::Kind kind,
                         const std::string& name = {}) {
  return static_cast<std::size_t>(std::count_if(
      r.happenings.begin(), r.happenings.end(),
      [&](const maupertuis::Happening& h) { return h.kind == kind && (name.empty() || h.name == name); }));
}
