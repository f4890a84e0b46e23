#pragma once
#include "../model_text.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/hamiltonian.hpp>
#include <maupertuis/print.hpp>

#include <string>

/// A model in phase space, for tests.
struct PhaseSpaceOf : ModelText {
  maupertuis::Hamiltonian h;

  explicit PhaseSpaceOf(const std::string& text) : ModelText(text), h(maupertuis::hamiltonian(equations)) {}

  maupertuis::Expr mom(std::size_t i) const { return h.momenta[i]; }
  std::string plain() const { return maupertuis::to_plain(h.legendre.readable, h.order); }
  std::string plain(const maupertuis::Expr& e) const { return maupertuis::to_plain(e, h.order); }
  maupertuis::Expr t() const { return system->context->time(); }
  maupertuis::Expr number(int n) const { return system->context->number(n); }

  bool equal(maupertuis::Expr a, maupertuis::Expr b) const {
    const maupertuis::Expr both[] = {a, b};
    const auto values = maupertuis::with_definitions(*system, both);
    return maupertuis::zero_test(values[0] - values[1]).verdict == maupertuis::Verdict::Zero;
  }
  bool certified() const {
    const maupertuis::Certificate certificate = maupertuis::certify(h, equations);
    for (const auto& check : certificate.checks)
      if (check.verdict != maupertuis::Verdict::Zero) MESSAGE(check.name << ": " << check.reason);
    return !certificate.checks.empty() && certificate.passed();
  }
};
