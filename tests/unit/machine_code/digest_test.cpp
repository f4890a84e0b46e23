#include "kernel/program/code.hpp"

#include <doctest/doctest.h>
#include <maupertuis/kernel.hpp>

#include <set>

using namespace maupertuis;
using namespace maupertuis::machine_code;

namespace {

Kernel oscillator(Context& context, std::int64_t stiffness) {
  KernelSource source;
  const Expr q = context.symbol("q", Role::Coordinate);
  source.coordinates = {q};
  source.residual = {context.symbol("q", Role::Coordinate, 2) + Rational(stiffness) * sin(q)};
  return build_kernel(source);
}

}  // namespace

TEST_CASE("programs that differ in a number differ in their digest, names do not count") {
  Context context;
  const Digest digest = digest_of(oscillator(context, 3).program());
  CHECK((digest_of(oscillator(context, 3).program()) == digest));
  Program renamed = oscillator(context, 3).program();
  renamed.coordinate_names = {"θ"};
  CHECK((digest_of(renamed) == digest));
  CHECK(!(digest_of(oscillator(context, 4).program()) == digest));
}

TEST_CASE("every field of a program counts") {
  Context context;
  const Kernel kernel = oscillator(context, 3);
  const Program& original = kernel.program();
  std::set<std::string> seen{digest_of(original).hex()};
  const auto change = [&](auto&& f) {
    Program program = original;
    f(program);
    CHECK(seen.insert(digest_of(program).hex()).second);
  };
  change([](Program& p) { p.instructions[0].out += 1; });
  change([](Program& p) { p.instructions[0].lag += 1; });
  change([](Program& p) { p.instructions.back().op = Op::Select; });
  change([](Program& p) { p.terms.back().shift += 1; });
  change([](Program& p) { p.terms.back().a += 1; });
  change([](Program& p) { p.constants.push_back({}); });
  change([](Program& p) { p.runs[Dynamics].pop_back(); });
  change([](Program& p) { p.slots += 1; });
  change([](Program& p) { p.stored_end[1] += 1; });
  change([](Program& p) { p.tangent_lags[0] += 1; });
  change([](Program& p) { p.first_stage -= 1; });
  change([](Program& p) { p.unknowns += 1; });
  change([](Program& p) { p.residual[0] += 1; });
}

TEST_CASE("texts of equal beginning, length apart, differ") {
  std::set<std::string> seen;
  const std::string zeros(40, '\0');
  for (std::size_t n = 0; n <= zeros.size(); ++n)
    CHECK(seen.insert(digest_of(std::span(zeros.data(), n)).hex()).second);
}
