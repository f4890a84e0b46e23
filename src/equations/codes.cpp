#include <maupertuis/codes.hpp>

#include <array>

namespace maupertuis {
namespace {

constexpr std::array entries{
    CodeEntry{"E0601", "constraints that cannot stay satisfied",
              "There is a state at the start that satisfies all constraints, but none shortly after it. Two of them "
              "prescribe the same coordinate differently, or a loop is driven to where it cannot close. The message "
              "names a smallest set: without any one of them the others can be satisfied.",
              "# maup check\nparam m = 1 kg, a = 1 m/s^2, b = 2 m/s^2\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\n"
              "constraint x = a t^2\nconstraint x = b t^2\n",
              "# maup check\nparam m = 1 kg, a = 1 m/s^2\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\n"
              "constraint x = a t^2\n"},
    CodeEntry{
        "W0602", "a redundant constraint",
        "The row of this constraint in A is a combination of the rows of others at every configuration that the "
        "constraints allow. The motion is the same without it. How the constraints of the set share their forces is "
        "not determined by rigid bodies: that is a question of elasticity. Friction that depends on such a force "
        "is not determined either.",
        "# maup check\nparam m = 1 kg\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\nconstraint x = y\n"
        "constraint y = z\nconstraint z = x\n",
        "# maup check\nparam m = 1 kg\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\nconstraint x = y\n"
        "constraint y = z\n"},
    CodeEntry{
        "W0603", "a velocity constraint that is holonomic in disguise",
        "By the theorem of Frobenius the velocities that the constraints allow keep the coordinates on a surface, and "
        "this constraint only says so for the velocities. The equations of motion are right, but the level of the "
        "positions is lost: rounding may move the motion to another surface, and a wrong start is not noticed.",
        "# maup check\nparam m = 1 kg, R = 20 cm\ncoord x : length, φ : angle\nT = 1/2 m x'^2 + 1/4 m R^2 φ'^2\n"
        "constraint x' = R φ'\n",
        "# maup check\nparam m = 1 kg, R = 20 cm\ncoord x : length, φ : angle\nT = 1/2 m x'^2 + 1/4 m R^2 φ'^2\n"
        "constraint x = R φ\n"},
    CodeEntry{
        "W0604", "a singular start",
        "At the start the rank of A is less than elsewhere on the manifold: a linkage is stretched, two branches of "
        "its motion meet. The accelerations may not be determined there.",
        "# maup check\nparam m = 1 kg, r = 1 m, a = 2 m\ncoord θ1, θ2, β : angle\n"
        "T = 1/2 m r^2 (θ1'^2 + θ2'^2) + 1/2 m a^2 β'^2\nconstraint r cos θ1 + a cos β = a + r cos θ2\n"
        "constraint r sin θ1 + a sin β = r sin θ2\nstart θ1 = 180 deg, θ2 = 180 deg\n",
        "# maup check\nparam m = 1 kg, r = 1 m, a = 2 m\ncoord θ1, θ2, β : angle\n"
        "T = 1/2 m r^2 (θ1'^2 + θ2'^2) + 1/2 m a^2 β'^2\nconstraint r cos θ1 + a cos β = a + r cos θ2\n"
        "constraint r sin θ1 + a sin β = r sin θ2\nstart θ1 = 60 deg, θ2 = 60 deg\n"},
    CodeEntry{
        "N0605", "a velocity constraint fixes a coordinate",
        "x' = 0 keeps x at the value that it starts with. Such a coordinate is a parameter; as a constraint, x = 0 "
        "holds it at a place and gives the same force.",
        "# maup check\nparam m = 1 kg\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nconstraint x' = 0\n",
        "# maup check\nparam m = 1 kg\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = 0\n"},
    CodeEntry{"N0606", "the constraints leave no freedom",
              "As many independent constraints as coordinates prescribe the motion. It does not depend on masses and "
              "forces, which decide only the forces of constraint.",
              "# maup check\nparam m = 1 kg, v = 1 m/s\ncoord x : length\nT = 1/2 m x'^2\nconstraint x = v t\n",
              "# maup check\nparam m = 1 kg, v = 1 m/s\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\n"
              "constraint x = v t\n"},
    CodeEntry{
        "N0607", "a constraint that is not linear in the velocities",
        "d'Alembert's principle says what force keeps a constraint that is linear in the velocities. For others the "
        "usual choice is that of Chetaev: the force is along ∂ψ/∂q'. Such constraints are realised by control rather "
        "than by contact. They are not classified.",
        "# maup check\nparam m = 1 kg, v = 1 m/s\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\n"
        "constraint x'^2 + y'^2 = v^2\nstart x' = v\n",
        "# maup check\nparam m = 1 kg, v = 1 m/s\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nstart x' = v\n"},
    CodeEntry{
        "N0608", "the rank of the constraints varies",
        "At some of the configurations that were tried the constraints leave more directions free than at the others: "
        "the manifold has several branches, or singular points.",
        "# maup check\nparam m = 1 kg\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\nconstraint x y = 0\n"
        "constraint x z = 0\nstart x = 1 m\n",
        "# maup check\nparam m = 1 kg\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\nconstraint y = 0\n"
        "constraint z = 0\nstart x = 1 m\n"},
    CodeEntry{"N0609", "a combination of velocity constraints is integrable",
              "No single one of these constraints can be integrated, but a combination can: the wheels of an axle roll "
              "non-holonomically, and the difference of their angles is still a function of the heading.",
              "# maup check\nparam m = 1 kg, R = 20 cm, b = 30 cm\ncoord x, y : length, ψ, φ1, φ2 : angle\n"
              "T = 1/2 m (x'^2 + y'^2) + 1/2 m b^2 ψ'^2 + 1/4 m R^2 (φ1'^2 + φ2'^2)\n"
              "constraint y' cos ψ = x' sin ψ name blade\nconstraint x' cos ψ + y' sin ψ + b ψ' = R φ1' name left\n"
              "constraint x' cos ψ + y' sin ψ - b ψ' = R φ2' name right\n",
              "# maup check\nparam m = 1 kg, R = 20 cm, b = 30 cm\ncoord x, y : length, ψ, φ1, φ2 : angle\n"
              "T = 1/2 m (x'^2 + y'^2) + 1/2 m b^2 ψ'^2 + 1/4 m R^2 (φ1'^2 + φ2'^2)\n"
              "constraint y' cos ψ = x' sin ψ name blade\nconstraint x' cos ψ + y' sin ψ + b ψ' = R φ1' name left\n"
              "constraint 2 b ψ = R (φ1 - φ2) name right\n"},
    CodeEntry{
        "N0620", "a degenerate Lagrangian",
        "∂²L/∂q̇∂q̇ is singular: some of Lagrange's equations hold no acceleration that the others do not hold. They are "
        "constraints on the state, and so are their derivatives, until nothing new comes (Gotay and Nester). A "
        "Lagrangian that is linear in the velocities has nothing but such constraints: ω q̇ = ∂H/∂q + ∂a/∂t. A start "
        "has to fulfil them; what it does not say follows from them.",
        "# maup check\nparam b = 3 kg/s, k = 2 N/m\ncoord x, y : length\nL = b x y' - 1/2 k (x^2 + y^2)\n",
        "# maup check\nparam m = 1 kg, b = 3 kg/s, k = 2 N/m\ncoord x, y : length\n"
        "L = 1/2 m (x'^2 + y'^2) + b x y' - 1/2 k (x^2 + y^2)\n"},
    CodeEntry{
        "W0621", "a coordinate without kinetic energy",
        "Its equation holds no acceleration: it is a constraint on the others, as for a joint without mass between two "
        "springs. That may be meant. Often a mass was forgotten.",
        "# maup check\nparam m = 1 kg, k = 1 N/m\ncoord x, y : length\nT = 1/2 m x'^2\n"
        "V = 1/2 k (x - y)^2 + 1/2 k y^2\n",
        "# maup check\nparam m = 1 kg, k = 1 N/m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\n"
        "V = 1/2 k (x - y)^2 + 1/2 k y^2\n"},
    CodeEntry{
        "W0622", "functions of time that the Lagrangian leaves open",
        "A degenerate Lagrangian may leave some accelerations undetermined: any function of time will do, and what "
        "depends on it has no value of its own (a gauge freedom, as of the potentials of electrodynamics). A run shows "
        "what does not depend on the choice. `gauge EXPR = EXPR` makes a choice.",
        "# maup check\nparam m = 1 kg, k = 4 N/m\ncoord r : length, θ : angle, z : [rad/s]\n"
        "L = 1/2 m r'^2 + 1/2 m r^2 (θ' - z)^2 - 1/2 k r^2\nstart r = 1 m, θ = 30 deg\n",
        "# maup check\nparam m = 1 kg, k = 4 N/m\ncoord r : length, θ : angle, z : [rad/s]\n"
        "L = 1/2 m r'^2 + 1/2 m r^2 (θ' - z)^2 - 1/2 k r^2\nstart r = 1 m, θ = 30 deg\ngauge z = 0\n"},
    CodeEntry{
        "E0623", "a Lagrangian without any motion",
        "Its equations ask for something that nothing fulfils: L = q gives 1 = 0. The message names the condition "
        "and where it comes from.",
        "# maup check\nparam F = 3 N\ncoord x : length\nL = F x\n",
        "# maup check\nparam m = 2 kg, F = 3 N\ncoord x : length\nL = 1/2 m x'^2 + F x\n"},
    CodeEntry{
        "E0624", "constraints of a degenerate Lagrangian that no state was found to fulfil",
        "Newton's method, from random states near the start, found none. Perhaps there is none, perhaps all lie far "
        "from the start: give a start near one.",
        "# maup check\nparam m = 1 kg, l = 1 m\ncoord x, y : length, λ : [N/m]\n"
        "L = 1/2 m (x'^2 + y'^2) + λ (x^2 + y^2 + l^2)\nstart x = l\n",
        "# maup check\nparam m = 1 kg, l = 1 m\ncoord x, y : length, λ : [N/m]\n"
        "L = 1/2 m (x'^2 + y'^2) + λ (x^2 + y^2 - l^2)\nstart x = l\n"},
    CodeEntry{
        "E0625", "a gauge where nothing is open",
        "The equations determine every acceleration: a further condition on the motion would be a constraint, with "
        "a force.",
        "# maup check\nparam m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\ngauge x = 0\n",
        "# maup check\nparam m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n"},
    CodeEntry{
        "E0626", "a gauge that fixes too much",
        "A gauge chooses among states that differ by the free functions alone, and leaves the motions as they are. "
        "This one excludes motions: it says something about a quantity that has a value of its own.",
        "# maup check\nparam m = 1 kg, k = 4 N/m\ncoord r : length, θ : angle, z : [rad/s]\n"
        "L = 1/2 m r'^2 + 1/2 m r^2 (θ' - z)^2 - 1/2 k r^2\nstart r = 1 m, θ = 30 deg\ngauge r = 1 [m]\n",
        "# maup check\nparam m = 1 kg, k = 4 N/m\ncoord r : length, θ : angle, z : [rad/s]\n"
        "L = 1/2 m r'^2 + 1/2 m r^2 (θ' - z)^2 - 1/2 k r^2\nstart r = 1 m, θ = 30 deg\ngauge z = 0\n"},
    CodeEntry{"W0627", "a gauge that leaves something open",
              "Functions of time stay free with it. Each needs a condition of its own.",
              "# maup check\nparam m = 1 kg\ncoord x1, x2 : length, v1, v2 : [m/s]\n"
              "L = 1/2 m (x1' - v1)^2 + 1/2 m (x2' - v2)^2\ngauge v1 = 0\n",
              "# maup check\nparam m = 1 kg\ncoord x1, x2 : length, v1, v2 : [m/s]\n"
              "L = 1/2 m (x1' - v1)^2 + 1/2 m (x2' - v2)^2\ngauge v1 = 0\ngauge v2 = 0\n"},
    CodeEntry{
        "E0629", "a start off the constraints of a degenerate Lagrangian",
        "The constraints leave fewer states than there are coordinates and velocities. What the start does not give "
        "follows from them; what it gives has to agree with them.",
        "# maup simulate\nparam b = 3 kg/s, k = 2 N/m\ncoord x, y : length\nL = b x y' - 1/2 k (x^2 + y^2)\n"
        "start exactly x = 1 m, y' = 3 m/s\nrun 2 s\n",
        "# maup simulate\nparam b = 3 kg/s, k = 2 N/m\ncoord x, y : length\nL = b x y' - 1/2 k (x^2 + y^2)\n"
        "start x = 1 m\nrun 2 s\n"},
    CodeEntry{
        "N0630", "what a run of a degenerate Lagrangian leaves out",
        "Some accelerations are free. A run has to choose them, and shows only what is the same with every choice: "
        "quantities that do not change along the orbits of the free functions.",
        "# maup simulate\nparam m = 1 kg, k = 4 N/m\ncoord r : length, θ : angle, z : [rad/s]\n"
        "L = 1/2 m r'^2 + 1/2 m r^2 (θ' - z)^2 - 1/2 k r^2\nstart r = 1 m, θ = 30 deg\nrun 3 s\n",
        "# maup simulate\nparam m = 1 kg, k = 4 N/m\ncoord r : length, θ : angle, z : [rad/s]\n"
        "L = 1/2 m r'^2 + 1/2 m r^2 (θ' - z)^2 - 1/2 k r^2\nstart r = 1 m, θ = 30 deg\ngauge z = 0\nrun 3 s\n"},
    CodeEntry{"E0631", "a quantity without a value of its own",
              "It depends on functions of time that the Lagrangian leaves open.",
              "# maup simulate --precision quad\nparam m = 1 kg, k = 4 N/m\ncoord r : length, θ : angle, z : [rad/s]\n"
              "L = 1/2 m r'^2 + 1/2 m r^2 (θ' - z)^2 - 1/2 k r^2\nstart r = 1 m, θ = 30 deg\nrun 3 s\n",
              "# maup simulate --precision quad\nparam m = 1 kg, k = 4 N/m\ncoord r : length, θ : angle, z : [rad/s]\n"
              "L = 1/2 m r'^2 + 1/2 m r^2 (θ' - z)^2 - 1/2 k r^2\nstart r = 1 m, θ = 30 deg\ngauge z = 0\nrun 3 s\n"},
    CodeEntry{
        "N0632", "a Lagrangian that holds accelerations",
        "Its equation d/dt ∂L/∂q' − ∂L/∂q − d²/dt² ∂L/∂q'' = 0 is of the fourth order (Ostrogradsky). A run takes "
        "L(q, v, v', t) + p (q' − v) in its place.",
        "# maup check\nparam m = 1 kg, a = 1 kg s^2, k = 2 N/m\ncoord x : length\n"
        "L = 1/2 m x'^2 - 1/2 a x''^2 - 1/2 k x^2\n",
        "# maup check\nparam m = 1 kg, k = 2 N/m\ncoord x : length\nL = 1/2 m x'^2 - 1/2 k x^2\n"},
    CodeEntry{
        "E0633", "a Lagrangian whose class is not the same everywhere",
        "What vanishes near the start, a coefficient of an acceleration or what would be a constraint, does not "
        "vanish elsewhere: behind a switch, or where a narrow bump of inertia lies. A motion that goes there would "
        "obey other equations, and a run from here would not know.",
        "# maup check\nparam b = 3 kg/s, k = 2 N/m, l = 3 m, M = 1 kg\ncoord x, y : length\n"
        "L = b x y' - 1/2 k (x^2 + y^2) + 1/2 M max(x/l - 1, 0)^2 x'^2\nstart x = 1 m\n",
        "# maup check\nparam b = 3 kg/s, k = 2 N/m, l = 3 m, K = 5 N/m\ncoord x, y : length\n"
        "L = b x y' - 1/2 k (x^2 + y^2) - 1/2 K max(x - l, 0)^2\nstart x = 1 m\n"},
    CodeEntry{
        "N0634", "constraints of a degenerate Lagrangian that branch",
        "A product of functions of the state vanishes where any of its factors does, and each of these branches has "
        "constraints, free functions and motions of its own. The branch on which the start lies is taken; where it "
        "lies on none, the one that was found next to it. What is told and run holds on this branch.",
        "# maup check\ndimensionless\ncoord x, y, u : number\n"
        "L = 1/2 (x'^2 + y'^2) + u x y\nstart x = 1, x' = 0.3\n",
        "# maup check\ndimensionless\ncoord x, y, u : number\n"
        "L = 1/2 (x'^2 + y'^2) + u y\nstart x = 1, x' = 0.3\n"},
    CodeEntry{
        "E0635", "constraints of a degenerate Lagrangian that are not regular",
        "The start fulfils the constraints, but their gradients vanish there or depend on each other: beside it no "
        "state was found that fulfils them, and ranks at the start alone say nothing of the states around it. Powers, "
        "products, and sums of squares are written as what their zeros are; other double zeros are not recognized.",
        "# maup check\ndimensionless\ncoord x, y, u : number\nL = 1/2 x'^2 + u (cosh(y) - 1)\nstart x = 1\n",
        "# maup check\ndimensionless\ncoord x, y, u : number\nL = 1/2 x'^2 + u sinh(y)\nstart x = 1\n"},
    CodeEntry{"N0628", "parameters with special values",
              "Ranks are taken at the values of the parameters. With these the class of the system is another one than "
              "for values nearby: a freedom, or a free function, more or less.",
              "# maup check\nparam La = 1 mH, Lb = 4 mH, M = 2 mH, C = 10 uF\ncoord q1, q2 : charge\n"
              "T = 1/2 La q1'^2 + 1/2 Lb q2'^2 + M q1' q2'\nV = 1/2 q1^2/C\n",
              "# maup check\nparam La = 1 mH, Lb = 4 mH, M = 1.8 mH, C = 10 uF\ncoord q1, q2 : charge\n"
              "T = 1/2 La q1'^2 + 1/2 Lb q2'^2 + M q1' q2'\nV = 1/2 q1^2/C\n"},
};

}  // namespace

std::span<const CodeEntry> equations_codes() { return entries; }

}  // namespace maupertuis
