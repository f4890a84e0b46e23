#pragma once

/// Whether this is the build with sanitizers, where numbers take about ten times as long. They look at the code that is
/// run, not at its numbers: what runs the same code on one more model, amplitude or draw is left to `make test`.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool under_sanitizers = true;
#else
inline constexpr bool under_sanitizers = false;
#endif
