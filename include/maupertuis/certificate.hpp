#pragma once
#include <maupertuis/equations_of_motion.hpp>
#include <maupertuis/evaluate.hpp>

#include <string>
#include <vector>

namespace maupertuis {

struct CertificateCheck {
  std::string
      name;  // "forms_agree", "jet_residual", "dalembert", "power_balance", "constraint_rows", "gauge_invariance"
  std::string statement;  // one sentence: what agreed with what
  Verdict verdict = Verdict::Undecided;
  bool applies = true;  // (c) without points: false, and the statement says so
  int points = 0;
  double error_bound = 1;
  std::string reason;   // when not Zero
  std::size_t row = 0;  // the first equation that failed; n: the row of a constraint
};

/// What was checked of a derivation, by routes that share nothing with it. Passed: every check that applies is Zero.
struct Certificate {
  std::vector<CertificateCheck> checks;
  bool passed() const;
};

struct CertifyOptions {
  bool full = false;  // (e) as well
  std::uint64_t seed = 0x6d617570;
};

/// Checks (b) to (d) on the computational form, and (a) if a readable derivation is given (may be null).
Certificate certify(const EquationsOfMotion& equations, const Derivation* readable, const CertifyOptions& options = {});

}  // namespace maupertuis
