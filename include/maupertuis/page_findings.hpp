#pragma once
#include <maupertuis/interrupt.hpp>
#include <maupertuis/invariants.hpp>
#include <maupertuis/locus.hpp>
#include <maupertuis/modes.hpp>

#include <optional>

/// What a page about a system looks for unasked. What it cannot say of a system is no mistake of the model: nothing
/// then, and no message.
namespace maupertuis {

/// Conserved quantities of a small basis: a page is not worth a long search.
std::optional<Invariants> page_invariants(const Model& model, const EquationsOfMotion& equations);

struct PageModes {
  std::optional<ModalStudy> modes;  // about the equilibria near the start
  std::optional<Locus> locus;       // over the model's `sweep`
};
PageModes page_modes(const Model& model, const EquationsOfMotion& equations, const Interrupt& interrupt);

}  // namespace maupertuis
