#include "support.hpp"

#include <doctest/doctest.h>

#include <set>

namespace {
using namespace language_test;

struct Case {
  const char* code;
  std::string wrong, right;
};

const std::string head = "system a\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\n";

/// A model of one coordinate with these lines at its end.
std::string model(const std::string& lines) { return head + "T = 1/2 m l^2 θ'^2\n" + lines; }

const std::vector<Case> cases = {
    {"E0104", model("V = -m g l cos θ;\n"), model("V = -m g l cos θ\n")},
    {"E0104", model("V := -m g l cos θ\n"), model("V = -m g l cos θ\n")},
    {"E0104", model("V = -m g l cos θ % gravity\n"), model("V = -m g l cos θ # gravity\n")},
    {"E0104", model("V = m g l \\frac{1}{2} sin θ\n"), model("V = m g l 1/2 sin θ\n")},
    {"E0105", "system a\nparam m = 1,5 kg\ncoord x : length\nT = 1/2 m x'^2\n",
     "system a\nparam m = 1.5 kg\ncoord x : length\nT = 1/2 m x'^2\n"},
    {"E0106", model("V = -m g (l cos θ\n"), model("V = -m g (l cos θ)\n")},
    {"E0107", model("  V = -m g l cos θ\n"), model("V = -m g l cos θ\n")},
    {"E0110", model("W0 = 3 m\nV = -m g (l + W0) cos θ\n"), model("let W0 = 3 m\nV = -m g (l + W0) cos θ\n")},
    {"E0110", model("potental = -m g l cos θ\n"), model("potential = -m g l cos θ\n")},
    {"E0110", "parameters m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n",
     "param m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n"},
    {"E0110", "param m = 1 kg\ncoordinate x\nT = 1/2 m (1 [m/s])^2\n",
     "param m = 1 kg\ncoord x\nT = 1/2 m (1 [m/s])^2\n"},
    {"E0110", model("V = -m g l cos θ\nθ(0) = 1\n"), model("V = -m g l cos θ\nstart θ = 1\n")},
    {"E0111", head + "point P mass m at l (sin θ, -cos θ)\ngravity = (0, -g)\n",
     head + "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\n"},
    {"E0111", model("V = -m g l cos θ\nstart θ(0) = 1\n"), model("V = -m g l cos θ\nstart θ = 1\n")},
    {"E0111", "param m = 1 kg, l = 1 m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nconstraint x^2 + y^2 - l^2\n",
     "param m = 1 kg, l = 1 m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nconstraint x^2 + y^2 - l^2 = 0\n"},
    {"E0111", head + "point P mas m at l (sin θ, -cos θ)\n", head + "point P mass m at l (sin θ, -cos θ)\n"},
    {"E0201", model("V = -m g l coss θ\n"), model("V = -m g l cos θ\n")},
    {"E0104", model("V = m g l θ**2\n"), model("V = m g l θ^2\n")},
    {"E0129", "param m = 1 kg\ncoord x\nT = 1/2 m x'^2\n", "param m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n"},
    {"E0201", "param m = 1 kg\ncoord x : length\nT = 1/2 m (dx/dt)^2\n",
     "param m = 1 kg\ncoord x : length\nT = 1/2 m (x')^2\n"},
    {"E0210", head + "point P mass m at l (sin θ, -cos θ)\ngravity g\n",
     head + "point P mass m at l (sin θ, -cos θ)\ngravity (0, -g)\n"},
    {"E0304", "param m = 1, l = 1 m\ncoord θ : angle\nT = 1/2 m l^2 θ'^2\n",
     "param m = 1 kg, l = 1 m\ncoord θ : angle\nT = 1/2 m l^2 θ'^2\n"},
    {"E0304", "param m = 1, g = 9.81 m/s^2\ncoord x : length\npoint P mass m at (x, 0)\ngravity (0, -g)\n",
     "param m = 1 kg, g = 9.81 m/s^2\ncoord x : length\npoint P mass m at (x, 0)\ngravity (0, -g)\n"},
    {"E0304", model("V = -m g l cos θ\nrun 10\n"), model("V = -m g l cos θ\nrun 10 s\n")},
    {"E0113", model("V = m g l sin -θ\n"), model("V = m g l sin(-θ)\n")},
    {"E0114", model("V = m g l cos θ^2\n"), model("V = m g l cos^2 θ\n")},
    {"E0115", model("V = m g l cos^-1 (1/3) cos θ\n"), model("V = m g l acos (1/3) cos θ\n")},
    {"E0117", model("param e1 = 2\nV = -m g l cos θ (2e1)\n"), model("param e1 = 2\nV = -m g l cos θ (2 e1)\n")},
    {"W0103", "param m = 1 kg, a = 1 J\ncoord α, β : angle\nT = 1/2 m (1 [m^2]) (α'^2 + β'^2)\nV = -a (cos α - β)\n",
     "param m = 1 kg, a = 1 J\ncoord α, β : angle\nT = 1/2 m (1 [m^2]) (α'^2 + β'^2)\nV = -a (cos(α - β))\n"},
    {"E0121", model("V = -m g l cos(θ(t))\n"), model("V = -m g l cos(θ)\n")},
    {"E0122", model("V = -m g l cosine(θ)\n"), model("V = -m g l cos(θ)\n")},
    {"E0123", model("V = -2 3 m g l cos θ\n"), model("V = -2 * 3 m g l cos θ\n")},
    {"E0201", model("V = -m g l cos θ1\n"), model("V = -m g l cos θ\n")},
    {"E0201", model("V = -mgl cos θ\n"), model("V = -m g l cos θ\n")},
    {"E0251", model("V = -m g l cos θ\nmethod stif\n"), model("V = -m g l cos θ\nmethod stiff\n")},
    {"E0301", "system a\nparam m = 1 kgg\ncoord x : length\nT = 1/2 m x'^2\n",
     "system a\nparam m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n"},
    {"E0312", model("V = -3 J cos θ\n"), model("V = -3 [J] cos θ\n")},
    {"W0102", model("V = -m g l cos θ/2\n"), model("V = -m g l cos(θ/2)\n")},
    {"W0310", model("V = -m g l cos θ\nstart θ = 60\n"), model("V = -m g l cos θ\nstart θ = 60 deg\n")},
    {"E0118", "param c = 4186 J/kg K, m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n",
     "param c = 4186 J/(kg K), m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n"},
    {"E0120", "system a\nparam L = 2 m, m = 1 kg\ncoord x : length\nL = 1/2 m x'^2\n",
     "system a\nparam L = 2 m, m = 1 kg\ncoord x : length\nlagrangian = 1/2 m x'^2\n"},
    {"E0207", model("T = 1/2 m l^2 θ'^2\n"), model("T += 1/2 m l^2 θ'^2\n")},
    {"E0208", model("point P mass m at (l sin θ, -l cos θ)\ngravity (0, -g)\ngravity (0, g)\n"),
     model("point P mass m at (l sin θ, -l cos θ)\ngravity (0, -g)\n")},
    {"E0208", model("V = -m g l cos θ\nstart θ = 1\nstart θ' = 2 rad/s, θ = 3\n"),
     model("V = -m g l cos θ\nstart θ = 1\nstart θ' = 2 rad/s\n")},
    {"E0209", model("param J = 1/3 m l^2\n"), model("let J = 1/3 m l^2\n")},
    {"E0306", model("V = -m g l cos θ\nstart θ' = 2 Hz\n"), model("V = -m g l cos θ\nstart θ' = 2 rev/s\n")},
    {"E0307", "param M = 1 kg, m = 3 m\ncoord x : length\nT = 1/2 M x'^2\nstart x = 2 m\n",
     "param M = 1 kg, m = 3 m\ncoord x : length\nT = 1/2 M x'^2\nstart x = 2 [m]\n"},
    {"E0308", "system a\ndimensionless\nparam m = 1 kg\ncoord x : number\nT = 1/2 m x'^2\n",
     "system a\ndimensionless\nparam m = 1\ncoord x : number\nT = 1/2 m x'^2\n"},
    {"E0406", "system a\nparam m = 1 kg\ncoord x, y : length\nT = 1/2 m x'^2\n",
     "system a\nparam m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n"},
    {"E0406", "system a\nparam m = 1 kg\ncoord y, x : length\nT = 1/2 m x'^2\n",
     "system a\nparam m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n"},
    {"E0406", "system a\nparam m = 1 kg\ncoord x : length, φ : angle\nT = 1/2 m x'^2\n",
     "system a\nparam m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n"},
    {"W0107", model("param lоad = 1\nV = -lоad m g l cos θ\n"), model("param load = 1\nV = -load m g l cos θ\n")},
    {"W0415", model("param k = 5 N/m, c = 1\nV = -c m g l cos θ\n"), model("param c = 1\nV = -c m g l cos θ\n")},
    {"W0415", model("param c = 1, k = 5 N/m\nV = -c m g l cos θ\n"), model("param c = 1\nV = -c m g l cos θ\n")},
    {"W0416", model("V = -m g l cos θ\nlet v = l θ'\n"), model("V = -m g l cos θ\n")},
};

std::ptrdiff_t count_of(Document& document, const std::string& code) {
  const auto items = document.diagnostics().items();
  return std::count_if(items.begin(), items.end(), [&](const Diagnostic& d) { return d.code == code; });
}

const Diagnostic* find(Document& document, const std::string& code) {
  for (const Diagnostic& d : document.diagnostics().items())
    if (d.code == code) return &d;
  return nullptr;
}

}  // namespace

TEST_CASE("the fix of each mistake is the text that its author meant") {
  std::set<std::string> codes;
  for (const Case& c : cases) {
    CAPTURE(c.code);
    CAPTURE(c.wrong);
    Document asked = document(c.wrong);
    const Diagnostic* d = find(asked, c.code);
    REQUIRE(d != nullptr);
    const std::vector<Fix> found = fixes_of(asked, *d);
    std::vector<std::string> texts;
    for (const Fix& fix : found) texts.push_back(edited(c.wrong, fix.edits));
    CAPTURE(texts.size());
    CHECK(std::find(texts.begin(), texts.end(), c.right) != texts.end());
    codes.insert(c.code);
  }
  CHECK(codes.size() >= 18);
}

TEST_CASE("what a fix leaves is looked at: in all refused models it takes its mistake away and brings none") {
  std::set<std::string> codes;
  for (const auto& path : models_in("tests/golden/reject")) {
    const std::string text = read_file(path);
    Document asked = document(text);
    const auto errors = [](Document& d) {
      const auto items = d.diagnostics().items();
      return std::count_if(items.begin(), items.end(),
                           [](const Diagnostic& x) { return x.severity == Severity::Error; });
    };
    const auto before = errors(asked);
    for (const Diagnostic& d : asked.diagnostics().items())
      for (const Fix& fix : fixes_of(asked, d)) {
        CAPTURE(path.filename().string());
        CAPTURE(fix.title);
        Document mended = document(edited(text, fix.edits));
        CHECK(errors(mended) <= before);
        CHECK(count_of(mended, fix.code) < count_of(asked, fix.code));
        codes.insert(fix.code);
      }
  }
  CHECK(codes.size() >= 38);
}

TEST_CASE("a fix takes away one thing of a statement that says several") {
  const std::string text =
      read_file(std::filesystem::path(PROJECT_DIR) / "tests/golden/reject/field_boundary_twice.lag");
  Document asked = document(text);
  std::size_t count = 0;
  for (const Diagnostic& d : asked.diagnostics().items())
    for (const Fix& fix : fixes_of(asked, d)) {
      CHECK_MESSAGE(edited(text, fix.edits).find("boundary left : u = 0") != std::string::npos, fix.title);
      ++count;
    }
  CHECK(count == 1);
}

TEST_CASE("words of a help are no text of a model") {
  const std::string text = "param m = 1 kg; l = 1 m; g = 9.81 m/s^2\ncoord θ : angle\nT = 1/2 m l^2 θ'^2\n";
  Document asked = document(text);
  for (const Diagnostic& d : asked.diagnostics().items())
    for (const Fix& fix : fixes_of(asked, d))
      CHECK_MESSAGE(edited(text, fix.edits).find("one statement") == std::string::npos, fix.title);
}

TEST_CASE("a fix is offered where the next mistake stands behind it") {
  // The velocity with its right name shows that the mass has no unit.
  const std::string text = "param m = 1, l = 1 m\ncoord θ : angle\nT = 1/2 m l^2 θdot^2\n";
  Document asked = document(text);
  REQUIRE(asked.diagnostics().items().size() == 1);
  const auto fixes = fixes_of(asked, asked.diagnostics().items()[0]);
  REQUIRE(fixes.size() == 1);
  Document mended = document(edited(text, fixes[0].edits));
  REQUIRE(mended.diagnostics().items().size() == 1);
  CHECK(mended.diagnostics().items()[0].code == "E0304");
}

TEST_CASE("a proposal that does not mend is not offered") {
  // A comma is missing: with a zero more and a minus before the bracket gravity would point upwards.
  Document upwards = document(head + "point P mass m at l (sin θ, -cos θ)\ngravity (0 -g)\n");
  CHECK(upwards.diagnostics().has_errors());
  for (const Diagnostic& d : upwards.diagnostics().items()) CHECK(fixes_of(upwards, d).empty());
  // "Write s" for the hour that is no unit of length: the dimension stays wrong, whatever is written.
  Document asked = document("system a\nparam m = 1 kg\ncoord x : length\nT = 1/2 m x'\n");
  for (const Diagnostic& d : asked.diagnostics().items()) CHECK(fixes_of(asked, d).empty());
  CHECK(asked.diagnostics().has_errors());
}

TEST_CASE("what is offered is a text of the model, with nothing of the help's own in it") {
  const auto offered = [](const std::string& text) {
    Document asked = document(text);
    std::vector<std::string> out;
    for (const Fix& fix : fixes(asked, asked.source().whole())) {
      CHECK(fix.title.find('`') == std::string::npos);
      out.push_back(edited(text, fix.edits));
    }
    return out;
  };
  const auto none_has = [&](const std::string& text, const std::string& part) {
    CAPTURE(text);
    CAPTURE(part);
    for (const std::string& mended : offered(text)) CHECK(mended.find(part) == std::string::npos);
  };
  none_has("param m = 1 kg\ncoord x\nT = 1/2 m x'^2\n", "[unit]");
  const std::string no_mass = "param l = 1 m, g = 9.81 m/s^2\ncoord θ : angle\nT = 1/2 m l^2 θ'^2\nV = -m g l cos θ\n";
  const std::string no_s = "param m = 1 kg, k = 1 N/m\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2 cos s\n";
  for (const std::string part : {"[m]", "declare", "3 "}) none_has(no_mass, part);
  for (const std::string part : {"[s]", "declare", "3 "}) none_has(no_s, part);
  none_has("param r = 7000 km\nparam ω = 7.67 km/s / r\ncoord φ : angle\nT = 1/2 (1 [kg m^2]) φ'^2\n", "sr");
  const std::string orbit =
      "param m = 1 kg, R = 6371 km, G = 6.674e-11 N m^2/kg^2, M = 5.972e24 kg\ncoord r : length, φ : angle\n"
      "T = m/2 (dr/dt^2 + r^2 dφ/dt^2)\nV = -G M m / r\nstart r = R + 400 km, φ' = 7.67 km/s / r\nrun 90 min\n";
  for (const std::string part : {"km/m", "3 [", "[s]", "declare", "m km"}) none_has(orbit, part);
  const std::string no_statements =
      "mass m = 1 kg\nlength l = 1 m\ncoordinate θ\nT = 1/2 m l^2 θ'^2\nV = -m g l cos θ\ninitial θ = 0.1\n";
  for (const std::string part : {"3 [", "[m]", "declare"}) none_has(no_statements, part);
  none_has("param m = 1 kg\ncoord r : length\nT = 1/2 m dr/dt^2\n", "r'");
  none_has(head + "point P mass m at (l sin θ; -l cos θ)\n", "\n-l");
  const auto vector = offered(head + "point P mass m at (l sin θ; -l cos θ)\n");
  CHECK(vector == std::vector<std::string>{head + "point P mass m at (l sin θ, -l cos θ)\n"});
  const std::string end = "coord x : length\nT = 1/2 m (l/l) x'^2\n";
  CHECK(offered("param m = 1 kg; l = 1 m\n" + end) == std::vector<std::string>{"param m = 1 kg, l = 1 m\n" + end});
  CHECK(offered("param m = 1 kg; param l = 1 m\n" + end) ==
        std::vector<std::string>{"param m = 1 kg\nparam l = 1 m\n" + end});
}

TEST_CASE("fixes of a range are those of the mistakes in it") {
  const std::string text = "system a\nparam m = 1 kgg, n = 2 mm\ncoord x : lenght\nT = 1/2 m x'^2\n";
  Document asked = document(text);
  const auto place = static_cast<std::uint32_t>(text.find("kgg"));
  const auto found = fixes(asked, {place, place, 0});
  for (const Fix& fix : found) CHECK(slice(text, fix.span) == "kgg");
}
