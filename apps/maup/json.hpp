#pragma once
#include <maupertuis/certificate.hpp>
#include <maupertuis/diagnostic.hpp>

#include <nlohmann/json.hpp>

namespace maupertuis::app {

using Json = nlohmann::ordered_json;

/// What every document of --json opens with: {"schema": 1, "command": …}.
Json json_document(const char* command);

/// [{code, severity, line, column, message, reason, help}]; line and column are null without a place, and `option` is
/// there where the place is in what an option said.
Json to_json(const Diagnostics& diagnostics, const SourceTexts& texts);
/// {passed, checks: [{name, statement, verdict, points, error_bound}]}
Json to_json(const Certificate& certificate);

const char* severity_name(Severity severity);
const char* verdict_name(Verdict verdict);

}  // namespace maupertuis::app
