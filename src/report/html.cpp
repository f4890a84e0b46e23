#include "report/markup.hpp"
#include "report/page.hpp"
#include "report/sections.hpp"

#include <maupertuis/escape_xml.hpp>
#include <maupertuis/field_pictures.hpp>

#include <fmt/format.h>

namespace maupertuis {
namespace {

// The browser itself enforces that the page asks nobody for anything.
constexpr std::string_view policy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:; base-uri 'none'; "
    "form-action 'none'";

std::string colours(bool dark) {
  std::string css =
      dark ? "color-scheme:dark;--paper:#14161a;--figure:#1a1d22;--ink:#e8e5de;--muted:#a09c93;--grid:#2c3037;"
             "--rule:#353a42;--accent:#7cc0ee;--good:#6cc98a;--warn:#e0a040;--bad:#ff8a80;"
             "--turned:invert(0.9) hue-rotate(180deg);"
           : "color-scheme:light;--paper:#fffdf8;--figure:#ffffff;--ink:#1d1b18;--muted:#69635a;--grid:#e8e3d8;"
             "--rule:#dad4c6;--accent:#0b5a8a;--good:#23703a;--warn:#b06a00;--bad:#b3261e;--turned:none;";
  const auto& palette = plot_palette(dark);
  for (std::size_t i = 0; i < palette.size(); ++i) css += fmt::format("--series-{}:{};", i + 1, palette[i]);
  return css;
}

// The system's choice, unless the reader chose otherwise; paper is always light.
std::string theme_rules() {
  return fmt::format(
      ":root{{{0}}}\n@media screen and (prefers-color-scheme:dark){{:root:not([data-theme=light]){{{1}}}}}\n"
      "@media screen{{:root[data-theme=dark]{{{1}}}}}\n",
      colours(false), colours(true));
}

std::string facts_line(const ReportContent& content) {
  std::string line;
  const auto add = [&](const std::string& fact) { line += (line.empty() ? "" : " · ") + fact; };
  for (const auto& [name, value] : content.summary)
    if (name == "freedoms") add(fmt::format("{} {}", value, value == "1" ? "freedom" : "freedoms"));
  if (!content.certificate.empty())
    add(content.certified ? "<span class=\"good\">✓ certified equations</span>"
                          : "<span class=\"bad\">✗ not certified</span>");
  for (const auto& [name, value] : content.statistics)
    if (name == "energy drift") add("energy drift " + number_html(value));
  return line.empty() ? line : fmt::format("<p class=\"facts\">{}</p>\n", line);
}

std::string header(const ReportContent& content) {
  std::string html =
      fmt::format("<header>\n<h1>{}</h1>\n", escape_xml(content.title.empty() ? content.name : content.title));
  if (!content.source.empty()) html += fmt::format("<p class=\"citation\">{}</p>\n", escape_xml(content.source));
  return html + notes_html(content.notes) + facts_line(content);
}

/// Up to the body. `title` is escaped.
std::string head(const std::string& title) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n<title>{}</title>\n"
      "<link rel=\"icon\" href=\"data:,\">\n<style>\n{}{}{}\n</style>\n</head>\n<body>\n"
      "<button id=\"theme\" type=\"button\"><svg viewBox=\"0 0 24 24\" aria-hidden=\"true\">"
      "<path d=\"M12 3a9 9 0 1 0 0 18V3z\"/><circle cx=\"12\" cy=\"12\" r=\"9\" fill=\"none\" stroke=\"currentColor\" "
      "stroke-width=\"1.4\"/></svg></button>\n",
      policy, title, theme_rules(), page_style, plot_page_style());
}

struct Part {
  std::string_view id, title;
  std::string html;
};

}  // namespace

std::string report_html(const ReportContent& content) {
  const Part parts[] = {
      {"", "", messages_section(content)},
      {"animation", "Drawing", drawing_section(content)},
      {"equations", "Equations", equations_section(content)},
      {"model", "Model", model_section(content)},
      {"motion", "Motion", motion_section(content)},
      {"modes", "Modes", modes_section(content)},
      {"orbits", "Long run", orbits_section(content)},
      {"paths", "Action", paths_section(content)},
      {"conserved", "Conserved quantities", conserved_section(content)},
      {"phase-space", "Phase space", phase_space_section(content)},
      {"derivation", "Derivation", derivation_section(content)},
      {"certificate", "Certificate", certificate_section(content)},
      {"expectations", "Expectations", expectations_section(content)},
  };
  std::string navigation, body;
  for (const Part& part : parts) {
    if (!part.id.empty() && !part.html.empty())
      navigation += fmt::format("<a href=\"#{}\">{}</a>\n", part.id, part.title);
    body += part.html;
  }
  const std::string title = escape_xml(content.title.empty() ? content.name : content.title);
  std::string page = head(title);
  page += header(content);
  page += fmt::format("<nav aria-label=\"Contents\">\n{}</nav>\n</header>\n<main>\n{}</main>\n", navigation, body);
  page += "<footer>Made by Maupertuis. Equations in MathML; everything on this page is contained in it.</footer>\n";
  page += fmt::format("<script>\n{}</script>\n", page_script);
  const bool moves = body.find("<figure id=\"animation\"") != std::string::npos ||
                     body.find("<figure class=\"mode\"") != std::string::npos;
  if (moves) page += fmt::format("<script>\n{}</script>\n", animation_script);
  return page + "</body>\n</html>\n";
}

std::string turned_pictures_html(const std::vector<std::string>& frames, double seconds, const std::string& title) {
  ReportContent content;
  content.title = title;
  return head(escape_xml(title)) + header(content) + "</header>\n<main>\n<figure id=\"film\">\n" +
         turned_pictures_svg(frames, seconds, true) +
         fmt::format(R"(<div class="controls">
<button id="film-play" type="button">pause</button>
<input id="film-scrub" type="range" min="0" max="{:.6g}" step="any" value="0" aria-label="Time">
</div>
</figure>
</main>
<footer>Made by Maupertuis. Everything on this page is contained in it.</footer>
<script>
{}</script>
<script>
{{
  const film = document.querySelector("#film > svg"), play = document.getElementById("film-play"),
        scrub = document.getElementById("film-scrub"), length = {:.6g};
  film.removeAttribute("width"), film.removeAttribute("height"), film.style.maxWidth = "100%";
  const turn = () => {{
    film.animationsPaused() ? film.unpauseAnimations() : film.pauseAnimations();
    play.textContent = film.animationsPaused() ? "play" : "pause";
  }};
  play.onclick = turn;
  scrub.oninput = () => {{
    if (!film.animationsPaused()) turn();
    film.setCurrentTime(Math.min(+scrub.value, length * 0.9999));
  }};
  const follow = () => {{
    if (!film.animationsPaused()) scrub.value = film.getCurrentTime() % length;
    requestAnimationFrame(follow);
  }};
  follow();
}}
</script>
</body>
</html>
)",
                     seconds, page_script, seconds);
}

std::string animation_html(const Drawing& drawing, const std::string& title) {
  ReportContent content;
  content.title = title;
  content.drawing = drawing;
  return head(escape_xml(title)) + header(content) + "</header>\n<main>\n" + drawing_section(content) +
         "</main>\n<footer>Made by Maupertuis. Everything on this page is contained in it.</footer>\n" +
         fmt::format("<script>\n{}</script>\n<script>\n{}</script>\n</body>\n</html>\n", page_script, animation_script);
}

}  // namespace maupertuis
