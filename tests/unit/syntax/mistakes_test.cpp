#include <doctest/doctest.h>

#include "../under_sanitizers.hpp"
#include "support.hpp"

#include <ctime>

using namespace maupertuis;
using namespace maupertuis::syntax;
using namespace maupertuis::syntax::test;

namespace {

struct Mistake {
  const char* text;
  const char* code;
  const char* marked;  // what the caret is under
  const char* says;    // stands in the message, the reason or the help
};

}  // namespace

TEST_CASE("one mistake gives one message, under the right words, with a way out") {
  const Mistake mistakes[] = {
      {"parm m = 1 kg", "E0110", "parm", "`param`"},
      {"Param m = 1 kg", "E0110", "Param", "`param`"},
      {"kinteic = 3", "E0110", "kinteic", "`kinetic`"},
      {"x = 3", "E0110", "x", "let x ="},
      {"θ' = 3", "E0110", "θ", "start θ ="},
      {"(1, 2)", "E0110", "(", "indented"},
      {"param m 1 kg", "E0111", "1", "`=`"},
      {"param m = ", "E0111", "", "end of the statement"},
      {"param m = 1 kg,", "E0111", "", "name of a parameter"},
      {"param m = 1 kg l = 2", "E0111", "l", "a comma is missing"},
      {"coord θ", "E0129", "θ", "θ : angle"},
      {"coord θ : angel", "E0129", "angel", "`angle`"},
      {"coord y [m], x : length", "E0111", "[", "write y : [m]."},
      {"coord θ = 30 deg", "E0111", "=", "and start θ = 30 deg"},
      {"system \"Foucault's pendulum\"", "E0111", "\"Foucault's pendulum\"", "system foucaults_pendulum \"Foucault's"},
      {"system \"2 + 2\"", "E0111", "\"2 + 2\"", "system my_system"},
      {"field u(x) : length on 0 .. l", "E0111", "0", "Write on x = 0 .. l."},
      {"density 1/2 u_t^2", "E0111", "1", "Write density = 1/2 u_t^2."},
      {"density L = 1/2 u_t^2", "E0111", "L", "Write density = 1/2 u_t^2."},
      {"constraint rod: x^2 + y^2 = l^2", "E0111", ":", "write constraint x^2 + y^2 = l^2 name rod."},
      {"point P = (x, y) mass m", "E0111", "=", "point P at (x, y) mass m"},
      {"coord x : m", "E0129", "m", "[m]"},
      {"point P mass m", "E0127", "point P mass m", "`at`"},
      {"point P at (0, 0) at (0, 1)", "E0127", "at", "twice"},
      {"spring A B stiffness k", "E0111", "B", "`-`"},
      {"damper A - B", "E0127", "damper A - B", "coefficient"},
      {"torque θ = 3", "E0111", "torque θ", "force θ"},
      {"reaction rod = l1", "E0111", "l1", "release"},
      {"run until x = 3", "E0127", "run until x = 3", "within"},
      {"output 3 s", "E0111", "3", "every"},
      {"draw A", "E0111", "", "another point"},
      {"let a = cos θ^2", "E0114", "cos θ^2", "cos^2 θ or cos(θ^2)"},
      {"let a = sin -θ", "E0113", "sin -θ", "sin(-θ)"},
      {"let a = sin^-1 θ", "E0115", "sin^-1", "asin"},
      {"let a = cos 2 θ", "E0113", "cos 2", "cos(2 θ)"},
      {"let a = sqrt x", "E0113", "sqrt", "sqrt(x)"},
      {"let a = sine(x)", "E0122", "sine", "Write sin(x)."},
      {"let a = sini(x)", "E0122", "sini", "`sin`"},
      {"let a = 2 3", "E0123", "2 3", "2 * 3"},
      {"let a = x**2", "E0104", "**", "x^2"},
      {"let a = x // half", "E0104", "//", "#"},
      {"let a == 2", "E0104", "==", "one `=`"},
      {"let a = 2;", "E0104", ";", "one statement a line"},
      {"let a = 2 @ 3", "E0104", "@", "U+0040"},
      {"let a = @@ 3", "E0104", "@", "U+0040"},
      {"let a = x\u200B", "E0104", "\u200B", "invisible"},
      {"let a = 3 – 2", "E0104", "–", "dash"},
      {"let a = |x|", "E0104", "|", "abs(x)"},
      {"let a = {2}", "E0104", "{", "round brackets"},
      {"let a = 5. ", "E0105", "5.", "decimal point"},
      {"let a = 1.2.3", "E0105", "1.2.3", "one decimal point"},
      {"let a = 1e400", "E0105", "1e400", "double precision"},
      {"let a = (1 + 2", "E0106", "(", "`)`"},
      {"let a = 1 + 2)", "E0106", ")", "No bracket"},
      {"let a = (1 + 2]", "E0106", "]", "`(`"},
      {"system a \"title", "E0104", "\"", "Close it"},
      {"let a = θ\"", "E0104", "\"", "θ''"},
      {"source \"a test of \"words\" and\"", "E0104", "\"", "Use '"},
      {"param c = 1 J/kg K", "E0118", "kg K", "/(kg K)"},
      {"param T0 = 20 °C", "E0104", "°C", "K"},
      {"param a = 2 m [s]", "E0119", "[", "after a number"},
  };
  for (const Mistake& mistake : mistakes) {
    CAPTURE(mistake.text);
    Parsed parsed(std::string(mistake.text) + "\nparam zzz = 1\n");
    INFO(parsed.messages());
    REQUIRE(parsed.codes().substr(0, 5) == mistake.code);
    const Diagnostic& d = parsed.diagnostics.items()[0];
    const bool repeated_sign = mistake.text == std::string("let a = |x|") || mistake.text == std::string("let a = {2}");
    if (!repeated_sign) CHECK(parsed.diagnostics.items().size() == 1);
    CHECK(parsed.at(0).substr(0, std::string(mistake.marked).size()) == mistake.marked);
    CHECK((d.message + d.reason + d.help).find(mistake.says) != std::string::npos);
    const bool explained = !(d.reason + d.help).empty() || d.message.find("expected") != std::string::npos;
    CHECK(explained);
    CHECK(parsed.tree.statements.size() == 1);  // the statement after it stands
  }
}

TEST_CASE("all mistakes of a text are told at once, in their places") {
  Parsed parsed(
      "param m = 1 kg, l = , g = 9.81 m/s^2, k = 3 [N\ncoord x :\nlet a = 1e999, b = sqrt x, c = 2\nlet d = 3\nfoo\n");
  CHECK(parsed.codes() == "E0106 E0129 E0105 E0110");
  Parsed list("param m = 1 kg, l = , g = 9.81 m/s^2, k = sqrt x, j = 2 3\n");
  CHECK(list.codes() == "E0111 E0113 E0123");
}

TEST_CASE("names of statements that were left out are kept for the stages after") {
  Parsed parsed("param m = 1 kg, l = \ncoord θ : angl\n");
  REQUIRE(parsed.tree.lost_names.size() == 3);
  CHECK(parsed.tree.lost_names[1].text == "l");
  CHECK(parsed.tree.lost_names[2].text == "θ");
}

TEST_CASE("texts that are no models") {
  CHECK(Parsed("").codes() == "E0109");
  CHECK(Parsed("\n\n# only a comment\n").codes() == "E0109");
  CHECK(Parsed("\x7F"
               "ELF\x02\x01\x01")
            .codes() == "E0103");
  CHECK(Parsed(std::string("param m = 1\0kg\n", 15)).codes() == "E0103");
  CHECK(Parsed("param m = 60\xB0\n").codes() == "E0102");
  CHECK(Parsed("param m = \xC0\xAF\n").codes() == "E0102");          // overlong
  CHECK(Parsed("param m = \xED\xA0\x80\n").codes() == "E0102");      // surrogate
  CHECK(Parsed("param m = \xF4\x90\x80\x80\n").codes() == "E0102");  // beyond U+10FFFF
  CHECK(Parsed("param m = \xE2\x82").codes() == "E0102");            // cut off
  CHECK(Parsed("\xFF\xFEp\x00").codes() == "E0102");
  CHECK(Parsed("system a\nsystem b\nsystem c\n").codes() == "E0124");
}

TEST_CASE("size, depth and length are bounded, and so is the time") {
  const std::clock_t begin = std::clock();  // of the processor: other work on the machine is no fault
  const auto repeat = [](std::size_t n, const std::string& part) {
    std::string all;
    for (std::size_t i = 0; i < n; ++i) all += part;
    return all;
  };
  CHECK(Parsed(std::string(10'000'000, 'x')).codes() == "E0101");
  CHECK(Parsed("let a = " + repeat(100'000, "(") + "1" + repeat(100'000, ")") + "\n").codes() == "E0108");
  CHECK(Parsed("let a = " + repeat(150, "(") + "1" + repeat(150, ")") + "\n").fine());
  CHECK(Parsed("let a = " + repeat(100'000, "(") + "\n").codes() == "E0106");
  CHECK(Parsed("let a = " + repeat(100'000, "-") + "1\n").codes() == "E0108");
  CHECK(Parsed("let a = 2" + repeat(100'000, "^2") + "\n").codes() == "E0108");
  CHECK(Parsed("let a = 2" + repeat(100'000, " + x") + "\n").codes() == "E0108");
  CHECK(Parsed("let a = 2" + repeat(1'900, " + x") + "\n").fine());
  CHECK(Parsed("let a = " + repeat(100'000, "√") + "x\n").diagnostics.items().size() > 0);
  CHECK(Parsed("let a = " + repeat(10'000, "dot(") + "x\n").codes() == "E0106");
  CHECK(Parsed("let a = x" + repeat(10'000, "'") + "\n").fine());
  CHECK(Parsed("let a = " + std::string(1'000'000, 'x') + "\n").codes() == "E0101");
  CHECK(Parsed("let a = " + std::string(1'000'000, '1') + "\n").codes() == "E0101");
  CHECK(Parsed("system a \"" + std::string(1'000'000, 'x') + "\"\n").fine());
  CHECK(Parsed("# " + std::string(1'000'000, 'x') + "\nparam a = 1\n").fine());
  const std::size_t many = under_sanitizers ? 10'000 : 100'000;
  CHECK(Parsed("param a = 1" + repeat(many, ", b = 2 kg") + "\n").fine());
  CHECK(Parsed("param a = 1" + repeat(many, ", b = ") + "\n").diagnostics.has_errors());
  CHECK(Parsed(repeat(2 * many, "bad\n")).diagnostics.has_errors());
  CHECK(Parsed(repeat(2'000'000, "a ")).codes() == "E0101");
  CHECK(Parsed("gravity " + repeat(20'000, "(1,") + "\n").codes() == "E0106");
  CHECK((std::clock() - begin) / CLOCKS_PER_SEC < (under_sanitizers ? 600 : 60));
}
