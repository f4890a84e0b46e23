#pragma once
/// Whether sanitizers watch. What computes numbers for minutes then and goes through no code that others do not go through
/// runs without them alone: TEST_CASE("…" * doctest::skip(sanitized)).
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif
