#include "studio/requests.hpp"
#include "studio/verified.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>

/// `claim`: an equation that a student wrote, judged as the last line of the text.
namespace maupertuis::studio {
namespace {

/// For exercises: whether it is right, and which known mistake it is, but not by what it differs.
Json without_answer(const ExpectationResult& r) {
  const std::string message =
      !r.where.empty()    ? "It follows from Lagrange's equations of this system where " + r.where + "."
      : r.passed          ? "It follows from Lagrange's equations of this system."
      : r.pitfall.empty() ? "It does not follow from Lagrange's equations of this system, and it is no known mistake."
                          : "It does not follow from Lagrange's equations of this system.";
  return {{"passed", r.passed}, {"message", message}, {"pitfall", r.pitfall}, {"where", r.where}, {"text", r.text}};
}

/// Whether both sides are the same formula.
bool says_nothing(const Study& study, std::uint32_t line) {
  const auto items = study.diagnostics().items();
  return std::any_of(items.begin(), items.end(), [&](const Diagnostic& d) {
    return d.code == "W0420" && d.span && study.source().locate(d.span->begin).line == line;
  });
}

/// Whether two rows are proportional: each minor a_i b_j − a_j b_i is 0.
bool are_proportional(const std::vector<Expr>& a, const std::vector<Expr>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = i + 1; j < a.size(); ++j)
      if (!vanishes_identically(a[i] * b[j] - a[j] * b[i])) return false;
  return true;
}

/// What an equation that holds is in the place of the equation of motion of one coordinate; empty where it is that.
/// Its accelerations stand in it as in a sum of Lagrange's equations, so that those of another coordinate alone show.
std::string another_equation(const EquationsOfMotion& equations, Expr difference, const std::string& asked) {
  const auto& coordinates = equations.system->coordinates;
  const auto wanted =
      std::find_if(coordinates.begin(), coordinates.end(), [&](const auto& c) { return c.name == asked; });
  if (wanted == coordinates.end() || coordinates.size() == 1 || equations.system->constrained()) return "";
  std::vector<Expr> accelerations;
  for (const Coordinate& c : coordinates) accelerations.push_back(c.acceleration);
  const std::vector<Expr> held = gradient(expand_time_derivatives(difference), accelerations);
  const auto at = static_cast<std::size_t>(wanted - coordinates.begin());
  if (vanishes_identically(held[at])) return fmt::format("It holds, but {}'' does not stand in it.", asked);
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (i == at) continue;
    const std::vector<Expr> row = gradient(expand_time_derivatives(equations.residual[i]), accelerations);
    if (are_proportional(held, row))
      return fmt::format("It holds, and is the equation of {}: that of {} is asked for.", coordinates[i].name, asked);
  }
  return "";
}

/// Why an equation that holds is not what is asked for; empty where it is.
std::string objection(Study& study, const ExpectationResult& result, const std::string& asked) {
  if (says_nothing(study, result.line))
    return "Its two sides are the same formula: it holds for every motion of every system.";
  if (asked.empty() || !study.equations()) return "";
  for (const Expectation& e : study.model()->experiment.expectations)
    if (study.source().locate(e.span.begin).line == result.line)
      if (const auto* equation = std::get_if<expectation::Equation>(&e.kind))
        return another_equation(*study.equations(), equation->left - equation->right, asked);
  return "";
}

}  // namespace

/// The claim becomes the last line of the text: its mistakes have places in it.
Json claim(Desk& desk, const Work& work) {
  const std::string typed = text_of(work.request, "text");
  if (typed.find_first_of("\r\n") != std::string::npos)
    throw Trouble{"refused", "A claim is one line.", "", "Write one equation, such as θ'' = -g/l sin θ.", "", nullptr};
  if (typed.find_first_not_of(" \t") == std::string::npos)
    throw Trouble{"refused", "Nothing is claimed yet.", "", "Write an equation, such as θ'' = -g/l sin θ.", "",
                  nullptr};
  std::string text(desk.source().text());
  const std::string_view before = "claim ";
  if (!text.empty() && text.back() != '\n') text += '\n';
  const auto begin = static_cast<std::uint32_t>(text.size() + before.size());
  text += before;
  text += typed + "\n";
  Study study(SourceText(desk.source().name(), text), work.interrupt);
  study.model();
  const auto collect = [&] {
    const Units units{std::string_view(typed)};
    Json list = Json::array();
    for (const Diagnostic& d : study.diagnostics().items()) {
      if (d.severity != Severity::Error) continue;
      const bool in_claim = d.span && d.span->source == 0 && d.span->begin + before.size() >= begin;
      const auto offset = [&](std::uint32_t at) { return units.of_byte(at > begin ? at - begin : 0); };
      list.push_back({{"code", d.code},
                      {"severity", "error"},
                      {"in_claim", in_claim},
                      {"from", in_claim ? Json(offset(d.span->begin)) : Json()},
                      {"to", in_claim ? Json(offset(d.span->end)) : Json()},
                      {"message", d.message},
                      {"reason", d.reason},
                      {"help", d.help}});
    }
    return list;
  };
  if (study.wrong()) {
    Json list = collect();
    const std::string first = list.empty() ? "The claim cannot be read." : list.front()["message"].get<std::string>();
    throw Trouble{"model", first, "", "", list.empty() ? "" : list.front()["code"].get<std::string>(), list};
  }
  const auto found = verification_of(study, work.interrupt);
  if (!found || found->results.empty()) {
    Json list = collect();
    throw Trouble{"model", list.empty() ? "The claim cannot be judged." : list.front()["message"].get<std::string>(),
                  "",      "",
                  "",      list};
  }
  // Its line is the last one of the text.
  const ExpectationResult& last = *std::max_element(found->results.begin(), found->results.end(),
                                                    [](const auto& a, const auto& b) { return a.line < b.line; });
  const InterruptScope scope = study.interruptible();
  if (const std::string why = last.passed ? objection(study, last, text_of(work.request, "about")) : ""; !why.empty())
    return {{"passed", false}, {"message", why}, {"pitfall", why}, {"text", last.text}};
  return is_true(work.request, "exercise") ? without_answer(last) : result_json(last);
}

}  // namespace maupertuis::studio
