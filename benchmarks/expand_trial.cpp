// trial: expand by two emitters in turn
#include "chain.hpp"
#include "measure.hpp"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <maupertuis/kernel.hpp>
using namespace maupertuis;
int main(int argc, char** argv) {
  const int n = std::atoi(argv[1]), rounds = argc > 2 ? std::atoi(argv[2]) : 41;
  const int only = argc > 3 ? std::atoi(argv[3]) : -1;
  const bench::ChainMotion chain = bench::chain_motion(n);
  std::vector<KernelWorkspace> w;
  for (int v = 0; v < 3; ++v) {
    w.emplace_back(chain.kernel, 20);
    w[v].set_parameters(chain.parameters);
    setenv("MAUP_TRIAL", v == 2 ? (std::getenv("WHICH") ? std::getenv("WHICH") : "2") : "0", 1);
    CompileOptions options;
    options.long_run = true;
    options.cache = false;
    if (v == 0 || (only >= 0 && v - 1 != only)) continue;
    for (int times = 0; times < (only >= 0 ? 1 : 3); ++times) {
    const double begin = bench::thread_seconds();
    const CompileReport report = w[v].compile(options);
    const double took = bench::thread_seconds() - begin;
    if (times == 0 || times == 2) fmt::print("variant {} compiled {} : {:.0f} ms thread, {}\n", v - 1, report.compiled, 1e3 * took, report.trouble);
    }
  }
  constexpr int states = 16;
  std::vector<std::vector<double>> qs, vs;
  for (int s = 0; s < states; ++s) {
    qs.push_back(chain.q), vs.push_back(chain.v);
    for (int i = 0; i < n; ++i) qs[s][i] += 0.01 * s, vs[s][i] = 0.1 * s * (i % 2 ? -1 : 1) + 0.03 * i;
  }
  for (int v = 1; v < 3 && only < 0; ++v)  {
    double worst = 0;
    for (int s = 0; s < states; ++s) {
      bench::require(w[0].expand(0, qs[s], vs[s]) == KernelStatus::Ok, "a");
      bench::require(w[v].expand(0, qs[s], vs[s]) == KernelStatus::Ok, "b");
      for (int k = 0; k <= 21; ++k)
        for (int i = 0; i < n; ++i) {
          const double a = w[0].coordinate(k)[i], b = w[v].coordinate(k)[i];
          worst = std::max(worst, std::abs(a - b) / (1e-300 + std::abs(a)));
        }
    }
    fmt::print("variant {} worst {:.2e}\n", v - 1, worst);
  }
  const int turns = only >= 0 ? 1 : 2000 / n;
  const auto time = [&](KernelWorkspace& x) {
    const double begin = bench::thread_seconds();
    for (int t = 0; t < turns; ++t)
      for (int s = 0; s < states; ++s)
        if (x.expand(0, qs[s], vs[s]) != KernelStatus::Ok) std::abort();
    return 1e9 * (bench::thread_seconds() - begin) / (turns * states);
  };
  if (only >= 0) {
    for (int r = 0; r < rounds; ++r) time(w[only + 1]);
    return 0;
  }
  std::vector<double> a, b, ratio;
  for (int r = 0; r < rounds; ++r) {
    a.push_back(time(w[1])), b.push_back(time(w[2]));
    ratio.push_back(b.back() / a.back());
  }
  const auto median = [](std::vector<double> x) { std::sort(x.begin(), x.end()); return x[x.size() / 2]; };
  fmt::print("n {} unrolled {:.1f} (least {:.1f}) trial {:.1f} (least {:.1f}) ratio {:.3f}\n", n, median(a),
             *std::min_element(a.begin(), a.end()), median(b), *std::min_element(b.begin(), b.end()), median(ratio));
}
