// V holds a function that the passes do not know. Taken for a constant it would leave the free particle, m x'' = 0,
// certified.
#include "../forgotten_kind.hpp"
#include "../model_text.hpp"

#include <maupertuis/certificate.hpp>
#include <maupertuis/kernel.hpp>

#include <stdexcept>

using namespace maupertuis;

TEST_CASE("a force of a forgotten kind is neither derived, nor certified as none, nor run") {
  ModelText model("system free\nparam m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\n");
  CHECK(certify(model.equations, nullptr).passed());
  auto system = std::make_shared<MechanicalSystem>(*model.system);
  system->potential.push_back(system->kinetic.front());
  system->potential.back().value = node_of_forgotten_kind(model.q(0));
  Diagnostics diagnostics;
  CHECK_THROWS_AS(euler_lagrange(system, diagnostics), std::logic_error);
  EquationsOfMotion free_particle = model.equations;
  free_particle.system = system;
  CHECK_THROWS_AS(certify(free_particle, nullptr), std::logic_error);
  KernelSource source;
  source.coordinates = {model.q(0)};
  source.residual = {model.a(0) + node_of_forgotten_kind(model.q(0))};
  CHECK_THROWS_AS(build_kernel(source), std::logic_error);
}

TEST_CASE("potentials of erf and of Lambert's W are certified by every route") {
  for (const char* v : {"V = erf(sqrt(x^2 + y^2)) - y erf(x - 2 y)", "V = lambert_w(1 + x^2) + x lambert_w(y)",
                        "V = exp(-lambert_w(x^2 + 1)) erf(erf(x y))"}) {
    const ModelText model(
        std::string("system s\ndimensionless\nparam m = 1\ncoord x, y : number\npoint P mass m at (x, y)\n") + v +
        "\n");
    const Derivation readable = readable_derivation(model.equations, false);
    const Certificate certificate = certify(model.equations, &readable);
    CAPTURE(std::string(v));
    for (const CertificateCheck& check : certificate.checks) {
      CAPTURE(check.name);
      CAPTURE(check.reason);
      if (check.applies) CHECK(check.verdict == Verdict::Zero);
    }
    CHECK(certificate.passed());
    // A wrong sign of the new derivative is seen.
    EquationsOfMotion wrong = model.equations;
    wrong.residual[0] = wrong.residual[0] - Rational(2) * differentiate(model.system->potential_energy(), model.q(0));
    CHECK_FALSE(certify(wrong, nullptr).passed());
  }
}
