#include <maupertuis/codes.hpp>

namespace maupertuis {
namespace {

constexpr CodeEntry kEntries[] = {
    // ------------------------------------------------------------------------------------------ names and statements
    {"E0201", "a name is not declared",
     "Every name of a formula is declared somewhere in the model: with param, coord, let, input, point, body or frame. "
     "The order of "
     "the lines does not matter. T, V, U, L, D, t, pi and the origin O need no declaration.",
     "coord x : length\nparam m = 1 kg\nT = 1/2 M x'^2\n", "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\n"},
    {"E0202", "a name is declared twice",
     "A name has one meaning in a model. Coordinates, parameters, definitions, points, bodies and frames share one "
     "list of names.",
     "coord x : length\nparam x = 1 m, m = 1 kg\nT = 1/2 m x'^2\n",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\n"},
    {"E0203", "definitions go round in a circle",
     "A definition may use others, in any order, but following them must come to an end: a = b + 1 and b = a - 1 "
     "define neither.",
     "coord x : length\nparam m = 1 kg\nlet a = b x, b = a/x\nT = 1/2 m a'^2\n",
     "coord x : length\nparam m = 1 kg\nlet a = b x, b = 2\nT = 1/2 m a'^2\n"},
    {"E0204", "the model has no coordinate",
     "Lagrange's equations are written in generalized coordinates, one equation for each. A model without one has "
     "nothing that could move.",
     "param m = 1 kg\n", "param m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n"},
    {"E0207", "an energy is given twice",
     "`T = …` gives the whole kinetic energy; a second one would contradict it. Further parts are added with `+=`.",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m x'^2\nT = 1/2 m y'^2\n",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m x'^2\nT += 1/2 m y'^2\n"},
    {"E0208", "something is given twice",
     "Gravity, run, output, sweep, path, the independent variable, the source and the start of each variable are given "
     "once.",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nrun 1 s\nrun 2 s\n",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nrun 2 s\n"},
    {"E0209", "a formula where a quantity is needed",
     "A parameter is a number with its unit, which --set and a parameter study may change. What follows from other "
     "quantities is a "
     "definition: `let J = m l^2`.",
     "coord x : length\nparam m = 1 kg\nparam M = m + m\nT = 1/2 M x'^2\n",
     "coord x : length\nparam m = 1 kg\nlet M = m + m\nT = 1/2 M x'^2\n"},
    {"E0210", "a vector and a number are mixed up",
     "Positions, forces and gravity are vectors; energies, masses and angles are numbers. A vector is scaled by a "
     "number, added to vectors, "
     "and made a number by .x, dot(u, v) or norm(u). v^2 is dot(v, v).",
     "coord x : length\nparam m = 1 kg\npoint P mass m at x\n",
     "coord x : length\nparam m = 1 kg\npoint P mass m at (x, 0)\n"},
    {"E0211", "two and three dimensions are mixed",
     "A model is in the plane or in space: all its vectors have two components, or all have three.",
     "coord x : length\nparam m = 1 kg, g = 9.81 m/s^2\npoint P mass m at (x, 0)\ngravity (0, 0, -g)\n",
     "coord x : length\nparam m = 1 kg, g = 9.81 m/s^2\npoint P mass m at (x, 0)\ngravity (0, -g)\n"},
    {"E0212", "a name of another kind",
     "Forces act on points and bodies, torques on bodies and frames, `in` takes a frame or a body, `force q = …` a "
     "coordinate.",
     "coord x : length\nparam m = 1 kg, F = 1 N\npoint P mass m at (x, 0)\nforce on x = (F, 0)\n",
     "coord x : length\nparam m = 1 kg, F = 1 N\npoint P mass m at (x, 0)\nforce on P = (F, 0)\n"},
    {"E0216", "there is no such component",
     "Points, bodies and vectors have .x and .y, in space .z; frames and bodies have their angular velocity, .ω along "
     "their own axes and .ω_world along the axes of the world.",
     "coord x : length\nparam m = 1 kg, g = 9.81 m/s^2\npoint P mass m at (x, x)\nV = m g P.z\n",
     "coord x : length\nparam m = 1 kg, g = 9.81 m/s^2\npoint P mass m at (x, x)\nV = m g P.y\n"},
    {"E0217", "the time derivative of a constant",
     "A parameter does not change in time, so that its derivative is zero; a formula that contains one almost always "
     "means another name.",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2 + m' x'\n",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\n"},
    {"E0218", "a number beyond the range of computation",
     "Runs compute in double precision, between 1e-308 and 1e308. Choose units in which the quantities of the model "
     "are of moderate size.",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nV = 1 [N] x * 10^5000\n",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nV = 1 [N] x * 10^5\n"},
    {"N0252", "an expected frequency that does not exist with these parameters",
     "`expect frequencies : sqrt(Ω^2 - k)` says something where Ω² > k. With other values of the parameters, by --set "
     "or in a sweep, the expectation fails in `test`; everything else of the model is computed as ever.",
     "dimensionless\nparam k = 1, Ω = 0.9\ncoord x : number\nL = 1/2 x'^2 - 1/2 k x^2\nexpect frequencies at x = 0 : "
     "sqrt(Ω^2 - k) rel 1e-9\n",
     "dimensionless\nparam k = 1, Ω = 1.5\ncoord x : number\nL = 1/2 x'^2 - 1/2 k x^2\nexpect frequencies at x = 0 : "
     "sqrt(Ω^2 - k) rel 1e-9\n"},
    {"E0253", "the condition that is to end a run does not depend on the motion",
     "`run until A = B` ends where A - B passes zero. Where it is made of numbers and parameters alone, or vanishes "
     "always as x - x does, it marks no moment.",
     "coord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\nstart x = 1 m\n"
     "run until x = x within 10 s\n",
     "coord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\nstart x = 1 m\n"
     "run until x = 0 m within 10 s\n"},
    {"E0219", "division by zero", "A quotient by zero and a negative power of zero have no value.",
     "coord x : length\nparam m = 1 kg\nT = m x'^2/0\n", "coord x : length\nparam m = 1 kg\nT = m x'^2/2\n"},
    {"E0220", "the dissipation function is given beside dampers",
     "Every damper adds its part to D; `D = …` would contradict it. Further parts are added with `D += …`.",
     "coord x : length\nparam m = 1 kg, c = 1 N s/m\npoint P mass m at (x, 0)\ndamper O - P coefficient c\nD = 1/2 c "
     "x'^2\n",
     "coord x : length\nparam m = 1 kg, c = 1 N s/m\npoint P mass m at (x, 0)\ndamper O - P coefficient c\nD += 1/2 c "
     "x'^2\n"},
    {"E0221", "a condition and a formula are mixed up",
     "Comparisons stand in piecewise(condition : value, …, else : value), and only there.",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nV = piecewise((x > 0) + 1 > 0 : 1 [N] x, else : 0)\n",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nV = piecewise(x > 0 : 1 [N] x, else : 0)\n"},
    {"E0222", "a number that must be known before the run",
     "Starts, durations, tolerances and sizes are made of quantities and parameters; coordinates and time are known "
     "only during the run. An input is a formula of t and parameters.",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\nstart x = y\n",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\nstart x = 1 m\n"},
    {"E0223", "a start of what is no coordinate",
     "The state of a system is its coordinates and their velocities. Parameters have their values from `param`, "
     "accelerations from the equations of motion.",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nstart m = 2 kg\n",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nstart x = 2 m\n"},
    {"E0224", "a value given beside the model does not fit it",
     "--set takes a parameter and a quantity of its dimension, --set m=2kg; --start takes a coordinate or its "
     "velocity, --start θ=30deg.",
     "maup check pendulum.lag --set m=2m", "maup check pendulum.lag --set m=2kg"},
    {"E0225", "a force of constraint where it cannot stand",
     "Multipliers and reactions follow from the equations of motion. They may be expected and claimed; energies, "
     "forces "
     "and constraints, from which the equations come, cannot be made of them.",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = y name rod\nforce x = "
     "reaction(rod)\n",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = y name rod\nexpect reaction(rod) "
     "at 1 s = 0 N ± 1e-9\n"},
    {"E0226", "no constraint of this name",
     "multiplier(rod), reaction(rod), draw reaction rod and `expect constraint rod is …` mean the constraint whose "
     "line "
     "ends with `name rod`. The name of `reaction rod = release l` has a reaction, and no multiplier.",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = y\nexpect multiplier(rod) at 1 s "
     "= 0 N ± 1e-9\n",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = y name rod\nexpect "
     "multiplier(rod) at 1 s = 0 N ± 1e-9\n"},
    {"E0227", "no class of constraints",
     "A constraint is holonomic, or nonholonomic; a holonomic one is scleronomic, or rheonomic if time stands in it; a "
     "constraint of velocities is integrable where it comes from one of positions.",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = y name rod\nexpect constraint rod "
     "is elastic\n",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = y name rod\nexpect constraint rod "
     "is holonomic\n"},
    {"E0228", "no coordinate for a Routhian",
     "`expect routhian of φ, ψ = …` names coordinates of the model: those whose velocities are replaced by their "
     "momenta.",
     "param m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\nexpect routhian of m = -p_x^2/(2 m)\n",
     "param m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\nexpect routhian of x = -p_x^2/(2 m)\n"},
    {"E0238", "no word for the stability of an equilibrium",
     "`expect equilibrium at θ = 0 is stable` is checked by the energy (a strict minimum) and by the eigenvalues; "
     "`unstable` needs an eigenvalue with a "
     "positive real part; `undecided` says that the linearization does not decide.",
     "dimensionless\ncoord θ : angle\nL = 1/2 θ'^2\nexpect equilibrium at θ = 0 is good",
     "dimensionless\ncoord θ : angle\nL = 1/2 θ'^2\nexpect equilibrium at θ = 0 is stable"},
    {"E0239", "a sweep of something that is no parameter, or of no values",
     "`sweep NAME = FROM .. TO steps N` goes through N equally spaced values of one parameter, both ends counted.",
     "dimensionless\nparam k = 1\ncoord x : number\nL = 1/2 x'^2 - 1/2 k x^2\nsweep x = 0 .. 1 steps 11",
     "dimensionless\nparam k = 1\ncoord x : number\nL = 1/2 x'^2 - 1/2 k x^2\nsweep k = 0 .. 1 steps 11"},
    {"E0240", "mechanics without the time",
     "`independent x : length` puts a length in the place of the time: q' is dq/dx, and the action is the integral of "
     "L dx, whatever "
     "the dimension of L. Masses, gravity, springs, forces and energies belong to motions in time, so that such a "
     "model gives its L alone.",
     "independent x : length\ncoord y : length\nparam m = 1 kg\nT = 1/2 m y'^2\n",
     "independent x : length\ncoord y : length\nL = sqrt(1 + y'^2)\n"},
    {"E0241", "a path with too few or too many values",
     "`path from (0, 1) at 0 to (2, free) at 1` and `expect action of (…)` give every coordinate its value, in the "
     "order of their declaration; "
     "`maup action --path \"x = 4 t, y = 3 t\"` names them, as `path from (x = 0, x' = 1) at 0 to …` does. `free` "
     "stands at an end where a coordinate may have any value. Rates stand there where second derivatives are in L.",
     "dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2)\npath from (0, 0) at 0 to 1 at 1\n",
     "dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2)\npath from (0, 0) at 0 to (1, free) at 1\n"},
    {"E0242", "a path that ends before it begins", "An action is an integral from an earlier time to a later one.",
     "dimensionless\ncoord x : number\nL = 1/2 x'^2\npath from 0 at 1 to 1 at 0\n",
     "dimensionless\ncoord x : number\nL = 1/2 x'^2\npath from 1 at 0 to 0 at 1\n"},
    {"E0243", "a path without ends",
     "`expect action`, `expect index` and `expect path` are about the stationary path between the ends that `path from "
     "… to …` gives; the "
     "action of a path that is given as a formula needs them as well, or its own: `expect action of (2 t) from 0 to 1 "
     "= 2`.",
     "dimensionless\ncoord x : number\nL = 1/2 x'^2\nexpect action = 1/2 ± 1e-9\n",
     "dimensionless\ncoord x : number\nL = 1/2 x'^2\npath from 0 at 0 to 1 at 1\nexpect action = 1/2 ± 1e-9\n"},
    {"E0244", "a motion where an integral of the path is held",
     "`constraint integral G = value` restricts whole paths: their equations are those of L + λ G with one λ for the "
     "whole path, which only the "
     "two ends and the value of the integral determine. `maup action` finds the path and λ; there is no motion from a "
     "start.",
     "dimensionless\ncoord x : number\nL = 1/2 x'^2\nconstraint integral x = 1\npath from 0 at 0 to 0 at 1\nexpect x "
     "at 1 = 0 ± 1e-9\n",
     "dimensionless\ncoord x : number\nL = 1/2 x'^2\nconstraint integral x = 1\npath from 0 at 0 to 0 at 1\nexpect "
     "path x at 1/2 = 3/2 ± 1e-9\n"},
    {"E0246", "an end of the run that the model does not have",
     "`expect until at T` and `expect EXPR at until` are about the moment at which the condition of `run until A = B "
     "within T` is met.",
     "dimensionless\ncoord x : number\nL = 1/2 x'^2\nrun 1\nexpect until at 1 ± 1e-9\n",
     "dimensionless\ncoord x : number\nL = 1/2 x'^2\nstart x' = 1\nrun until x = 1 within 2\nexpect until at 1 ± "
     "1e-9\n"},
    {"E0247", "a matrix that does not fit the model",
     "Rows and columns of M, C, G, K and N belong to coordinates, those of A to coordinates and velocities, the "
     "columns of B to inputs; `in (…)` names "
     "the rows that are meant and `by (…)` the columns. A row is a bracket: ((1, 2), (3, 4)).",
     "dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2)\nexpect M at x = 0 : ((1)) ± 1e-9\n",
     "dimensionless\ncoord x, y : number\nL = 1/2 (x'^2 + y'^2)\nexpect M at x = 0 : ((1, 0), (0, 1)) ± 1e-9\n"},
    {"E0248", "a critical value of something that is no parameter",
     "`expect stable for Ω < 5.72 rad/s ± 1e-2 at θ = 0` says at which value of a parameter the stability of an "
     "equilibrium changes.",
     "dimensionless\nparam k = 1\ncoord x : number\nL = 1/2 x'^2 - 1/2 k x^2\nexpect stable for x > 0 ± 1e-9\n",
     "dimensionless\nparam k = 1\ncoord x : number\nL = 1/2 x'^2 - 1/2 k x^2\nexpect stable for k > 0 ± 1e-9\n"},
    {"E0249", "a step or an order that a method chooses itself",
     "Taylor's and the stiff method choose the lengths of their steps by the tolerance, the stiff one also its order. "
     "The variational method has steps "
     "that are all alike: `method variational order 4 step 10 ms`.",
     "dimensionless\ncoord x : number\nL = 1/2 x'^2\nmethod stiff step 1\n",
     "dimensionless\ncoord x : number\nL = 1/2 x'^2\nmethod variational step 1\n"},
    {"E0250", "a tolerance beside the rate of a steady motion",
     "What has a tolerance is solved for, beginning at the value that is given; the rate of a steady motion, or its "
     "momentum, is what chooses among a "
     "family of them. So the rate is given, and the coordinates that belong to it are found.",
     "dimensionless\ncoord r, φ : number\nL = 1/2 (r'^2 + r^2 φ'^2) + 1/r\nstart r = 1\nexpect equilibrium at r = 1, "
     "φ' = 1 ± 1e-9\n",
     "dimensionless\ncoord r, φ : number\nL = 1/2 (r'^2 + r^2 φ'^2) + 1/r\nstart r = 1\nexpect equilibrium at r = 1 ± "
     "1e-9, φ' = 1\n"},
    {"E0251", "no method, or no precision, of this name",
     "`method` says how the runs of a model step: auto, taylor, variational or stiff. `precision` says with how many "
     "digits `maup simulate` and "
     "`maup test` calculate: double (16), quad (33) or 100.",
     "dimensionless\ncoord x : number\nL = 1/2 x'^2\nmethod euler\n",
     "dimensionless\ncoord x : number\nL = 1/2 x'^2\nmethod stiff\n"},
    // ----------------------------------------------------------------------------------------------------------- units
    {"E0301", "a unit is not known",
     "Units are SI base and derived units with the SI prefixes, and common ones without: min, h, deg, rev, rpm, bar, "
     "eV, inch, ft, lbf.",
     "coord x : length\nparam m = 1 kgg\nT = 1/2 m x'^2\n", "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\n"},
    {"E0302", "quantities of different dimensions are added or compared",
     "An energy cannot be added to a momentum, nor a length be compared with a time. One of the terms lacks a factor, "
     "a power or a derivative.",
     "coord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2 + k x\n",
     "coord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"},
    {"E0303", "the argument of a function has a dimension",
     "sin, exp and log are power series in their argument: x + x³/6 makes sense only for a bare number (or an angle). "
     "Divide by a length, or multiply a "
     "rate by t. Without brackets a function takes one name: cos ω t is (cos ω) t.",
     "coord x : length\nparam m = 1 kg, k = 1 J\nT = 1/2 m x'^2\nV = k cos x\n",
     "coord x : length\nparam m = 1 kg, k = 1 J, a = 1 m\nT = 1/2 m x'^2\nV = k cos(x/a)\n"},
    {"E0304", "a quantity of another dimension is needed",
     "T, V, U and L are energies, D is a power, a force on a point is a force, a force along a coordinate is an energy "
     "divided by the coordinate. The "
     "message names what is needed and what is there.",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'\n", "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\n"},
    {"E0305", "an exponent that no dimension has",
     "An exponent is a bare number, and it is known where the base has a dimension: the dimension of the result must "
     "be known.",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nV = 1 [J] * 2^x\n",
     "coord x : length\nparam m = 1 kg, a = 1 m\nT = 1/2 m x'^2\nV = 1 [J] * 2^(x/a)\n"},
    {"E0306", "a frequency in Hz where an angular velocity is needed",
     "A frequency of 1 Hz is one turn a second, an angular velocity of 2π rad/s. Write rev/s, rpm or rad/s, or "
     "multiply by 2 pi.",
     "coord θ : angle\nparam I = 1 kg m^2\nT = 1/2 I θ'^2\nstart θ' = 2 Hz\n",
     "coord θ : angle\nparam I = 1 kg m^2\nT = 1/2 I θ'^2\nstart θ' = 2 rev/s\n"},
    {"E0307", "a word is a unit and a name, and both fit",
     "After a number a word may be a unit or a name of the model; the reading whose dimension fits is taken. Where "
     "both fit, say which: 2 [m] is two metres, 2 * m twice m.",
     "coord x : length\nparam m = 1 m, M = 1 kg\nT = 1/2 M x'^2\nstart x = 2 m\n",
     "coord x : length\nparam m = 1 m, M = 1 kg\nT = 1/2 M x'^2\nstart x = 2 * m\n"},
    {"E0308", "a unit in a model without units",
     "`dimensionless` turns units off for models of the literature; every quantity is a bare number, only angles may "
     "be given in deg.",
     "dimensionless\ncoord x : number\nparam m = 1 kg\nT = 1/2 m x'^2\n",
     "dimensionless\ncoord x : number\nparam m = 1\nT = 1/2 m x'^2\n"},
    {"W0309", "a frequency in Hz turns a phase without 2π",
     "sin(f t) with f in Hz runs through a period in 2π/f, not in 1/f: sin(2 pi f t) was probably meant.",
     "coord x : length\nparam m = 1 kg, f = 2 Hz, F = 1 N\nT = 1/2 m x'^2\nforce x = F sin(f t)\n",
     "coord x : length\nparam m = 1 kg, f = 2 Hz, F = 1 N\nT = 1/2 m x'^2\nforce x = F sin(2 pi f t)\n"},
    {"W0310", "a large angle without a unit",
     "A bare number is an angle in radians: 60 are nine and a half turns. Write 60 deg for degrees, or 60 rad if it is "
     "meant.",
     "coord θ : angle\nparam I = 1 kg m^2\nT = 1/2 I θ'^2\nstart θ = 60\n",
     "coord θ : angle\nparam I = 1 kg m^2\nT = 1/2 I θ'^2\nstart θ = 60 deg\n"},
    {"E0313", "a unit word with two meanings",
     "By the rules of SI PS is a petasiemens, and to many a horsepower; Gs is a gigasecond, and a gauss. A model that "
     "takes the wrong "
     "one is off by many powers of ten, so that neither is taken silently.",
     "coord x : length\nparam m = 1 kg, v = 1 m/s, P = 1 PS\nT = 1/2 m x'^2\nforce x = P/v\n",
     "coord x : length\nparam m = 1 kg, v = 1 m/s, P = 735.49875 W\nT = 1/2 m x'^2\nforce x = P/v\n"},
    {"E0312", "a unit in a formula needs brackets",
     "In formulas m is a name, never the metre. A number with a unit is written 3 [m] there.",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nV = 3 N x\n",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nV = 3 [N] x\n"},
    // -------------------------------------------------------------------------------------------- kinematics and
    // physics
    {"E0401", "a derivative of too high an order",
     "Positions depend on coordinates and time; energies and forces on these and velocities. Accelerations are what "
     "the equations of motion give.",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nV = m x x''\n",
     "coord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"},
    {"E0402", "a rotation is not complete",
     "In the plane a rotation is `angle θ`. In space it is `axis (…) angle θ`, `euler zxz (φ, θ, ψ)` with three axes, "
     "neighbours different, `rpy (roll, pitch, yaw)`, or `quaternion`.",
     "coord θ : angle\nparam m = 1 kg, l = 1 m\nframe F at (0, 0, 0) rotation axis (0, 0, 0) angle θ\npoint P mass m "
     "at (l, 0, 0) in F\n",
     "coord θ : angle\nparam m = 1 kg, l = 1 m\nframe F at (0, 0, 0) rotation axis (0, 0, 1) angle θ\npoint P mass m "
     "at (l, 0, 0) in F\n"},
    {"E0403", "a mass is zero or negative", "Masses are positive. A point that only marks a place has no `mass`.",
     "coord x : length\nparam m = 0 kg\npoint P mass m at (x, 0)\n",
     "coord x : length\nparam m = 1 kg\npoint P mass m at (x, 0)\n"},
    {"E0404", "no body has this inertia",
     "A moment of inertia is a sum of masses times squared distances: none is negative, and each principal moment is "
     "at most the sum of the other two (equal for flat bodies).",
     "coord θ : angle\nparam I = 1 kg m^2, J = 3 kg m^2\nbody B inertia diag(I, I, J) rotation axis (0, 0, 1) angle "
     "θ\n",
     "coord θ : angle\nparam I = 1 kg m^2, J = 2 kg m^2\nbody B inertia diag(I, I, J) rotation axis (0, 0, 1) angle "
     "θ\n"},
    {"E0405", "a velocity stands in V",
     "A potential energy depends on positions and perhaps on time; its force is −∂V/∂q. What depends on velocities is "
     "a generalized potential U (magnetic forces) or friction (D).",
     "coord x : length\nparam m = 1 kg, b = 1 N s\nT = 1/2 m x'^2\nV = b x'\n",
     "coord x : length\nparam m = 1 kg, k = 1 N\nT = 1/2 m x'^2\nV = k x\n"},
    {"E0406", "a coordinate is never used",
     "No energy and no force depends on the coordinate, so that nothing determines its motion.",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m x'^2\n", "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\n"},
    {"E0407", "a coordinate has no kinetic energy",
     "No mass moves when it changes, and what else the model says leaves its motion open, or contradicts itself: a "
     "constant force on a point without mass. Where its equation determines it all the same, there is a warning, "
     "W0621.",
     "coord x, y : length\nparam m = 1 kg, F = 1 N\npoint P mass m at (x, 0)\npoint Q at (x, y)\nforce on Q = (0, F)\n",
     "coord x, y : length\nparam m = 1 kg, F = 1 N\npoint P mass m at (x, 0)\npoint Q mass m at (x, y)\nforce on Q = "
     "(0, "
     "F)\n"},
    {"E0408", "the mass matrix is singular",
     "The kinetic energy of points and bodies depends on a combination of velocities only: a motion that keeps it "
     "costs "
     "nothing, and its acceleration is not determined. So with four components of a quaternion of which nothing holds "
     "the "
     "norm.",
     "coord w, x, y, z : number\nparam I = 1 kg m^2\nbody B inertia diag(I, I, 2 I) rotation quaternion (w, x, y, z)\n"
     "start w = 1\n",
     "coord w, x, y, z : number\nparam I = 1 kg m^2\nbody B inertia diag(I, I, 2 I) rotation quaternion (w, x, y, z)\n"
     "constraint w^2 + x^2 + y^2 + z^2 = 1\nstart w = 1\n"},
    {"E0409", "a parameter is zero where motion needs it",
     "With the value zero the kinetic energy of a motion vanishes: a pendulum of length zero cannot swing.",
     "coord θ : angle\nparam m = 1 kg, l = 0 m\nT = 1/2 m l^2 θ'^2\n",
     "coord θ : angle\nparam m = 1 kg, l = 1 m\nT = 1/2 m l^2 θ'^2\n"},
    {"W0410", "the kinetic energy is not positive",
     "Some velocity has a negative kinetic energy. Real masses do not, but Lagrangians of the literature may "
     "(Bateman's damped oscillator and its mirror image).",
     "coord x, y : length\nparam m = 1 kg\nT = m x' y'\n",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\n"},
    {"E0411", "a given energy is not that of the points",
     "Points, bodies, springs and gravity give T and V. `T = …` beside them is a claim, which is checked; the message "
     "shows the difference. A further part is added with `T += …`.",
     "coord θ : angle\nparam m = 1 kg, l = 1 m\npoint P mass m at l (sin θ, -cos θ)\nT = m l^2 θ'^2\n",
     "coord θ : angle\nparam m = 1 kg, l = 1 m\npoint P mass m at l (sin θ, -cos θ)\nT = 1/2 m l^2 θ'^2\n"},
    {"W0411", "whether a given energy is that of the points could not be decided",
     "The difference of the two could neither be proved to vanish nor shown not to.", "", ""},
    {"W0412", "a term of the Lagrangian has no effect",
     "A total time derivative dF(q,t)/dt adds nothing to Lagrange's equations. Damping is written as D = 1/2 c x'^2, "
     "not as a term of L.",
     "coord x : length\nparam m = 1 kg, c = 1 N s/m\nL = 1/2 m x'^2 - c x x'\n",
     "coord x : length\nparam m = 1 kg, c = 1 N s/m\nL = 1/2 m x'^2\nD = 1/2 c x'^2\n"},
    {"W0413", "the weight is counted twice",
     "`gravity` gives every point and body with a mass its potential energy. The same weight in V doubles it.",
     "coord y : length\nparam m = 1 kg, g = 9.81 m/s^2\npoint P mass m at (0, y)\ngravity (0, -g)\nV += m g y\n",
     "coord y : length\nparam m = 1 kg, g = 9.81 m/s^2\npoint P mass m at (0, y)\ngravity (0, -g)\n"},
    {"W0415", "a parameter or an input is never used",
     "Nothing in the model depends on it: often a term was forgotten or a name misspelt.",
     "coord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\n",
     "coord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"},
    {"W0416", "a definition is never used",
     "No formula of the model names it: often a term was forgotten or a name misspelt.",
     "coord x : length\nparam m = 1 kg\nlet a = 2 m\nT = 1/2 m x'^2\n",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\n"},
    {"E0417", "more coordinates than the masses have ways to move",
     "The positions of the masses depend on fewer combinations than there are coordinates: some change of the "
     "coordinates moves no mass.",
     "coord x, y : length\nparam m = 1 kg\npoint P mass m at (x + y, 0)\n",
     "coord x : length\nparam m = 1 kg\npoint P mass m at (x, 0)\n"},
    {"W0418", "an energy has no effect beside a given Lagrangian",
     "`L = …` gives the whole Lagrangian; T and V count only as far as it names them: L = T - V + ….",
     "coord x : length\nparam m = 1 kg, k = 1 N/m\nV = 1/2 k x^2\nL = 1/2 m x'^2\n",
     "coord x : length\nparam m = 1 kg, k = 1 N/m\nV = 1/2 k x^2\nL = 1/2 m x'^2 - V\n"},
    {"W0419", "a negative stiffness, rest length or dissipation",
     "Such a spring pushes away from its rest, such a damper or D feeds energy in. All this is allowed, and rarely "
     "meant.",
     "coord x : length\nparam m = 1 kg, k = -1 N/m\npoint P mass m at (x, 0)\nspring O - P stiffness k\n",
     "coord x : length\nparam m = 1 kg, k = 1 N/m\npoint P mass m at (x, 0)\nspring O - P stiffness k\n"},
    {"W0420", "an expectation says nothing",
     "It holds for every motion of every system, so that it tests nothing: its two sides are the same formula, or what "
     "it calls conserved is a constant.",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nexpect equation x'' = x''\n",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nexpect equation m x'' = 0\n"},
    {"W0421", "a kinetic energy without a velocity",
     "Velocities are written with a prime: x'. An energy of position is a potential energy.",
     "coord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 k x^2\nL += 1/2 m x'^2\n",
     "coord x : length\nparam m = 1 kg, k = 1 N/m\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"},
    {"W0422", "a dissipation function without a velocity",
     "D enters the equations as ∂D/∂q̇; a term without a velocity has no effect. Linear damping is D = 1/2 c x'^2.",
     "coord x : length\nparam m = 1 kg, P = 1 W\nT = 1/2 m x'^2\nD = P\n",
     "coord x : length\nparam m = 1 kg, c = 1 N s/m\nT = 1/2 m x'^2\nD = 1/2 c x'^2\n"},
    {"E0423", "a constraint without coordinates",
     "A constraint relates coordinates or velocities. A relation of parameters and time alone is true or false, "
     "whatever "
     "the motion; what is computed from parameters is a definition.",
     "coord x : length\nparam m = 1 kg, a = 1 m, b = 2 m\nT = 1/2 m x'^2\nconstraint a = b\n",
     "coord x : length\nparam m = 1 kg, a = 1 m\nlet b = 2 a\nT = 1/2 m x'^2\nconstraint x = b\n"},
    {"E0424", "a constraint that is always true",
     "Both sides are the same function of the coordinates, so that every motion obeys it: often a term has the wrong "
     "name or sign.",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\nconstraint (x + y)^2 = x^2 + 2 x y + y^2\n",
     "coord x, y : length\nparam m = 1 kg, l = 1 m\nT = 1/2 m (x'^2 + y'^2)\nconstraint x^2 + y^2 = l^2\n"},
    {"W0425", "a constraint is written twice",
     "The second one takes no freedom away. The motion is the same, but how the force is shared between the two is not "
     "determined.",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = y\nconstraint y - x = 0\n",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\nconstraint x = y\n"},
    {"E0426", "a constraint with a switch",
     "The force of a constraint needs its second derivative along the motion. abs, sign, step, min, max and piecewise "
     "have none at their switches; neither has an input that is made of them. An inequality is a contact.",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\nconstraint y = abs(x)\n",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\nconstraint y = x\n"},
    {"W0427", "a quaternion that is not of norm 1",
     "A rotation needs a unit quaternion: another one stretches what it turns. `rotation quaternion` alone adds the "
     "four "
     "components and their norm; where the components are given, the model sees to it.",
     "param I = 1 kg m^2\ncoord w, x, y, z : number\nbody B inertia diag(I, I, I) rotation quaternion (w, x, y, z)\n"
     "constraint w = 1\n",
     "param I = 1 kg m^2\ncoord w, x, y, z : number\nbody B inertia diag(I, I, I) rotation quaternion (w, x, y, z)\n"
     "constraint w^2 + x^2 + y^2 + z^2 = 1\n"},
    {"N0428", "a coordinate without kinetic energy of its own",
     "The mass matrix is singular, but regular on what the constraints leave, so that the accelerations are "
     "determined. "
     "That is as it should be for a gear without inertia or an auxiliary coordinate; else a mass was forgotten.",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m x'^2\nconstraint y = 2 x\n",
     "coord x, y : length\nparam m = 1 kg\nT = 1/2 m (x'^2 + y'^2)\nconstraint y = 2 x\n"},
    {"E0430", "an energy that jumps at a switch",
     "Where V jumps by ΔV a motion gains or loses ΔV of kinetic energy at once: an impulse. Where T jumps the "
     "momentum, not "
     "the velocity, goes on. Lagrange's equations on the two sides know nothing of either, so that the run would be "
     "wrong "
     "without a word. T, V, U and L have to be continuous at each switch of abs, sign, step, min, max and piecewise; "
     "kinks "
     "are fine, and so are forces that jump, also as a V that jumps in time alone. D has to be continuous in the "
     "velocities. That it is continuous is looked for at points of each switch, found by root finding.",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nV = 2 [J] step(x - 1 [m])\n",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\nV = 1 [J] (1 + tanh((x - 1 [m])/0.01 [m]))\n"},
    {"E0431", "a position that jumps at a switch",
     "A mass goes from one place to another through those between. A prescribed position may have kinks only where the "
     "velocity that they give does not change L at once.",
     "coord x : length\nparam m = 1 kg, d = 1 m\npoint P mass m at (x + d step(t - 1 [s]), 0)\n",
     "coord x : length\nparam m = 1 kg, d = 1 m\npoint P mass m at (x + d/2 (1 + tanh((t - 1 [s])/0.1 [s])), 0)\n"},
    {"E0432", "a momentum that jumps at a switch",
     "∂L/∂q' goes on where the motion passes a switch, since forces are finite. Where it jumps as a function of the "
     "velocity, as of a term |q'|, the velocity would have to stay or jump instead; the equations of motion on the two "
     "sides do not say so.",
     "coord x : length\nparam m = 1 kg, p = 1 N s\nT = 1/2 m x'^2\nU = p abs(x')\n",
     "coord x : length\nparam m = 1 kg, p = 1 N s\nT = 1/2 m x'^2\nU = p sqrt(x'^2 + 1e-6 [m^2/s^2])\n"},
    {"E0433", "a mass depends on a coordinate",
     "Lagrange's equations of a body with a mass m(q) are not Newton's: what the body gains or loses as it moves "
     "brings "
     "momentum of its own, of which its T knows nothing (Pesce, J. Appl. Mech. 70, 2003). A rope that runs over a "
     "table "
     "has one T for all its parts, and that is right.",
     "coord x : length\nparam ρ = 1 kg/m\npoint P mass ρ x at (x, 0)\nstart x = 1 m\n",
     "coord x : length\nparam ρ = 1 kg/m, l = 2 m\nT = 1/2 ρ l x'^2\nstart x = 1 m\n"},
    {"W0434", "an energy that is nowhere a real number",
     "A root or a logarithm of something negative has no value. Derivatives can be formed all the same, and the "
     "equations are certified; but no state has an energy, and a run ends before it begins.",
     "coord x : length\nparam m = 1 kg, k = 2 N/m, h = 1 m\nT = 1/2 m x'^2\nV = 1/2 k (sqrt(-h^2 - x^2) - h)^2\n",
     "coord x : length\nparam m = 1 kg, k = 2 N/m, h = 1 m\nT = 1/2 m x'^2\nV = 1/2 k (sqrt(h^2 + x^2) - h)^2\n"},
    {"W0435", "a slip velocity times a factor",
     "Friction is μ times the normal force, against the velocity of the touching point. The force that acts on a "
     "coordinate is this times the derivative of the slip velocity by the coordinate's own: a slip velocity of 2 x' "
     "where the point moves with x' doubles it.",
     "coord x, y : length\nparam m = 1 kg, g = 9.81 m/s^2\npoint P mass m at (x, y)\ngravity (0, -g)\ncontact y >= 0 "
     "friction 0.3 slip 2 x'\n",
     "coord x, y : length\nparam m = 1 kg, g = 9.81 m/s^2\npoint P mass m at (x, y)\ngravity (0, -g)\ncontact y >= 0 "
     "friction 0.3 slip x'\n"},
    {"W0437", "a gap that is no distance",
     "Friction is μ times the normal force, λ |∂g/∂r| with r the place of what the contact pushes. Where the model has "
     "the masses as points or bodies that is calculated; energies as formulas do not say which coordinates are the "
     "place of one mass, and λ itself is taken. It is the normal force where the gap is the distance to the surface, "
     "whose derivatives by the coordinates of one point are those of a direction: (0, 1), and not (−2 a x, 1).",
     "coord x, y : length\nparam m = 1 kg, g = 9.81 m/s^2, a = 1 m^-1\nT = 1/2 m (x'^2 + y'^2)\nV = m g y\n"
     "contact y - a x^2 >= 0 friction 0.3 slip (x' + 2 a x y')/sqrt(1 + 4 a^2 x^2)\nstart y = 1 m\n",
     "coord x, y : length\nparam m = 1 kg, g = 9.81 m/s^2, a = 1 m^-1\npoint P mass m at (x, y)\ngravity (0, -g)\n"
     "contact y - a x^2 >= 0 friction 0.3 slip (x' + 2 a x y')/sqrt(1 + 4 a^2 x^2)\nstart y = 1 m\n"},
    {"W0438", "two names that are printed alike",
     "Formulas set a second letter and what follows an underscore below the line, as textbooks do: mS and m_S. Names "
     "that differ only in how they say so are one symbol in a formula, and the formula is false. The momentum of x is "
     "printed as p_x, the energy function as h_E.",
     "coord x, y : length\nparam mS = 1 kg, m_S = 2 kg, k = 3 N/m\nT = 1/2 mS x'^2 + 1/2 m_S y'^2\nV = 1/2 k (x - "
     "y)^2\n",
     "coord x, y : length\nparam m1 = 1 kg, m2 = 2 kg, k = 3 N/m\nT = 1/2 m1 x'^2 + 1/2 m2 y'^2\nV = 1/2 k (x - "
     "y)^2\n"},
    {"W0439", "a start at which the mass matrix is singular",
     "Coordinates may fail at single positions: at the middle angle at which two axes of a rotation coincide (gimbal "
     "lock: ±90° of rpy and yzx, 0 and 180° of zxz), at r = 0 of polar ones. There a change of a coordinate moves "
     "nothing, its acceleration is not determined, and a run ends before it begins. Bodies have no such position with "
     "`rotation quaternion`.",
     "coord r : length, φ : angle\nparam m = 1 kg, k = 2 N/m\nT = 1/2 m (r'^2 + r^2 φ'^2)\nV = 1/2 k r^2\nstart r = 0 "
     "m\nrun 1 s\n",
     "coord x, y : length\nparam m = 1 kg, k = 2 N/m\nT = 1/2 m (x'^2 + y'^2)\nV = 1/2 k (x^2 + y^2)\nstart x = 0 "
     "m\nrun 1 s\n"},
    {"W0440", "a mass that changes with time",
     "Lagrange's equations of a mass m(t) say d/dt (m v) = F: what joins or leaves has no velocity in the frame at "
     "rest. Exhaust that leaves a rocket with the velocity u relative to it takes the momentum m' (v + u): that is a "
     "force, m' (v + u), beside it, and then m v' = F + m' u.",
     "param m0 = 10 kg, b = 0.1 kg/s\ncoord y : length\nlet m = m0 - b t\npoint R mass m at (0, y)\nrun 1 s\n", ""},
    {"E0441", "a spring or damper between a place and itself",
     "A link has a length and a direction, from one place to another one.",
     "coord x : length\nparam m = 1 kg, k = 1 N/m\npoint P mass m at (x, 0)\nspring P - P stiffness k\n",
     "coord x : length\nparam m = 1 kg, k = 1 N/m\npoint P mass m at (x, 0)\nspring O - P stiffness k\n"},
    {"W0442", "an energy is counted twice",
     "Points and bodies with a mass give T by themselves, springs V. What `+=` adds to them is a further part; "
     "the same "
     "part once more doubles it.",
     "coord x : length\nparam m = 1 kg\npoint P mass m at (x, 0)\nT += 1/2 m x'^2\n",
     "coord x : length\nparam m = 1 kg\npoint P mass m at (x, 0)\n"},
    {"W0443", "simultaneous impacts beside friction",
     "`impact simultaneous` is a law of normal impulses alone. A contact that is hit alone has its friction; where one "
     "with friction is hit together with others a run ends, since the law says nothing of friction. `impact "
     "sequential`, the default, hits one contact after the other, each with its friction.",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact z >= 0 friction "
     "0.3 slip x' name floor\ncontact x >= 0 name wall\nimpact simultaneous\nstart x = 1 m, z = 1 m\n",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact z >= 0 friction "
     "0.3 slip x' name floor\ncontact x >= 0 name wall\nstart x = 1 m, z = 1 m\n"},
    {"E0436", "gravity, or a damping coefficient, depends on the motion",
     "`gravity` is one vector for all bodies, whose weights m g come from the potential −m g·r; a field that differs "
     "from place to place has a potential of its own. A damper is D = ½ c ṡ², which gives the force c ṡ only where c "
     "holds no velocity: the force c |ṡ| ṡ has D = c |ṡ|³/3.",
     "coord x : length\nparam m = 1 kg, c = 0.5 N s^2/m^2\npoint P mass m at (x, 0)\npoint W at (-1 [m], 0)\ndamper P "
     "- "
     "W coefficient c*abs(x')\n",
     "coord x : length\nparam m = 1 kg, c = 0.5 N s^2/m^2\npoint P mass m at (x, 0)\nD = 1/3 c abs(x')^3\n"},
    // ------------------------------------------------------------------------------------------------ not supported
    // yet
    {"E0255", "as many names as components",
     "Names before one sign of equality name the components of the vector behind it, one each.",
     "coord x, y : length, ψ : angle\nparam m = 1 kg, I = 1 kg m^2\nT = 1/2 m (x'^2 + y'^2) + 1/2 I ψ'^2\nrates v, u = "
     "x' cos ψ + y' sin ψ\n",
     "coord x, y : length, ψ : angle\nparam m = 1 kg, I = 1 kg m^2\nT = 1/2 m (x'^2 + y'^2) + 1/2 I ψ'^2\nrates v = x' "
     "cos ψ + y' sin ψ, u = -x' sin ψ + y' cos ψ, w = ψ'\n"},
    {"E0256", "a rate that is no linear combination of velocities",
     "Rates (quasi-velocities) take the place of the velocities: σ = Y(q,t) q' + y(q,t), linear in q', so that q' "
     "follows from them. Accelerations and inputs stand in none.",
     "coord x, y : length, ψ : angle\nparam m = 1 kg, I = 1 kg m^2\nT = 1/2 m (x'^2 + y'^2) + 1/2 I ψ'^2\nrates v = "
     "sqrt(x'^2 + y'^2)\n",
     "coord x, y : length, ψ : angle\nparam m = 1 kg, I = 1 kg m^2\nT = 1/2 m (x'^2 + y'^2) + 1/2 I ψ'^2\nrates v = x' "
     "cos ψ + y' sin ψ, u = -x' sin ψ + y' cos ψ, w = ψ'\n"},
    {"E0257", "rates that depend on each other",
     "One of them follows from the others and from the constraints, so that they cannot be chosen independently.",
     "coord x, y : length, ψ : angle\nparam m = 1 kg, I = 1 kg m^2\nT = 1/2 m (x'^2 + y'^2) + 1/2 I ψ'^2\nrates v = x' "
     "cos ψ + y' sin ψ, u = 2 v, w = ψ'\n",
     "coord x, y : length, ψ : angle\nparam m = 1 kg, I = 1 kg m^2\nT = 1/2 m (x'^2 + y'^2) + 1/2 I ψ'^2\nrates v = x' "
     "cos ψ + y' sin ψ, u = -x' sin ψ + y' cos ψ, w = ψ'\n"},
    {"E0258", "more rates than velocities left free",
     "Constraints leave as many independent velocities as there are coordinates less independent constraints; there "
     "are no more rates than that.",
     "coord x, y : length, ψ : angle\nparam m = 1 kg, I = 1 kg m^2\nT = 1/2 m (x'^2 + y'^2) + 1/2 I ψ'^2\nrates v = "
     "x', u = y', w = ψ', s = x' + y'\n",
     "coord x, y : length, ψ : angle\nparam m = 1 kg, I = 1 kg m^2\nT = 1/2 m (x'^2 + y'^2) + 1/2 I ψ'^2\nrates v = x' "
     "cos ψ + y' sin ψ, u = -x' sin ψ + y' cos ψ, w = ψ'\n"},
    {"E0259", "an acceleration in the Lagrangian beside what does not go with it",
     "Where accelerations stand in L a state goes up to the third derivatives. Constraints, contacts, gauges, rates, "
     "masses and events that set values take it to be positions and velocities.",
     "dimensionless\ncoord x, y : number\nL = 1/2 x''^2 + 1/2 y'^2\nconstraint x = y\n",
     "dimensionless\ncoord x, y : number\nL = 1/2 x'^2 + 1/2 y'^2\nconstraint x = y\n"},
    {"E0261", "no such event",
     "What is expected of an event or a contact names it: the name behind `event`, or that at the end of a contact. A "
     "contact has an impact, is made and lost; friction sticks and slips.",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact z >= 0 name "
     "floor\nrun 1 s\nexpect event flor at 1 s ± 1e-9\n",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact z >= 0 name "
     "floor\nstart z = 1 m\nrun 1 s\nexpect event floor = 1\n"},
    {"E0262", "a velocity in a contact",
     "A contact bounds positions. While it is closed its velocities and accelerations follow from that.",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact z' >= 0\n",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact z >= 0 "
     "restitution 0.5 friction 0.2 slip x' name floor\n"},
    {"E0263", "a coefficient of contact out of its range",
     "Restitution lies between 0 and 1: it is the part of the speed that an impact gives back. A coefficient or limit "
     "of friction is not negative.",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact z >= 0 "
     "restitution 1.5\n",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact z >= 0 "
     "restitution 0.5 friction 0.2 slip x' name floor\n"},
    {"E0264", "static friction below kinetic friction",
     "What holds a body that rests is at least what brakes one that slides; else it would neither rest nor slide.",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact z >= 0 friction "
     "0.4 static 0.3 slip x'\n",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact z >= 0 "
     "restitution 0.5 friction 0.2 slip x' name floor\n"},
    {"E0265", "friction without the velocity that it acts against",
     "Friction needs the velocity of the touching point along the surface: linear in the velocities, and not the "
     "velocity along the normal, at which the contact opens and closes.",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact z >= 0 friction "
     "0.3 slip z'\n",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact z >= 0 "
     "restitution 0.5 friction 0.2 slip x' name floor\n"},
    {"E0266", "friction at a gap that is no length",
     "Friction is μ times the normal force. The multiplier of a contact is that force only where g is the distance to "
     "the surface.",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact x^2 + z^2 >= 1 "
     "m^2 friction 0.3 slip x'\n",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\nparam R = 1 m\ncontact "
     "sqrt(x^2 + z^2) >= R friction 0.3 slip (z x' - x z')/sqrt(x^2 + z^2)\nstart z = R\n"},
    {"E0267", "a contact without a coordinate", "Its two sides are known for all times, whatever the motion.",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact 2 m >= 1 m\n",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\ncontact z >= 0 "
     "restitution 0.5 friction 0.2 slip x' name floor\n"},
    {"E0268", "an event on constants",
     "The two sides of its condition are known before the motion, so that they never cross.",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\nevent hit when g = 9.8 "
     "m/s^2 : record\n",
     "coord x, z : length\nparam m = 1 kg, g = 9.81 m/s^2\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\nevent hit when z = 0 m "
     ": record\n"},
    {"E0280", "a field without a density",
     "The action of a field is the integral of its density over space and time; the field equations are its variation.",
     "field u(x) : length\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\n"},
    {"E0281", "what belongs to a field, without one",
     "A density, a boundary and natural conditions are parts of the action of a field.",
     "coord x : length\nparam m = 1 kg\nT = 1/2 m x'^2\ndensity = 1/2 m x'^2\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\n"},
    {"E0282", "a second time derivative in a density",
     "A density depends on fields and their velocities, as a Lagrangian does; accelerations are what the equations "
     "give.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u u'' - 1/2 T u_x^2\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\n"},
    {"E0283", "a derivative above the second in a density",
     "Densities hold derivatives up to the second: beams, plates, dispersive waves. A dissipation density holds rates "
     "of these, u_txx of what bends.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\nparam a = "
     "1 N m^2\ndensity += a u_x u_xxx\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\n"},
    {"E0284", "a domain or a variable that does not fit",
     "Each space variable of a field has two ends, which are known before the run; all fields of a model live on one "
     "space.",
     "field u(x) : length on x = 1 m .. 0 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\n"},
    {"E0285", "a boundary condition that is none",
     "Given at a boundary are the field or its slope, each once. All other conditions are natural: they follow from "
     "the density.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\nboundary "
     "left : u = 0, u = 0\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\nboundary "
     "left : u = 0\n"},
    {"E0286", "a boundary that the field does not have",
     "A field of one space variable has the ends left and right, of two the sides left, right, bottom and top; a field "
     "without a domain has none.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\nboundary "
     "top : u = 0\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\nboundary "
     "right : u = 0\n"},
    {"E0287", "a mesh that cannot be made",
     "A mesh has a whole number of cells along each variable, and must fit into memory.",
     "field u(x) : length on x = 0 m .. 1 m cells 2.5\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\n",
     "field u(x) : length on x = 0 m .. 1 m cells 20\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\n"},
    {"E0288", "a force on a field that acts nowhere",
     "A force density acts in each piece of space, `force u(l) = F` at an end of the domain.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\nforce "
     "density ρ = 1 N/m\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\nforce "
     "density u = 1 N/m\n"},
    {"E0289", "a place where the field is not",
     "The value of a field is asked for at a place of its domain, one number a space variable.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\nrun 1 "
     "s\nexpect u(2 m) at 1 s = 0 m ± 1e-9\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\n"},
    {"E0290", "a name that is a derivative of a field", "u_x is the derivative of the field u along x.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\nparam u_x "
     "= 1\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\n"},
    {"E0291", "an expectation that does not fit the fields",
     "A solution gives every field, a current one flux for each space variable.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\nexpect "
     "current ρ u' flux -T u_x, 0\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T = 1 N\ndensity = 1/2 ρ u'^2 - 1/2 T u_x^2\nexpect "
     "current ρ u' flux -T u_x\n"},
    {"E0509", "an expectation of fields at other values of parameters",
     "`expect … with a = 2` is carried out for models of coordinates; one with fields is verified at its own values.",
     "# maup test\nparam ρ = 1 kg/m, F = 1 N, l = 1 m, a = 1 mm\nfield u(x) : length on x = 0 m .. l cells 10 boundary "
     "u = 0\ndensity = 1/2 ρ u'^2 - 1/2 F u_x^2\nstart u = a sin(pi x/l)\nrun 1 s\nexpect u(l/2) at 0 s = 1 mm ± 1e-6 "
     "with F = 2 N\n",
     "# maup test\nparam ρ = 1 kg/m, F = 1 N, l = 1 m, a = 1 mm\nfield u(x) : length on x = 0 m .. l cells 10 boundary "
     "u = 0\ndensity = 1/2 ρ u'^2 - 1/2 F u_x^2\nstart u = a sin(pi x/l)\nrun 1 s\nexpect u(l/2) at 0 s = 1 mm ± "
     "1e-6\n"},
    {"E0504", "a value that is given for what has none here",
     "A start gives coordinates, their velocities, the angular velocities of bodies, B.ω, and points and bodies by "
     "their place and velocity, P.x = 1 m, P' = (1, 0) m/s: coordinates and velocities that give it are solved for. A "
     "configuration that is asked about, as in `expect M at x = 1 m : …`, is given by its coordinates and rates, and "
     "so is the "
     "start of a degenerate Lagrangian.",
     "coord x : length\nparam m = 1 kg\npoint P mass m at (x, x)\nexpect M at P.x = 1 m : ((2)) rel 1e-9\n",
     "coord x : length\nparam m = 1 kg\npoint P mass m at (x, x)\nexpect M at x = 1 m : ((2)) rel 1e-9\n"},
    {"E0293", "a density that is not real",
     "The action is a real number, and so is its density. i conj(ψ) ψ' alone is not: its imaginary part is half the "
     "derivative of |ψ|² by t.",
     "dimensionless\nfield ψ(x) : complex\ndensity = i conj(ψ) ψ' - 1/2 abs(ψ_x)^2\n",
     "dimensionless\nfield ψ(x) : complex\ndensity = i/2 (conj(ψ) ψ' - ψ conj(ψ')) - 1/2 abs(ψ_x)^2\n"},
    {"E0294", "a complex value in a place for real ones",
     "Formulas with a complex field ψ fall apart into their real and imaginary parts, in ψ_r and ψ_i. What is measured "
     "or conserved is real: re(…), im(…), abs(…). Functions of complex values are exp and whole powers.",
     "dimensionless\nfield ψ(x) : complex\ndensity = i/2 (conj(ψ) ψ' - ψ conj(ψ')) - 1/2 abs(ψ_x)^2\n"
     "expect current ψ flux im(conj(ψ) ψ_x)\n",
     "dimensionless\nfield ψ(x) : complex\ndensity = i/2 (conj(ψ) ψ' - ψ conj(ψ')) - 1/2 abs(ψ_x)^2\n"
     "expect current abs(ψ)^2 flux im(conj(ψ) ψ_x)\n"},
    {"E0296", "a derivative at a place that nothing holds",
     "At a place a body is held by the value of the field, with a force, and by its slope, with a moment.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 kg\ndensity = 1/2 ρ u'^2 - 1/2 T0 "
     "u_x^2\nV = 1 [N m^3] u_xx(1 m)^2\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 kg\ndensity = 1/2 ρ u'^2 - 1/2 T0 "
     "u_x^2\nT = 1/2 m u(1 m)'^2\n"},
    {"E0297", "two statements about one end",
     "At an end the field is given, or what acts there is: never both. A given slope of a field without bending energy "
     "is a force on the field.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 kg\ndensity = 1/2 ρ u'^2 - 1/2 T0 "
     "u_x^2\nboundary right : u = 0\nT = 1/2 m u(1 m)'^2\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 kg\ndensity = 1/2 ρ u'^2 - 1/2 T0 "
     "u_x^2\nboundary left : u = 0\nT = 1/2 m u(1 m)'^2\n"},
    {"E0298", "a body on a slope that may jump",
     "Without u_xx in the density the slope of a field has kinks: no moment turns it, and no body can take hold of it.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 kg\ndensity = 1/2 ρ u'^2 - 1/2 T0 "
     "u_x^2\nT = 1/2 m (1 [m] u_x(1 m)')^2\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 kg\ndensity = 1/2 ρ u'^2 - 1/2 T0 "
     "u_x^2\nT = 1/2 m u(1 m)'^2\n"},
    {"E0299", "a field without a place, or a coordinate in a density",
     "A density is integrated over the field; T, V, L, D, constraints and forces hold values at places, and couple the "
     "field with coordinates.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 kg\ndensity = 1/2 ρ u'^2 - 1/2 T0 "
     "u_x^2\nT = 1/2 m u'^2\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 kg\ndensity = 1/2 ρ u'^2 - 1/2 T0 "
     "u_x^2\nT = 1/2 m u(1 m)'^2\n"},
    {"E0505", "a statement that does not go with fields",
     "Beside fields stand coordinates, points and bodies, energies, constraints, forces, contacts, friction and "
     "events. "
     "Rates, gauges, paths, drawings and methods belong to models of coordinates alone.",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 kg\ndensity = 1/2 ρ u'^2 - 1/2 T0 "
     "u_x^2\ncoord y : length\nT = 1/2 m y'^2\nrates w = y'\n",
     "field u(x) : length on x = 0 m .. 1 m\nparam ρ = 1 kg/m, T0 = 1 N, m = 1 kg\ndensity = 1/2 ρ u'^2 - 1/2 T0 "
     "u_x^2\ncoord y : length\nT = 1/2 m y'^2\n"},
};

}  // namespace

std::span<const CodeEntry> system_codes() { return kEntries; }

}  // namespace maupertuis
