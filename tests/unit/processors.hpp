#pragma once
#include <doctest/doctest.h>

#include <initializer_list>
#include <string>
#include <vector>

/// Whether this processor runs code that is made for this level of x86-64: x86-64, x86-64-v2, x86-64-v3.
inline bool runs_code_for(const std::string& level) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  const bool second = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
  const bool third =
      second && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  return level == "x86-64" || (level == "x86-64-v2" && second) || (level == "x86-64-v3" && third);
#else
  return false;
#endif
}

/// Those of these levels whose code runs here; a word about each of the others. The name "" is this processor.
inline std::vector<std::string> levels_here(std::initializer_list<const char*> names) {
  std::vector<std::string> out;
  for (const char* const name : names)
    if (*name == '\0' || runs_code_for(name))
      out.emplace_back(name);
    else
      MESSAGE("skipped: this processor does not run code for ", name);
  return out;
}
