// Constraints of phase space: classes, their combinations, gauge transformations, against the literature.
#include "../model_text.hpp"

#include <maupertuis/dirac.hpp>
#include <maupertuis/print.hpp>

using namespace maupertuis;

namespace {

struct Degenerate {
  ModelText m;
  Hamiltonian h;
  std::optional<DiracAnalysis> dirac;

  explicit Degenerate(const std::string& text)
      : m("dimensionless\n" + text), h(hamiltonian(m.equations)), dirac(dirac_analysis(h, m.equations, near())) {
    REQUIRE(dirac);
    REQUIRE(dirac->outcome == ConstraintChain::Outcome::Closed);
  }
  Bindings near() const { return generic_state(m.model); }
  Expr bracket(Expr a, Expr b) const { return poisson_bracket(a, b, h)->value; }

  /// Whether e vanishes where all constraints hold.
  bool vanishes(Expr e) const {
    ExprVector relations, states = h.momenta;
    for (const PhaseConstraint& c : dirac->constraints) relations.push_back(c.value);
    Bindings center = near();
    for (const Expr& p : h.momenta) center[p] = 0.7;
    for (const Coordinate& c : m.system->coordinates) states.push_back(c.q);
    return zero_test_where({&e, 1}, relations, states, center).verdict == Verdict::Zero;
  }
  std::vector<std::string> texts(const ExprVector& list) const {
    std::vector<std::string> out;
    for (const Expr& e : list) out.push_back(to_plain(e, h.order));
    return out;
  }
};

const std::string brown =
    "coord q1, q2, q3, q4 : number\nL = 1/2 ((q1 + q2' + q3')^2 + (q4' - q2')^2 + (q1 + 2 q2) (q1 + 2 q4))\n";
const std::string einbein = "param m = 1.1\ncoord T, x, e : number\nL = (x'^2 - T'^2)/(2 e) - 1/2 e m^2\nstart e = 1\n";
const std::string christ_lee = "coord r, θ, z : number\nL = r'^2/2 + r^2 (θ' - z)^2/2 - r^2\nstart r = 1\n";

}  // namespace

TEST_CASE("brackets of the functions of the first class with every constraint vanish") {
  for (const std::string& text : {brown, einbein, christ_lee}) {
    const Degenerate space(text);
    REQUIRE(space.dirac->first_class_functions.size() == space.dirac->first_class);
    for (const Expr& f : space.dirac->first_class_functions)
      for (const PhaseConstraint& c : space.dirac->constraints) CHECK(space.vanishes(space.bracket(f, c.value)));
  }
  const Degenerate space(brown);
  CHECK(space.texts(space.dirac->first_class_functions).front() == "p_q2 - 2 p_q1 - p_q3 + p_q4");
}

TEST_CASE("Dirac's brackets with constraints of the second class vanish") {
  const Degenerate space(
      "coord x, y, z, u : number\nL = (x'^2 + y'^2 + z'^2)/2 - z + u (x^2 + y^2 + z^2 - 1)/2\nstart x = 1\n");
  CHECK(space.dirac->second_class == 4);
  for (const PhaseConstraint& c : space.dirac->constraints)
    for (const Expr& f : space.h.momenta)
      CHECK(space.vanishes(dirac_bracket(c.value, f, space.h, *space.dirac)->value));
  // On the unit sphere {x, p_x}_D = 1 − x².
  const Expr x = space.m.q(0), one = x.context().number(1);
  CHECK(space.vanishes(dirac_bracket(x, space.h.momenta[0], space.h, *space.dirac)->value - (one - x * x)));
  CHECK_FALSE(space.vanishes(dirac_bracket(x, space.h.momenta[0], space.h, *space.dirac)->value - one));
}

TEST_CASE("each free multiplier has its gauge transformation") {
  for (const std::string& text : {brown, einbein, christ_lee}) {
    const Degenerate space(text);
    CHECK(space.dirac->primary_first_class == 1);
    REQUIRE(space.dirac->generators.size() == 1);
  }
  // δθ = ε, δz = ε': the angle of a moving frame.
  const Degenerate space(christ_lee);
  const GaugeGenerator& g = space.dirac->generators.front();
  REQUIRE(g.parts.size() == 2);
  CHECK(to_plain(g.changes[1][0], space.h.order) == to_plain(g.changes[2][1], space.h.order));
  CHECK(g.changes[0][0].is_zero());
  CHECK(g.changes[2][0].is_zero());
}
