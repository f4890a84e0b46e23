#include <maupertuis/codes.hpp>

#include <array>

namespace maupertuis {
namespace {

constexpr std::array entries{
    CodeEntry{"E1001", "the basis of a search for integrals is too large",
              "maup invariants looks for conserved quantities among the combinations of finitely many functions. "
              "Polynomials of "
              "high degree in many velocities have so many coefficients that the matrix of the search would not fit; "
              "the size is "
              "computed before anything else. A lower --degree asks for less; --largest-basis allows more.",
              "# maup invariants --degree 4\nparam m = 1 kg, k = 4 N/m\ncoord a, b, c, d, e, f : length\n"
              "T = 1/2 m (a'^2 + b'^2 + c'^2 + d'^2 + e'^2 + f'^2)\n"
              "V = 1/2 k ((b - a)^2 + (c - b)^2 + (d - c)^2 + (e - d)^2 + (f - e)^2)\nstart a = 1 cm\nrun 3 s\n",
              "# maup invariants --degree 2\nparam m = 1 kg, k = 4 N/m\ncoord a, b, c, d, e, f : length\n"
              "T = 1/2 m (a'^2 + b'^2 + c'^2 + d'^2 + e'^2 + f'^2)\n"
              "V = 1/2 k ((b - a)^2 + (c - b)^2 + (d - c)^2 + (e - d)^2 + (f - e)^2)\nstart a = 1 cm\nrun 3 s\n"},
    CodeEntry{"E1002", "the accelerations are not determined, so that nothing can be said of conservation",
              "dI/dt along the motion needs the accelerations. Where the mass matrix, bordered by the constraints, is "
              "singular, "
              "several motions start from one state. Functions of time that a degenerate Lagrangian leaves free are no "
              "obstacle: what is found is conserved whatever they are.",
              "", ""},
    CodeEntry{"E1003", "constraints that are not linear in the velocities are not searched",
              "Points of the motion are drawn over a prime field. Velocities that satisfy linear equations are found "
              "there by "
              "elimination; others are not. A single candidate is proved by `expect conserved EXPR`.",
              "# maup invariants\nparam m = 1 kg, v = 2 m/s\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\n"
              "constraint x'^2 + y'^2 = v^2\nstart x' = v\nrun 2 s\n",
              "# maup test\nparam m = 1 kg, v = 2 m/s\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\n"
              "constraint x'^2 + y'^2 = v^2\nstart x' = v\nrun 2 s\nexpect conserved 1/2 m (x'^2 + y'^2)\n"},
    CodeEntry{"W1004", "the drift of the integrals was not measured",
              "The integrals are proved without a run. Their drift along the model's own run is measured in addition; "
              "this run "
              "failed or could not start.",
              "# maup invariants\nparam m = 1 kg, k = 1 J m^2\ncoord x : length\nT = 1/2 m x'^2\nV = -1/2 k/x^2\n"
              "start x = 1 m\nrun 2 s\n",
              "# maup invariants\nparam m = 1 kg, k = 1 J m^2\ncoord x : length\nT = 1/2 m x'^2\nV = -1/2 k/x^2\n"
              "start x = 1 m\nrun 0.5 s\n"},
};

}  // namespace

std::span<const CodeEntry> invariants_codes() { return entries; }

}  // namespace maupertuis
