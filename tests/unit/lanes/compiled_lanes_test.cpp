#include "lane_systems.hpp"

#include <random>

// Compiled lanes against the reference interpreter, coefficient by coefficient; and against themselves at every width, to the bit.

namespace {

std::shared_ptr<const LaneExpansion> compiled(const Kernel& kernel, int width, CompileOptions options = {}) {
  options.cache = false;
  const CompiledLanes made = compiled_lanes(kernel, width, options);
  REQUIRE_MESSAGE(made.expansion, made.trouble);
  CHECK(made.expansion->backend() == "compiled");
  return made.expansion;
}

CompileOptions long_run(int expected_order) {
  CompileOptions options;
  options.long_run = true;
  options.order = expected_order;
  return options;
}

void check_same(const Expansion& found, const Expansion& expected) {
  CHECK(same_bits(found.quality, expected.quality));
  for (std::size_t i = 0; i < expected.coefficients.size(); ++i) CHECK(same_bits(found.coefficients[i], expected.coefficients[i]));
}

}  // namespace

TEST_CASE("every instruction, compiled, agrees with the reference interpreter; short and long code with each other to the bit") {
  for (const auto& system : systems()) {
    CAPTURE(system->name);
    const Kernel kernel = build_kernel(system->source);
    const auto motions = motions_near(system->start, 3);
    const Expansion found = expand(kernel, motions, compiled(kernel, 4));
    for (std::size_t i = 0; i < motions.size(); ++i) {
      CHECK(found.quality[i] > 1e-5);
      CHECK(found.quality[i] <= 1);
      check_against_reference(kernel, motions[i], found.coefficients[i], found.quality[i]);
    }
    // Stages up to an expected order are written out; beyond it they run in the loop again.
    check_same(expand(kernel, motions, compiled(kernel, 4, long_run(5))), found);
    if (system->name == "chain of 1" || system->name == "moving support")
      for (const int expected : {order, order + 7}) check_same(expand(kernel, motions, compiled(kernel, 4, long_run(expected))), found);
  }
}

TEST_CASE("compiled lanes give the same bits at every width") {
  for (const auto& system : systems()) {
    CAPTURE(system->name);
    const Kernel kernel = build_kernel(system->source);
    const auto motions = motions_near(system->start, 19);
    const Expansion expected = expand(kernel, motions, compiled(kernel, 1));
    for (const int width : widths) {
      CAPTURE(width);
      check_same(expand(kernel, motions, compiled(kernel, width)), expected);
    }
  }
}
