#pragma once
#include "open_study.hpp"
#include "run_options.hpp"

#include <maupertuis/field_pictures.hpp>

#include <string>
#include <utility>
#include <vector>

namespace maupertuis::app {

/// Whether a text declares fields: known before it is elaborated, as what options say beside it has to be.
bool declares_fields(const syntax::SyntaxTree* tree);

/// E0809 for options of motions of coordinates, which have no meaning for fields: those of a run, and `more` by their
/// names with whether they were given.
void refuse_options_of_motions(const RunOptions& run, const std::vector<std::pair<const char*, bool>>& more,
                               Diagnostics& diagnostics);

/// What is drawn, by names: "u", "u'", …; all fields where none is named. E0811 where one is no field.
std::vector<FieldPictureOptions> field_pictures_of(Study& study, const FieldEquations& equations,
                                                   const std::vector<std::string>& names,
                                                   const FieldPictureOptions& like);

/// E0843 where the run ended before there was anything to draw.
bool has_pictures(const FieldRunResult& run, Diagnostics& diagnostics);

/// The pictures of the fields of a run below each other. Precondition: has_pictures.
std::string pictures_of_fields(Study& study, const FieldEquations& equations, const FieldRunResult& run,
                               std::vector<FieldPictureOptions> pictures);

/// The same of fields at rest.
std::string pictures_of_rest(const FieldEquations& equations, const FieldEquilibrium& rest,
                             std::vector<FieldPictureOptions> pictures);

}  // namespace maupertuis::app
