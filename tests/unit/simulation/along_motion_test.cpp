#include "../model_text.hpp"

#include <maupertuis/along_motion.hpp>

#include <fmt/format.h>

using namespace maupertuis;

namespace {

/// A plane chain of pendulums; `further`: more statements.
std::string chain(int links, const std::string& further = "") {
  std::string text = "param m = 1 kg, l = 1 m, g = 9.81 m/s^2, c = 0.1 N m s\ngravity (0, -g)\n";
  for (int i = 1; i <= links; ++i)
    text += fmt::format("coord a{0} : angle\npoint P{0} mass m at {1} l (sin a{0}, -cos a{0})\n", i,
                        i == 1 ? "" : fmt::format("P{} +", i - 1));
  return text + further + "run 1 s\n";
}

Verdict verdict(const ModelText& m, Expr e) { return AlongMotion(m.equations).is_constant(e).verdict; }

}  // namespace

TEST_CASE("functions of the energy are constant, and what only resembles it is not") {
  const ModelText m(chain(3));
  const Expr energy = m.equations.energy_function;
  CHECK(verdict(m, energy) == Verdict::Zero);
  CHECK(verdict(m, 3 * energy / m.p("m") + m.p("g")) == Verdict::Zero);
  CHECK(verdict(m, energy * energy) == Verdict::Zero);
  CHECK(verdict(m, energy + m.p("m") * m.p("g") * m.p("l") * cos(m.q(0))) == Verdict::Nonzero);
  CHECK(verdict(m, m.v(0)) == Verdict::Nonzero);
  CHECK(verdict(m, m.q(0)) == Verdict::Nonzero);
}

TEST_CASE("friction takes energy, and other integrals than the energy are constant too") {
  const ModelText damped(chain(2, "D = 1/2 c a1'^2\n"));
  CHECK(verdict(damped, damped.equations.energy_function) == Verdict::Nonzero);
  const ModelText free("param m = 1 kg\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = 0 [J]\nrun 1 s\n");
  CHECK(verdict(free, free.v(0)) == Verdict::Zero);
  CHECK(verdict(free, free.q(0) * free.v(1) - free.q(1) * free.v(0)) == Verdict::Zero);
  CHECK(verdict(free, free.q(0)) == Verdict::Nonzero);
}

TEST_CASE("the energy of many coordinates is proved without the accelerations, which take n³ nodes") {
  const auto nodes_of_proof = [](int links) {
    const ModelText m(chain(links));
    const std::size_t before = m.system->context->node_count();
    CHECK(verdict(m, m.equations.energy_function) == Verdict::Zero);
    return m.system->context->node_count() - before;
  };
  CHECK(nodes_of_proof(24) < 4 * nodes_of_proof(12));
}
