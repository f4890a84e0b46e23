#include "referee.hpp"

#include "../../cli/program.hpp"
#include "reference.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>
#include <sstream>

namespace steep {
namespace {

constexpr double agreement = 1e-13;  // of the two runs of the reference
constexpr double probe = 1e-9, most_growth = 1e4;
const char* const names[most] = {"x", "y", "z"};

double size(Quad x) { return std::max(1.0, std::abs(static_cast<double>(x))); }

/// The right end; nothing where the two resolutions disagree or the motion is too sensitive to judge anybody by it.
std::optional<State<Quad>> right_end(const Description& d) {
  const Law<Long> coarse(d), moved(d, probe);
  const auto b = Reference<Long>(coarse, {1e-16, 0.6, 8}).run(), c = Reference<Long>(moved, {1e-16, 0.6, 8}).run();
  if (!b || !c) return std::nullopt;
  const Law<Quad> fine(d);
  const auto a = Reference<Quad>(fine, {1e-22, 1, 10}).run();
  if (!a) return std::nullopt;
  const auto agrees = [&](Quad x, Long y, Long z) {
    const double growth = std::abs(static_cast<double>(y - z)) / probe / size(x);
    return growth < most_growth && static_cast<double>(fabs(x - Quad(y))) < agreement * std::max(1.0, growth) * size(x);
  };
  for (int i = 0; i < d.n; ++i)
    if (!agrees(a->q[i], b->q[i], c->q[i]) || !agrees(a->v[i], b->v[i], c->v[i])) return std::nullopt;
  return a;
}

std::string digits(Quad x) {
  char out[64];
  quadmath_snprintf(out, sizeof out, "%.20Qg", x);
  return out;
}

std::string expectations(const Description& d, const State<Quad>& end) {
  std::string out;
  const char* const unit = d.pivot_moves ? " rad" : d.units ? " m" : "";
  const char* const second = d.units ? " s" : "";
  for (int i = 0; i < d.n; ++i) {
    out += fmt::format("expect {} at {}{} = {}{} ± 1e-9\n", names[i], d.duration.text, second, digits(end.q[i]), unit);
    out += fmt::format("expect {}' at {}{} = {}{}{} ± 1e-9\n", names[i], d.duration.text, second, digits(end.v[i]),
                       unit, d.units ? "/s" : "");
  }
  return out;
}

/// The component with the largest error, as a multiple of what is allowed.
double worst(const Description& d, const State<Quad>& end, const nlohmann::json& final, Judgement& out) {
  double most_allowed = 0;
  const nlohmann::json errors = final.value("errors", nlohmann::json::object());
  for (int i = 0; i < d.n; ++i)
    for (const bool rate : {false, true}) {
      const std::string name = names[i] + std::string(rate ? "'" : "");
      const Quad right = rate ? end.v[i] : end.q[i];
      const nlohmann::json& found = final.at("state").at(name);
      if (!found.is_number()) return HUGE_VAL;
      const double error = static_cast<double>(fabs(Quad(found.get<double>()) - right)) / size(right);
      // The spacing of doubles is nobody's error. A stated error that is null says that nothing is known.
      double allowed = 1e-9, stated = 0;
      if (errors.contains(name)) {
        stated = errors[name].is_number() ? errors[name].get<double>() / size(right) : HUGE_VAL;
        allowed = std::max(10 * stated, 2.3e-16);
      }
      if (error / allowed <= most_allowed && !(out.error == 0)) continue;
      most_allowed = std::max(most_allowed, error / allowed), out.error = error, out.stated = stated;
    }
  return most_allowed;
}

}  // namespace

Judgement judge(const Description& d, const std::string& arguments) {
  Judgement out;
  const auto end = right_end(d);
  if (!end) return out;
  out.expectations = expectations(d, *end);
  std::vector<std::string> words{"simulate", "-", "--json"};
  std::istringstream more(arguments);
  for (std::string word; more >> word;) words.push_back(word);
  const cli_test::Outcome run = cli_test::maup(words, text_of(d, "steep"));
  const nlohmann::json document = nlohmann::json::parse(run.out, nullptr, false);
  if (document.is_discarded() || run.code == 124) {
    out.verdict = Verdict::Wrong,
    out.reason = run.code == 124 ? "no end within 60 s" : fmt::format("exit {}: {}", run.code, run.err.substr(0, 300));
    return out;
  }
  if (run.code != 0) {
    out.verdict = run.code == 3 ? Verdict::Ended : Verdict::Refused;
    if (document.contains("ended")) out.reason = document["ended"].value("reason", "");
    for (const auto& diagnostic : document.value("diagnostics", nlohmann::json::array()))
      if (diagnostic.value("severity", "") == "error")
        out.reason += diagnostic.value("code", "") + " " + diagnostic.value("message", "");
    if (out.reason.empty())
      out.verdict = Verdict::Wrong, out.reason = fmt::format("exit {} without a reason", run.code);
    return out;
  }
  out.verdict = worst(d, *end, document.at("final"), out) <= 1 ? Verdict::Right : Verdict::Wrong;
  return out;
}

}  // namespace steep
