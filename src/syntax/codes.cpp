#include <maupertuis/codes.hpp>

namespace maupertuis {
namespace {

constexpr CodeEntry kEntries[] = {
    {"E0101", "the text is too large",
     "A model text may have 8 MiB and a million words and signs, a name or a number 200 bytes. A model that is larger "
     "is "
     "almost always data in the wrong place.",
     "", ""},
    {"E0102", "the text is not UTF-8",
     "Model texts are UTF-8, the encoding that most editors use by default. In other encodings θ, ° and é are other "
     "bytes, "
     "so that they cannot be read. Save the file as UTF-8.",
     "maup check latin1.lag", "iconv --from latin1 --to utf-8 latin1.lag -o utf8.lag\nmaup check utf8.lag"},
    {"E0103", "the file is no text",
     "The file contains control characters, as programs, pictures and archives do. A model is plain text.",
     "maup check picture.png", "maup check pendulum.lag"},
    {"E0104", "a character or sign that the language does not have",
     "The signs of the language are + - * / ^ ( ) [ ] , : = += < <= > >= ' . .. ±, the typeset · × − √ ½ ² and "
     "quotation marks "
     "around titles. Comments begin with #, powers are written with ^, and a statement ends with its line.",
     "system s\nparam m = 1 kg;\n", "system s\nparam m = 1 kg\n"},
    {"E0105", "this is not a number",
     "Numbers are decimal: 9.81, 0.5, .5, 6.674e-11. A decimal point stands between digits, there is one of them, and "
     "the "
     "value lies within the range of double precision, about 1e-307 to 1e308. NaN and infinity are no quantities.",
     "system s\nparam m = 1e400 kg\n", "system s\nparam m = 1e4 kg\n"},
    {"E0106", "a bracket without its partner",
     "Every ( has its ) and every [ its ] before the next statement begins. An open bracket continues the statement on "
     "the "
     "next line, so that a missing one is noticed only where a new statement begins.",
     "system s\nlet a = 2 (1 + pi\nlet b = 1\n", "system s\nlet a = 2 (1 + pi)\nlet b = 1\n"},
    {"E0107", "an indented line begins like a statement",
     "A line that is indented more than the first statement of the file continues the statement before it. If it "
     "begins with "
     "a statement word it was probably meant as a statement of its own: remove its indentation. If it is a "
     "continuation, "
     "break the line elsewhere.",
     "system s\nparam m = 1 kg\n  coord x : length\n", "system s\nparam m = 1 kg\ncoord x : length\n"},
    {"E0108", "a formula is nested too deeply or too long",
     "Brackets, signs and exponents may be nested 200 deep, and a formula may have 2000 operations in a row. Name its "
     "parts "
     "with `let`, or add to an energy in several statements with `+=`.",
     "", ""},
    {"E0109", "the model is empty",
     "The file has no statement, only blanks and comments perhaps. The least model has a coordinate and an energy or a "
     "mass; "
     "`maup new pendulum` writes one to start from.",
     "# nothing here\n", "system s\ncoord x : number\n"},
    {"E0110", "a line does not begin with a statement word",
     "Every statement begins with its word: param, coord, let, point, T, V, force, start, run and so on. A definition "
     "is "
     "`let a = …`, a parameter `param a = …`, an initial value `start a = …`. A line that goes on with the statement "
     "before "
     "must be indented.",
     "system s\na = 2\n", "system s\nlet a = 2\n"},
    {"E0111", "something else is expected here",
     "The statement was understood up to the marked place. The message says what may stand there; "
     "docs/manual/grammar.ebnf "
     "has the whole grammar.",
     "param m 1 kg\ncoord x : length\nT = 1/2 m x'^2\n",
     "param m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n"},
    {"E0112", "a reserved word as a name",
     "Words that separate the parts of statements (mass, at, in, length, angle, name, …), functions, t for the time "
     "and pi "
     "cannot be names, since a reader could not tell the two meanings apart. Words that begin statements are reserved "
     "at the "
     "start of a line only.",
     "system s\nparam mass = 1 kg\n", "system s\nparam m = 1 kg\n"},
    {"E0113", "a function needs brackets",
     "Circular and hyperbolic functions may stand without brackets before one name: sin θ, cos 2θ, cos P.x. Everything "
     "else "
     "takes brackets, so that there is no doubt where the argument ends: sqrt(x), sin(-θ), cos(2 θ + φ).",
     "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = sin -x\n",
     "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = sin(-x)\n"},
    {"E0114", "a power after a function without brackets",
     "cos θ^2 is read as (cos θ)^2 by some and as cos(θ^2) by others. Write cos^2 θ or cos(θ^2).",
     "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = cos x^2\n",
     "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = cos^2 x\n"},
    {"E0115", "an exponent before the argument that is not a whole number",
     "sin^2 θ is (sin θ)^2. But sin^-1 θ is the inverse function for some and 1/sin θ for others: write asin(θ) or "
     "1/sin(θ). "
     "Other exponents stand after the brackets: sin(θ)^n.",
     "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = sin^-1 x\n",
     "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = asin(x)\n"},
    {"E0116", "a wrong number of arguments",
     "Most functions take one argument; atan2, cross take two, min and max two or more; dot takes two vectors, or one "
     "expression whose time derivative it is. inertia diag takes three moments, full six.",
     "system s\ncoord x : number\nV = atan2(x)\n", "system s\ncoord x : number\nV = atan2(x, 1)\n"},
    {"E0117", "a number that is also a product",
     "2e1 is the number 20. If the model has a name e1 it could be 2 times e1 as well. Write 2 e1 or 2.0e1.",
     "system s\nparam e1 = 3\nlet a = 2e1\n", "system s\nparam e1 = 3\nlet a = 2 e1\n"},
    {"E0118", "two units after one slash",
     "J/kg K is read as J/(kg K) by some and as J K/kg by others. After a slash stands one unit, or several in "
     "brackets.",
     "system s\nparam c = 1 J/kg K\n", "system s\nparam c = 1 J/(kg K)\n"},
    {"E0119", "square brackets that hold no unit, or stand after no number",
     "Inside formulas a unit stands in square brackets directly after a number, 3 [J], so that m the mass is never "
     "taken for "
     "m the metre. Names have their unit from their declaration.",
     "param m = 1 kg, F = 2 N\ncoord x : length\nT = 1/2 m x'^2\nlet work = F [m]\n",
     "param m = 1 kg, F = 2 N\ncoord x : length\nT = 1/2 m x'^2\nlet work = F 1 [m]\n"},
    {"E0120", "an energy whose letter is a name of the model",
     "A model that declares T, V, U, L or D itself means that name everywhere. The energies are then given by their "
     "long "
     "names: kinetic, potential, generalized_potential, lagrangian, dissipation.",
     "param m = 1 kg, k = 2 N/m, V = 3 m/s\ncoord x : length\nstart x' = V\nT = 1/2 m x'^2\nV = 1/2 k x^2\n",
     "param m = 1 kg, k = 2 N/m, V = 3 m/s\ncoord x : length\nstart x' = V\nT = 1/2 m x'^2\npotential = 1/2 k x^2\n"},
    {"E0121", "a coordinate written as a function of time",
     "A coordinate depends on time by itself: θ, not θ(t). In this language θ(t) would be the product of θ and t. A "
     "field at a place that moves with the time has a speed in it, `w(v t)`; without units `w(1 t)`.",
     "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = x(t)^2\n",
     "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = x^2\n"},
    {"E0122", "an unknown word before a bracket",
     "Before a bracket stands a function of the language or a name of the model, which then is a factor. Functions "
     "cannot be "
     "defined; give the expression a name with `let`.",
     "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = sine(x)\n",
     "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = sin(x)\n"},
    {"E0123", "two numbers side by side",
     "A product needs no sign between factors, but two numbers in a row are more often a slip than a product. Write "
     "2*3, and "
     "long numbers without blanks: 10000.",
     "dimensionless\ncoord x : number\nlet a = 2 3\nT = 1/2 a x'^2\n",
     "dimensionless\ncoord x : number\nlet a = 2*3\nT = 1/2 a x'^2\n"},
    {"E0124", "two systems in one file",
     "A file describes one system, and the statement `system` names it. Put the second one into a file of its own.",
     "system a\nsystem b\n", "system a\n"},
    {"E0125", "a prime that belongs to nothing",
     "The prime is the time derivative of a name, of a field of a point or body, or of a bracket: θ', P.x', (l θ)'.",
     "dimensionless\ncoord x : number\nT = 1/2 exp(x)'^2\n",
     "dimensionless\ncoord x : number\nT = 1/2 ((exp(x))')^2\n"},
    {"E0126", "brackets with nothing or too much in them",
     "Brackets hold one expression, or the two or three components of a vector.", "system s\ngravity (0, 0, 0, 1)\n",
     "system s\ngravity (0, 0, 1)\n"},
    {"E0127", "a part of the statement is missing or given twice",
     "A point needs `at`, a spring `stiffness`, `run until` needs `within`, an expected value its tolerance (± or "
     "rel). Each part stands once.",
     "param m = 1 kg\ncoord x : length\npoint P mass m\n",
     "param m = 1 kg\ncoord x : length\npoint P mass m at (x, 0)\n"},
    {"E0128", "a condition that is none, or a chain of comparisons",
     "Conditions stand in piecewise( ): comparisons with < <= > >=, joined by `and` and `or`. 0 < x < 1 is written 0 < "
     "x and x < 1.",
     "system s\ncoord x : number\nV = piecewise(0 < x < 1 : x, else : 1)\n",
     "system s\ncoord x : number\nV = piecewise(0 < x and x < 1 : x, else : 1)\n"},
    {"E0129", "a coordinate without a kind",
     "After the names of coordinates stands their kind: angle, length, charge, number, or any unit in brackets. Names "
     "before a colon share it.",
     "param m = 1 kg\ncoord x : metre\nT = 1/2 m x'^2\n",
     "param m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n"},
    {"W0101", "a name after a quotient of names",
     "Products without a sign bind as division does, from left to right: a/b c is (a/b) c. Who writes a/b c often "
     "means a/(b c).",
     "system s\nparam a = 1, b = 2, c = 3\nlet d = a/b c\n", "system s\nparam a = 1, b = 2, c = 3\nlet d = a/(b c)\n"},
    {"W0102", "a number after a function without brackets",
     "sin θ/2 is half the sine of θ. The sine of half the angle is sin(θ/2). Write 1/2 sin θ if the first is meant.",
     "dimensionless\ncoord x : angle\nT = 1/2 x'^2\nV = sin x/2\n",
     "dimensionless\ncoord x : angle\nT = 1/2 x'^2\nV = 1/2 sin x\n"},
    {"W0103", "an angle after a function without brackets",
     "cos θ1 - θ2 subtracts an angle from a cosine; the cosine of the difference is cos(θ1 - θ2).",
     "system s\ncoord x, y : angle\nV = cos x - y\n", "system s\ncoord x, y : angle\nV = cos(x - y)\n"},
    {"W0104", "the time or an angle after a function without brackets",
     "cos ω t is t times the cosine of ω. With units the argument would be seen to be no angle; in a dimensionless "
     "model nothing tells. So is cos n θ the cosine of n, times θ.",
     "system s\ndimensionless\nparam w = 2\ncoord x : number\nV = x cos w t\n",
     "system s\ndimensionless\nparam w = 2\ncoord x : number\nV = x cos(w t)\n"},
    {"W0109", "a unit after a division of numbers",
     "A unit in brackets belongs to the number right before it: 1/2 [deg] is 1/(2 deg), not half a degree.",
     "system s\ncoord x : angle\nparam k = 1 J\nV = k cos(x + 1/2 [deg])\n",
     "system s\ncoord x : angle\nparam k = 1 J\nV = k cos(x + 1 [deg]/2)\n"},
    {"W0110", "a root without brackets around its exponent",
     "A power binds before a division: x^1/2 is x/2. The root is x^(1/2) or sqrt(x).",
     "system s\ncoord x : number\nV = x^1/2\n", "system s\ncoord x : number\nV = x^(1/2)\n"},
    {"W0111", "a power after a unit in brackets",
     "A unit in brackets belongs to the number before it, and a power takes both: 5 [mm]^2 is (5 mm)^2, which is "
     "25 mm^2. Five square millimetres are 5 [mm^2].",
     "system s\ncoord x : length\nparam k = 1 N/m\nV = k (x^2 + 5 [mm]^2)\n",
     "system s\ncoord x : length\nparam k = 1 N/m\nV = k (x^2 + 5 [mm^2])\n"},
    {"W0106", "two names look alike",
     "Letters of the Latin, Greek and Cyrillic alphabets can look exactly the same: `a` and Cyrillic `а` are two names "
     "that no reader can tell apart. Such a pair "
     "comes from copied text or from a keyboard of another language.",
     "param а = 1 m, a = 2 m", "param b = 1 m, a = 2 m"},
    {"W0107", "a name mixes alphabets",
     "A letter of another alphabet that looks Latin stands among Latin letters. The name cannot be found by typing "
     "what is seen.",
     "coord x : length\nparam lo\u0430d = 1 kg  # the third letter is Cyrillic\nT = 1/2 lo\u0430d x'^2\n",
     "coord x : length\nparam load = 1 kg\nT = 1/2 load x'^2\n"},
    {"W0108", "a character that is not shown",
     "Unicode has characters that turn the direction of writing and are not shown themselves. In a comment or a title "
     "they make an editor show other text than is read.",
     "", ""},
    {"W0105", "a number after a factor", "x 2 is twice x. Who writes it often means x^2.",
     "system s\ncoord x : number\nV = x 2\n", "system s\ncoord x : number\nV = x^2\n"},
};

}  // namespace

std::span<const CodeEntry> syntax_codes() { return kEntries; }

}  // namespace maupertuis
