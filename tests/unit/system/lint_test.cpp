#include "../under_sanitizers.hpp"
#include "support.hpp"

#include <fmt/format.h>

#include <string>

using namespace maupertuis;
using namespace maupertuis::test;

TEST_CASE("models that look suspicious and are not") {
  for (const char* text :
       {// Bateman is a warning, nothing more
        "param m = 1 kg, k = 2 N/m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = 1/2 k (x - y)^2 + 3 [J]\n",
        // a gyroscopic term is linear in the velocities and no total derivative
        "param m = 1 kg, b = 2 kg/s\ncoord x, y : length\nL = 1/2 m (x'^2 + y'^2) + b (x y' - y x')\n",
        // a total derivative beside a free end of the path, where it counts
        "dimensionless\ncoord x : number\nL = 1/2 x'^2 - 1/2 x^2 + x x'\npath from 1 at 0 to free at 7\n",
        // relativistic: T is not quadratic
        "param m = 1 kg, c = 3 m/s\ncoord x : length\nL = -m c^2 sqrt(1 - x'^2/c^2)\n",
        // weight of a mass that no point carries
        "param m = 1 kg, M = 2 kg, g = 9.81 m/s^2\ncoord x, y : length\npoint P mass m at (0, x)\ngravity (0, -g)\nT "
        "+= 1/2 M y'^2\nV += M g y\n",
        // a mass that the start puts where the square root is defined
        "param m = 1 kg, a = 1 m, k = 1 J\ncoord r : length\nT = 1/2 m r'^2\nV = k sqrt(r/a - 5)\nstart r = 20 m\n",
        // a true claim, also when written otherwise; the zero of V is free
        "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\npoint P mass m at l (sin θ, -cos θ)\ngravity (0, "
        "-g)\nT = 1/2 m (l θ')^2\nV = 2 m g l sin(θ/2)^2\n"})
    CHECK_MESSAGE(Elaborated(text).fine(), text << Elaborated(text).messages());
}

TEST_CASE("an energy that is nowhere a real number, and such as are real far from zero or near it alone") {
  const auto warned = [](const std::string& line) {
    const std::string codes = Elaborated(
                                  "param m = 1 kg, k = 1 J, R = 1e-9 m, a = 1e6 m, c = 3 m/s\ncoord x, y : length\n"
                                  "T = 1/2 m (x'^2 + y'^2) + 0 m c (R/a) y'\n" +
                                  line + "\n")
                                  .codes();
    CHECK_MESSAGE(codes.find('E') == std::string::npos, line << ": " << codes);
    return codes.find("W0434") != std::string::npos;
  };
  for (const char* somewhere : {"V = k sqrt(R^2 - x^2)/R", "V = k log(x/a - 1)", "V = k asin(x/R)",
                                "V = k acos(x/a - 3)", "V = k sqrt((x - y)/R - 4)", "U = k sqrt(y'^2/c^2 - 4)",
                                "D = k c/R sqrt(y'/c)", "U = k sqrt(x'/c - 1000)\nstart x' = 6000 m/s"})
    CHECK_MESSAGE(!warned(somewhere), somewhere);
  for (const char* nowhere : {"V = k sqrt(-R^2 - x^2)/R", "V = k log(-1 - x^2/a^2)", "V = k asin(2 + x^2/R^2)",
                              "U = k sqrt(-1 - y'^2/c^2)", "D = k c/R sqrt(-1 - y'^2/c^2)"})
    CHECK_MESSAGE(warned(nowhere), nowhere);
}

TEST_CASE("null vectors name the coordinates they move") {
  const Elaborated e(
      "param m = 1 kg, l = 2 m\ncoord x : length, θ : angle, y : length\npoint P mass m at (x + l θ, y)\n");
  CHECK(e.codes() == "E0417");
  CHECK(e.first_message() == "the masses cannot tell `x` and `θ` apart");
  CHECK(e.diagnostics.items()[0].reason.find("x' by -2 and θ' by 1") != std::string::npos);
}

TEST_CASE("many coordinates: the rank is found from differences of the momenta") {
  std::string text = "param m = 1 kg\ncoord ";
  for (int i = 0; i < 20; ++i) text += (i ? ", x" : "x") + std::to_string(i);
  text += " : length\nT = 1/2 m (";
  for (int i = 0; i < 20; ++i)
    text += (i ? " + (x" : "(x") + std::to_string(i) + "' - x" + std::to_string((i + 1) % 20) + "')^2";
  const Elaborated e(text + ")\n");  // a ring: moving all together costs nothing
  CHECK(e.codes() == "E0408");
}

TEST_CASE("under constraints the mass matrix may be singular, but not on what they leave") {
  const auto codes = [](const std::string& text) { return Elaborated(text).codes(); };
  const std::string gear =
      "param Rs = 20 mm, Rp = 15 mm, n = 3, mp = 50 g, τ = 0.1 N m\n"
      "param Is = 1e-5 kg m^2, Ip = 4e-6 kg m^2, Ic = 8e-5 kg m^2\ncoord φs, φp, φc, φr : angle\n"
      "let Rr = Rs + 2 Rp, a = Rs + Rp\nT = 1/2 Is φs'^2 + n/2 Ip φp'^2 + 1/2 (Ic + n mp a^2) φc'^2\n"
      "constraint Rs (φs - φc) = -Rp (φp - φc)\nforce φs = τ\n";
  const std::string mesh = "constraint Rr (φr - φc) = Rp (φp - φc)\n";
  CHECK(codes(gear + mesh) == "N0428");
  CHECK(codes(gear + mesh + "constraint φr = 0\n") == "N0428");
  CHECK(codes(gear + "V = 1 [J] φr + 1 [J] (Rr/Rs) φr\n") == "E0407");
  // A chain of two massless ends, each tied to the next.
  const std::string chain = "param m = 1 kg\ncoord x, y, z : length\nT = 1/2 m x'^2\nconstraint y = 2 x\n";
  CHECK(codes(chain + "constraint z = x + y\n") == "N0428");
  CHECK(codes(chain + "V = 1 [N] z\n") == "E0407");
  CHECK(codes(chain + "constraint z' = x'\n") == "N0428");
  // Only y + z is tied: its two parts are not told apart.
  CHECK(codes(chain + "coord w : length\nconstraint z + w = x\n") == "E0408");
  // An indefinite T that is positive on what the constraints leave.
  CHECK(codes("param m = 1 kg\ncoord x, y : length\nT = 1/2 m (x'^2 - y'^2)\n") == "W0410");
  CHECK(codes("param m = 1 kg\ncoord x, y : length\nT = 1/2 m (x'^2 - y'^2)\nconstraint x = 2 y\n") == "");
  CHECK(codes("param m = 1 kg\ncoord x, y : length\nT = 1/2 m (x'^2 - y'^2)\nconstraint 2 x = y\n") == "W0410");
  // ∂²L/∂x'² = 1/(1 - x^2) is negative where y is no real number.
  const std::string half_circle = "dimensionless\ncoord x : number\nlet y = -sqrt(1 - x^2)\nL = (x'^2 ";
  CHECK(codes(half_circle + "+ y'^2)/2 - y\nstart x = 0.6\n") == "");
  CHECK(codes(half_circle + "- 2 y'^2)/2 - y\nstart x = 0.9\n") == "W0410");
  // The null direction turns with the state.
  CHECK(codes("param I = 1 kg m^2\nbody sat inertia diag(I, I, I) rotation quaternion\n") == "");
  CHECK(codes("param m = 1 kg\nbody sat mass m rotation quaternion\n") == "E0407");
  CHECK(codes("param m = 1 kg, l = 1 m\ncoord x, y : length\npoint P mass m at (x, 0)\nconstraint x^2 + y^2 = l^2\n") ==
        "N0428");
}

TEST_CASE("a coordinate in a constraint alone is used") {
  CHECK(Elaborated("param m = 1 kg\ncoord x, y : length\nT = 1/2 m x'^2\nconstraint y = x\n").codes() == "N0428");
  CHECK(Elaborated("param m = 1 kg\ncoord x, y, z : length\nT = 1/2 m x'^2\nconstraint y = x\n").codes() == "E0406");
}

TEST_CASE("a quaternion of given components needs its norm, whatever holds it") {
  const auto codes = [](const std::string& text) {
    return Elaborated(
               "param I = 1 kg m^2\ncoord w, x, y, z : number\nbody B inertia diag(I, I, I) rotation quaternion "
               "(w, x, y, z)\n" +
               text)
        .codes();
  };
  CHECK(codes("constraint w^2 + x^2 + y^2 + z^2 = 1\n") == "");
  CHECK(codes("constraint sqrt(w^2 + x^2 + y^2 + z^2) = 1\n") == "");
  CHECK(codes("constraint w^2 + x^2 + y^2 + z^2 = 2\n") == "W0427");
  CHECK(codes("constraint w + x = 1\n") == "W0427");
}

TEST_CASE("energies that jump at a switch are refused; kinks, pieces that meet and forces that jump are not") {
  const auto codes = [](const std::string& text) {
    return Elaborated("dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n" + text).codes();
  };
  for (const char* fine :
       {"V = abs(x) + max(y, 0)^1.5", "V = piecewise(x^2 + y^2 < 4 : 0, else : (sqrt(x^2 + y^2) - 2)^2)",
        "V = min(x^2, y^2)", "force x = step(x - 1)", "D = 1/2 step(x) x'^2", "D = abs(x')", "V = x^2/(1 + abs(x)/x)",
        // switched on in time: a force, no impulse; Meissner's equation
        "V = -x step(t - 1)", "V = 1/2 (2 + sign(cos(t))) x^2", "V = 5 step(t - 1) + x^2",
        // a total time derivative, and a jump that other parts take back
        "V = x^2 + y^2\nU = step(x) x'", "V = x^2 + step(x - 1)\nV += piecewise(x < 1 : 1, else : 0)",
        // a switch between parameters
        "param a = 1, b = 2\nV = piecewise(a < b : x^2, else : 1)",
        // met in the decimals as written, in no double
        "param a = 0.1, b = 0.3\nV = piecewise(x < a + 0.2 : x, else : b)", "V = step(x)/x"})
    CHECK_MESSAGE(codes(fine).find("E04") == std::string::npos, fine);
  for (const char* wrong :
       {"V = step(x)", "V = piecewise(x < 2 : x^2, else : 1)", "V = y step(x)", "V = x^2\nU = sign(y) x'",
        "V = x^2\nU = step(t - 1) x'", "T += 1/2 step(t - 1) x'^2", "T += 1/2 step(x) x'^2",
        "T += 1/2 step(x' - 1) x'^2", "L = 1/2 (x'^2 + y'^2) - 1e-9 step(x)", "D = step(x' - 1)",
        "V = max(x - 50, 0)^2 step(y - 70)", "V = step(x - t)"})
    CHECK_MESSAGE(codes(wrong).find("E0430") != std::string::npos, wrong);
  CHECK(codes("V = x^2\nU = abs(x' - 1)") == "E0432");
  CHECK(codes("T += 1/2 max(x', 0)^2").empty());  // the momentum has a kink, no jump
}

TEST_CASE("the jump is named with its size and its place") {
  const auto message = [](const std::string& text) { return Elaborated(text).first_message(); };
  const std::string head = "param m = 1 kg, a = 3 m, W = 0.4 J\ncoord x : length\nT = 1/2 m x'^2\n";
  CHECK(message(head + "V = W step(x - a)\n") == "V jumps by 0.4 J where x = a");
  CHECK(message(head + "V = W piecewise(x < 2 [m] : x/a, else : 1)\n") == "V jumps by 0.133333 J where x = 2 [m]");
  CHECK(message("param m = 1 kg\ncoord x : length\nT = 1/2 m step(x) x'^2 + 1/2 m x'^2\n") ==
        "T jumps where x = 0: by 0.5 J at x = 0 m, x' = 1 m/s");
  CHECK(message("param m = 1 kg, d = 1 m\ncoord x : length\npoint P mass m at (x + d step(x), 0)\n") ==
        "the position of P jumps where x = 0");
}

TEST_CASE("what is said of a coordinate without kinetic energy fits the way T is given") {
  const auto told = [](const std::string& text) {
    const Elaborated e("param m = 1 kg, b = 2 kg/s, k = 1 N/m\ncoord x, y : length\nV = 1/2 k y^2\n" + text);
    REQUIRE(e.codes().find("E0407") != std::string::npos);
    return e.diagnostics.items().back().reason;
  };
  const std::string masses = "No mass moves when y changes", given = "y' does not enter T";
  CHECK(told("point P mass m at (x, 0)\n").find(masses) == 0);
  CHECK(told("T = 1/2 m x'^2\n").find(given) == 0);
  CHECK(told("point P mass m at (x, 0)\nT += 3/2 m x'^2\n").find(given) == 0);
  CHECK(told("point P mass m at (x, 0)\nL += b y x'\n").find(given) == 0);
}

TEST_CASE("one jump among thousands of pieces, or behind one of hundreds of springs, is found") {
  const auto stairs = [](int pieces, int wrong) {
    std::string text = "param m = 1 kg, L = 1 m, V0 = 1 J\ncoord x : length\nT = 1/2 m x'^2\nV = V0 piecewise(";
    int level = 0;
    for (int i = 1; i < pieces; ++i) {
      const int slope = 1 + i % 7;
      text += "x/L < " + std::to_string(i) + " : " + std::to_string(slope) + " (x/L - " + std::to_string(i - 1) +
              ") + " + std::to_string(level + (i == wrong ? 1 : 0)) + ",\n  ";
      level += slope;
    }
    return text + "else : " + std::to_string(level) + ")\n";
  };
  const int pieces = under_sanitizers ? 500 : 2000, at = under_sanitizers ? 234 : 1234;
  CHECK(Elaborated(stairs(pieces, 0)).fine());
  const Elaborated wrong(stairs(pieces, at));
  CHECK(wrong.codes() == "E0430 E0430");
  CHECK(wrong.first_message() == fmt::format("V jumps by 1 J where x/L = {}", at - 1));

  const auto springs = [](int count, const std::string& more) {
    std::string text = "param m = 1 kg, k = 100 N/m, l = 1 m\n";
    for (int i = 0; i < count; ++i)
      text += "coord x" + std::to_string(i) + " : length\nT += 1/2 m x" + std::to_string(i) + "'^2\n";
    for (int i = 1; i < count; ++i)
      text += "V += 1/2 k (abs(x" + std::to_string(i) + " - x" + std::to_string(i - 1) + ") - l)^2\n";
    return text + more;
  };
  const int count = under_sanitizers ? 110 : 300, last = count - 10;
  CHECK(Elaborated(springs(count, "")).fine());
  const Elaborated torn(springs(count, fmt::format("V += 1/2 k l^2 step(x{} - x{})\n", last + 1, last)));
  CHECK(torn.codes() == "E0430");
  const std::string place = fmt::format("V jumps by 50 J where x{} - x{} = 0", last, last + 1);
  CHECK(torn.first_message().find(place) != std::string::npos);
}

TEST_CASE("a jump far from everything that is tried is found by solving for its place") {
  for (const char* jump : {"step(x - 1e6)*1e-3", "step(x - 1234567)", "2 step(x - 1e13)", "step(-x - 3e9)",
                           "abs(x) + step(x - 4e7)", "x*step(y - 5e8)", "step(t - 7e8)*0 + step(x - 7e8)"})
    CHECK_MESSAGE(
        Elaborated("dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = " + std::string(jump) + "\n")
                .codes() == "E0430",
        jump);
  CHECK(
      Elaborated("dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\nV = max(x, 1e9) + abs(y - 3e8)\n").fine());
}

TEST_CASE("of a table that jumps everywhere twenty places are told, and how many are left") {
  const auto table = [](int pieces) {
    std::string text = "dimensionless\ncoord x : number\nT = 1/2 x'^2\nV = piecewise(";
    for (int i = 0; i < pieces; ++i) text += "x < " + std::to_string(i) + " : " + std::to_string(2 * i) + ", ";
    return Elaborated(text + "else : -1)\n");
  };
  CHECK(table(20).messages().find("not looked at") == std::string::npos);
  CHECK(table(25).messages().find("5 more switches are not looked at") != std::string::npos);
}
