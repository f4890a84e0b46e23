#include "studio/requests.hpp"

#include <maupertuis/action.hpp>
#include <maupertuis/diagram.hpp>

namespace maupertuis::studio {

/// `paths`: the paths between the ends of the model on which the action is stationary, with their pictures.
Json paths(Desk& desk, const Work& work) {
  Study& study = desk.certified(work.request);
  if (study.has_fields() || !study.equations()) desk.refuse(study);
  const Model& model = *study.model();
  if (!model.experiment.path)
    throw Trouble{"refused", "The model has no ends between which a path runs.",
                  "",        "A line says them: `path from (0, 1) at 0 to (2, free) at 1`.",
                  "",        nullptr};
  const InterruptScope scope = study.interruptible();
  ActionOptions options;
  options.interrupt = work.interrupt;
  Diagnostics said;
  const auto found = stationary_paths(model, *study.equations(), ends_of(model), options, said);
  work.interrupt.throw_if_asked();
  if (!found) desk.refuse(study, said);
  ReportParts parts;
  parts.paths = &*found;
  const ReportContent content = compose_report(model, study.source(), *study.equations(), Derivation(), Certificate(),
                                               parts, [](std::string_view section, const std::function<void()>& part) {
                                                 if (section == "paths") part();
                                                 return section == "paths";
                                               });
  Json list = Json::array(), figures = Json::array();
  for (const auto& path : content.paths) list.push_back({{"title", path.title}, {"facts", pairs_json(path.facts)}});
  for (const auto& [caption, given] : content.path_pictures) {
    Diagram diagram = given;
    diagram.theme = PlotTheme::Page;
    figures.push_back({{"caption", caption}, {"svg", diagram_svg(diagram)}});
  }
  return {{"paths", std::move(list)},
          {"figures", std::move(figures)},
          {"search", content.path_search},
          {"diagnostics", desk.diagnostics(study, said)}};
}

}  // namespace maupertuis::studio
