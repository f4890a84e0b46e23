// Many runs through modes: each is the run that it would be alone, to the bit.
#include <maupertuis/ensemble_through_modes.hpp>
#include <maupertuis/motion_kernel.hpp>

#include "run_text.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

using namespace maupertuis;

namespace {

bool same_bits(std::span<const double> a, std::span<const double> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}
bool same_bits(double a, double b) { return same_bits({&a, 1}, {&b, 1}); }

/// Starts of one model, with the parameters of each.
struct Members {
  std::vector<double> q, v, parameters, begin, end, times;  // begin: empty, or one for all

  EnsembleStart start() const {
    EnsembleStart out;
    out.q = q, out.v = v, out.parameters = parameters, out.begin = begin, out.end = end, out.times = times;
    return out;
  }
  std::size_t count() const { return end.size(); }
};

/// The single run of a member, from a text of its own: nothing is shared with the ensemble.
SimulationResult alone(const std::string& text, const Members& members, std::size_t k) {
  ModelText m(text);
  const std::size_t n = m.system->coordinates.size(), p = m.system->parameters.size();
  Context& context = *m.model.system.context;
  m.model.experiment.start.clear();
  const auto set = [&](std::size_t i, int order, double value) {
    StartValue s;
    s.coordinate = i, s.order = order, s.value = context.number(Rational::from_double(value));
    m.model.experiment.start.push_back(s);
  };
  for (std::size_t i = 0; i < n; ++i) set(i, 0, members.q[k * n + i]), set(i, 1, members.v[k * n + i]);
  auto system = m.model.system;
  for (std::size_t i = 0; i < p; ++i) {
    system.parameters[i].value = context.number(Rational::from_double(members.parameters[k * p + i]));
    system.parameters[i].si_value = members.parameters[k * p + i];
  }
  m.model.system = system;
  m.equations = *euler_lagrange(std::make_shared<const MechanicalSystem>(system), m.diagnostics);
  SimulationOptions options;
  options.duration = members.end[k];
  for (const double t : members.times)
    if (t <= members.end[k]) options.at.push_back(t);
  options.errors = ErrorEstimates::None;
  auto out = simulate(m.model, m.equations, options, m.diagnostics);
  INFO(render(m.diagnostics, m.source));
  REQUIRE(out);
  return std::move(*out);
}

ThroughModesResult together(const std::string& text, const Members& members, ThroughModesOptions options = {}) {
  ModelText m(text);
  options.happenings = 100'000;
  auto out = advance_ensemble(m.model, m.equations, members.start(), options, m.diagnostics);
  REQUIRE(out);
  return std::move(*out);
}

void check_same(const ThroughModesResult& found, const SimulationResult& run, const Members& members, std::size_t k) {
  CAPTURE(k);
  const ThroughModes& through = found.through[k];
  CHECK(found.endings[k].ok() == run.ok());
  CHECK(found.endings[k].steps == run.statistics.steps);
  CHECK(same_bits(found.endings[k].t, run.final.t));
  CHECK(same_bits(found.endings[k].energy_drift, run.statistics.energy_drift));
  CHECK(same_bits(found.q_of(k), run.final.q));
  CHECK(same_bits(found.v_of(k), run.final.v));
  for (std::size_t i = 0; i < run.at.size(); ++i) {
    if (run.at[i].q.empty()) continue;
    CHECK(same_bits(found.q_of(k, i), run.at[i].q));
    CHECK(same_bits(found.v_of(k, i), run.at[i].v));
  }
  CHECK(through.first_mode == run.first_mode);
  CHECK(through.remarks == run.remarks);
  REQUIRE(through.happenings.size() == run.happenings.size());
  std::array<std::size_t, 8> counts{};
  for (std::size_t i = 0; i < run.happenings.size(); ++i) {
    const Happening &a = through.happenings[i], &b = run.happenings[i];
    ++counts[static_cast<std::size_t>(b.kind)];
    CHECK(a.kind == b.kind);
    CHECK(a.mode == b.mode);
    CHECK(same_bits(a.t, b.t));
    CHECK(same_bits(a.impulse, b.impulse));
    CHECK(same_bits(a.q, b.q));
  }
  CHECK(through.counts == counts);
  CHECK(through.books.has_value() == run.books.has_value());
  if (run.books) CHECK(same_bits(through.books->impacts, run.books->impacts));
  if (run.books) CHECK(same_bits(through.books->friction, run.books->friction));
  CHECK(members.count() == found.endings.size());
}

/// As single runs, on one thread and on three.
ThroughModesResult check_as_alone(const std::string& text, const Members& members) {
  ThroughModesOptions one, three;
  one.threads = 1, three.threads = 3;
  const ThroughModesResult a = together(text, members, one), b = together(text, members, three);
  CHECK(same_bits(a.q, b.q));
  CHECK(same_bits(a.v, b.v));
  CHECK(same_bits(a.sampled_q, b.sampled_q));
  for (std::size_t k = 0; k < members.count(); ++k) check_same(b, alone(text, members, k), members, k);
  return a;
}

std::vector<double> model_parameters(const std::string& text) { return parameter_values(*ModelText(text).system); }

const std::string bouncing =
    "param m = 1 kg, g = 9.81 m/s^2, e = 0.8\ncoord z : length\nT = 1/2 m z'^2\nV = m g z\n"
    "contact z >= 0 restitution e name floor\n";

const std::string sliding_rod =
    "param m = 1 kg, l = 1 m, g = 9.81 m/s^2, μ = 0.3\ncoord x, z : length, θ : angle\n"
    "T = 1/2 m (x'^2 + z'^2) + 1/24 m l^2 θ'^2\nV = m g z\n"
    "contact z - l/2 sin θ >= 0 restitution 0.5 friction μ slip x' + l/2 sin θ θ' name left\n"
    "contact z + l/2 sin θ >= 0 restitution 0.5 friction μ slip x' - l/2 sin θ θ' name right\n";

}  // namespace

TEST_CASE("bouncing balls of an ensemble: times of the closed form, bits of single runs") {
  Members members;
  const std::vector<double> model = model_parameters(bouncing);
  for (int k = 0; k < 8; ++k) {
    members.q.push_back(0.5 + 0.1 * k), members.v.push_back(0.2 * k), members.end.push_back(3 + 0.3 * k);
    members.parameters.insert(members.parameters.end(), {1 + 0.5 * k, model[1], 0.5 + 0.05 * k});
  }
  members.times = {0, 0.5, 1.25, 4};
  const ThroughModesResult found = check_as_alone(bouncing, members);
  for (std::size_t k = 0; k < members.count(); ++k) {
    const double h = members.q[k], v = members.v[k], e = members.parameters[3 * k + 2], g = 9.81;
    const double speed = std::sqrt(v * v + 2 * g * h);  // as it hits the floor first
    CHECK(found.through[k].happenings.at(0).t == doctest::Approx((v + speed) / g).epsilon(1e-14));
    CHECK(found.through[k].happenings.at(1).t == doctest::Approx((v + speed) / g + 2 * e * speed / g).epsilon(1e-13));
    CHECK(found.through[k].count(Happening::Kind::Impact) >= 2);
    const bool rests = (v + speed) / g + 2 * speed / g * e / (1 - e) < members.end[k];
    CHECK(found.through[k].count(Happening::Kind::Made) == (rests ? 1 : 0));
    CHECK(found.through[k].last_mode == (rests ? "floor" : ""));
  }
  CHECK(std::isnan(found.q_of(0, 3)[0]));  // it ended before
}

TEST_CASE("rods that bounce and slide in an ensemble have the bits of single runs") {
  Members members;
  const std::vector<double> model = model_parameters(sliding_rod);
  for (int k = 0; k < 6; ++k) {
    members.q.insert(members.q.end(), {0, 1, 0.3 * k - 0.7}), members.v.insert(members.v.end(), {2.0 - k, 0, 0.1 * k});
    members.end.push_back(1.5);
    members.parameters.insert(members.parameters.end(), model.begin(), model.end());
    members.parameters.back() = 0.1 * k;
  }
  members.times = {0.3, 0.9};
  const ThroughModesResult found = check_as_alone(sliding_rod, members);
  for (const ThroughModes& t : found.through) CHECK(t.count(Happening::Kind::Impact) > 0);
}

TEST_CASE("stick and slip, impacts of several contacts, friction in space, constraints and sets in ensembles") {
  const auto vary = [](const std::string& text, std::vector<double> q, std::vector<double> v, double end) {
    Members members;
    const std::vector<double> model = model_parameters(text);
    for (int k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < q.size(); ++i) members.q.push_back(q[i]), members.v.push_back((1 + 0.2 * k) * v[i]);
      members.parameters.insert(members.parameters.end(), model.begin(), model.end());
      members.end.push_back(end);
    }
    check_as_alone(text, members);
  };
  SUBCASE("stick-slip")
  vary(
      "param m = 1 kg, k = 100 N/m, g = 9.81 m/s^2, μ = 0.3, μs = 0.4, v = 0.2 m/s\ncoord x, z : length\n"
      "T = 1/2 m (x'^2 + z'^2)\nV = 1/2 k x^2 + m g z\ncontact z >= 0 friction μ static μs slip x' - v name belt\n",
      {0, 0}, {0.2, 0}, 5);
  SUBCASE("friction of a coordinate")
  vary(
      "param m = 1 kg, k = 4 N/m, F = 0.5 N\ncoord x : length\nT = 1/2 m x'^2\nV = 1/2 k x^2\n"
      "friction x limit F static 1.5 F\n",
      {1}, {0.5}, 20);
  SUBCASE("cradle") {
    std::string text =
        "dimensionless\nparam R = 1\ncoord a, b, c : number\nT = 1/2 (a'^2 + b'^2 + c'^2)\n"
        "V = 1/2 ((a)^2 + (b - 1)^2 + (c - 2)^2)\n";
    vary(text + "contact b - a - R >= 0 restitution 1 name ab\ncontact c - b - R >= 0 restitution 1 name bc\n",
         {-1, 1, 2}, {0.1, 0, 0}, 10);
    vary(text +
             "contact b - a - R >= 0 restitution 0.7 name ab\ncontact c - b - R >= 0 restitution 0.7 name bc\n"
             "impact simultaneous\n",
         {-1, 1, 2}, {0.1, 0, 0}, 10);
  }
  SUBCASE("in space")
  vary(
      "param m = 1 kg, g = 9.81 m/s^2\ncoord x, y, z : length\nT = 1/2 m (x'^2 + y'^2 + z'^2)\nV = m g z\n"
      "contact z >= 0 restitution 0.5 friction 0.3 slip (x', y') name floor\n",
      {0, 0, 0.2}, {1, 0.5, 0}, 3);
  SUBCASE("a pendulum in Cartesian coordinates whose wall sets its speed")
  vary(
      "param m = 1 kg, g = 9.81 m/s^2, l = 1 m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = m g y\n"
      "constraint x^2 + y^2 = l^2\nevent back when x = 0 rising : set x' = -0.5 x', y' = -0.5 y'\n",
      {-0.6, -0.8}, {0, 0}, 4);
}

TEST_CASE("what an event sets is checked against the constraints with the parameters of each trajectory") {
  const std::string text =
      "param m = 1 kg, g = 9.81 m/s^2, l = 1 m\ncoord x, y : length\nT = 1/2 m (x'^2 + y'^2)\nV = m g y\n"
      "constraint x^2 + y^2 = l^2\nevent mirror when x = 0.1 m rising : set x = -0.1 m, y' = -y'\n";
  const std::string broken = "event off when x = 0.1 m rising : set x = -0.11 m, y' = -y'\n";
  Members members;
  for (const double l : {1.0, 2.0}) {
    members.q.insert(members.q.end(), {-0.6 * l, -0.8 * l}), members.v.insert(members.v.end(), {0, 0});
    members.parameters.insert(members.parameters.end(), {1, 9.81, l});
    members.end.push_back(1);
  }
  const ThroughModesResult found = check_as_alone(text, members);
  for (const TrajectoryEnding& e : found.endings) CHECK(e.ok());
  for (const ThroughModes& t : found.through) CHECK(t.count(Happening::Kind::Event) > 0);
  const ThroughModesResult off = together(text.substr(0, text.find("event")) + broken, members);
  for (const TrajectoryEnding& e : off.endings) CHECK(e.ending == StepEnding::ImpossibleState);
}

TEST_CASE("models of the gallery have the bits of their single runs in an ensemble") {
  for (const char* name :
       {"ball_on_vibrating_table", "bouncing_dumbbell", "bowling_ball", "dry_hoop", "knee_stops", "loop_the_loop",
        "newtons_cradle", "rocking_block", "sliding_ladder", "two_link_hopper", "wheel_brake", "woodpecker"}) {
    CAPTURE(std::string(name));
    std::ostringstream text;
    text << std::ifstream(std::string(PROJECT_DIR) + "/models/" + name + ".lag").rdbuf();
    ModelText m(text.str());
    const auto begin = consistent_start(m.model, m.equations, m.diagnostics);
    REQUIRE(begin);
    Members members;
    members.begin = {begin->state.t};
    members.end = {begin->state.t + 1.7, begin->state.t + 0.9};
    members.parameters = parameter_values(m.model.system);
    for (std::size_t k = 0; k < 2; ++k) {
      members.q.insert(members.q.end(), begin->state.q.begin(), begin->state.q.end());
      members.v.insert(members.v.end(), begin->state.v.begin(), begin->state.v.end());
    }
    ThroughModesOptions options;
    options.threads = 2, options.happenings = 100'000;
    const auto found = advance_ensemble(m.model, m.equations, members.start(), options, m.diagnostics);
    REQUIRE(found);
    for (std::size_t k = 0; k < 2; ++k) {
      ModelText single(text.str());
      SimulationOptions of_run;
      of_run.duration = k == 0 ? 1.7 : 0.9, of_run.errors = ErrorEstimates::None;
      const auto run = simulate(single.model, single.equations, of_run, single.diagnostics);
      REQUIRE(run);
      check_same(*found, *run, members, k);
    }
  }
}

TEST_CASE("what ends one motion of an ensemble ends it alone, and an event that stops is named") {
  const std::string text = bouncing + "event high when z = 2 m rising : stop\n";
  Members members;
  const std::vector<double> model = model_parameters(text);
  members.q = {1, -0.5, 1, 1}, members.v = {0, 0, 10, 0}, members.end = {2, 2, 2, 2}, members.parameters = model;
  ThroughModesOptions options;
  options.maximum_steps = 100'000;
  const ThroughModesResult found = together(text, members, options);
  CHECK(found.endings[0].ok());
  CHECK_FALSE(found.endings[0].event);
  CHECK(found.endings[1].ending == StepEnding::Paradox);
  CHECK(found.endings[1].reason == "The start violates the contact floor.");
  CHECK(found.q_of(1)[0] == -0.5);
  CHECK(found.endings[2].ok());
  REQUIRE(found.endings[2].event);
  CHECK(*found.endings[2].event == 0);
  CHECK(found.endings[2].t == doctest::Approx((10 - std::sqrt(100 - 2 * 9.81)) / 9.81).epsilon(1e-14));
  CHECK(same_bits(found.q_of(3), found.q_of(0)));
}

TEST_CASE("an ensemble that is interrupted says so of each motion that is not done") {
  std::atomic<bool> stop{true};
  Members members;
  members.q = {1, 2}, members.v = {0, 0}, members.end = {2, 2}, members.parameters = model_parameters(bouncing);
  ThroughModesOptions options;
  options.interrupt = &stop;
  ModelText m(bouncing);
  const auto found = advance_ensemble(m.model, m.equations, members.start(), options, m.diagnostics);
  REQUIRE(found);
  for (const TrajectoryEnding& e : found->endings) CHECK(e.ending == StepEnding::Interrupted);
  CHECK(same_bits(found->q, members.q));
}

TEST_CASE("values that a text may not have end their own trajectory, where it starts") {
  const std::string ball =
      "system b\nparam m = 1 kg, g = 9.81 m/s^2, e = 0.8, μ = 0.3\ncoord x, z : length\npoint P mass m at (x, z)\n"
      "gravity (0, -g)\ncontact z >= 0 restitution e friction μ slip x' name floor\nstart z = 1 m\n";
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::vector<double>> values = {{1, 9.81, 0.8, 0.3},  {1, 9.81, 2, 0.3},    {1, 9.81, -0.5, 0.3},
                                                   {1, 9.81, none, 0.3}, {-1, 9.81, 0.8, 0.3}, {1, 9.81, 0.8, -0.3}};
  const char* const told[] = {"",
                              "The restitution of floor is 2",
                              "The restitution of floor is -0.5",
                              "A parameter is",
                              "The mass of P is -1",
                              "friction of floor is -0.3"};
  Members members;
  for (const auto& row : values) {
    members.q.insert(members.q.end(), {0, 1}), members.v.insert(members.v.end(), {1, 0});
    members.parameters.insert(members.parameters.end(), row.begin(), row.end());
    members.end.push_back(2);
  }
  const ThroughModesResult found = together(ball, members);
  CHECK(found.endings[0].ok());
  CHECK(found.through[0].count(Happening::Kind::Impact) > 0);
  for (std::size_t k = 1; k < values.size(); ++k) {
    CAPTURE(k);
    CHECK(found.endings[k].ending == StepEnding::Refused);
    CHECK(found.endings[k].reason.find(told[k]) != std::string::npos);
    CHECK(found.endings[k].t == 0);
    CHECK(found.q_of(k)[1] == 1);
    CHECK(found.through[k].count(Happening::Kind::Impact) == 0);
  }
}

TEST_CASE("a restitution that has no value for a trajectory ends it where it starts") {
  Members members;
  members.q = {1, 1}, members.v = {0, 0}, members.end = {2, 2}, members.parameters = {1, 9.81, 0.64, 1, 9.81, -0.64};
  const ThroughModesResult found = together(
      "system b\nparam m = 1 kg, g = 9.81 m/s^2, e = 0.64\ncoord z : length\npoint P mass m at (0, z)\ngravity (0, "
      "-g)\n"
      "contact z >= 0 restitution sqrt(e) name floor\nstart z = 1 m\n",
      members);
  CHECK(found.endings[0].ok());
  CHECK(found.endings[1].ending == StepEnding::Refused);
  CHECK(found.endings[1].reason.find("The restitution of floor has no value") == 0);
}

TEST_CASE("starts off the constraints of a model with contacts are told") {
  const std::string text =
      "system p\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord x, y : length\npoint B mass m at (x, y)\n"
      "gravity (0, -g)\nconstraint x^2 + y^2 = l^2 name rod\ncontact x + 2 [m] >= 0 restitution 0.5\n"
      "start x = 0.6 m, y = -0.8 m\n";
  Members members;
  members.q = {0.6, -0.8, 1, 1}, members.v = {0, 0, 0, 0}, members.end = {1, 1};
  const ModelText m(text);
  members.parameters = parameter_values(*m.system);
  ThroughModesOptions options;
  Diagnostics diagnostics;
  const auto found = advance_ensemble(m.model, m.equations, members.start(), options, diagnostics);
  REQUIRE(found);
  CHECK(found->endings[0].ok());
  CHECK(found->endings[1].ending == StepEnding::Refused);
  CHECK(found->endings[1].reason.find("constraint rod") != std::string::npos);
}
