#pragma once

namespace maupertuis {

/// Ends the program: a precondition that a caller promised does not hold. Not for mistakes of the user.
[[noreturn]] void requirement_failed(const char* condition, const char* file, int line);

}  // namespace maupertuis

/// An assert that stays on in release builds.
#define MAUP_REQUIRE(condition) \
  ((condition) ? static_cast<void>(0) : ::maupertuis::requirement_failed(#condition, __FILE__, __LINE__))
