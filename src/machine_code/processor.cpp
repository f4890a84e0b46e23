#include "machine_code/processor.hpp"

#include <maupertuis/vector_instructions.hpp>

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace maupertuis {
namespace {

VectorInstructions of_processor() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return VectorInstructions::None;
  const bool widest =
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  return widest ? VectorInstructions::Avx512 : VectorInstructions::Avx2;
#else
  return VectorInstructions::None;
#endif
}

std::string_view wanted() {
  const char* const text = std::getenv("MAUPERTUIS_INSTRUCTIONS");
  return text ? text : "";
}

VectorInstructions allowed() {
  const std::string_view most = wanted();
  return most == "none"   ? VectorInstructions::None
         : most == "avx2" ? VectorInstructions::Avx2
                          : VectorInstructions::Avx512;
}

}  // namespace

VectorInstructions vector_instructions() {
  static const VectorInstructions used = std::min(of_processor(), allowed());
  return used;
}

std::string unknown_vector_instructions() {
  const std::string_view word = wanted();
  const bool known = word.empty() || word == "none" || word == "avx2" || word == "avx512";
  return known ? std::string() : std::string(word);
}

const char* code_processor() {
  static const bool held_back = vector_instructions() < of_processor();
  if (!held_back) return "";
  return vector_instructions() == VectorInstructions::Avx2 ? "x86-64-v3" : "x86-64";
}

}  // namespace maupertuis
