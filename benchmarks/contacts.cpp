// Motions with contacts: each row checks its result, then says what it cost. MuJoCo beside them where it is installed.
#include "chain.hpp"
#include "measure.hpp"

#include <maupertuis/simulation.hpp>

#include <fmt/format.h>
#ifdef MAUPERTUIS_MUJOCO
#include <mujoco/mujoco.h>
#endif

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace maupertuis;

struct Timed {
  SimulationResult result;
  double seconds = 0;  // processor time, with what derives and compiles
};

Timed run(const std::string& text, double end) {
  const double begin = bench::thread_seconds();
  const auto model = bench::read(text);
  const EquationsOfMotion equations = bench::derive(model);
  SimulationOptions options;
  options.duration = end;
  options.errors = ErrorEstimates::None;
  Diagnostics diagnostics;
  auto result = simulate(*model, equations, options, diagnostics);
  bench::require(result && result->ok(), "the run ends as it should");
  return {std::move(*result), bench::thread_seconds() - begin};
}

void row(const std::string& what, const std::string& measured, const std::string& reach, const std::string& note) {
  fmt::print("| {} | {} | {} | {} |\n", what, measured, reach, note);
}

std::vector<double> times(const SimulationResult& r, Happening::Kind kind) {
  std::vector<double> out;
  for (const Happening& h : r.happenings)
    if (h.kind == kind) out.push_back(h.t);
  return out;
}

const std::string ball =
    "param m = 1 kg, g = 9.81 m/s^2\ncoord z : length\nT = 1/2 m z'^2\nV = m g z\n"
    "contact z >= 0 restitution 0.8 name floor\nstart z = 1 m\n";

/// Dropped from 1 m: t_k = t_0 (1 + 2 Σ e^j).
void bouncing_ball() {
  const Timed t = run(ball, 6);
  const double first = std::sqrt(2 / 9.81), e = 0.8;
  double closed = first, off = 0, power = 1;
  const auto hits = times(t.result, Happening::Kind::Impact);
  for (int k = 0; k < 8; ++k) {
    off = std::max(off, std::abs(hits[static_cast<std::size_t>(k)] - closed));
    power *= e;
    closed += 2 * first * power;
  }
  const double end = first * (1 + e) / (1 - e);
  const double accumulated = std::abs(times(t.result, Happening::Kind::Made).back() / end - 1);
  bench::require(off < 1e-12 && accumulated < 1e-9, "the times of a bouncing ball");
  row("bouncing ball, first eight impacts", fmt::format("{:.1e} s off", off), "1e-12",
      fmt::format("accumulation {:.1e}, {:.1f} ms", accumulated, 1e3 * t.seconds));
}

void stadium() {
  const Timed t =
      run("dimensionless\ncoord x, y : number\nT = 1/2 (x'^2 + y'^2)\n"
          "contact max(abs(x) - 1, 0)^2 + y^2 <= 1 restitution 1\nstart x = 0.1, y = 0.2, x' = 0.8, y' = 0.6\n",
          147'000);
  const std::size_t count = times(t.result, Happening::Kind::Impact).size();
  double inside = 0;
  for (const Happening& h : t.result.happenings)
    if (!h.q.empty()) inside = std::max(inside, std::pow(std::max(std::abs(h.q[0]) - 1, 0.0), 2) + h.q[1] * h.q[1] - 1);
  bench::require(inside < 1e-13, "no reflection is missed");
  row(fmt::format("stadium billiard, {} reflections", count), fmt::format("{:.2f} s", t.seconds), "0.2 s per 1e5",
      fmt::format("energy {:.1e}, outside by {:.1e} at most", t.result.statistics.energy_drift, inside));
}

void cradle() {
  std::string text = "param m = 1 kg, l = 1 m, g = 9.81 m/s^2, d = 0.1 m\ncoord θ1, θ2, θ3, θ4, θ5 : angle\nT = ";
  for (int i = 1; i <= 5; ++i) text += fmt::format("{}1/2 m l^2 θ{}'^2", i > 1 ? " + " : "", i);
  text += "\nV = ";
  for (int i = 1; i <= 5; ++i) text += fmt::format("{}-m g l cos θ{}", i > 1 ? " " : "", i);
  text += "\n";
  for (int i = 1; i < 5; ++i) text += fmt::format("contact θ{} >= θ{} restitution 1 name c{}\n", i + 1, i, i);
  const Timed t = run(text + "start θ1 = -0.5\n", 100);
  bench::require(t.result.statistics.energy_drift < 1e-12, "the energy of the cradle");
  row("Newton's cradle of five, 100 s", fmt::format("{:.3f} s", t.seconds), "0.3 s",
      fmt::format("{} impacts, energy {:.1e}", times(t.result, Happening::Kind::Impact).size(),
                  t.result.statistics.energy_drift));
}

void stick_slip() {
  const Timed t =
      run("param m = 1 kg, k = 100 N/m, g = 9.81 m/s^2, μ = 0.3, μs = 0.4, v = 0.2 m/s\ncoord x, z : length\n"
          "T = 1/2 m (x'^2 + z'^2)\nV = 1/2 k x^2 + m g z\ncontact z >= 0 friction μ static μs slip x' - v name belt\n"
          "start x' = v\n",
          3200);
  const auto slips = times(t.result, Happening::Kind::Slip);
  const double w = 10, force = 0.1 * 9.81, v = 0.2, pi = std::acos(-1.0);
  const double period = (pi + 2 * std::atan(v * 100 / (w * force))) / w + 2 * force / (100 * v);
  const double measured = (slips.back() - slips.front()) / static_cast<double>(slips.size() - 1);
  bench::require(std::abs(measured / period - 1) < 1e-12, "the period of stick and slip");
  const std::size_t transitions = slips.size() + times(t.result, Happening::Kind::Stick).size();
  row(fmt::format("stick-slip oscillator, {} transitions", transitions), fmt::format("{:.2f} s", t.seconds),
      "0.3 s per 1e4", fmt::format("period off by {:.1e}", std::abs(measured / period - 1)));
}

/// n × n discs in a box, their speeds at random.
std::string discs(int n) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> speed(-1, 1);
  std::string names, energy, contacts, start;
  for (int i = 0; i < n * n; ++i) {
    const char* const comma = i > 0 ? ", " : "";
    names += fmt::format("{}x{}, y{}", comma, i, i);
    energy += fmt::format("{}1/2 (x{}'^2 + y{}'^2)", i > 0 ? " + " : "", i, i);
    start += fmt::format("{0}x{1} = {2}, y{1} = {3}, x{1}' = {4:.6f}, y{1}' = {5:.6f}", comma, i, i % n + 0.5,
                         i / n + 0.5, speed(random), speed(random));
    for (const char c : {'x', 'y'})
      contacts +=
          fmt::format("contact {0}{1} >= 0.3 restitution 1\ncontact {0}{1} <= {2} restitution 1\n", c, i, n - 0.3);
    for (int j = 0; j < i; ++j)
      contacts += fmt::format("contact sqrt((x{0} - x{1})^2 + (y{0} - y{1})^2) >= 0.6 restitution 1\n", i, j);
  }
  return "dimensionless\ncoord " + names + " : number\nT = " + energy + "\n" + contacts + "start " + start + "\n";
}

void hundred_discs() {
  const Timed t = run(discs(10), 8.3);
  bench::require(t.result.statistics.energy_drift < 1e-12, "the energy of the discs");
  row(fmt::format("10 × 10 discs in a box, {} collisions", times(t.result, Happening::Kind::Impact).size()),
      fmt::format("{:.1f} s", t.seconds), "10 s per 1000",
      fmt::format("energy {:.1e}", t.result.statistics.energy_drift));
}

// ------------------------------------------------------------------------------------------------------ beside MuJoCo

#ifdef MAUPERTUIS_MUJOCO

/// The height, or the place along a slope, of the last body at a time.
double mujoco_place(const std::string& text, double end, const std::vector<double>& start, int coordinate,
                    double& seconds) {
  mjVFS files;
  mj_defaultVFS(&files);
  mj_makeEmptyFileVFS(&files, "model.xml", static_cast<int>(text.size()));
  text.copy(static_cast<char*>(files.filedata[mj_findFileVFS(&files, "model.xml")]), text.size());
  char error[300] = "";
  mjModel* const model = mj_loadXML("model.xml", &files, error, sizeof error);
  mj_deleteVFS(&files);
  if (!model) throw std::runtime_error(error);
  mjData* const data = mj_makeData(model);
  for (std::size_t i = 0; i < start.size(); ++i) data->qvel[i] = start[i];
  const double begin = bench::thread_seconds();
  while (data->time < end - 1e-9) mj_step(model, data);
  seconds = bench::thread_seconds() - begin;
  const double place = data->qpos[coordinate];
  mj_deleteData(data);
  mj_deleteModel(model);
  return place;
}

/// A block that slides on a floor with μ = 0.3 from 3 m/s and stops after v²/(2 μ g).
void beside_mujoco() {
  const double closed = 9 / (2 * 0.3 * 9.81);
  const Timed ours =
      run("param m = 1 kg, g = 9.81 m/s^2\ncoord x, z : length\nT = 1/2 m (x'^2 + z'^2)\nV = m g z\n"
          "contact z >= 0 friction 0.3 slip x' name floor\nstart x' = 3 m/s\n",
          3);
  row("block with friction, way after 3 s: maupertuis",
      fmt::format("{:.1e} m off", std::abs(ours.result.final.q[0] - closed)), "",
      fmt::format("{:.2f} ms, whole", 1e3 * ours.seconds));
  for (const double step : {2e-3, 1e-4}) {
    double seconds = 0;
    const double x = mujoco_place(
        fmt::format("<mujoco><option timestep='{}' gravity='0 0 -9.81' cone='elliptic' impratio='10'/><worldbody>"
                    "<geom type='plane' size='9 9 1' friction='0.3 0 0'/><body pos='0 0 0.1'>"
                    "<joint type='slide' axis='1 0 0'/><joint type='slide' axis='0 0 1'/>"
                    "<geom type='sphere' size='0.1' mass='1' friction='0.3 0 0'/></body></worldbody></mujoco>",
                    step),
        3, {3, 0}, 0, seconds);
    row(fmt::format("the same: MuJoCo, steps of {:g} s", step), fmt::format("{:.1e} m off", std::abs(x - closed)), "",
        fmt::format("{:.2f} ms for its steps", 1e3 * seconds));
  }
  // A ball that falls from 1 m and bounces without loss is there again after each 2 √(2 h/g).
  const double period = 2 * std::sqrt(2 / 9.81), end = 3 * period;
  std::string elastic = ball;
  elastic.replace(elastic.find("0.8"), 3, std::string("1"));
  const Timed bounce = run(elastic, end);
  row("bouncing ball without loss, height after three bounces: maupertuis",
      fmt::format("{:.1e} m off", std::abs(bounce.result.final.q[0] - 1)), "",
      fmt::format("{:.2f} ms, whole", 1e3 * bounce.seconds));
  for (const double step : {2e-3, 1e-4}) {
    double seconds = 0;
    const double z = mujoco_place(
        fmt::format(
            "<mujoco><option timestep='{}' gravity='0 0 -9.81' integrator='RK4'/><worldbody>"
            "<geom type='plane' size='9 9 1' solref='-10000 0'/><body pos='0 0 1.1'><joint type='slide' axis='0 0 1'/>"
            "<geom type='sphere' size='0.1' mass='1' solref='-10000 0'/></body></worldbody></mujoco>",
            step),
        end, {}, 0, seconds);
    row(fmt::format("the same: MuJoCo, steps of {:g} s", step), fmt::format("{:.1e} m off", std::abs(z)), "",
        fmt::format("{:.2f} ms for its steps", 1e3 * seconds));
  }
}

#endif

}  // namespace

int main() {
  fmt::print("| what | measured | to reach | |\n|---|---|---|---|\n");
  bouncing_ball();
  stadium();
  cradle();
  stick_slip();
  hundred_discs();
#ifdef MAUPERTUIS_MUJOCO
  beside_mujoco();
#endif
}
