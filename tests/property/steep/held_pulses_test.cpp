// Random pulses that move nothing until a force of constraint gives way: on a body that lies on a contact, on one that
// friction holds, in an event on a reaction, in an event alone. The coordinates know nothing of them; what is watched
// does. Right values by the shapes' inverses and by quadrature in 113 bits.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <random>
#include <thread>
#include <vector>

#include "../../cli/program.hpp"
#include "real.hpp"

using namespace steep;

namespace {

enum class Held { Contact, Friction, Reaction, Event };
constexpr std::array held_by = {"contact", "friction", "reaction", "event"};

/// s(u) = 1 at 0, falling to both sides.
struct Bell {
  const char* text;  // of U
  Quad (*value)(Quad u);
  Quad (*place)(Quad s);  // u ≥ 0 where it has this value
};

Quad arcosh(Quad x) { return acoshq(x); }

const std::array<Bell, 8> bells = {{
    {"exp(-(U)^2)", [](Quad u) { return expq(-u * u); }, [](Quad s) { return sqrtq(-logq(s)); }},
    {"sech(U)^2", [](Quad u) { return u > 100 ? Quad(0) : 1 / (coshq(u) * coshq(u)); },
     [](Quad s) { return arcosh(1 / sqrtq(s)); }},
    {"1/cosh(U)", [](Quad u) { return u > 200 ? Quad(0) : 1 / coshq(u); }, [](Quad s) { return arcosh(1 / s); }},
    {"1/(1 + (U)^2)", [](Quad u) { return 1 / (1 + u * u); }, [](Quad s) { return sqrtq(1 / s - 1); }},
    {"1/(1 + (U)^2)^1.5", [](Quad u) { return powq(1 + u * u, Quad(-1.5)); },
     [](Quad s) { return sqrtq(powq(s, Quad(-2) / 3) - 1); }},
    {"1/(1 + (U)^2)^2", [](Quad u) { return 1 / ((1 + u * u) * (1 + u * u)); },
     [](Quad s) { return sqrtq(1 / sqrtq(s) - 1); }},
    {"1/(1 + (U)^2)^3", [](Quad u) { return powq(1 + u * u, Quad(-3)); },
     [](Quad s) { return sqrtq(powq(s, Quad(-1) / 3) - 1); }},
    {"1/(1 + (U)^4)", [](Quad u) { return 1 / (1 + u * u * u * u); },
     [](Quad s) { return powq(1 / s - 1, Quad(0.25)); }},
}};

/// ∫ s du and ∫ u s du over [a, b] with u = sinh y, by Gauss's five points in short panels.
std::array<Quad, 2> integrals(const Bell& bell, Quad a, Quad b) {
  const Quad first = asinhq(a), last = asinhq(b), root = 2 * sqrtq(Quad(10) / 7);
  const std::array<Quad, 3> node = {Quad(0), sqrtq(5 - root) / 3, sqrtq(5 + root) / 3};
  const std::array<Quad, 3> weight = {Quad(128) / 225, (322 + 13 * sqrtq(Quad(70))) / 900,
                                      (322 - 13 * sqrtq(Quad(70))) / 900};
  const int panels = static_cast<int>((last - first) / Quad(0.01)) + 1;
  const Quad half = (last - first) / (2 * panels);
  std::array<Quad, 2> out{};
  for (int panel = 0; panel < panels; ++panel)
    for (int k = -2; k <= 2; ++k) {
      const auto at = static_cast<std::size_t>(std::abs(k));
      const Quad y = first + half * (2 * panel + 1 + (k < 0 ? -node[at] : node[at])), u = sinhq(y);
      const Quad share = weight[at] * half * coshq(y) * bell.value(fabsq(u));
      out[0] += share, out[1] += u * share;
    }
  return out;
}

struct HeldPulse {
  explicit HeldPulse(unsigned long long number);
  std::string text() const;
  /// Of the coordinate that is set free, at the end.
  Quad right() const;

  Held held;
  const Bell* bell;
  std::string level, force, time, width, duration;  // as they are written
};

/// Written so that it is a number of the machine: this test is not about the rounding of times.
std::string binary(double time) { return fmt::format("{}", std::round(1024 * time) / 1024); }

HeldPulse::HeldPulse(unsigned long long number) {
  std::mt19937_64 random(number * 0x9e3779b97f4a7c15ull + 5);
  const auto by_ratio = [&](double low, double high) {
    return low * std::exp(std::uniform_real_distribution<double>(0, std::log(high / low))(random));
  };
  held = static_cast<Held>(random() % held_by.size());
  bell = &bells[random() % bells.size()];
  const double l = by_ratio(0.1, 10), w = by_ratio(1e-5, 0.1), t0 = by_ratio(1, 3000), flight = by_ratio(0.3, 20);
  level = fmt::format("{:.4g}", l), width = fmt::format("{:.4g}", w);
  force = fmt::format("{:.4g}", l * std::max(3.0, 2 * flight / w));
  const double before = w * static_cast<double>(bell->place(Quad(l) / Quad(std::stod(force))));  // of the peak
  time = binary(t0 + before);
  duration = binary(t0 + before + flight);
}

std::string HeldPulse::text() const {
  std::string pulse = bell->text;
  pulse.replace(pulse.find('U'), 1, fmt::format("(t - {})/{}", time, width));
  if (pulse.front() == '1')
    pulse.erase(0, 1), pulse = force + pulse;
  else
    pulse = force + "*" + pulse;
  const std::string end = fmt::format("run {}\n", duration), body = "dimensionless\ncoord x : number\nT = 1/2 x'^2\n";
  switch (held) {
    case Held::Contact:
      return body + fmt::format("V = {} x\ncontact x >= 0\nforce x = {}\n", level, pulse) + end;
    case Held::Friction:
      return body + fmt::format("friction x limit {}\nforce x = {}\n", level, pulse) + end;
    case Held::Reaction:
      return fmt::format(
                 "dimensionless\ncoord x, z : number\nT = 1/2 (x'^2 + z'^2)\nconstraint z = 0 name rail\n"
                 "force z = {}\nevent e when multiplier(rail) = -{} : set x' = 1\nstart x = 0\n",
                 pulse, level) +
             end;
    case Held::Event:
      break;
  }
  return body + fmt::format("event e when {} = {} : set x' = 1\nstart x = 0\n", pulse, level) + end;
}

Quad HeldPulse::right() const {
  const Quad l = parse<Quad>(level), f = parse<Quad>(force), t0 = parse<Quad>(time), w = parse<Quad>(width),
             end = parse<Quad>(duration), u = -bell->place(l / f), passed = end - (t0 + w * u);
  if (held == Held::Reaction || held == Held::Event) return passed;
  const auto [once, moment] = integrals(*bell, u, (end - t0) / w);
  return f * w * ((end - t0) * once - w * moment) - l * passed * passed / 2;
}

unsigned long long wanted(const char* name, unsigned long long otherwise) {
  const char* const text = std::getenv(name);
  return text && *text ? std::strtoull(text, nullptr, 10) : otherwise;
}

enum class Outcome { Right, Word, Wrong };

/// Right within ten times what it states, or it says that it does not know.
Outcome judge_held(const HeldPulse& model, std::string& told) {
  const cli_test::Outcome run = cli_test::maup({"simulate", "-", "--json"}, model.text());
  const nlohmann::json document = nlohmann::json::parse(run.out, nullptr, false);
  told = fmt::format("exit {}", run.code);
  if (document.is_discarded() || (run.code != 0 && run.code != 3)) return Outcome::Wrong;
  if (document.contains("ended")) told = document["ended"].value("reason", "");
  if (run.code == 3) return Outcome::Word;
  const nlohmann::json &found = document.at("final").at("state").at("x"), &errors = document.at("final").at("errors");
  told = "no digit is certain";
  if (!found.is_number() || !errors.contains("x") || !errors["x"].is_number()) return Outcome::Word;
  const Quad right = model.right();
  const double size = std::max(1.0, std::abs(static_cast<double>(right)));
  const double off = static_cast<double>(fabsq(Quad(found.get<double>()) - right)), stated = errors["x"].get<double>();
  told = fmt::format("x = {}, off by {:.2g}, stated {:.2g}", found.get<double>(), off, stated);
  return off <= std::max(10 * stated, 2.3e-16 * size) ? Outcome::Right : Outcome::Wrong;
}

}  // namespace

TEST_CASE("random pulses on what is held: no wrong number without a word") {
  const auto count = wanted("STEEP_COUNT", 100), first = wanted("STEEP_FIRST", 1);
  std::atomic<unsigned long long> next{0}, words{0}, wrong{0};
  std::mutex printing;
  std::vector<std::thread> team(wanted("STEEP_THREADS", 2));
  for (std::thread& t : team)
    t = std::thread([&] {
      for (unsigned long long k = next++; k < count; k = next++) {
        const HeldPulse model(first + k);
        std::string told;
        const Outcome outcome = judge_held(model, told);
        if (outcome == Outcome::Right) continue;
        const bool is_wrong = outcome == Outcome::Wrong;
        ++(is_wrong ? wrong : words);
        const std::lock_guard lock(printing);
        fmt::print("{} {} {}: {}\n{}", is_wrong ? "WRONG" : "a word", held_by[static_cast<std::size_t>(model.held)],
                   first + k, told, is_wrong ? model.text() : "");
      }
    });
  for (std::thread& t : team) t.join();
  CHECK(wrong == 0);
  CHECK(words <= 1 + count / 10);
}
