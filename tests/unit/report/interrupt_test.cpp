// What is computed from expressions ends when it is asked to, and nothing of it stays behind.
#include "../model_text.hpp"

#include <maupertuis/certificate.hpp>
#include <maupertuis/hamiltonian.hpp>
#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/invariants.hpp>
#include <maupertuis/modes.hpp>
#include <maupertuis/report.hpp>
#include <maupertuis/transform.hpp>
#include <maupertuis/verification.hpp>

#include <functional>

using namespace maupertuis;

namespace {

const char* const text =
    "param m1 = 1 kg, m2 = 2 kg, l1 = 1 m, l2 = 2 m, g = 9.81 m/s^2\ncoord a, b : angle\npoint A mass m1 at l1 (sin a, "
    "-cos a)\n"
    "point B mass m2 at A + l2 (sin b, -cos b)\ngravity (0, -g)\nstart a = 0.1 rad\nrun 1 s\n";

struct Work {
  const char* name;
  std::function<void(const ModelText&)> carry_out;
};

void find_modes(const ModelText& m) {
  Diagnostics unheard;
  const PointEquations at_points(m.equations);
  modal_study(at_points, {0, {0.1, 0}, {0, 0}}, unheard);
}

void search_invariants(const ModelText& m) {
  Diagnostics unheard;
  find_invariants(m.model, m.equations, {}, unheard);
}

const Work all[] = {
    {"equations",
     [](const ModelText& m) {
       Diagnostics unheard;
       euler_lagrange(m.system, unheard);
     }},
    {"derivation", [](const ModelText& m) { readable_derivation(m.equations, true); }},
    {"certificate", [](const ModelText& m) { certify(m.equations, nullptr, {}); }},
    {"hamiltonian", [](const ModelText& m) { hamiltonian(m.equations); }},
    {"invariants", search_invariants},
    {"modes", find_modes},
};

}  // namespace

TEST_CASE("a flag that is set ends each of them; afterwards they go through") {
  const std::atomic<bool> set = true;
  for (const Work& work : all) {
    CAPTURE(work.name);
    const ModelText m(text);
    {
      const InterruptScope scope(*m.system->context, &set);
      CHECK_THROWS_AS(work.carry_out(m), Interrupted);
    }
    CHECK_FALSE(interrupt_of(*m.system->context).asked());
    CHECK_NOTHROW(work.carry_out(m));
  }
}

TEST_CASE("a flag that is not set does not disturb; scopes end where they began") {
  const ModelText m(text);
  std::atomic<bool> flag = false;
  const InterruptScope outer(*m.system->context, &flag);
  {
    const std::atomic<bool> set = true;
    const InterruptScope inner(*m.system->context, &set);
    CHECK(interrupt_of(*m.system->context).asked());
  }
  CHECK_FALSE(interrupt_of(*m.system->context).asked());
  CHECK_NOTHROW(readable_derivation(m.equations, true));
}

TEST_CASE("the steps of a derivation are laid out until a flag is set") {
  const ModelText m(text);
  const Derivation derivation = readable_derivation(m.equations, true);
  const Certificate certificate = certify(m.equations, &derivation, {});
  bool ended = false;
  compose_report(m.model, m.source, m.equations, derivation, certificate, {},
                 [&](std::string_view name, const std::function<void()>& work) {
                   if (name != "derivation") return false;
                   const std::atomic<bool> set = true;
                   const InterruptScope scope(*m.system->context, &set);
                   CHECK_THROWS_AS(work(), Interrupted);
                   ended = true;
                   return false;
                 });
  CHECK(ended);
}

TEST_CASE("a section of a page that is given up leaves nothing behind, the others stay") {
  const ModelText m(text);
  const Derivation derivation = readable_derivation(m.equations, true);
  const Certificate certificate = certify(m.equations, &derivation, {});
  const auto without = [&](std::string_view left_out) {
    return compose_report(m.model, m.source, m.equations, derivation, certificate, {},
                          [&](std::string_view name, const std::function<void()>& work) {
                            work();
                            return name != left_out;
                          });
  };
  const ReportContent whole = without("none");
  CHECK(whole.equations.size() == 2);
  CHECK(whole.derivation.size() > 0);
  CHECK(without("derivation").derivation.empty());
  CHECK(without("derivation").equations.size() == 2);
  CHECK(without("phase-space").phase_space.empty());
  CHECK(without("conserved").conserved.empty());
  CHECK(without("equations").equations.empty());
  CHECK(without("equations").energies.empty());
}
