#include "report/markup.hpp"
#include "report/sections.hpp"

#include <maupertuis/escape_xml.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {
namespace {

std::string rows_table(const std::vector<ReportContent::ModeRow>& rows) {
  if (rows.empty()) return {};
  const bool damped = std::any_of(rows.begin(), rows.end(), [](const auto& r) { return !r.damping.empty(); });
  std::string body;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    body += fmt::format("<tr><td>{}</td><td>{}</td>", i + 1, sentence_html(rows[i].kind));
    for (const std::string* cell : {&rows[i].frequency, &rows[i].hertz, &rows[i].period})
      body += fmt::format("<td class=\"number\">{}</td>", number_html(*cell));
    if (damped) body += fmt::format("<td>{}</td>", number_html(rows[i].damping));
    body += "</tr>\n";
  }
  return fmt::format(
      "<div "
      "class=\"scroll\"><table>\n<thead><tr><th>mode</th><th></th><th>ω</th><th>frequency</th><th>period</th>{}</tr></"
      "thead>\n"
      "<tbody>\n{}</tbody></table></div>\n",
      damped ? "<th>damping</th>" : "", body);
}

std::string shape_figure(const ReportContent::ModeShape& shape, const std::string& id) {
  std::string inside, attributes;
  if (shape.drawing) {
    // Two seconds for a swing, whatever the frequency is.
    const double period = shape.drawing->times.back() - shape.drawing->times.front();
    attributes = fmt::format(" data-drawing=\"{}\" data-loop data-rate=\"{:.6g}\"", id, period / 2);
    inside = fmt::format(
        "<canvas role=\"img\" aria-label=\"{}\"></canvas>\n<script type=\"application/json\" id=\"{}\">{}</script>",
        escape_xml(shape.caption), id, drawing_json(*shape.drawing));
  } else if (shape.diagram) {
    Diagram d = *shape.diagram;
    d.theme = PlotTheme::Page;
    inside = diagram_svg(d);
  } else {
    inside = shape.svg;
  }
  return fmt::format("<figure class=\"mode\"{}>\n{}\n<figcaption>{}</figcaption></figure>\n", attributes, inside,
                     sentence_html(shape.caption));
}

std::string point_part(const ReportContent::ModePoint& point, std::size_t index) {
  std::string html = fmt::format("<h3>{}</h3>\n<p class=\"{}\">{}</p>\n", sentence_html(point.name),
                                 point.stable ? "good" : "muted", sentence_html(point.stability));
  for (const auto& formula : point.formulas)
    html += fmt::format("<div class=\"where\">{}</div>\n", display_math(formula.left, formula.right));
  html += rows_table(point.rows);
  std::string shapes;
  for (std::size_t k = 0; k < point.shapes.size(); ++k)
    shapes += shape_figure(point.shapes[k], fmt::format("mode-{}-{}", index + 1, k + 1));
  return shapes.empty() ? html : html + "<div class=\"mode-shapes\">\n" + shapes + "</div>\n";
}

}  // namespace

std::string modes_section(const ReportContent& content) {
  std::string html;
  for (std::size_t i = 0; i < content.mode_points.size(); ++i) html += point_part(content.mode_points[i], i);
  html += diagrams_html(content.loci);
  if (html.empty()) return {};
  const std::string search =
      content.mode_search.empty() ? "" : fmt::format("<p class=\"muted\">{}</p>\n", sentence_html(content.mode_search));
  return fmt::format("<section id=\"modes\">\n<h2>Equilibria and modes</h2>\n{}{}</section>\n", search, html);
}

}  // namespace maupertuis
