#pragma once
#include <maupertuis/field_run.hpp>
#include <maupertuis/report.hpp>

#include <string>
#include <vector>

namespace maupertuis {

/// What a report of fields may show beside its equations and their certificate.
struct FieldReportParts {
  const FieldRunResult* run = nullptr;         // with rows
  const Verification* verification = nullptr;  // null: the `expect` lines were not carried out
  const FieldCurrents* currents = nullptr;     // null: conservation laws were not looked for
  const ComplexExpr* dispersion = nullptr;     // of waves on the field at rest
  const FieldModes* modes = nullptr;           // small motions about rest
  bool with_equations = true, with_derivation = true;
};

/// Fills a report from the artifacts of a study of fields.
ReportContent compose_field_report(const Model& model, const SourceText& source, const FieldEquations& equations,
                                   const Certificate& certificate, const FieldReportParts& parts = {});

}  // namespace maupertuis
