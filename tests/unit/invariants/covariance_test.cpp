// What is conserved does not depend on the coordinates: numbers of symmetries and ranks under linear transformations.
#include "../model_text.hpp"

#include <maupertuis/invariants.hpp>

#include <fmt/format.h>
#include <rapidcheck.h>

using namespace maupertuis;

namespace {

struct Counts {
  std::size_t symmetries, rank, autonomous_rank;
  bool integrable;
  friend bool operator==(const Counts&, const Counts&) = default;
};

/// x = a u + b v, y = c u + d v in T = ½ (x'^2 + y'^2) and V(x, y).
Counts counts_of(const std::string& potential, int a, int b, int c, int d) {
  const std::string x = fmt::format("({} u + {} v)", a, b), y = fmt::format("({} u + {} v)", c, d);
  const ModelText m(
      fmt::format("dimensionless\nparam k = 1\ncoord u, v : number\nlet X = {}, Y = {}\n"
                  "T = 1/2 (X'^2 + Y'^2)\nV = {}\n",
                  x, y, potential));
  InvariantsOptions options;
  options.drift = options.completeness = false;
  Diagnostics diagnostics;
  const auto found = find_invariants(m.model, m.equations, options, diagnostics);
  RC_ASSERT(bool(found));
  return {found->noether_symmetries, found->rank, found->autonomous_rank, found->completely_integrable};
}

}  // namespace

TEST_CASE("linear coordinates change neither the number of symmetries nor the ranks") {
  const std::string potentials[] = {"0", "1/2 k (X^2 + Y^2) + X^2 Y + 2 Y^3", "k X", "-k/sqrt(X^2 + Y^2)"};
  for (const std::string& potential : potentials) {
    CAPTURE(potential);
    const Counts straight = counts_of(potential, 1, 0, 0, 1);
    CHECK(rc::check(potential, [&] {
      const int a = *rc::gen::inRange(-3, 4), b = *rc::gen::inRange(-3, 4), c = *rc::gen::inRange(-3, 4),
                d = *rc::gen::inRange(-3, 4);
      RC_PRE(a * d != b * c);
      RC_ASSERT(counts_of(potential, a, b, c, d) == straight);
    }));
  }
}
