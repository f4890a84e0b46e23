#include "support.hpp"

#include <maupertuis/language_words.hpp>

#include <doctest/doctest.h>

#include <set>

namespace {
using namespace language_test;

std::string hovered(const std::string& marked) {
  const Marked at(marked);
  Document asked = document(at.text);
  const auto found = hover(asked, at.offset);
  return found ? found->markdown : std::string();
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::set<std::string> offered(const std::string& marked) {
  const Marked at(marked);
  Document asked = document(at.text);
  std::set<std::string> out;
  for (const Completion& c : complete(asked, at.offset).items) out.insert(c.label);
  return out;
}

std::string at_mark(const std::string& text, const std::string& part, std::size_t into = 0) {
  std::string out = text;
  return out.insert(out.find(part) + into, "|");
}

}  // namespace

TEST_CASE("hover says kind, dimension, value, declaration and the comment beside it") {
  const std::string l = hovered(at_mark(pendulum, "l (sin"));
  CHECK(has(l, "param l = 1 m"));
  CHECK(has(l, "parameter `l`: length (m), 1 m in SI"));
  CHECK(has(l, "the bob's mass"));
  CHECK(has(l, "Declared on line 2."));
  CHECK(has(hovered(at_mark(pendulum, "m = 500")), "mass (kg), 0.5 kg in SI"));
  CHECK(has(hovered(at_mark(pendulum, "ω0")), "definition `ω0`"));
  CHECK(has(hovered(at_mark(pendulum, "ω0")), "3.13209"));  // sqrt(9.81)
  CHECK(has(hovered(at_mark(pendulum, "θ : ")), "coordinate `θ`: angle (rad)"));
  CHECK(has(hovered(at_mark(pendulum, "bob mass")), "mass 0.5 kg"));
}

TEST_CASE("hover says kind, dimension and value while another line has a mistake") {
  const std::string head =
      "system pendulum\nparam m = 500 g, l = 1 m, g = 9.81 m/s^2\nlet ω0 = sqrt(g/l)\ncoord θ : angle\n"
      "T = 1/2 m l^2 θ'^2\nV = -m g l cos θ\nstart θ = 1 rad\nrun 2 s\n";
  for (const char* mistake : {"draw Q\n", "let w = m *\n", "run 5,5 s\n",
                              "let w = m + l\nlet u = 2 w\nD = 1/2 u θ'^2\n", "expect θ at 1 s = \n"}) {
    CAPTURE(mistake);
    CHECK(has(hovered(at_mark(head + mistake, "l = 1 m")), "parameter `l`: length (m), 1 m in SI"));
    CHECK(has(hovered(at_mark(head + mistake, "m = 500")), "mass (kg), 0.5 kg in SI"));
    CHECK(has(hovered(at_mark(head + mistake, "ω0")), "3.13209"));
    CHECK(has(hovered(at_mark(head + mistake, "θ : ")), "coordinate `θ`: angle (rad)"));
  }
}

TEST_CASE("hover explains words, functions, units and mistakes") {
  CHECK(has(hovered(at_mark(pendulum, "point bob")), "A particle, or without mass a marked point."));
  CHECK(has(hovered(at_mark(pendulum, "mass m at")), "Its mass."));
  CHECK(has(hovered(at_mark(pendulum, "sqrt")), "The square root."));
  CHECK(has(hovered(at_mark(pendulum, "deg\n")), "1 deg = 0.0174533 rad"));
  CHECK(has(hovered("param w = 3 r|pm\n"), "1 rpm = 0.10472 rad/s"));
  CHECK(has(hovered("param m = 3 k|gg\ncoord x : length\nT = 1/2 m x'^2\n"), "**E0301**"));
  CHECK(hovered(at_mark(pendulum, "500")).empty());
  CHECK(hovered("# a com|ment\n").empty());
}

TEST_CASE("statements at the beginning of a line, their words inside, units after numbers") {
  for (const std::string_view word : syntax::statement_words()) CHECK(offered("|").count(std::string(word)) == 1);
  CHECK(offered(std::string(pendulum) + "sta|").count("start") == 1);
  CHECK(offered("point P |").empty() == false);
  CHECK(offered("point P |").count("mass") == 1);
  CHECK(offered("point P |").count("stiffness") == 0);
  CHECK(offered("param m = 3 |").count("kg") == 1);
  CHECK(offered("param m = 3 k|").count("kg") == 1);
  CHECK(offered("coord x : [|]").count("m") == 1);
  CHECK(offered("coord x : |").count("length") == 1);
  CHECK(offered("draw |").count("trail") == 1);
  CHECK(offered("body B rotation |").count("quaternion") == 1);
  CHECK(offered("impact |").count("sequential") == 1);
}

TEST_CASE("names in scope and functions in formulas; none where a new name is due, in comments and texts") {
  const auto names = offered(std::string(pendulum) + "V = -m g |");
  for (const char* name : {"m", "l", "g", "θ", "ω0", "bob", "cos", "sqrt", "t", "pi"}) CHECK(names.count(name) == 1);
  CHECK(names.count("system") == 0);
  CHECK(offered("param |").empty());
  CHECK(offered("param m = 1 kg, |").empty());
  CHECK(offered("# par|").empty());
  CHECK(offered("system a \"t|\"\n").empty());
}

TEST_CASE("nothing is offered behind what is finished: a key for a new line is one") {
  const std::string lines[] = {"system pendulum \"Simple pendulum\"",
                               "param m = 1 kg, l = 1 m, g = 9.81 m/s^2",
                               "coord theta : angle",
                               "point bob mass m at l (sin theta, -cos theta)",
                               "gravity (0, -g)",
                               "start theta = 60 deg",
                               "run 10 s",
                               "draw O - bob, trail bob",
                               "expect energy conserved rel 1e-12",
                               "let v2 = theta'^2",
                               "let w = theta'"};
  std::string typed;
  for (const std::string& line : lines) {
    typed += line;
    CAPTURE(line);
    CHECK(offered(typed + "|").empty());
    typed += "\n";
  }
  CHECK(offered(typed + "expect the|").count("θ") == 1);
}

TEST_CASE("units stand where the grammar takes one, those that fit first") {
  for (const std::string none :
       {"let a = 2 |", "V = 1/2 |", "V = m^2 |", "expect energy conserved rel 1e-12 |", "let b = m^|"}) {
    CAPTURE(none);
    CHECK(offered(std::string(pendulum) + none).count("kg") == 0);
  }
  CHECK(offered(std::string(pendulum) + "body B mass 1 |").count("kg") == 1);
  CHECK(offered(std::string(pendulum) + "param a = 9.81 m/|").count("s") == 1);
  CHECK(offered(std::string(pendulum) + "param c = 9.81 m^2 |").count("kg") == 1);
  const auto first = [](const std::string& line) {
    const Marked at("coord q : angle, x : length\n" + line);
    Document asked = document(at.text);
    const Completions found = complete(asked, at.offset);
    const auto best = std::min_element(found.items.begin(), found.items.end(),
                                       [](const Completion& a, const Completion& b) { return a.rank < b.rank; });
    return best == found.items.end() ? std::string() : best->label;
  };
  CHECK(first("run 10 |") == "s");
  CHECK(first("start q = 60 |") == "rad");
  CHECK(first("start q' = -60 |") == "rad/s");
  CHECK(first("start q = 60 deg, x' = 2 |") == "m/s");
  CHECK(first("param a = 2 |") == "kg");
}

TEST_CASE("members after a point") {
  const std::string body = "coord x : length\nbody B mass 1 kg inertia 1 kg m^2 at (x, 0) rotation angle 0\n";
  CHECK(offered(body + "V = B.|") == std::set<std::string>{"x", "y", "z", "ω", "ω_world", "qw", "qx", "qy", "qz"});
  const auto of_point = offered(std::string(pendulum) + "draw O - bob\nexpect bob.|");
  CHECK(of_point.count("x") == 1);
  CHECK(of_point.count("ω") == 0);
}

TEST_CASE("signatures count commas") {
  const Marked at("let a = atan2(sin(x), |");
  Document asked = document(at.text);
  const auto found = signature(asked, at.offset);
  REQUIRE(found);
  CHECK(found->label == "atan2(y, x)");
  CHECK(found->active == 1);
  const Marked inner("let a = atan2(sin(x|), y)");
  Document other = document(inner.text);
  CHECK(signature(other, inner.offset)->label == "sin(angle)");
  const Marked outside("let a = (x|)");
  Document none = document(outside.text);
  CHECK(!signature(none, outside.offset));
}

TEST_CASE("what stands in a model of the gallery would have been offered there") {
  std::size_t asked_for = 0, missing = 0;
  std::string first_missing;
  for (const auto& path : models_in("models")) {
    const std::string text = read_file(path);
    if (text.size() > 1200) continue;
    const syntax::TextReading reading = syntax::read_text(SourceText("", text));
    Document whole = document(text);
    for (std::size_t s = 0; s < reading.statements.size(); s += 1)
      for (std::size_t i = reading.statements[s].begin; i < reading.statements[s].end; i += 1) {
        const syntax::TextToken& token = reading.tokens[i];
        if (token.kind != syntax::TextToken::Kind::Name || text[token.span.begin] == '\xe2') continue;  // √
        if (i > reading.statements[s].begin && reading.tokens[i - 1].is("error")) continue;             // a code
        const auto& declares = reading.statements[s].declares;
        const bool declaration =
            std::any_of(declares.begin(), declares.end(), [&](const syntax::Name& n) { return n.span == token.span; });
        const bool derived = token.text.find('_') != std::string::npos;
        if (declaration || derived || slice(text, token.span) != token.text) continue;
        const Completions found = complete(whole, token.span.begin);
        const bool there = std::any_of(found.items.begin(), found.items.end(),
                                       [&](const Completion& c) { return c.label == token.text; });
        ++asked_for;
        if (!there && missing++ < 12)
          first_missing += "\n" + path.filename().string() + ": " + token.text + " in " +
                           std::string(whole.source().line(whole.source().locate(token.span.begin).line));
      }
  }
  CHECK(asked_for > 2000);
  INFO(first_missing);
  CHECK(missing == 0);
}

TEST_CASE("every word of the parser has its line of help, and every form is the language's") {
  std::set<std::string_view> statements, others;
  for (const WordHelp& word : words()) {
    CHECK(!word.help.empty());
    CHECK(!word.form.empty());
    (word.statements.empty() ? statements : others).insert(word.word);
  }
  for (const std::string_view word : syntax::statement_words()) CHECK(statements.count(word) == 1);
  CHECK(statements.size() == syntax::statement_words().size());
  for (const std::string_view word : syntax::clause_words()) {
    CAPTURE(word);
    CHECK((others.count(word) == 1 || word == "else" || word == "and" || word == "or"));
  }
  for (const syntax::Function& function : syntax::functions()) {
    CAPTURE(function.name);
    const Marked at("let a = " + std::string(function.name) + "(|");
    Document asked = document(at.text);
    const auto found = signature(asked, at.offset);
    REQUIRE(found);
    const bool any = function.most == 0;
    CHECK((any || found->parameters.size() == static_cast<std::size_t>(function.most) || function.name == "dot"));
  }
}
