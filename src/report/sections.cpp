#include "report/sections.hpp"

#include "report/markup.hpp"

#include <maupertuis/escape_xml.hpp>

#include <fmt/format.h>

#include <cmath>

namespace maupertuis {
namespace {

std::string section(std::string_view id, std::string_view title, const std::string& body) {
  if (body.empty()) return {};
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, title, body);
}

std::string facts_list(const std::vector<std::pair<std::string, std::string>>& facts) {
  if (facts.empty()) return {};
  std::string html = "<dl class=\"facts-list\">\n";
  for (const auto& [name, value] : facts)
    html += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape_xml(name), number_html(value));
  return html + "</dl>\n";
}

std::string table(std::string_view head, const std::string& rows, std::string_view more = {}) {
  if (rows.empty()) return {};
  return fmt::format("<div class=\"scroll\"><table{}>\n<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
                     more, head, rows);
}

std::string formula_block(const ReportContent::Formula& formula) {
  std::string html;
  if (!formula.right.empty() || !formula.left.empty()) html += display_math(formula.left, formula.right);
  if (!formula.sentence.empty()) html += fmt::format("<p class=\"sentence\">{}</p>", sentence_html(formula.sentence));
  return html;
}

// 10^-18 rather than 8.67e-19: a bound is an order of magnitude.
std::string bound_html(double bound) {
  if (bound >= 1) return "—";
  if (bound <= 0) return "0";
  return fmt::format("10<sup>−{}</sup>", static_cast<int>(std::floor(-std::log10(bound))));
}

std::string verdict_html(bool applies, bool passed, const std::string& verdict) {
  if (!applies) return "<span class=\"muted mark\">does not apply</span>";
  return passed ? "<span class=\"good mark\">✓ " + escape_xml(verdict) + "</span>"
                : "<span class=\"bad mark\">✗ " + escape_xml(verdict) + "</span>";
}

std::string_view message_class(Severity severity) {
  return severity == Severity::Error ? "error" : severity == Severity::Warning ? "warning" : "note";
}

}  // namespace

std::string notes_html(const std::vector<std::string>& notes) {
  std::string html;
  for (const std::string& note : notes) html += fmt::format("<p class=\"note\">{}</p>\n", sentence_html(note));
  return html;
}

std::string messages_section(const ReportContent& content) {
  std::string html;
  for (const auto& message : content.messages) {
    html += fmt::format("<div class=\"message {0}\"><p><b>{1}</b> <span class=\"code\">{2}{3}</span></p>",
                        message_class(message.severity), sentence_html(message.message), escape_xml(message.code),
                        message.line > 0 ? fmt::format(", line {}", message.line) : "");
    if (!message.text.empty()) html += fmt::format("<pre>{}</pre>", escape_xml(message.text));
    for (const auto* sentence : {&message.reason, &message.help})
      if (!sentence->empty()) html += fmt::format("<p>{}</p>", sentence_html(*sentence));
    html += "</div>\n";
  }
  return html.empty() ? html : "<section id=\"messages\" aria-label=\"Messages\">\n" + html + "</section>\n";
}

std::string drawing_section(const ReportContent& content) {
  if (!content.drawing || content.drawing->empty()) return {};
  const bool spatial = content.drawing->dimension == 3;
  return fmt::format(R"(<figure id="animation" data-drawing="drawing-data" tabindex="0" aria-label="Animation of {}">
<canvas role="img" aria-label="Drawing of {}"></canvas>
<div class="controls">
<button data-control="play" type="button" aria-label="Play"><svg viewBox="0 0 16 16" aria-hidden="true">
<path class="icon-play" d="M3 1.5v13l11-6.5z"/>
<path class="icon-pause" d="M3 2h4v12H3zM9 2h4v12H9z"/></svg></button>
<input data-control="scrub" type="range" min="0" max="1" step="any" value="0" aria-label="Time">
<output data-control="time"></output>
<label>speed <select data-control="speed" aria-label="Speed"></select></label>
<label>trail <select data-control="trail" aria-label="Trail">
<option value="some">fading</option><option value="all">whole</option>
<option value="none">none</option></select></label>
</div>
<figcaption class="hint"><kbd>space</kbd> plays and pauses, <kbd>←</kbd> <kbd>→</kbd> step through the
motion{}.</figcaption>
</figure>
<script type="application/json" id="drawing-data">{}</script>
)",
                     escape_xml(content.title), escape_xml(content.title),
                     spatial ? ", dragging turns the view, a double click turns it back" : "",
                     drawing_json(*content.drawing));
}

std::string equations_section(const ReportContent& content) {
  std::string html;
  std::size_t number = 0;
  for (const auto& equation : content.equations) {
    ++number;
    const std::string label = equation.sentence.empty() ? std::to_string(number) : escape_xml(equation.sentence);
    html += fmt::format("<div class=\"equation\">{}<div class=\"number\">({})</div></div>\n",
                        display_math(equation.left, equation.right), label);
  }
  if (!content.intermediates.empty()) html += "<p>with</p>\n";
  for (const auto& intermediate : content.intermediates)
    html += fmt::format("<div class=\"where\">{}</div>\n", formula_block(intermediate));
  if (!content.energies.empty()) html += fmt::format("<h3>{}</h3>\n", escape_xml(content.energies_title));
  for (const auto& energy : content.energies)
    html += fmt::format("<div class=\"where\">{}</div>\n", formula_block(energy));
  return section("equations", "Equations of motion", html);
}

namespace {

std::string coordinates_table(const ReportContent& content) {
  bool started = false;
  for (const auto& c : content.coordinates) started = started || !c.start.empty();
  std::string rows;
  for (const auto& c : content.coordinates) {
    const std::string name = c.name.empty() ? "" : fmt::format(" <code>{}</code>", escape_xml(c.name));
    rows += fmt::format("<tr><td>{}{}</td><td>{}</td>", inline_math(c.symbol), name, unit_html(c.kind));
    if (started)
      rows += fmt::format("<td class=\"number\">{}</td><td class=\"number\">{}</td>", number_html(c.start),
                          number_html(c.start_velocity));
    rows += "</tr>\n";
  }
  return table(
      started ? "<th>coordinate</th><th>kind</th><th>start</th><th>velocity</th>" : "<th>coordinate</th><th>kind</th>",
      rows);
}

std::string parameters_table(const ReportContent& content) {
  bool converted = false;
  for (const auto& p : content.parameters) converted = converted || !p.si.empty();
  std::string rows;
  for (const auto& p : content.parameters)
    rows += fmt::format("<tr><td>{}</td><td class=\"number\">{}</td><td class=\"unit\">{}</td>{}</tr>\n",
                        inline_math(p.symbol), number_html(p.value), unit_html(p.unit),
                        converted ? fmt::format("<td class=\"muted\">{}</td>", number_html(p.si)) : "");
  return table(fmt::format("<th>parameter</th><th>value</th><th>unit</th>{}", converted ? "<th>in SI</th>" : ""), rows);
}

}  // namespace

std::string model_section(const ReportContent& content) {
  std::string tables;
  for (const auto& part : {coordinates_table(content), parameters_table(content)})
    if (!part.empty()) tables += "<div>" + part + "</div>\n";
  std::string html = facts_list(content.summary);
  if (!tables.empty()) html += "<div class=\"two\">\n" + tables + "</div>\n";
  for (const auto& definition : content.definitions)
    html += fmt::format("<div class=\"where\">{}</div>\n", formula_block(definition));
  if (!content.model_text.empty()) {
    html += fmt::format("<h3>Model text{}</h3>\n", content.file.empty() ? "" : ", " + escape_xml(content.file));
    html += fmt::format("<pre class=\"model\"><code>{}</code></pre>\n", model_html(content.model_text));
  }
  return section("model", "Model", html);
}

std::string derivation_section(const ReportContent& content) {
  std::size_t lines = 0;
  for (const auto& part : content.derivation) lines += part.lines.size();
  std::string html;
  for (const auto& part : content.derivation) {
    html += fmt::format("<details{}><summary>{}<span class=\"muted\">{}</span></summary>\n", lines <= 24 ? " open" : "",
                        sentence_html(part.title),
                        part.lines.size() == 1 ? "1 line" : fmt::format("{} lines", part.lines.size()));
    html += notes_html(part.notes);
    for (const auto& line : part.lines)
      html += fmt::format("<div class=\"step\">{}<div class=\"rule\">{}</div></div>\n", formula_block(line),
                          sentence_html(line.rule));
    html += "</details>\n";
  }
  if (html.empty()) return {};
  return section(
      "derivation", "Derivation",
      fmt::format("<p class=\"hint\"><button id=\"all-steps\" class=\"link\" type=\"button\">{}</button></p>\n",
                  lines <= 24 ? "close all" : "open all") +
          html);
}

std::string phase_space_section(const ReportContent& content) {
  std::string html;
  for (const auto& part : content.phase_space) {
    html += fmt::format("<h3>{}</h3>\n", sentence_html(part.title));
    for (const auto& line : part.lines) {
      if (line.right.empty())
        html += fmt::format("<p>{}</p>\n", sentence_html(line.sentence));
      else
        html += fmt::format("<div class=\"where\">{}</div>\n", formula_block(line));
    }
  }
  if (html.empty()) return {};
  if (content.phase_space_certified)
    html += "<p class=\"hint\">Each of these was proved against Lagrange's equations.</p>\n";
  return section("phase-space", "Phase space", html);
}

std::string certificate_section(const ReportContent& content) {
  std::string rows;
  for (const auto& check : content.certificate)
    rows += fmt::format("<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td>{}</td></tr>\n",
                        sentence_html(check.statement), check.applies ? fmt::format("{}", check.points) : "—",
                        check.applies ? bound_html(check.error_bound) : "—",
                        verdict_html(check.applies, check.passed, check.verdict));
  if (rows.empty()) return {};
  const std::string sentence =
      content.certified ? "<p>Every line above was checked by routes that share nothing with the derivation.</p>\n"
                        : "<p class=\"bad\">This derivation did not pass all checks: do not rely on it.</p>\n";
  return section("certificate", "Certificate",
                 sentence + table("<th>what agrees</th><th>points</th><th>error bound</th><th>verdict</th>", rows,
                                  " class=\"wide\""));
}

std::string conserved_section(const ReportContent& content) {
  std::string html;
  for (const auto& quantity : content.conserved) {
    html += "<div>" + (quantity.sentence.empty() ? "" : fmt::format("<p>{}</p>", sentence_html(quantity.sentence)));
    if (!quantity.formula.right.empty())
      html += fmt::format("<div class=\"where\">{}</div>", formula_block(quantity.formula));
    if (!quantity.value.empty())
      html +=
          fmt::format("<p class=\"muted where\">{} at the start{}</p>", number_html(quantity.value),
                      quantity.drift.empty() ? "" : ", relative drift along the run " + number_html(quantity.drift));
    html += "</div>\n";
  }
  return section("conserved", "Conserved quantities", html);
}

std::string motion_section(const ReportContent& content) {
  std::string html = notes_html(content.last_notes);
  if (!content.ending.empty())
    html += fmt::format("<div class=\"message\"><p>{}</p></div>\n", sentence_html(content.ending));
  html += facts_list(content.statistics);
  std::string plots;
  for (const auto& picture : content.pictures) {
    PlotOptions options = picture.options;
    options.theme = PlotTheme::Page;
    plots += fmt::format("<figure>\n{}<figcaption>{}</figcaption></figure>\n", plot_svg(content.trajectory, options),
                         sentence_html(picture.caption));
  }
  for (const auto& [caption, svg] : content.figures)
    html += fmt::format("<figure>\n{}<figcaption>{}</figcaption></figure>\n", svg, sentence_html(caption));
  if (!plots.empty()) html += "<div class=\"plots\">\n" + plots + "</div>\n";
  return section("motion", "Motion", html);
}

std::string orbits_section(const ReportContent& content) {
  std::string html;
  for (const ReportContent::Finding& finding : content.orbits) {
    html += fmt::format("<h3>{}</h3>\n{}", escape_xml(finding.title), facts_list(finding.facts));
    if (finding.caption.empty()) continue;
    PlotOptions options = finding.picture;
    options.theme = PlotTheme::Page;
    html += fmt::format("<figure>\n{}<figcaption>{}</figcaption></figure>\n", plot_svg(finding.rows, options),
                        sentence_html(finding.caption));
  }
  return section("orbits", "Long run", html);
}

std::string diagrams_html(const std::vector<ReportContent::Locus>& diagrams) {
  std::string figures;
  for (const auto& [caption, diagram] : diagrams) {
    Diagram d = diagram;
    d.theme = PlotTheme::Page;
    figures +=
        fmt::format("<figure>\n{}<figcaption>{}</figcaption></figure>\n", diagram_svg(d), sentence_html(caption));
  }
  return figures.empty() ? figures : "<div class=\"plots\">\n" + figures + "</div>\n";
}

std::string paths_section(const ReportContent& content) {
  std::string html;
  for (const ReportContent::Finding& path : content.paths)
    html += fmt::format("<h3>{}</h3>\n{}", escape_xml(path.title), facts_list(path.facts));
  html += diagrams_html(content.path_pictures);
  if (!html.empty()) html = fmt::format("<p class=\"muted\">{}</p>\n", sentence_html(content.path_search)) + html;
  return section("paths", "Stationary paths of the action", html);
}

std::string expectations_section(const ReportContent& content) {
  std::string rows;
  for (const auto& result : content.expectations)
    rows +=
        fmt::format("<tr><td><code>{}</code>{}</td><td>{}</td><td>{}</td></tr>\n", escape_xml(result.text),
                    result.passed || result.message.empty() ? "" : "<br>" + sentence_html(result.message),
                    number_html(result.actual), verdict_html(true, result.passed, result.passed ? "passed" : "failed"));
  return section("expectations", "Expectations",
                 table("<th>line of the model</th><th>came out</th><th></th>", rows, " class=\"wide\""));
}

}  // namespace maupertuis
