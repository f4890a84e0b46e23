// Of thousands of named parts a section shows the first hundred, and tells how many more there are.
#include "../model_text.hpp"

#include <maupertuis/certificate.hpp>
#include <maupertuis/report.hpp>

#include <algorithm>
#include <string>

using namespace maupertuis;

namespace {

const ReportContent::Section& section_of(const ReportContent& content, const std::string& title) {
  const auto found = std::find_if(content.derivation.begin(), content.derivation.end(),
                                  [&](const auto& section) { return section.title == title; });
  REQUIRE(found != content.derivation.end());
  return *found;
}

std::ptrdiff_t names_in(const ReportContent::Section& section) {
  return std::count_if(section.lines.begin(), section.lines.end(),
                       [](const ReportContent::Formula& line) { return line.rule == "with"; });
}

}  // namespace

TEST_CASE("names beyond the first hundred of a section are counted; the next section has its own") {
  const ModelText m("param k = 1 N/m, m = 1 kg\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n");
  Derivation derivation = readable_derivation(m.equations, true);
  const Certificate certificate = certify(m.equations, &derivation, {});
  DerivationStep step = derivation.steps.back();
  step.section = "Long";
  for (int i = 1; i <= 70; ++i)
    step.intermediates.push_back({m.system->context->symbol("k" + std::to_string(i), Role::Auxiliary), step.right});
  derivation.steps.push_back(step);
  derivation.steps.push_back(step);
  step.section = "Next";
  derivation.steps.push_back(step);
  const ReportContent content = compose_report(m.model, m.source, m.equations, derivation, certificate, {});
  const auto& longer = section_of(content, "Long");
  CHECK(names_in(longer) == 100);
  CHECK(longer.lines.size() == 103);
  CHECK(longer.lines.back().sentence == "40 more names stand in these lines; `maup derive --steps` writes them all.");
  CHECK(names_in(section_of(content, "Next")) == 70);
  CHECK(section_of(content, "Next").lines.back().sentence.empty());
}
