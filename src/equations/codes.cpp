#include <maupertuis/codes.hpp>

#include <array>

namespace maupertuis {
namespace {

constexpr std::array entries{
    CodeEntry{
        "E0601", "constraints that cannot stay satisfied",
        "There is a state at the start that satisfies all constraints, but none shortly after it. Two of them "
        "prescribe the same coordinate differently, or a loop is driven to where it cannot close. The message "
        "names a smallest set: without any one of them the others can be satisfied.",
        "param m = 1 kg, a = 1 m/s^2, b = 2 m/s^2\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = a t^2\n"
        "constraint x = b t^2\n",
        "param m = 1 kg, a = 1 m/s^2\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = a t^2\n"},
    CodeEntry{
        "W0602", "a redundant constraint",
        "The row of this constraint in A is a combination of the rows of others at every configuration that the "
        "constraints allow. The motion is the same without it. How the constraints of the set share their forces is "
        "not determined by rigid bodies: that is a question of elasticity. Friction that depends on such a force "
        "is not determined either.",
        "param m = 1 kg, l = 1 m\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\nconstraint x = y\nconstraint "
        "y = z\n"
        "constraint z = x\n",
        "param m = 1 kg, l = 1 m\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\nconstraint x = y\nconstraint "
        "y = z\n"},
    CodeEntry{
        "W0603", "a velocity constraint that is holonomic in disguise",
        "By the theorem of Frobenius the velocities that the constraints allow keep the coordinates on a surface, and "
        "this constraint only says so for the velocities. The equations of motion are right, but the level of the "
        "positions is lost: rounding may move the motion to another surface, and a wrong start is not noticed.",
        "param m = 1 kg, R = 20 cm\ncoord x : length, φ : angle\nT = 1/2 m x'^2 + 1/4 m R^2 φ'^2\nconstraint x' = R "
        "φ'\n",
        "param m = 1 kg, R = 20 cm\ncoord x : length, φ : angle\nT = 1/2 m x'^2 + 1/4 m R^2 φ'^2\nconstraint x = R "
        "φ\n"},
    CodeEntry{
        "W0604", "a singular start",
        "At the start the rank of A is less than elsewhere on the manifold: a linkage is stretched, two branches of "
        "its motion meet. The accelerations may not be determined there.",
        "", ""},
    CodeEntry{
        "N0605", "a velocity constraint fixes a coordinate",
        "x' = 0 keeps x at the value that it starts with. Such a coordinate is a parameter; as a constraint, x = 0 "
        "holds it at a place and gives the same force.",
        "param m = 1 kg\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nconstraint x' = 0\n",
        "param m = 1 kg\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = 0\n"},
    CodeEntry{"N0606", "the constraints leave no freedom",
              "As many independent constraints as coordinates prescribe the motion. It does not depend on masses and "
              "forces, which decide only the forces of constraint.",
              "param m = 1 kg, v = 1 m/s\ncoord x : length\nT = 1/2 m x'^2\nconstraint x = v t\n",
              "param m = 1 kg, v = 1 m/s\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = v t\n"},
    CodeEntry{
        "N0607", "a constraint that is not linear in the velocities",
        "d'Alembert's principle says what force keeps a constraint that is linear in the velocities. For others the "
        "usual choice is that of Chetaev: the force is along ∂ψ/∂q'. Such constraints are realised by control rather "
        "than by contact. They are not classified.",
        "param m = 1 kg, v = 1 m/s\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nconstraint x'^2 + y'^2 = v^2\nstart "
        "x' = v\n",
        ""},
    CodeEntry{
        "N0608", "the rank of the constraints varies",
        "At some of the configurations that were tried the constraints leave more directions free than at the others: "
        "the manifold has several branches, or singular points.",
        "", ""},
    CodeEntry{"N0609", "a combination of velocity constraints is integrable",
              "No single one of these constraints can be integrated, but a combination can: the wheels of an axle roll "
              "non-holonomically, and the difference of their angles is still a function of the heading.",
              "", ""},
    CodeEntry{
        "N0620", "a degenerate Lagrangian",
        "∂²L/∂q̇∂q̇ is singular: some of Lagrange's equations hold no acceleration that the others do not hold. They are "
        "constraints on the state, and so are their derivatives, until nothing new comes (Gotay and Nester). A "
        "Lagrangian that is linear in the velocities has nothing but such constraints: ω q̇ = ∂H/∂q + ∂a/∂t. A start "
        "has to fulfil them; what it does not say follows from them.",
        "", ""},
    CodeEntry{
        "W0621", "a coordinate without kinetic energy",
        "Its equation holds no acceleration: it is a constraint on the others, as for a joint without mass between two "
        "springs. That may be meant. Often a mass was forgotten.",
        "coord x, y : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k (x - y)^2\n",
        "coord x, y : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m (x'^2 + y'^2)\nV = 1/2 k (x - y)^2\n"},
    CodeEntry{
        "W0622", "functions of time that the Lagrangian leaves open",
        "A degenerate Lagrangian may leave some accelerations undetermined: any function of time will do, and what "
        "depends on it has no value of its own (a gauge freedom, as of the potentials of electrodynamics). A run shows "
        "what does not depend on the choice. `gauge EXPR = EXPR` makes a choice.",
        "dimensionless\ncoord r, θ, z : number\nL = 1/2 r'^2 + 1/2 r^2 (θ' - z)^2 - r^2\n",
        "dimensionless\ncoord r, θ, z : number\nL = 1/2 r'^2 + 1/2 r^2 (θ' - z)^2 - r^2\ngauge z = 0\n"},
    CodeEntry{
        "E0623", "a Lagrangian without any motion",
        "Its equations ask for something that nothing fulfils: L = q gives 1 = 0. The message names the condition "
        "and where it comes from.",
        "dimensionless\ncoord q : number\nL = q\n", "dimensionless\ncoord q : number\nL = 1/2 q'^2 + q\n"},
    CodeEntry{
        "E0624", "constraints of a degenerate Lagrangian that no state was found to fulfil",
        "Newton's method, from random states near the start, found none. Perhaps there is none, perhaps all lie far "
        "from the start: give a start near one.",
        "dimensionless\ncoord x, y : number\nL = 1/2 x'^2 + y (x^2 + 1)\n",
        "dimensionless\ncoord x, y : number\nL = 1/2 x'^2 + y (x^2 - 1)\nstart x = 1\n"},
    CodeEntry{
        "E0625", "a gauge where nothing is open",
        "The equations determine every acceleration: a further condition on the motion would be a constraint, with "
        "a force.",
        "dimensionless\ncoord x : number\nL = 1/2 x'^2\ngauge x = 0\n",
        "dimensionless\ncoord x : number\nL = 1/2 x'^2\n"},
    CodeEntry{
        "E0626", "a gauge that fixes too much",
        "A gauge chooses among states that differ by the free functions alone, and leaves the motions as they are. "
        "This one excludes motions: it says something about a quantity that has a value of its own.",
        "dimensionless\ncoord r, θ, z : number\nL = 1/2 r'^2 + 1/2 r^2 (θ' - z)^2 - r^2\ngauge r = 1\n",
        "dimensionless\ncoord r, θ, z : number\nL = 1/2 r'^2 + 1/2 r^2 (θ' - z)^2 - r^2\ngauge z = 0\n"},
    CodeEntry{
        "W0627", "a gauge that leaves something open",
        "Functions of time stay free with it. Each needs a condition of its own.",
        "dimensionless\ncoord x, y, u, w : number\nL = 1/2 (x' - y)^2 + 1/2 (u' - w)^2\ngauge y = 0\n",
        "dimensionless\ncoord x, y, u, w : number\nL = 1/2 (x' - y)^2 + 1/2 (u' - w)^2\ngauge y = 0\ngauge w = 0\n"},
    CodeEntry{
        "E0629", "a start off the constraints of a degenerate Lagrangian",
        "The constraints leave fewer states than there are coordinates and velocities. What the start does not give "
        "follows from them; what it gives has to agree with them.",
        "dimensionless\ncoord x, y : number\nL = x y' - 1/2 (x^2 + y^2)\nstart exactly x = 1, y' = 3\nrun 1\n",
        "dimensionless\ncoord x, y : number\nL = x y' - 1/2 (x^2 + y^2)\nstart x = 1\nrun 1\n"},
    CodeEntry{
        "N0630", "what a run of a degenerate Lagrangian leaves out",
        "Some accelerations are free. A run has to choose them, and shows only what is the same with every choice: "
        "quantities that do not change along the orbits of the free functions.",
        "", ""},
    CodeEntry{"E0631", "a quantity without a value of its own",
              "It depends on functions of time that the Lagrangian leaves open.", "", ""},
    CodeEntry{
        "N0632", "a Lagrangian that holds accelerations",
        "Its equation d/dt ∂L/∂q' − ∂L/∂q − d²/dt² ∂L/∂q'' = 0 is of the fourth order (Ostrogradsky). A run takes "
        "L(q, v, v', t) + p (q' − v) in its place.",
        "dimensionless\ncoord q : number\nL = 1/2 q''^2 - 1/2 q^2\n", ""},
    CodeEntry{
        "E0633", "a Lagrangian whose class is not the same everywhere",
        "What vanishes near the start, a coefficient of an acceleration or what would be a constraint, does not "
        "vanish elsewhere: behind a switch, or where a narrow bump of inertia lies. A motion that goes there would "
        "obey other equations, and a run from here would not know.",
        "dimensionless\ncoord x, y : number\nL = 1/2 max(x - 3, 0)^2 x'^2 + x y' - 1/2 (x^2 + y^2)\nstart x = 1\n",
        "dimensionless\ncoord x, y : number\nL = x y' - 1/2 (x^2 + y^2) - max(x - 3, 0)^2\nstart x = 1\n"},
    CodeEntry{"N0628", "parameters with special values",
              "Ranks are taken at the values of the parameters. With these the class of the system is another one than "
              "for values nearby: a freedom, or a free function, more or less.",
              "", ""},
};

}  // namespace

std::span<const CodeEntry> equations_codes() { return entries; }

}  // namespace maupertuis
