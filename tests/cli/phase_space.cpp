// maup hamiltonian, from outside.
#include "json.hpp"

#include <doctest/doctest.h>

using namespace cli_test;

namespace {

const std::string kepler =
    "system kepler\n"
    "param m = 2 kg, k = 3 J m\n"
    "coord r : length, φ : angle\n"
    "T = 1/2 m (r'^2 + r^2 φ'^2)\n"
    "V = -k/r\n"
    "start r = 1 m, φ' = 1 rad/s\n"
    "run 5 s\n";

}  // namespace

TEST_CASE("hamiltonian: H, the canonical equations, the effective potential, the certificate") {
  const Folder folder;
  const Outcome told = maup({"hamiltonian", folder.write("kepler.lag", kepler)});
  CHECK_MESSAGE(told.code == 0, told.err);
  CHECK(told.err.empty());
  CHECK(contains(told.out, "H = p_r^2/(2 m) + p_φ^2/(2 m r^2) - k/r"));
  CHECK(contains(told.out, "p_r' = p_φ^2/(m r^3) - k/r^2"));
  CHECK(contains(told.out, "V_eff = p_φ^2/(2 m r^2) - k/r"));
  CHECK(contains(told.out, "Conserved: p_φ, H."));
  CHECK(contains(told.out, "Certificate: passed"));
}

TEST_CASE("hamiltonian --bracket reads the language of the model, and its mistakes are told as the model's") {
  const Folder folder;
  const std::string model = folder.write("kepler.lag", kepler);
  const Outcome told = maup({"hamiltonian", model, "--bracket", "r", "p_r", "--bracket", "φ", "r φ'", "--json"});
  REQUIRE_MESSAGE(told.code == 0, told.err);
  const Json document = json_of(told);
  REQUIRE(document["brackets"].size() == 2);
  CHECK(document["brackets"][0]["plain"] == "1");
  CHECK(document["brackets"][1]["plain"] == "1/(m r)");

  const Outcome unknown = maup({"hamiltonian", model, "--bracket", "r", "p_s"});
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "E0201"));
  const Outcome acceleration = maup({"hamiltonian", model, "--bracket", "r", "r''"});
  CHECK(acceleration.code == 2);
  CHECK(contains(acceleration.err, "E1104"));
}

TEST_CASE("hamiltonian --integrate gives the motion of simulate") {
  const Folder folder;
  const std::string model = folder.write("kepler.lag", kepler), rows = folder.path("phase.csv");
  const Outcome told = maup({"hamiltonian", model, "--integrate", "-o", rows, "--json"});
  REQUIRE_MESSAGE(told.code == 0, told.err);
  const Json canonical = json_of(told)["integration"];
  CHECK(canonical["difference"].get<double>() < 1e-13);
  const Json run = json_of(maup({"simulate", model, "--json"}))["final"];
  CHECK(canonical["final"]["state"]["r"].get<double>() ==
        doctest::Approx(run["state"]["r"].get<double>()).epsilon(1e-13));
  CHECK(canonical["final"]["state"]["p_φ"].get<double>() == doctest::Approx(2.0).epsilon(1e-14));
  CHECK(contains(read(rows), "t [s],r [m],φ [rad],p_r [kg m/s]"));
}

TEST_CASE("a singular Legendre transform is a warning with its constraints, and no canonical motion") {
  const Folder folder;
  const std::string model = folder.write("sat.lag",
                                         "param I1 = 1 kg m^2, I2 = 2 kg m^2, I3 = 3 kg m^2\n"
                                         "body sat inertia diag(I1, I2, I3) rotation quaternion\n"
                                         "start sat.ω = (0.1, 2, 0.1) rad/s\nrun 1 s\n");
  const Outcome told = maup({"hamiltonian", model});
  CHECK(told.code == 0);
  CHECK(contains(told.err, "W1101"));
  CHECK(contains(told.out, "sat.qw p_sat.qw + sat.qx p_sat.qx + sat.qy p_sat.qy + sat.qz p_sat.qz = 0"));
  CHECK(contains(told.out, "Certificate: passed"));
  const Outcome run = maup({"hamiltonian", model, "--integrate"});
  CHECK(run.code == 1);
  CHECK(contains(run.err, "E1102"));
}

TEST_CASE("--routhian names coordinates; a wrong name is told") {
  const Folder folder;
  const std::string model = folder.write("kepler.lag", kepler);
  const Outcome both = maup({"hamiltonian", model, "--routhian", "r,φ", "--plain"});
  CHECK_MESSAGE(both.code == 0, both.err);
  CHECK(contains(both.out, "R = "));
  const Outcome wrong = maup({"hamiltonian", model, "--routhian", "phi"});
  CHECK(wrong.code == 1);
  CHECK(contains(wrong.err, "E1105"));
}

TEST_CASE("LaTeX and MathML of phase space") {
  const Folder folder;
  const std::string model = folder.write("kepler.lag", kepler);
  CHECK(contains(maup({"hamiltonian", model, "--latex"}).out, "\\dot{p}_{r} &= "));
  CHECK(contains(maup({"hamiltonian", model, "--mathml"}).out, "<msub>"));
}

TEST_CASE("expectations about phase space: proved, refuted, and told what it is instead") {
  const Folder folder;
  const Outcome good =
      maup({"test", folder.write("good.lag", kepler + "expect hamiltonian = p_r^2/(2 m) + p_φ^2/(2 m r^2) - k/r\n"
                                                      "expect routhian of φ = 1/2 m r'^2 - p_φ^2/(2 m r^2) + k/r\n"
                                                      "expect bracket (r p_r, p_φ^2) = 0\n"
                                                      "expect p_φ at 3 s = 2 kg m^2/s rel 1e-13\n")});
  CHECK_MESSAGE(good.code == 0, good.out);
  const Outcome bad =
      maup({"test", folder.write("bad.lag", kepler + "expect hamiltonian = p_r^2/(2 m) + p_φ^2/(m r^2) - k/r\n")});
  CHECK(bad.code == 4);
  CHECK(contains(bad.out, "The hamiltonian is (p_r^2 + p_φ^2/r^2)/(2 m) - k/r"));
}

TEST_CASE("a momentum before a bracket is a factor") {
  const Folder folder;
  const Outcome told =
      maup({"hamiltonian", folder.write("kepler.lag", kepler), "--bracket", "r", "p_r (r + r)", "--json"});
  REQUIRE_MESSAGE(told.code == 0, told.err);
  CHECK(json_of(told)["brackets"][0]["plain"] == "2 r");
}

TEST_CASE("a Lagrangian whose mass matrix is singular has primary constraints, and no motion to integrate") {
  const std::string linear = "dimensionless\ncoord x, y : number\nL = x' y - 1/2 x^2 - 1/2 y^2\nstart x = 1\nrun 1\n";
  const Outcome both = maup({"hamiltonian", "-"}, linear);
  CHECK_MESSAGE(both.code == 0, both.err);
  CHECK(contains(both.err, "W1101"));
  CHECK(contains(both.out, "p_x - y = 0"));
  CHECK(contains(both.out, "p_y = 0"));
  CHECK(contains(both.out, "H = 1/2 x^2 + 1/2 y^2"));
  const std::string mixed =
      "dimensionless\nparam m = 1\ncoord x, y : number\nL = 1/2 m (x' - y)^2 - 1/2 x^2\nstart x = 1\nrun 1\n";
  const Outcome one = maup({"hamiltonian", "-"}, mixed);
  CHECK_MESSAGE(one.code == 0, one.err);
  CHECK(contains(one.out, "p_y = 0"));
  CHECK(contains(one.out, "p_x^2/(2 m)"));
  const Outcome run = maup({"hamiltonian", "-", "--integrate"}, linear);
  CHECK(run.code != 0);
  CHECK(contains(run.err, "E1102"));
}
