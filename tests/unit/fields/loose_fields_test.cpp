#include <maupertuis/study.hpp>

#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

/// u and x have values at places alone: statements about bodies and runs refuse them where they stand without one.
using namespace maupertuis;

namespace {

/// The statements beside a string on x = 0 .. 1.
std::string codes_beside_string(const std::string& statements) {
  Study study(SourceText("loose.lag",
                         "dimensionless\nfield u(x) : number on x = 0 .. 1\ndensity = 1/2 u_t^2 - 1/2 u_x^2\n"
                         "coord q : number\nT = 1/2 q'^2\n" +
                             statements + "\n"));
  study.model();
  std::string out;
  for (const Diagnostic& d : study.diagnostics().items()) out += d.code + " ";
  return out;
}

}  // namespace

TEST_CASE("fields without a place are refused in every statement about bodies") {
  const std::pair<const char*, const char*> refused[] = {
      {"constraint u = q", "E0299 "},
      {"constraint x = q", "E0299 "},
      {"constraint x = q\nconstraint u = q", "E0299 E0299 "},
      {"V = u q", "E0299 "},
      {"force q = u", "E0299 "},
      {"contact u >= 0", "E0299 "},
      {"friction q coefficient 0.1 normal u", "E0299 "},
      {"point P at (x, 0)", "E0299 "},
      {"point P mass 1 at (x, 0)", "E0299 "},
      {"body B mass 1 inertia 1 at (0, x)", "E0299 "},
      {"point P mass 1 at (0, q)\ngravity (0, x)", "E0289 "},
  };
  for (const auto& [statements, codes] : refused) {
    CAPTURE(statements);
    CHECK(codes_beside_string(statements) == codes);
  }
}

TEST_CASE("fields without a place are refused in every statement about a run") {
  const std::pair<const char*, const char*> refused[] = {
      {"event e when u = q : record\nrun 1", "E0289 "},
      {"event e when q = x : record\nrun 1", "E0289 "},
      {"event e when q = 1 : set q' = u\nrun 1", "E0289 "},
      {"event e when q = 1 : set q' = x\nrun 1", "E0289 "},
      {"run until q = x within 3", "E0289 "},
      {"run until u = q within 3", "E0289 "},
      {"run x", "E0289 "},
      {"run 1\noutput every x", "E0289 "},
      {"start q = x", "E0289 "},
      {"let k = 2 x\nstart q' = k", "E0289 "},
      {"run 1\nexpect q at x = 0 ± 1", "E0289 "},
      {"run 1\nexpect q at 1 = x ± 1", "E0289 "},
  };
  for (const auto& [statements, codes] : refused) {
    CAPTURE(statements);
    CHECK(codes_beside_string(statements) == codes);
  }
}

TEST_CASE("values at places stand in all of them") {
  for (const char* statements :
       {"constraint u(0) = q", "V = u(1) q", "force q = u(0.5)", "contact u(1) >= q",
        "friction q coefficient 0.1 normal u(0)", "friction q limit u(0)^2 static 2 u(1)^2",
        "event e when u(0) = q : set q' = u(1)\nrun 1", "run until u(0) = q within 3", "start u = x (1 - x)\nrun 1"}) {
    CAPTURE(statements);
    CHECK(codes_beside_string(statements).empty());
  }
}
