#include "studio/desk.hpp"

#include <algorithm>

namespace maupertuis::studio {

std::string text_of(const Json& request, const char* key, const std::string& otherwise) {
  const auto found = request.find(key);
  if (found == request.end() || found->is_null()) return otherwise;
  if (!found->is_string()) throw Trouble{"request", std::string("`") + key + "` is no text.", "", "", "", nullptr};
  return found->get<std::string>();
}

double number_of(const Json& request, const char* key, double otherwise) {
  const auto found = request.find(key);
  if (found == request.end() || found->is_null()) return otherwise;
  if (!found->is_number()) throw Trouble{"request", std::string("`") + key + "` is no number.", "", "", "", nullptr};
  return found->get<double>();
}

bool is_true(const Json& request, const char* key) {
  const auto found = request.find(key);
  return found != request.end() && found->is_boolean() && found->get<bool>();
}

void Desk::open(std::string name, std::string text) {
  studies_.clear();
  certified_modes_.clear();
  units_.reset();
  document_.emplace(SourceText(std::move(name), std::move(text)), interrupt_);
  units_.emplace(document_->source().text());
}

language::Document& Desk::document() {
  if (!document_) throw Trouble{"request", "No model is open.", "", "Open a text first.", "", nullptr};
  return *document_;
}

const Units& Desk::units() {
  document();
  return *units_;
}

namespace {

/// `values`: {"l1": "1.2 m", …}; each becomes a text of its own.
void put_in(Study& study, const Json& request, const char* key, OverrideKind kind) {
  const auto values = request.find(key);
  if (values == request.end() || values->is_null()) return;
  if (!values->is_object()) throw Trouble{"request", std::string("`") + key + "` is no object.", "", "", "", nullptr};
  for (const auto& [name, value] : values->items()) {
    if (!value.is_string()) throw Trouble{"request", "The value of " + name + " is no text.", "", "", "", nullptr};
    study.override_with(kind, key, name + " = " + value.get<std::string>());
  }
}

}  // namespace

Study& Desk::study(const Json& request) {
  Json beside = Json::object();
  for (const char* key : {"set", "start", "run", "mode", "section"})
    if (const auto found = request.find(key); found != request.end()) beside[key] = *found;
  const std::string key = beside.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (auto kept = studies_.begin(); kept != studies_.end(); ++kept)
    if (kept->key == key) {
      studies_.splice(studies_.begin(), studies_, kept);
      return *studies_.front().study;
    }
  auto study = std::make_unique<Study>(source(), interrupt_);
  put_in(*study, request, "set", OverrideKind::Parameters);
  put_in(*study, request, "start", OverrideKind::Start);
  if (const std::string run = text_of(request, "run"); !run.empty())
    study->override_with(OverrideKind::Run, "run", run);
  if (const std::string section = text_of(request, "section"); !section.empty())
    study->override_with(OverrideKind::Section, "section", section);
  if (const std::string mode = text_of(request, "mode"); !mode.empty()) study->fix_mode(mode);
  studies_.push_front({key, std::move(study), 0});
  if (studies_.size() > most_kept) studies_.pop_back();
  return *studies_.front().study;
}

Json Desk::diagnostics(const Study& study, const Diagnostics& more) {
  Diagnostics all = study.diagnostics();
  all.append(more);
  all.sort_by_place();
  return diagnostics_json(all, study.texts(), units());
}

void Desk::refuse(const Study& study, const Diagnostics& more) {
  Diagnostics all = study.diagnostics();
  all.append(more);
  const auto items = all.items();
  const auto is_error = [](const Diagnostic& d) { return d.severity == Severity::Error; };
  const auto first = std::find_if(items.begin(), items.end(), is_error);
  Trouble trouble{"model", "The model has a mistake.", "", "", "", diagnostics(study, more)};
  if (first != items.end()) {
    trouble.message = first->message, trouble.reason = first->reason;
    trouble.help = help_on_page(*first), trouble.code = first->code;
  }
  throw trouble;
}

namespace {

/// Whether the equations of the study, or of its fields, were derived.
bool derived(Study& study) {
  return study.has_fields() ? study.field_equations() != nullptr : study.equations() != nullptr;
}

}  // namespace

Study& Desk::certified(const Json& request) {
  Study& study = this->study(request);
  if (!derived(study)) refuse(study);
  if (!study.has_fields()) {
    study.derivation(true);  // before the certificate, which vouches for the readable form too
    if (!study.certificate() || study.wrong()) refuse(study);
  }
  certified_modes_.insert(text_of(request, "mode"));
  Kept& kept = studies_.front();
  if (kept.messages == 0) kept.messages = 1 + study.diagnostics().items().size();
  return study;
}

Study& Desk::moved(const Json& request) {
  if (certified_modes_.count(text_of(request, "mode")) == 0) return certified(request);
  Study& study = this->study(request);
  if (!derived(study)) refuse(study);
  Kept& kept = studies_.front();
  if (kept.messages == 0) kept.messages = 1 + study.diagnostics().items().size();
  return study;
}

void Desk::forget_said() {
  studies_.remove_if([](const Kept& kept) {
    return kept.study->wrong() || kept.messages != 1 + kept.study->diagnostics().items().size();
  });
}

}  // namespace maupertuis::studio
