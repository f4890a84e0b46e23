// The table of docs/benchmarks.md: each row first asserts that its result is right, then says what it cost.
#include "chain.hpp"
#include "process.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <maupertuis/certificate.hpp>
#include <maupertuis/print.hpp>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace {

using namespace maupertuis;

void require(bool condition, const char* what) {
  if (!condition) throw std::runtime_error(std::string("wrong result: ") + what);
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

double median_seconds(int runs, const std::function<void()>& work) {
  std::vector<double> seconds;
  for (int i = 0; i < runs; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return median(seconds);
}

/// A model file that lives as long as the object.
class TemporaryModel {
 public:
  explicit TemporaryModel(const std::string& text) : path_(fmt::format("/tmp/maup_bench_{}.lag", ::getpid())) {
    std::ofstream(path_) << text;
  }
  ~TemporaryModel() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

void row(const std::string& what, const std::string& measured, const std::string& limit, bool within) {
  fmt::print("| {} | {} | {} |{}\n", what, measured, limit, within ? "" : "  <- over");
  std::fflush(stdout);
}

std::string milliseconds(double seconds) { return fmt::format("{:.1f} ms", 1e3 * seconds); }

void derive_double_pendulum() {
  const std::string first =
      "(m1 + m2) l1^2 θ1'' + m2 l1 l2 cos(θ1 - θ2) θ2'' + m2 l1 l2 sin(θ1 - θ2) θ2'^2 + (m1 + m2) g l1 sin θ1 = 0";
  std::vector<double> seconds;
  for (int i = 0; i < 21; ++i) {
    const auto run = bench::run_process({MAUP_PROGRAM, "derive", PROJECT_DIR "/models/double_pendulum.lag"});
    require(run.exit_code == 0 && run.output.find(first) != std::string::npos, "equation of θ1");
    require(run.output.find("Certificate: passed") != std::string::npos, "certificate");
    seconds.push_back(run.seconds);
  }
  row("`maup derive models/double_pendulum.lag`, whole process, certified", milliseconds(median(seconds)), "30 ms",
      median(seconds) <= 0.030);
}

void check_chain() {
  const TemporaryModel model(bench::chain_text(100));
  std::vector<double> seconds;
  for (int i = 0; i < 11; ++i) {
    const auto run = bench::run_process({MAUP_PROGRAM, "check", model.path(), "--json"});
    require(run.exit_code == 0 && nlohmann::json::parse(run.output).at("freedoms") == 100, "freedoms of the chain");
    seconds.push_back(run.seconds);
  }
  row("`maup check` on the 100-link chain", milliseconds(median(seconds)), "100 ms", median(seconds) <= 0.1);
}

void readable_chain() {
  const auto model = bench::read(bench::chain_text(8));
  Derivation derivation;
  const double seconds = median_seconds(5, [&] {
    const auto fresh = bench::read(bench::chain_text(8));
    derivation = readable_derivation(bench::derive(fresh), false);
  });
  const EquationsOfMotion equations = bench::derive(model);
  const Derivation checked = readable_derivation(equations, false);
  require(certify(equations, &checked).passed(), "certificate of the 8-link chain");
  require(to_plain(checked.equations.at(7), equations.order).find("m l^2 cos(θ1 - θ8) θ1''") != std::string::npos,
          "textbook pattern of the 8-link chain");
  row("readable equations of the 8-link chain from points", milliseconds(seconds), "1 s", seconds <= 1);
}

/// The exponent p of cost ~ n^p between two sizes.
double exponent(double small, double large, double ratio) { return std::log(large / small) / std::log(ratio); }

void computational_chain() {
  const auto model = bench::read(bench::chain_text(100));
  const double seconds = median_seconds(3, [&] {
    const EquationsOfMotion equations = bench::derive(bench::read(bench::chain_text(100)));
    require(certify(equations, nullptr).passed(), "certificate of the 100-link chain");
  });
  row("computational form of the 100-link chain, derived and certified (b) to (d)", milliseconds(seconds), "1 s",
      seconds <= 1);

  double residual[2], matrix[2];
  for (int i = 0; i < 2; ++i) {
    const int links = i == 0 ? 50 : 200;
    residual[i] = median_seconds(3, [&] { bench::derive(bench::read(bench::chain_text(links))); });
    const EquationsOfMotion equations = bench::derive(bench::read(bench::chain_text(links)));
    matrix[i] = median_seconds(1, [&] { mass_matrix(equations); });
  }
  const double p = exponent(residual[0], residual[1], 4), q = exponent(matrix[0], matrix[1], 4);
  row("its residual, cost from 50 to 200 links", fmt::format("n^{:.2f}", p), "about n", p <= 1.5);
  row("its M, cost from 50 to 200 links", fmt::format("n^{:.2f}", q), "about n²", q <= 2.5);
}

void long_run() {
  const TemporaryModel model(
      "system double_pendulum\nparam m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord θ1, θ2 : angle\n"
      "point A mass m at l (sin θ1, -cos θ1)\npoint B mass m at A + l (sin θ2, -cos θ2)\ngravity (0, -g)\n"
      "start θ1 = 2.0 rad, θ2 = 2.5 rad\nrun 1000 s\n");
  const auto at =
      bench::run_process({MAUP_PROGRAM, "simulate", model.path(), "--at", "2s", "--duration", "2s", "--json"});
  const auto state = nlohmann::json::parse(at.output).at("at").at(0).at("state");
  require(std::abs(state.at("θ1").get<double>() + 2.922032235907541) < 1e-13, "θ1 at 2 s");
  require(std::abs(state.at("θ2").get<double>() - 0.11738517220261478) < 1e-13, "θ2 at 2 s");

  std::vector<double> seconds, peaks;
  double drift = 0;
  for (int i = 0; i < 5; ++i) {
    const auto run = bench::run_process({MAUP_PROGRAM, "simulate", model.path(), "--json"});
    require(run.exit_code == 0, "the run of 1000 s");
    const auto statistics = nlohmann::json::parse(run.output).at("statistics");
    seconds.push_back(statistics.at("seconds").get<double>());
    drift = std::max(drift, statistics.at("energy_drift").get<double>());
    peaks.push_back(static_cast<double>(run.peak_kilobytes) / 1024);
  }
  row("double pendulum, 1000 s at rounding level, interpreter", milliseconds(median(seconds)), "200 ms",
      median(seconds) <= 0.2);
  row("its relative energy error", fmt::format("{:.1e}", drift), "2e-12", drift <= 2e-12);
  row("its peak memory", fmt::format("{:.1f} MB", median(peaks)), "50 MB", median(peaks) <= 50);
}

/// Median stepping time of `maup simulate MODEL`, after `maup test` has found its reference values right.
/// every: the time between rows.
nlohmann::json constrained_run(const std::string& model, const char* duration, double& seconds,
                               const char* every = nullptr) {
  std::vector<double> times;
  nlohmann::json statistics;
  for (int i = 0; i < 5; ++i) {
    std::vector<std::string> arguments{MAUP_PROGRAM, "simulate", model, "--duration", duration, "--json"};
    if (every) arguments.insert(arguments.end(), {"--every", every});
    const auto run = bench::run_process(arguments);
    require(run.exit_code == 0, "a constrained run");
    statistics = nlohmann::json::parse(run.output).at("statistics");
    times.push_back(statistics.at("seconds").get<double>());
  }
  seconds = median(times);
  return statistics;
}

void constrained_runs() {
  const std::string problems = PROJECT_DIR "/tests/problems/";
  double seconds = 0;
  // The model's own expectations: 14 states and 7 accelerations at 0.03 s to 1e-10 relative.
  require(bench::run_process({MAUP_PROGRAM, "test", problems + "ivp_andrews.lag"}).exit_code == 0, "Andrews' squeezer");
  constrained_run(problems + "ivp_andrews.lag", "0.03s", seconds);
  row("Andrews' squeezer to t = 0.03, values to 1e-10 relative", milliseconds(seconds), "50 ms", seconds <= 0.05);
  constrained_run(problems + "ivp_andrews.lag", "0.03s", seconds, "0.03s");
  row("the same without rows on the way", milliseconds(seconds), "5 ms", seconds <= 0.005);

  require(bench::run_process({MAUP_PROGRAM, "test", problems + "ivp_fekete.lag"}).exit_code == 0, "Fekete's points");
  constrained_run(problems + "ivp_fekete.lag", "1000s", seconds);
  row("Fekete's points, 60 coordinates and 20 constraints, to t = 1000", fmt::format("{:.2f} s", seconds), "2 s",
      seconds <= 2);

  // 10,000 periods of 4 K(1/√2) √(l/g) from rest at 90°.
  const auto statistics = constrained_run(problems + "iftomm_a01_pendulum.lag", "23678.419475762374493s", seconds);
  const double residual = statistics.at("constraint_residual").get<double>(),
               drift = statistics.at("energy_drift").get<double>();
  row("pendulum in x and y over 10,000 periods", fmt::format("{:.2f} s", seconds), "", true);
  row("its constraint residual", fmt::format("{:.1e}", residual), "1e-14", residual <= 1e-14);
  row("its relative energy error", fmt::format("{:.1e}", drift), "1e-12", drift <= 1e-12);
}

}  // namespace

int main() {
  fmt::print("| what | measured | at most |\n|---|---|---|\n");
  int wrong = 0;
  for (const auto& section :
       {derive_double_pendulum, check_chain, readable_chain, computational_chain, long_run, constrained_runs}) {
    try {
      section();
    } catch (const std::exception& error) {
      ++wrong;
      fmt::print("| {} | failed | |\n", error.what());
    }
  }
  return wrong;
}
