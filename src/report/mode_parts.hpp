#pragma once
#include <maupertuis/report.hpp>

/// The part of a report on equilibria, steady motions and their modes.
namespace maupertuis {

void add_modes(ReportContent& content, const Model& model, const EquationsOfMotion& equations, const ModalStudy& study);
void add_loci(ReportContent& content, const MechanicalSystem& system, const Locus& locus);

}  // namespace maupertuis
