#include "field_views.hpp"

#include "columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <functional>

namespace maupertuis::app {

bool declares_fields(const syntax::SyntaxTree* tree) {
  return tree && std::any_of(tree->statements.begin(), tree->statements.end(), [](const syntax::Statement& s) {
           const auto* of_field = std::get_if<syntax::FieldStatement>(&s.body);
           return of_field && of_field->what == "field";
         });
}

void refuse_options_of_motions(const RunOptions& run, const std::vector<std::pair<const char*, bool>>& more,
                               Diagnostics& diagnostics) {
  std::vector<std::pair<const char*, bool>> given{
      {"--until", !run.until.empty()},  {"--within", !run.within.empty()},  {"--method", run.method.has_value()},
      {"--step", run.step.has_value()}, {"--order", run.order.has_value()}, {"--tol", run.tolerance.has_value()}};
  given.insert(given.end(), more.begin(), more.end());
  for (const auto& [name, is_given] : given)
    if (is_given)
      diagnostics.error("E0809", {}, fmt::format("{} is about motions of coordinates, and the model has fields.", name),
                        "A field runs over its mesh for a time, by Taylor steps within the stability limit.",
                        "Leave it out; `expect u(3 m) at 2 s = …` asks for values.");
}

std::vector<FieldPictureOptions> field_pictures_of(Study& study, const FieldEquations& equations,
                                                   const std::vector<std::string>& names,
                                                   const FieldPictureOptions& like) {
  const MechanicalSystem& system = study.model()->system;
  std::vector<FieldPictureOptions> out;
  const auto add = [&](std::size_t a, int order) {
    out.push_back(like);
    out.back().field = a, out.back().order = order;
    out.back().dimensionless = system.dimensionless;
    if (out.back().title.empty()) out.back().title = system.title.empty() ? system.name : system.title;
  };
  std::vector<std::string> known;
  for (const std::size_t f : equations.varied)
    for (const char* prime : {"", "'"}) known.push_back(equations.system().fields[f].name + prime);
  for (std::size_t a = 0; names.empty() && a < equations.varied.size(); ++a) add(a, 0);
  for (const std::string& list : names)
    for (const Span& piece : pieces_of(list)) {
      const std::string name = list.substr(piece.begin, piece.end - piece.begin);
      const auto at = std::find(known.begin(), known.end(), name);
      if (at != known.end()) {
        add(static_cast<std::size_t>(at - known.begin()) / 2, static_cast<int>(at - known.begin()) % 2);
        continue;
      }
      const std::string near = did_you_mean(name, known);
      study.diagnostics().error("E0811", {}, fmt::format("`{}` is no field of this model", name),
                                "Pictures of fields show fields and their velocities over space and time.",
                                near.empty() ? "" : fmt::format("Did you mean `{}`?", near));
    }
  return out;
}

namespace {

/// Pictures below each other, with the title of the first for all.
std::string below_each_other(std::vector<FieldPictureOptions> pictures,
                             const std::function<std::string(const FieldPictureOptions&)>& draw) {
  double width = 0, height = 0;
  std::string inside;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    if (i > 0) pictures[i].title.clear();
    std::string one = draw(pictures[i]);
    if (pictures.size() == 1) return one;
    double across = 0, up = 0;  // it says its size itself
    if (const std::size_t at = one.find(" width=\""); at != std::string::npos)
      std::sscanf(one.c_str() + at, " width=\"%lf\" height=\"%lf\"", &across, &up);
    inside += fmt::format("<g transform=\"translate(0 {:.0f})\">\n{}</g>\n", height, one);
    width = std::max(width, across), height += up;
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n{2}</svg>\n",
      width, height, inside);
}

}  // namespace

bool has_pictures(const FieldRunResult& run, Diagnostics& diagnostics) {
  if (run.trajectory.rows() > 1 && !run.places.empty()) return true;
  diagnostics.error("E0843", {}, "The run ended at its start: there is nothing to draw.", run.trouble,
                    "`maup simulate` shows what is known of the start.");
  return false;
}

std::string pictures_of_fields(Study& study, const FieldEquations& equations, const FieldRunResult& run,
                               std::vector<FieldPictureOptions> pictures) {
  if (pictures.empty()) pictures = field_pictures_of(study, equations, {}, {});
  return below_each_other(std::move(pictures),
                          [&](const FieldPictureOptions& one) { return field_picture_svg(equations, run, one); });
}

std::string pictures_of_rest(const FieldEquations& equations, const FieldEquilibrium& rest,
                             std::vector<FieldPictureOptions> pictures) {
  return below_each_other(std::move(pictures),
                          [&](const FieldPictureOptions& one) { return field_equilibrium_svg(equations, rest, one); });
}

}  // namespace maupertuis::app
