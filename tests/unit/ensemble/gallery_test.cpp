#include "systems.hpp"

#include <doctest/doctest.h>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/simulation.hpp>

#include <fstream>
#include <sstream>

// Models of the gallery in lanes against TaylorStepper. Both follow the same motion with the same tolerance, but round
// differently, so that they agree as far as the motion lets rounding errors grow.

namespace {

using namespace maupertuis;

struct GalleryModel {
  std::shared_ptr<const Model> model;
  EquationsOfMotion equations;
  MotionState start;

  explicit GalleryModel(const std::string& name) {
    std::ostringstream text;
    text << std::ifstream(std::string(PROJECT_DIR) + "/models/" + name + ".lag").rdbuf();
    const SourceText source(name, text.str());
    Diagnostics diagnostics;
    auto elaborated = elaborate(syntax::parse(source, diagnostics), source, diagnostics);
    REQUIRE(elaborated);
    model = std::make_shared<const Model>(std::move(*elaborated));
    auto derived = euler_lagrange({model, &model->system}, diagnostics);
    REQUIRE(derived);
    equations = std::move(*derived);
    const auto begin = consistent_start(*model, equations, diagnostics);
    REQUIRE(begin);
    start = begin->state;
  }
};

struct Agreement {
  std::string name;
  double duration, bound;  // s; of the distance, relative to the size of the state
  bool conservative = true;
};

void check_agreement(const Agreement& a) {
  CAPTURE(a.name);
  const GalleryModel gallery(a.name);
  const MotionKernel motion = motion_kernel(gallery.equations);
  const Kernel& kernel = motion.kernel;
  Trajectories input;
  for (int i = 0; i < 11; ++i) {
    std::vector<double> q = gallery.start.q, v = gallery.start.v;
    for (double& x : q) x *= 1 + 0.002 * i;
    for (double& x : v) x *= 1 - 0.003 * i;
    input.add(q, v, a.duration);
  }
  input.parameters = motion.parameters;
  EnsembleOptions options;
  options.energy_terms = motion.energy_terms;
  const EnsembleResult result = advance_ensemble(kernel, input.start(), options);
  CHECK(result.width > 0);
  for (std::size_t i = 0; i < input.count(); ++i) {
    CAPTURE(i);
    CHECK_FALSE(result.endings[i].alone);
    if (a.conservative) CHECK(result.endings[i].energy_drift < 2e-14);
    TaylorStepper stepper(kernel, input.parameters, {});
    stepper.start(0, input.q_of(i), input.v_of(i));
    while (stepper.time() != a.duration) REQUIRE(stepper.step(a.duration).ending == StepEnding::None);
    CHECK(std::abs(static_cast<double>(result.endings[i].steps) - static_cast<double>(stepper.steps())) <=
          1 + 0.02 * static_cast<double>(stepper.steps()));
    for (std::size_t k = 0; k < input.n; ++k) {
      CHECK(std::abs(result.q_of(i)[k] - stepper.q()[k]) <= a.bound * (1 + std::abs(stepper.q()[k])));
      CHECK(std::abs(result.v_of(i)[k] - stepper.v()[k]) <= a.bound * (1 + std::abs(stepper.v()[k])));
    }
  }
}

}  // namespace

TEST_CASE("models of the gallery move in lanes as they do alone") {
  for (const Agreement& a : std::vector<Agreement>{{"pendulum", 10, 1e-12},
                                                   {"double_pendulum", 3, 1e-11},
                                                   {"cart_pendulum", 5, 1e-12, false},
                                                   {"elastic_pendulum", 5, 1e-11},
                                                   {"spherical_pendulum", 5, 1e-12},
                                                   {"rotating_frame", 5, 1e-12},
                                                   {"lagrange_top", 1, 1e-11},
                                                   {"robot_arm", 1, 1e-12, false},
                                                   {"bead_on_hoop", 5, 1e-12},
                                                   {"satellite", 5, 1e-11}})
    check_agreement(a);
}
