#include "../processors.hpp"
#include "lane_systems.hpp"

// Compiled lanes against the reference interpreter, coefficient by coefficient; and against themselves at every width,
// to the bit.

namespace {

std::shared_ptr<const LaneExpansion> compiled(const Kernel& kernel, int width, CompileOptions options = {}) {
  options.cache = false;
  const CompiledLanes made = compiled_lanes(kernel, width, options);
  REQUIRE_MESSAGE(made.expansion, made.trouble);
  CHECK(made.expansion->backend() == "compiled");
  return made.expansion;
}

CompileOptions long_run() {
  CompileOptions options;
  options.long_run = true;
  return options;
}

void check_same(const Expansion& found, const Expansion& expected) {
  CHECK(same_bits(found.quality, expected.quality));
  for (std::size_t i = 0; i < expected.coefficients.size(); ++i)
    CHECK(same_bits(found.coefficients[i], expected.coefficients[i]));
}

}  // namespace

/// The interpreter of lanes shares nothing with the emitter but the program and the sums of lanes::Plan.
void check_against_interpreter(const Kernel& kernel, const std::vector<Motion>& motions, const Expansion& found) {
  const Expansion expected = expand(kernel, motions, 1, InstructionSet::Best);
  const std::size_t n = kernel.freedoms();
  for (std::size_t i = 0; i < motions.size(); ++i)
    for (std::size_t k = 0; k <= order + 1; ++k) {
      double size = 1;
      for (std::size_t j = 0; j < n; ++j) size = std::max(size, std::abs(expected.coefficients[i][k * n + j]));
      for (std::size_t j = 0; j < n; ++j) {
        CAPTURE(k);
        CHECK(std::abs(found.coefficients[i][k * n + j] - expected.coefficients[i][k * n + j]) <=
              1e-13 * static_cast<double>(k + 1) * size);
      }
    }
}

TEST_CASE(
    "random programs: compiled lanes agree with interpreted ones and the reference, and with each other at every width "
    "to the bit") {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    CAPTURE(seed);
    System s;
    make_random(s, seed);
    const Kernel kernel = build_kernel(s.source);
    const auto motions = motions_near(s.start, 5);
    const Expansion found = expand(kernel, motions, compiled(kernel, 4));
    check_against_interpreter(kernel, motions, found);
    for (std::size_t i = 0; i < motions.size(); ++i)
      check_against_reference(kernel, motions[i], found.coefficients[i], found.quality[i]);
    // Where a value takes several registers, LLVM's time grows as the square of the program: two short ones are wide
    // enough.
    if (seed != 3 && seed != 6) continue;
    check_same(expand(kernel, motions, compiled(kernel, 1)), found);
    check_same(expand(kernel, motions, compiled(kernel, 8)), found);
    check_same(expand(kernel, motions, compiled(kernel, 16)), found);
  }
}

TEST_CASE("other processors: without AVX-512 the same bits, without fused products the same to rounding") {
  for (const unsigned seed : {3u, 5u}) {
    System s;
    make_random(s, seed);
    const Kernel kernel = build_kernel(s.source);
    const auto motions = motions_near(s.start, 3);
    const auto on = [&](const std::string& processor) {
      CompileOptions options;
      options.processor = processor;
      return expand(kernel, motions, compiled(kernel, 4, options));
    };
    if (has_instruction_set(InstructionSet::Avx2))
      check_same(on("x86-64-v3"), expand(kernel, motions, compiled(kernel, 4)));
    for (const std::string& level : levels_here({"x86-64-v2"})) check_against_interpreter(kernel, motions, on(level));
  }
}

TEST_CASE("every instruction, compiled, agrees with the reference interpreter") {
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
    // What LLVM does more where code runs long changes no bit.
    check_same(expand(kernel, motions, compiled(kernel, 4, long_run())), found);
  }
}

TEST_CASE("orders beyond the table of reciprocals are left to the reference, which a low quality asks for") {
  const auto system = std::move(systems().front());
  const Kernel kernel = build_kernel(system->source);
  for (const auto& [beyond, finds] : {std::pair{124, true}, {125, false}}) {
    LaneWorkspace work(kernel, beyond, compiled(kernel, 2));
    for (int lane = 0; lane < 2; ++lane) place(work, lane, system->start);
    work.expand();
    for (int lane = 0; lane < 2; ++lane) CHECK((work.quality()[lane] > 0) == finds);
  }
}

TEST_CASE("compiled lanes give the same bits at every width") {
  for (const auto& system : systems()) {
    CAPTURE(system->name);
    const Kernel kernel = build_kernel(system->source);
    const auto motions = motions_near(system->start, 19);
    const Expansion expected = expand(kernel, motions, compiled(kernel, 1));
    for (const int width : widths) {
      if (width > 4 && kernel.freedoms() > 3) continue;  // nothing new is in them, and LLVM is slow
      CAPTURE(width);
      check_same(expand(kernel, motions, compiled(kernel, width)), expected);
    }
  }
}

/// One motion: the expansion as a whole in code, or in rolled code, against the interpreter of packs.
void check_compiled_workspace(const System& s, const Kernel& kernel, bool as_a_whole,
                              const std::string& processor = {}) {
  KernelWorkspace work = compiled_workspace(kernel, order, as_a_whole, processor);
  const auto interpreted = expand(kernel, motions_near(s.start, 5), 1, InstructionSet::Best);
  std::size_t index = 0;
  for (const Motion& m : motions_near(s.start, 5)) {
    work.set_parameters(m.parameters);
    REQUIRE(work.expand(m.t, m.q, m.v) == KernelStatus::Ok);
    std::vector<double> found;
    for (int k = 0; k <= order + 1; ++k)
      found.insert(found.end(), work.coordinate(k), work.coordinate(k) + kernel.freedoms());
    // The sums run in other orders, and 1/k is a product.
    check_against_reference(kernel, m, found, interpreted.quality[index++] / 4);
  }
}

TEST_CASE("one motion compiled: every instruction agrees with the interpreter") {
  for (const bool as_a_whole : {true, false}) {
    CAPTURE(as_a_whole);
    for (const auto& s : systems()) {
      CAPTURE(s->name);
      check_compiled_workspace(*s, build_kernel(s->source), as_a_whole);
      if (s->name == "friction")  // no fused products
        for (const std::string& level : levels_here({"x86-64-v2"}))
          check_compiled_workspace(*s, build_kernel(s->source), as_a_whole, level);
    }
    for (unsigned seed = 1; seed <= 4; ++seed) {
      CAPTURE(seed);
      System s;
      make_random(s, seed);
      check_compiled_workspace(s, build_kernel(s.source), as_a_whole);
    }
  }
}
