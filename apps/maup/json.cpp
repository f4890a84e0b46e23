#include "json.hpp"

namespace maupertuis::app {

Json json_document(const char* command) { return {{"schema", 1}, {"command", command}}; }

const char* severity_name(Severity severity) {
  switch (severity) {
    case Severity::Note:
      return "note";
    case Severity::Warning:
      return "warning";
    case Severity::Error:
      return "error";
  }
  return "";
}

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::Zero:
      return "zero";
    case Verdict::Nonzero:
      return "nonzero";
    case Verdict::Undecided:
      return "undecided";
  }
  return "";
}

Json to_json(const Diagnostics& diagnostics, const SourceTexts& texts) {
  Json list = Json::array();
  for (const Diagnostic& d : diagnostics.items()) {
    Json item = {{"code", d.code},       {"severity", severity_name(d.severity)},
                 {"line", nullptr},      {"column", nullptr},
                 {"message", d.message}, {"reason", d.reason},
                 {"help", d.help}};
    if (d.span) {
      const LineColumn place = texts.locate(*d.span);
      item["line"] = place.line;
      item["column"] = place.column;
      if (d.span->source != texts.model().id()) item["option"] = texts.of(*d.span).name();
    }
    list.push_back(std::move(item));
  }
  return list;
}

Json to_json(const Certificate& certificate) {
  Json checks = Json::array();
  for (const CertificateCheck& check : certificate.checks) {
    if (check.applies)
      checks.push_back({{"name", check.name},
                        {"statement", check.statement},
                        {"verdict", verdict_name(check.verdict)},
                        {"points", check.points},
                        {"error_bound", check.error_bound}});
  }
  return {{"passed", certificate.passed()}, {"checks", std::move(checks)}};
}

}  // namespace maupertuis::app
