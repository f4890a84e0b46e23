// 100 s of the double pendulum by several integrators at several tolerances: error of the energy against time. The
// others get a right-hand side written by hand and all optimizations of the compiler.
#include "chain.hpp"
#include "measure.hpp"

#include <benchmark/benchmark.h>
#include <boost/numeric/odeint.hpp>
#ifdef MAUPERTUIS_CVODE
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#endif

#include <array>
#include <cmath>
#include <functional>
#include <maupertuis/integrator.hpp>

namespace {

using bench::require;
using State = std::array<double, 4>;                 // θ1, θ2, θ1', θ2'
using Observer = std::function<void(const State&)>;  // empty: nothing is looked at, and the run is timed

constexpr double duration = 100;  // s
constexpr State begin{2.0, 2.5, 0, 0};

///     2 θ1'' + c θ2'' = −s θ2'² − 2 g sin θ1,    c θ1'' + θ2'' = s θ1'² − g sin θ2,    c, s of θ1 − θ2
inline void accelerations(const double* x, double* rate) {
  const double g = 9.81, s1 = std::sin(x[0]), c1 = std::cos(x[0]), s2 = std::sin(x[1]), c2 = std::cos(x[1]);
  const double c = c1 * c2 + s1 * s2, s = s1 * c2 - c1 * s2;
  const double r1 = -s * x[3] * x[3] - 2 * g * s1, r2 = s * x[2] * x[2] - g * s2;
  const double inverse = 1 / (2 - c * c);
  rate[0] = x[2], rate[1] = x[3];
  rate[2] = (r1 - c * r2) * inverse, rate[3] = (2 * r2 - c * r1) * inverse;
}

/// The largest relative error of the energy that the observer sees.
class EnergyError {
 public:
  void operator()(const State& x) {
    const bench::ChainEnergy energy = bench::chain_energy({x.data(), 2}, {x.data() + 2, 2});
    error_ = std::max(error_, std::abs(energy.value - value_));
    terms_ = std::max(terms_, energy.terms);
    ++calls_;
  }
  double relative() const {
    require(calls_ > 2, "nothing was observed");
    return error_ / terms_;
  }

 private:
  double value_ = bench::chain_energy({begin.data(), 2}, {begin.data() + 2, 2}).value, error_ = 0, terms_ = 0;
  int calls_ = 0;
};

State maupertuis_taylor(double tolerance, const Observer& observe) {
  using namespace maupertuis;
  static const bench::ChainMotion chain = bench::chain_motion(2);
  static double last = -1;
  static std::unique_ptr<TaylorStepper> stepper;
  if (!stepper || last != tolerance) {
    TaylorOptions options;
    options.tolerance = tolerance;
    options.backend = Backend::Compiled;
    stepper = std::make_unique<TaylorStepper>(chain.kernel, chain.parameters, options);
    bench::settle(*stepper, chain);
    last = tolerance;
  }
  const auto state = [&] { return State{stepper->q()[0], stepper->q()[1], stepper->v()[0], stepper->v()[1]}; };
  stepper->start(0, chain.q, chain.v);
  while (stepper->time() != duration) {
    require(stepper->step(duration).ending == StepEnding::None, "a step failed");
    if (observe) observe(state());
  }
  return state();
}

namespace odeint = boost::numeric::odeint;

template <class Stepper>
State odeint_run(Stepper stepper, const Observer& observe) {
  State x = begin;
  const auto right = [](const State& y, State& rate, double) { accelerations(y.data(), rate.data()); };
  if (observe)
    odeint::integrate_adaptive(stepper, right, x, 0.0, duration, 0.01, [&](const State& y, double) { observe(y); });
  else
    odeint::integrate_adaptive(stepper, right, x, 0.0, duration, 0.01);
  return x;
}

State odeint_fehlberg78(double tolerance, const Observer& observe) {
  return odeint_run(odeint::make_controlled<odeint::runge_kutta_fehlberg78<State>>(tolerance, tolerance), observe);
}

State odeint_bulirsch_stoer(double tolerance, const Observer& observe) {
  return odeint_run(odeint::bulirsch_stoer<State>(tolerance, tolerance), observe);
}

#ifdef MAUPERTUIS_CVODE

int cvode_right(realtype, N_Vector x, N_Vector rate, void*) {
  accelerations(N_VGetArrayPointer(x), N_VGetArrayPointer(rate));
  return 0;
}

State cvode_adams(double tolerance, const Observer& observe) {
  SUNContext context = nullptr;
  SUNContext_Create(nullptr, &context);
  N_Vector x = N_VNew_Serial(4, context);
  double* value = N_VGetArrayPointer(x);
  std::copy(begin.begin(), begin.end(), value);
  void* memory = CVodeCreate(CV_ADAMS, context);
  SUNNonlinearSolver solver = SUNNonlinSol_FixedPoint(x, 0, context);
  bool fine = CVodeInit(memory, cvode_right, 0, x) == CV_SUCCESS &&
              CVodeSStolerances(memory, tolerance, tolerance) == CV_SUCCESS &&
              CVodeSetNonlinearSolver(memory, solver) == CV_SUCCESS &&
              CVodeSetMaxNumSteps(memory, 100'000'000) == CV_SUCCESS &&
              CVodeSetStopTime(memory, duration) == CV_SUCCESS;
  for (double t = 0; fine && t < duration;) {
    fine = CVode(memory, duration, x, &t, observe ? CV_ONE_STEP : CV_NORMAL) >= 0;
    if (observe) observe({value[0], value[1], value[2], value[3]});
  }
  const State end{value[0], value[1], value[2], value[3]};
  SUNNonlinSolFree(solver);
  CVodeFree(&memory);
  N_VDestroy(x);
  SUNContext_Free(&context);
  require(fine, "CVODE ended early");
  return end;
}

#endif

/// Argument: the tolerance is 10^−digits.
void motion(benchmark::State& state, State (*integrate)(double, const Observer&)) {
  try {
    const double tolerance = std::pow(10.0, -static_cast<double>(state.range(0)));
    EnergyError energy;
    integrate(tolerance, std::ref(energy));
    require(energy.relative() < 1e-2, "energy");
    for (auto _ : state) benchmark::DoNotOptimize(integrate(tolerance, {}));
    state.counters["energy_error"] = energy.relative();
    state.counters["second_of_motion"] = benchmark::Counter(duration * static_cast<double>(state.iterations()),
                                                            benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  } catch (const std::exception& error) {
    state.SkipWithError(error.what());
  }
}

void digits(benchmark::internal::Benchmark* rows) {
  rows->ArgName("digits")->DenseRange(6, 14, 2)->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(motion, maupertuis, maupertuis_taylor)->Apply(digits)->Arg(16);
BENCHMARK_CAPTURE(motion, odeint_fehlberg78, odeint_fehlberg78)->Apply(digits);
BENCHMARK_CAPTURE(motion, odeint_bulirsch_stoer, odeint_bulirsch_stoer)->Apply(digits);
#ifdef MAUPERTUIS_CVODE
BENCHMARK_CAPTURE(motion, cvode_adams, cvode_adams)->Apply(digits);
#endif

}  // namespace

BENCHMARK_MAIN();
