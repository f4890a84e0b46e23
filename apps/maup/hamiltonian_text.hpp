#pragma once
#include "json.hpp"
#include <maupertuis/formula_document.hpp>

#include <maupertuis/dirac.hpp>
#include <maupertuis/hamiltonian.hpp>

#include <string>
#include <vector>

namespace maupertuis::app {

/// {a, b} = value
struct Bracket {
  Expr a, b;
  ReadableForm value;
  bool dirac = false;
};

/// All that `maup hamiltonian` found, but the integration.
struct PhaseSpace {
  Hamiltonian hamiltonian;
  std::optional<Routhian> routhian;
  std::optional<DiracAnalysis> dirac;  // where the Legendre transform is singular
  std::vector<Bracket> brackets;
  std::vector<DerivationStep> lines;  // but the brackets
  Certificate certificate;            // of both
};

/// Sections with their formulas, for a reader.
std::string phase_space_text(const PhaseSpace& found);
/// The formulas alone in one notation, for another program.
std::string phase_space_text(const PhaseSpace& found, Notation notation);
/// {coordinates, momenta, hamiltonian, equations, routhian, certificate, …}
void add_to(Json& document, const PhaseSpace& found);

}  // namespace maupertuis::app
