#include "worlds.hpp"

#include <vector>

namespace maupertuis::fuzz {
namespace {

struct World {
  std::string model;
  std::vector<std::string> terms;  // what may stand in a formula, or so it seems
};

const std::vector<World> worlds{
    {"coord q, y : number\nparam k = 1, m = 1\npoint P mass m at (q, y)\nframe F at (q, 0)\n"
     "body B mass 1 inertia 1 at (q, 1) rotation angle y\nlet f = k q\ninput w = sin(t)\n"
     "contact y >= -3 name wall\nconstraint q = y^2 name rod\n",
     {"q",
      "q'",
      "q''",
      "y'",
      "k",
      "f",
      "f'",
      "t",
      "P",
      "P.x",
      "P.x'",
      "F",
      "B",
      "B.ω",
      "w",
      "w'",
      "wall",
      "rod",
      "B.x",
      "p_q",
      "T",
      "V",
      "L",
      "(q, y)",
      "multiplier(rod)",
      "reaction(rod)",
      "reaction(wall)"}},
    {"coord q, y : number\nparam k = 1\nT = 1/2 (q'^2 + y'^2)\nV = 1/2 k (q^2 + 2 y^2)\nstart q = 0.3, y' = 1\n",
     {"q", "q'", "q''", "q'''", "y", "y'", "k", "t", "p_q", "p_y", "T", "V", "L", "D", "sin(q)", "abs(y)", "step(q)"}},
    {"coord x, y, ψ : number\nT = 1/2 (x'^2 + y'^2 + ψ'^2)\nconstraint x' sin(ψ) = y' cos(ψ) name edge\n"
     "rates v = x' cos(ψ) + y' sin(ψ), ω = ψ'\nstart v = 1, ω = 1\n",
     {"v", "ω", "v'", "ω'", "v''", "x", "x'", "ψ", "edge", "p_x", "reaction(edge)", "multiplier(edge)", "T", "t"}},
    {"coord x, y : number\nL = 1/2 (x' - y)^2\nparam k = 1\n",
     {"x", "y", "y'", "x''", "k", "t", "p_x", "p_y", "L", "T"}},
    {"coord y : number\nparam k = 1\nL = 1/2 y''^2 - k y\n", {"y", "y'", "y''", "y'''", "y''''", "k", "t", "p_y", "L"}},
    {"independent s : number\ncoord y : number\nL = sqrt(1 + y'^2)\n", {"y", "y'", "y''", "s", "t", "L", "p_y"}},
    {"field u(x) : number on x = 0 .. 1 cells 2\ndensity = 1/2 u'^2 - 1/2 u_x^2\ncoord q : number\nT = 1/2 q'^2\n"
     "param k = 1\nlet f = k q\n",
     {"u", "u'", "x", "u_x", "u_xx", "u(0)", "u(0)'", "u_x(1)", "q", "q'", "q''", "k", "f", "f'", "t", "u(q)", "u(t)",
      "total u", "p_q"}},
    {"field u(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 2 by 2\nparam k = 1\n"
     "density = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2)\n",
     {"u", "u'", "x", "y", "u_y", "u(0, 0)", "u(0)", "k", "t", "u_xx", "total u"}},
    {"field ψ(x) : complex on x = 0 .. 1 cells 2 boundary periodic\n"
     "density = i/2 (conj(ψ) ψ' - ψ conj(ψ')) - 1/2 conj(ψ_x) ψ_x\n",
     {"ψ", "x", "ψ(0)", "re(ψ(0))", "im(ψ)", "conj(ψ)", "i", "t", "ψ_x"}},
};

/// @ stands for a formula.
const std::vector<std::string> statements{
    "constraint @ = @",
    "constraint @ = @ name c2",
    "constraint integral @ = @",
    "V += @ * (@)",
    "T += @ * (@)",
    "D += (@)^2",
    "L += @ * (@)",
    "V = @",
    "force q = @",
    "force x = @",
    "force y = @ * (@)",
    "force on P = (@, @)",
    "torque on B = @",
    "event e when @ = @ : record",
    "event e when @ = 0 rising : stop",
    "event e when t = 0.25 : set @ = @",
    "event e when @ = 0.1 : set q = @, q' = @",
    "run until @ = @ within 1",
    "run @",
    "output every @",
    "start @ = @",
    "start q = @",
    "start at @, q = @",
    "expect @ at 0.5 = @ ± 1",
    "expect @ at until = @ ± 1",
    "expect @ at @ = 0 ± @",
    "expect @ = @",
    "expect @ not conserved",
    "expect conserved @",
    "expect conserved @ where @ = @",
    "expect integral @ * (@)",
    "expect equation @ = @",
    "expect hamiltonian = @",
    "expect routhian of q = @",
    "expect constraints : @ ; @",
    "expect bracket (@, @) = 1",
    "expect frequencies : @, @ ± 1",
    "expect frequencies at q = @ : 1 ± 1",
    "expect equilibrium at q = @",
    "expect equilibrium at y = @ is stable",
    "expect solution q = @",
    "expect action of (@, @) from 0 to @ = 1 ± 1",
    "expect path @ at 0.5 = @ ± 1",
    "expect natural @ = @",
    "expect total @ at 0.5 = @ ± 1",
    "expect dispersion @ = @",
    "expect current @ flux @",
    "expect event e 1 at @ ± 1",
    "expect event e = @",
    "claim @ = @",
    "contact @ >= @",
    "contact @ <= @ restitution @ name g2",
    "contact y >= -2 restitution 0.5 friction @ slip @",
    "friction @ limit @",
    "friction @ coefficient 0.1 normal @",
    "friction q limit @ static @",
    "gauge @ = @",
    "rates r1 = @",
    "point R mass @ at (@, 0)",
    "point R at (@, @)",
    "body C mass 1 inertia @ at (@, 0) rotation angle @",
    "frame G at (@, 0) rotation angle @\npoint R mass 1 at (1, 0) in G",
    "spring (@, 0) - (@, @) stiffness 1 length @",
    "damper (0, @) - (@, 0) coefficient @",
    "torsion spring q stiffness @ rest @",
    "path from (@, @) at 0 to (1, free) at 1",
    "path from @ at 0 to @ at 1",
    "sweep @ = 0 .. 1 steps 3",
    "let g3 = @ + @\nstart q = g3",
    "let g3 = @ * (@)\nforce q = g3'",
    "param n2 = @",
    "input z2 = @\nforce q = z2 + @",
    "gravity (@, @)",
    "boundary left : @ = @",
    "boundary @ = @",
    "density += @",
    "dissipation density = (@)^2",
    "force density u = @",
    "draw circle (@, @) 1",
    "draw (@, 0) - (0, @), trail (@, @)",
    "reaction r2 = release P",
    "method taylor step @",
    "method variational order 2 step @",
};

std::string with_terms(const std::string& statement, const World& world, Random& random) {
  const auto term = [&]() -> std::string {
    const std::string a = random.of(world.terms);
    switch (random.below(12)) {
      case 0:
        return a + " + " + random.of(world.terms);
      case 1:
        return "(" + a + ") (" + random.of(world.terms) + ")";
      case 2:
        return std::to_string(random.below(3));
      default:
        return a;
    }
  };
  std::string out;
  for (const char c : statement) out += c == '@' ? term() : std::string(1, c);
  return out;
}

}  // namespace

std::vector<std::string> sound_worlds() {
  std::vector<std::string> out;
  for (const World& world : worlds) out.push_back("dimensionless\n" + world.model);
  return out;
}

std::string model_of_a_world(Random& random) {
  const World& world = random.of(worlds);
  std::string out = "dimensionless\n" + world.model;
  bool runs = false;
  for (std::size_t count = 1 + random.below(3); count--;) {
    const std::string statement = with_terms(random.of(statements), world, random);
    runs = runs || statement.compare(0, 3, "run") == 0;
    out += statement + "\n";
  }
  return out + (runs ? "" : "run 0.5\n");
}

}  // namespace maupertuis::fuzz
