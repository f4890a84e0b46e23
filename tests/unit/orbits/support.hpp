#pragma once
#include "../model_text.hpp"

#include <maupertuis/orbits.hpp>

#include <cmath>
#include <numbers>
#include <string>

inline maupertuis::FloquetResult floquet_of(const ModelText& m, const maupertuis::FloquetOptions& options = {}) {
  maupertuis::Diagnostics diagnostics;
  auto result = maupertuis::floquet(m.model, m.equations, options, diagnostics);
  INFO(maupertuis::render(diagnostics, m.source));
  REQUIRE(result);
  return std::move(*result);
}

inline maupertuis::LyapunovResult lyapunov_of(const ModelText& m, const maupertuis::LyapunovOptions& options = {}) {
  maupertuis::Diagnostics diagnostics;
  auto result = maupertuis::lyapunov_exponents(m.model, m.equations, options, diagnostics);
  INFO(maupertuis::render(diagnostics, m.source));
  REQUIRE(result);
  CHECK(diagnostics.items().empty());
  return std::move(*result);
}

/// The code of the only diagnostic of an analysis that refuses.
template <class Analysis>
std::string code_of(Analysis analysis) {
  maupertuis::Diagnostics diagnostics;
  CHECK_FALSE(analysis(diagnostics));
  REQUIRE(diagnostics.items().size() == 1);
  return diagnostics.items().front().code;
}
