#pragma once
#include "../model_text.hpp"

#include <maupertuis/verification.hpp>

#include <string>

/// Each form of an expectation passes just inside its tolerance and fails just outside.

inline maupertuis::Verification verify_text(const std::string& text,
                                            const maupertuis::SimulationOptions& options = {}) {
  const ModelText m(text);
  maupertuis::Diagnostics diagnostics;
  return maupertuis::verify(m.model, m.equations, m.source, options, diagnostics);
}

inline maupertuis::ExpectationResult only(const std::string& text, const maupertuis::SimulationOptions& options = {}) {
  const maupertuis::Verification v = verify_text(text, options);
  REQUIRE(v.results.size() == 1);
  return v.results.front();
}

inline void passes(const std::string& model, const std::string& line) {
  const auto r = only(model + line + "\n");
  INFO(line, ": ", r.actual, " | ", r.expected, " | ", r.message);
  CHECK(r.passed);
}

inline void fails(const std::string& model, const std::string& line) {
  const auto r = only(model + line + "\n");
  INFO(line, ": ", r.actual, " | ", r.expected, " | ", r.message);
  CHECK_FALSE(r.passed);
  CHECK_FALSE(r.message.empty());
}

/// `line` holds TOL where the tolerance stands; what comes out is off by `error`, in the unit of the tolerance.
inline void boundary(const std::string& model, const std::string& line, double error) {
  const auto with = [&](double tolerance) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%.9e", tolerance);
    std::string out = line;
    return out.replace(out.find("TOL"), 3, digits);
  };
  passes(model, with(1.01 * error));
  fails(model, with(0.99 * error));
}
