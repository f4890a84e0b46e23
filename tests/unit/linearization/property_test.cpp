#include "support.hpp"

#include <rapidcheck.h>

using namespace maupertuis;

namespace {

/// Three coordinates, M = 1 + small couplings, K of any sign, damping, gyroscopic and follower forces: coefficients in
/// tenths.
std::string random_system() {
  const auto tenth = [](int low, int high) { return "(" + std::to_string(*rc::gen::inRange(low, high)) + "/10)"; };
  std::string text = "system random\ndimensionless\ncoord x, y, z : number\n";
  text += "T = 1/2 (x'^2 + 2 y'^2 + 3 z'^2) + " + tenth(-6, 7) + " x' y' + " + tenth(-6, 7) + " y' z'\n";
  text += "V = " + tenth(-20, 40) + " x^2 + " + tenth(-20, 40) + " y^2 + " + tenth(-20, 40) + " z^2 + " +
          tenth(-9, 10) + " x y + " + tenth(-9, 10) + " y z\n";
  text += "D = " + tenth(0, 9) + " x'^2 + " + tenth(0, 9) + " (y' - z')^2\n";
  text += "L = T - V + " + tenth(-9, 10) + " (x y' - y x') + " + tenth(-9, 10) + " (y z' - z y')\n";
  text += "force x = " + tenth(-9, 10) + " y\n";
  return text;
}

}  // namespace

TEST_CASE("Random linear systems: eigenvalues are roots of the characteristic polynomial, shapes solve the problem") {
  CHECK(rc::check([] {
    Linearized m(random_system());
    const ModalEntry e = m.here();
    RC_ASSERT(e.analysis.eigenvalues.size() == 6u);
    RC_ASSERT(largest_root_error(e.linearization.a, e.analysis.eigenvalues) < 1e-11);
    RC_ASSERT(e.analysis.residual < 1e-12);
    for (const Mode& mode : e.analysis.modes) {
      const auto& φ = mode.shape;
      const RealMatrix& mass = e.linearization.mass;
      std::complex<double> modal_mass = 0;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) modal_mass += std::conj(φ[i]) * mass.at(i, j) * φ[j];
      RC_ASSERT(std::abs(modal_mass - 1.0) < 1e-12);
    }
  }));
}

TEST_CASE("Random conservative systems: an energy minimum is never called unstable, a saddle never stable") {
  CHECK(rc::check([] {
    const auto tenth = [](int low, int high) { return "(" + std::to_string(*rc::gen::inRange(low, high)) + "/10)"; };
    Linearized m("system random\ndimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2) + 1/4 x' y'\nV = " +
                 tenth(-20, 40) + " x^2 + " + tenth(-20, 40) + " y^2 + " + tenth(-30, 31) + " x y\nL = T - V + " +
                 tenth(-9, 10) + " (x y' - y x')\n");
    const ModalEntry e = m.here();
    const RealMatrix& k = e.linearization.stiffness;
    const double determinant = k.at(0, 0) * k.at(1, 1) - k.at(0, 1) * k.at(1, 0);
    const Stability verdict = e.analysis.stability.verdict;
    if (k.at(0, 0) > 1e-9 && determinant > 1e-9) RC_ASSERT(verdict == Stability::Energetic);
    if (determinant < -1e-9)
      RC_ASSERT(verdict == Stability::Unstable);  // an odd number of negative directions (Kelvin and Chetaev)
    if (k.at(0, 0) < -1e-9 && determinant > 1e-9) RC_ASSERT(verdict != Stability::Energetic);
  }));
}
