// Constraints of phase space: classes, their combinations, gauge transformations, against the literature.
#include "../model_text.hpp"

#include <maupertuis/dirac.hpp>
#include <maupertuis/print.hpp>

#include <array>

using namespace maupertuis;

namespace {

struct Degenerate {
  ModelText m;
  Hamiltonian h;
  std::optional<DiracAnalysis> dirac;

  explicit Degenerate(const std::string& text)
      : m("dimensionless\n" + text),
        h(hamiltonian(m.equations)),
        dirac(dirac_analysis(h, m.equations, near(), written_start(m.model))) {
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

TEST_CASE("brackets that vanish on the constraints alone are of the first class") {
  const auto counts = [](const std::string& text) {
    const Degenerate space(text);
    const DiracAnalysis& d = *space.dirac;
    return std::array{d.first_class, d.second_class, d.physical_dimension};
  };
  using Counts = std::array<std::size_t, 3>;
  // {x p_x + y p_y, p_x} = p_x.
  CHECK(counts("coord x, y : number\nL = (x' y - x y')^2/2\nstart x = 1, y = 0.5, x' = 0.3\n") == Counts{2, 0, 0});
  // The rotations of a triplet: two of G = x × p are independent, and {G_1, G_2} = G_3 is a combination of them.
  CHECK(counts("coord x, y, z, a, b, c : number\n"
               "L = ((x' + b z - c y)^2 + (y' + c x - a z)^2 + (z' + a y - b x)^2)/2 - (x^2 + y^2 + z^2)^2/4\n"
               "start x = 1, y = 0.3, z = 0.2\n") == Counts{5, 0, 2});
  CHECK(counts("coord x, y, z : number\nL = ((y' - exp(x))^2 + (z' - y)^2)/2\nstart x = 1\n") == Counts{3, 0, 0});
}

TEST_CASE("phase space lies on the branch of the start, as Lagrange's states do") {
  const std::string pushed = "coord x, y, z : number\nL = (x' + y z)^2/2 + y^2/2\n";
  const Degenerate resting(pushed + "start x' = 0, z = 1\n"), moving(pushed + "start x' = 1, z = 0\n");
  CHECK(resting.vanishes(resting.h.momenta[0]));
  CHECK_FALSE(moving.vanishes(moving.h.momenta[0]));
  CHECK(moving.vanishes(moving.m.q(2)));
  CHECK(moving.dirac->physical_dimension == 2);
}
