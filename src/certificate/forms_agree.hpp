#pragma once
#include <maupertuis/certificate.hpp>

namespace maupertuis::certification {

/// (a) Each readable equation, its intermediates put in, against the residual.
CertificateCheck forms_agree(const EquationsOfMotion& equations, const Derivation& readable, std::uint64_t seed);

/// (e) A total time derivative dG(q, t)/dt added to L leaves the residual as it is.
CertificateCheck gauge_invariance(const EquationsOfMotion& equations, std::uint64_t seed);

}  // namespace maupertuis::certification
