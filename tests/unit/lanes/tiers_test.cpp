// Code in two tiers, and the observables that it has in itself.
#include "kernel/workspace/code_tiers.hpp"
#include "lane_systems.hpp"

#include <doctest/doctest.h>
#include <cstring>

using namespace maupertuis;

namespace {

constexpr int order_of_tiers = 14;

KernelWorkspace tiered_workspace(const Kernel& kernel, bool in_tiers) {
  KernelWorkspace work(kernel, order_of_tiers);
  const CompileReport report = work.compile({.cache = false, .long_run = true, .in_tiers = in_tiers, .processor = {}});
  REQUIRE_MESSAGE(report.compiled, report.trouble);
  CHECK(report.is_final == !in_tiers);
  return work;
}

void expand_at(KernelWorkspace& work, const Motion& m) {
  work.set_parameters(m.parameters);
  REQUIRE(work.expand(m.t, m.q, m.v) == KernelStatus::Ok);
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Terms of an energy, a place, something with t and something that no stage needs.
void add_observables(System& s) {
  const std::vector<Expr> q = s.source.coordinates;
  Expr sum = q[0], squares = pow(s.dot(q[0]), 2);
  for (std::size_t i = 1; i < q.size(); ++i)
    sum = sum + Rational(static_cast<long>(i) + 1) * q[i], squares = squares + pow(s.dot(q[i]), 2) * cos(q[i]);
  s.source.observables = {squares,
                          sin(q[0]) + cos(sum),
                          pow(sum, 3) / (squares + Rational(4)),
                          sqrt(squares + Rational(2)),
                          apply(Kind::Exp, -sum) * s.context.time(),
                          apply(Kind::Cosh, q[0]),
                          q[0],
                          s.dot(s.dot(q[0])) * cos(sum)};
}

}  // namespace

TEST_CASE("code in tiers: quickly compiled and with all passes, equal to the bit") {
  Systems list;
  for (const int links : {1, 2, 3, 5, 8}) add_chain(list, links);
  add_driven(list), add_mixed_angles(list);
  add_function(list, "quotient", 0.6, [](Expr u) { return sin(u) / (u + Rational(2)); });
  for (const auto& s : list) {
    CAPTURE(s->name);
    const Kernel kernel = build_kernel(s->source);
    KernelWorkspace quick = tiered_workspace(kernel, true), whole = tiered_workspace(kernel, false);
    for (const Motion& m : motions_near(s->start, 3)) {
      expand_at(quick, m), expand_at(whole, m);
      for (int k = 0; k <= order_of_tiers + 1; ++k)
        for (std::size_t i = 0; i < kernel.freedoms(); ++i)
          CHECK(same_bits(quick.coordinate(k)[i], whole.coordinate(k)[i]));
      CHECK(same_bits(quick.radius(0.1), whole.radius(0.1)));
    }
  }
}

TEST_CASE("code in tiers: the second follows the first without a change of a bit") {
  Systems list;
  add_chain(list, 2);
  const System& s = *list[0];
  const Kernel kernel = build_kernel(s.source);
  const Motion m = motions_near(s.start, 2)[1];
  KernelWorkspace work = tiered_workspace(kernel, true);
  expand_at(work, m);
  std::vector<double> first(work.coordinate(order_of_tiers), work.coordinate(order_of_tiers) + 2);
  const PolynomialIncrements* const increments = work.polynomials().increments;
  bool has_changed = false;
  for (int i = 0; i < 20'000'000 && !has_changed; ++i) {
    expand_at(work, m);
    has_changed = work.polynomials().increments != increments;
  }
  CHECK(has_changed);
  CHECK(same_bits(work.coordinate(order_of_tiers)[0], first[0]));
  CHECK(same_bits(work.coordinate(order_of_tiers)[1], first[1]));
}

TEST_CASE("straight-line code has the observables") {
  Systems list;
  for (const int links : {1, 2, 3, 5}) add_chain(list, links);
  add_driven(list), add_mixed_angles(list);
  for (const auto& s : list) {
    CAPTURE(s->name);
    add_observables(*s);
    const Kernel kernel = build_kernel(s->source);
    KernelWorkspace code = tiered_workspace(kernel, false), engine(kernel, order_of_tiers);
    for (const Motion& m : motions_near(s->start, 3)) {
      expand_at(code, m), expand_at(engine, m);
      for (std::size_t i = 0; i < kernel.observables(); ++i) {
        CAPTURE(i);
        CHECK(code.observable(i) == doctest::Approx(engine.observable(i)).epsilon(1e-13));
      }
    }
  }
}
