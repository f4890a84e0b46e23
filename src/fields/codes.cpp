#include <maupertuis/codes.hpp>

namespace maupertuis {
namespace {

constexpr CodeEntry kEntries[] = {
    {"E0292", "a slope that clashes with the natural condition",
     "At a free end the variation leaves ∂ℒ/∂u_x = 0. A given slope is an end force only where it says by itself what "
     "∂ℒ/∂u_x is there.",
     "# maup simulate\nfield u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N, a = 1 m\n"
     "density = 1/2 ρ u'^2 - 1/2 T u^2/a^2 u_x^2\nboundary left : u_x = 1\nrun 1 s\n",
     "# maup simulate\nfield u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\n"
     "density = 1/2 ρ u'^2 - 1/2 T u_x^2\nboundary left : u_x = 1\nrun 1 s\n"},
    {"E0508", "a run or an expectation of fields that is not supported yet",
     "Runs are those of fields of one space variable on a domain or of two on a rectangle: waves, beams and plates, "
     "and "
     "fields of first order in time, with coordinates and bodies on those of one variable. Fields of three space "
     "variables, without a domain, or with an input that has no formula have derivations, conservation laws and waves.",
     "# maup simulate\nfield u(x) : length\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\nrun 1 s\n",
     "# maup simulate\nfield u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\n"
     "density = 1/2 ρ u'^2 - 1/2 T u_x^2\nrun 1 s\n"},
    {"E0642", "a motion of a field that is not determined",
     "Each field needs an equation with its derivative by t. Where the density is linear in the velocities the "
     "equations are of first order: the field alone determines how it goes on, and its velocity cannot be chosen.",
     "# maup simulate\ndimensionless\nfield a(x), b(x) : number on x = 0 .. 1 cells 10 boundary a = 0, b = 0\n"
     "density = b a' - a b' - 1/2 (a_x^2 + b_x^2)\nstart a = sin(pi x), a' = 1\nrun 1\n",
     "# maup simulate\ndimensionless\nfield a(x), b(x) : number on x = 0 .. 1 cells 10 boundary a = 0, b = 0\n"
     "density = b a' - a b' - 1/2 (a_x^2 + b_x^2)\nstart a = sin(pi x)\nrun 1\n"},
    {"E0643", "a field that grows beyond all numbers",
     "The run met an infinity: an unstable density, or a start that grows.",
     "# maup simulate\nfield w(x) : length on x = 0 m .. 1 m cells 4 boundary w_x = 0\n"
     "param ρ = 1 kg/m, E = 1 N m^2, k = 1 N/m^4\ndensity = 1/2 ρ w'^2 - 1/2 E w_xx^2 + k w^4\nstart w = 10 m\n"
     "run 1 s\n",
     "# maup simulate\nfield w(x) : length on x = 0 m .. 1 m cells 4 boundary w_x = 0\n"
     "param ρ = 1 kg/m, E = 1 N m^2, k = 1 N/m^4\ndensity = 1/2 ρ w'^2 - 1/2 E w_xx^2 - k w^4\nstart w = 10 cm\n"
     "run 1 s\n"},
    {"E0645", "a start of a field that is no number",
     "Somewhere in the domain the formula of the start has no finite value.",
     "# maup simulate\nfield u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N, l = 1 m\n"
     "density = 1/2 ρ u'^2 - 1/2 T u_x^2\nstart u = l log(x/l - 2)\nrun 1 s\n",
     "# maup simulate\nfield u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N, l = 1 m\n"
     "density = 1/2 ρ u'^2 - 1/2 T u_x^2\nstart u = l log(x/l + 2)\nrun 1 s\n"},
    {"W0646", "a start of a field that does not fit its boundary condition",
     "At an end the field has the value of the condition from the beginning on, and its rate: with u = A sin(w t) the "
     "end moves off at once, u' = A w. Another value or rate beside it is a jump, of u or of u', which runs into the "
     "domain and which no mesh resolves.",
     "# maup simulate\nfield u(x) : length on x = 0 m .. 1 m boundary u = 0\nparam ρ = 1 kg/m, T = 1 N, l = 1 m\n"
     "density = 1/2 ρ u'^2 - 1/2 T u_x^2\nstart u = l\nrun 1 s\n",
     "# maup simulate\nfield u(x) : length on x = 0 m .. 1 m boundary u = 0\nparam ρ = 1 kg/m, T = 1 N, l = 1 m\n"
     "density = 1/2 ρ u'^2 - 1/2 T u_x^2\nstart u = l sin(pi x/l)\nrun 1 s\n"},
    {"E0647", "a mesh that passes something by",
     "A bump, a layer or a jump of the density or of the start lies between the nodes of the mesh. Values on it, and "
     "on a "
     "second mesh, would be those of a system without it.",
     "# maup simulate\ndimensionless\nfield u(x) : number on x = 0 .. 1 cells 20\ndensity = 1/2 u'^2 - 1/2 u_x^2\n"
     "start u = exp(-((x - 0.4877)/1e-4)^2)\nrun 1\n",
     "# maup simulate\ndimensionless\nfield u(x) : number on x = 0 .. 1 cells 20\ndensity = 1/2 u'^2 - 1/2 u_x^2\n"
     "start u = exp(-((x - 0.4877)/0.1)^2)\nrun 1\n"},
    {"W0650", "forces in time that are shorter than a step",
     "Boundary values, forces and coefficients in t are followed by the series of each step from its beginning. A "
     "pulse "
     "inside of a step is passed by on both meshes, and no error is estimated. Where the motion of a side has a jump "
     "or a kink steps end, but waves of every length run in from it, so that the error falls about with the width of a "
     "cell; its estimate is made for that.",
     "# maup simulate\ndimensionless\nfield u(x) : number on x = 0 .. 1 cells 4 order 6 boundary u = 0\n"
     "density = 1/2 u'^2 - 1/2 u_x^2\nforce density u = 1000 sin(pi x) exp(-((t - 0.5)/1e-5)^2)\nrun 1\n",
     "# maup simulate\ndimensionless\nfield u(x) : number on x = 0 .. 1 cells 4 order 6 boundary u = 0\n"
     "density = 1/2 u'^2 - 1/2 u_x^2\nforce density u = sin(pi x) exp(-((t - 0.5)/0.5)^2)\nrun 1\n"},
    {"W0651", "a jump or a kink in space",
     "Where the start jumps or has a kink, and where a periodic start does not close, waves of every length arise. No "
     "mesh follows the short ones, so that the error falls about with the width of a cell; its estimate is made for "
     "that.",
     "# maup simulate\ndimensionless\nfield u(x) : number on x = 0 .. 1 cells 20 boundary u = 0\n"
     "density = 1/2 u'^2 - 1/2 u_x^2\nstart u = min(x, 1 - x)\nrun 1\n",
     "# maup simulate\ndimensionless\nfield u(x) : number on x = 0 .. 1 cells 20 boundary u = 0\n"
     "density = 1/2 u'^2 - 1/2 u_x^2\nstart u = sin(pi x)\nrun 1\n"},
    {"W0652", "a start that the mesh follows in part",
     "Between the nodes of the elements the start is another function than their polynomials, by more than a "
     "hundredth of its largest value. Errors are those of short waves then, and fall fast with more cells; the "
     "estimate takes a "
     "mesh of twice the cells too.",
     "# maup simulate\ndimensionless\nfield u(x) : number on x = 0 .. 1 cells 20 boundary u = 0\n"
     "density = 1/2 u'^2 - 1/2 u_x^2\nstart u = exp(-((x - 0.4)/0.01)^2)\nrun 1\n",
     "# maup simulate\ndimensionless\nfield u(x) : number on x = 0 .. 1 cells 200 boundary u = 0\n"
     "density = 1/2 u'^2 - 1/2 u_x^2\nstart u = exp(-((x - 0.4)/0.01)^2)\nrun 1\n"},
    {"W0660", "a field that becomes steeper than its mesh can follow",
     "Where the speed of a wave depends on how steep it is, its parts overtake each other, and after a finite time the "
     "slope jumps. From there on the equations have no smooth solution, and which of the others is meant they do not "
     "say: a mesh goes on with short waves of its own. Values from that moment on have no estimate.",
     "# maup simulate\ndimensionless\nfield u(x) : number on x = 0 .. 1 cells 40 order 4 boundary periodic\n"
     "density = 1/2 u'^2 - 1/2 u_x^2 - u_x^4\nstart u = 0.1 sin(2 pi x)\nrun 2\n",
     "# maup simulate\ndimensionless\nfield u(x) : number on x = 0 .. 1 cells 40 order 4 boundary periodic\n"
     "density = 1/2 u'^2 - 1/2 u_x^2 - u_x^4\nstart u = 0.1 sin(2 pi x)\nrun 0.1\n"},
    {"W0661", "a run that does not keep its energy",
     "The discrete field has an energy of its own, which its motion conserves as the field conserves its energy; what "
     "is lost is lost by the steps in time. Where that is more than a millionth of its terms, they do not follow the "
     "motion of the mesh.",
     "", ""},
    {"W0653", "modes of a field without its dissipation",
     "Modes of fields are those of the density of Lagrange's function alone: frequencies and shapes of motions that do "
     "not decay. With dissipation each motion has a rate of decay and another frequency, of a string with r u' in "
     "every place sqrt(ω^2 - (r/2ρ)^2).",
     "# maup modes\nfield u(x) : length on x = 0 m .. 1 m cells 20 boundary u = 0\n"
     "param ρ = 1 kg/m, T0 = 1 N, r = 0.1 kg/(m s)\ndensity = 1/2 ρ u'^2 - 1/2 T0 u_x^2\n"
     "dissipation density = 1/2 r u'^2\n",
     "# maup modes --dispersion\nfield u(x) : length on x = 0 m .. 1 m cells 20 boundary u = 0\n"
     "param ρ = 1 kg/m, T0 = 1 N, r = 0.1 kg/(m s)\ndensity = 1/2 ρ u'^2 - 1/2 T0 u_x^2\n"
     "dissipation density = 1/2 r u'^2\n"},
    {"N0648", "a constant of a field that no equation determines",
     "A potential w of u = w_x stands in the density by its derivatives alone. Then w plus any function of t is the "
     "same "
     "motion, and a run keeps w at the left end of a periodic domain, or of free ends, as it starts.",
     "# maup simulate\ndimensionless\nfield w(x) : number on x = 0 .. 2*pi cells 6 order 9 boundary periodic\n"
     "density = 1/2 w' w_x - 1/2 w_xx^2\nstart w = cos(2*x)\nrun 1\n",
     "# maup simulate\ndimensionless\nfield w(x) : number on x = -5 .. 5 cells 10 order 7\n"
     "density = 1/2 w' w_x - 1/2 w_xx^2\nboundary left : w = 0, w_x = 0\nboundary right : w = 0, w_x = 0\n"
     "start w = exp(-x^2)\nrun 1/10\n"},
    {"E0656", "a mesh too large for a run with bodies",
     "Fields that bodies take hold of, and those whose density changes at a place, run as one system of at most 200 "
     "unknowns of elements. Elements of high order need few of them: 10 elements of order 16 have 161.",
     "# maup simulate\nfield u(x) : length on x = 0 m .. 1 m cells 400\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 kg\n"
     "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\nT = 1/2 m u(1 m)'^2\nrun 1 s\n",
     "# maup simulate\nfield u(x) : length on x = 0 m .. 1 m cells 10\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 kg\n"
     "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\nT = 1/2 m u(1 m)'^2\nrun 1 s\n"},
    {"E0657", "an impact on a field without a mass",
     "The impulse of an impact changes the velocity of what is hit by Λ/m. A point of a string or a beam has no mass, "
     "and the node of a mesh that stands for a piece of it has another one on each mesh.",
     "# maup simulate\nfield u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N\n"
     "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\ncontact u(1 m) <= 10 cm restitution 1/2\nstart u' = 1 m/s\nrun 1/2 s\n",
     "# maup simulate\nfield u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 kg\n"
     "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\nT = 1/2 m u(1 m)'^2\ncontact u(1 m) <= 10 cm restitution 1/2\n"
     "start u' = 1 m/s\nrun 1/2 s\n"},
    {"E0659", "static friction on a field without a mass",
     "Where friction gives way with μ_s > μ its force jumps, and with it the velocity of a string at that place: by "
     "ΔF/(2 Z) with the impedance Z. A mesh follows such a jump with oscillations, on which friction catches hold "
     "again.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N\n"
     "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\nfriction u(1 m) limit 0.1 N static 0.2 N\nstart u' = 1 m/s\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N\n"
     "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\nfriction u(1 m) limit 0.1 N\nstart u' = 1 m/s\n"},
    {"W0658", "modes of a field without contacts and dry friction",
     "Modes are small motions of one linear system. A contact that is closed holds the system on one side alone, and "
     "dry "
     "friction holds it altogether up to a limit; the modes that are shown have the contacts open and no friction.",
     "# maup modes\nfield u(x) : length on x = 0 m .. 1 m\nboundary left : u = 0\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 "
     "kg\n"
     "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\nT = 1/2 m u(1 m)'^2\ncontact u(1 m) <= 10 cm\n",
     "# maup modes\nfield u(x) : length on x = 0 m .. 1 m\nboundary left : u = 0\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 "
     "kg\n"
     "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\nT = 1/2 m u(1 m)'^2\n"},
    {"E0649", "a mesh that does not fit into the memory",
     "The Taylor coefficients of all nodes stand in the memory at once: some hundred bytes a node and operation of the "
     "density; of beams and fields of first order the matrices of a step. What a mesh takes is known before it is "
     "made.",
     "# maup simulate\ndimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 1000, 1000 order 20\n"
     "density = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2) - (1 - cos u)\nrun 1\n",
     "# maup simulate\ndimensionless\nfield u(x, y) : number on x = 0 .. 1, y = 0 .. 1 cells 20, 20 order 6\n"
     "density = 1/2 u'^2 - 1/2 (u_x^2 + u_y^2) - (1 - cos u)\nrun 1\n"},
    {"E0644", "no modes of a field",
     "Frequencies are those of small motions about a rest, the start where it is one, else φ = 0, else the equilibrium "
     "that Newton's method finds from the start, of a field of one or two space variables with a domain, coefficients "
     "that are constant in time and a positive energy; dispersion relations those of waves through coefficients that "
     "are constant in space too.",
     "# maup modes\nfield u(x) : length on x = 0 m .. 1 m cells 20 boundary u = 0\n"
     "param ρ = 1 kg/m, T0 = 1 N, τ = 2 s\ndensity = 1/2 ρ u'^2 - 1/2 T0 (1 + t/τ) u_x^2\n",
     "# maup modes\nfield u(x) : length on x = 0 m .. 1 m cells 20 boundary u = 0\nparam ρ = 1 kg/m, T0 = 1 N\n"
     "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\n"},
    {"E0641", "an ill-posed field equation",
     "Where the parts of the density in u' and in u_x have the same sign, the equation is elliptic in time: waves "
     "grow, the shorter the faster, so that no start determines what follows.",
     "# maup derive\nfield u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N\n"
     "density = 1/2 ρ u'^2 + 1/2 T0 u_x^2\n",
     "# maup derive\nfield u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N\n"
     "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\n"},
    {"N0640", "field equations without the time",
     "The density holds no velocity: its equations are those of a field at rest, or of one that follows at once what "
     "it carries.",
     "# maup derive\nfield u(x) : length on x = 0 m .. 1 m\nparam T0 = 1 N\ndensity = -1/2 T0 u_x^2\n",
     "# maup derive\nfield u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N\n"
     "density = 1/2 ρ u'^2 - 1/2 T0 u_x^2\n"},
    {"N0662", "a start of a field without inertia that is not followed",
     "A string or a beam without mass is at rest at every moment: between the masses that it carries its shape follows "
     "from their places. A mass starts where the start of the field has its place; what the start says between them "
     "is another shape than that of the rest, and does not count.",
     "# maup simulate\nfield u(x) : length on x = 0 m .. 2 m cells 4 order 4 boundary u = 0\n"
     "param T0 = 1 N, m = 1 kg, a = 1 m, A = 1 mm\ndensity = -1/2 T0 u_x^2\nT = 1/2 m u(a)'^2\n"
     "start u = A x (2 a - x)/a^2\nrun 1 s\n",
     "# maup simulate\nfield u(x) : length on x = 0 m .. 2 m cells 4 order 4 boundary u = 0\n"
     "param T0 = 1 N, m = 1 kg, a = 1 m, A = 1 mm\ndensity = -1/2 T0 u_x^2\nT = 1/2 m u(a)'^2\n"
     "start u = A min(x, 2 a - x)/a\nrun 1 s\n"},
};

}  // namespace

std::span<const CodeEntry> fields_codes() { return kEntries; }

}  // namespace maupertuis
