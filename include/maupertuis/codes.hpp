#pragma once
#include <maupertuis/diagnostic.hpp>

#include <span>

/// The catalogue behind `maup explain`: each stage owns the entries of the codes that it gives.
///   01xx text and grammar · 02xx names and statements · 03xx units · 04xx kinematics and physics lint
///   05xx not supported yet · 06xx equations · 07xx runs · 08xx files and command line · 09xx expectations · 10xx
///   invariants 11xx phase space 12xx action 13xx equilibria, linearization, modes 14xx orbits
namespace maupertuis {

std::span<const CodeEntry> syntax_codes();
std::span<const CodeEntry> system_codes();
std::span<const CodeEntry> equations_codes();
std::span<const CodeEntry> simulation_codes();
std::span<const CodeEntry> verification_codes();
std::span<const CodeEntry> comparison_codes();
std::span<const CodeEntry> invariants_codes();
std::span<const CodeEntry> hamiltonian_codes();
std::span<const CodeEntry> action_codes();
std::span<const CodeEntry> linearization_codes();
std::span<const CodeEntry> orbits_codes();
std::span<const CodeEntry> study_codes();
std::span<const CodeEntry> fields_codes();

}  // namespace maupertuis
