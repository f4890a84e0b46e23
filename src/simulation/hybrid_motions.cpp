#include "simulation/hybrid_motions.hpp"

#include <algorithm>
#include <utility>

namespace maupertuis::hybrid {
namespace {

constexpr std::size_t most_modes = 128;  // whose motions are kept

}  // namespace

/// Recorded events end no step, nor do those of one direction that are passed in the other.
void ModeMotions::treat_events(ModeMotion& motion) const {
  std::vector<TaylorStepper::EventTreatment> treatments;
  for (const Watch& w : motion.watches()) {
    const ModelEvent* const event = w.what == Watch::What::Event ? &problem_.model.experiment.events[w.index] : nullptr;
    const bool is_recorded = event && event->action == ModelEvent::Action::Record;
    treatments.push_back({!is_recorded, w.touches_count() || tells_touches_, event ? event->direction : 0});
  }
  motion.stepper->treat_events(treatments);
}

void ModeMotions::tell_touches() {
  tells_touches_ = true;
  for (const auto& [key, motion] : modes_) treat_events(*motion);
}

/// A heap goes through thousands of modes: those that were last asked for stay.
void ModeMotions::forget_oldest() {
  if (modes_.size() <= most_modes) return;
  const auto older = [this](const auto& a, const auto& b) {
    if ((a.second.get() == now_) != (b.second.get() == now_)) return b.second.get() == now_;
    return a.second->asked_for < b.second->asked_for;
  };
  modes_.erase(std::min_element(modes_.begin(), modes_.end(), older));
}

ModeMotion& ModeMotions::in(const ContactMode& mode, const Given& given) {
  const ModeDetails details{problem_.in_space ? slips_.stop_speeds() : std::vector<double>(), given.is_preload,
                            given.begins};
  std::string key = key_of(mode, details);
  const auto known = modes_.find(key);
  if (!given.values.empty() && known != modes_.end() && known->second.get() == now_) key += " again";
  std::unique_ptr<ModeMotion>& slot = modes_[key];
  ++asked_for_;
  const bool is_known = slot && slot->given == given;
  if (!is_known) slot = made(mode, given, details);
  ModeMotion& out = *slot;
  out.asked_for = asked_for_;
  if (!is_known) forget_oldest();
  return out;
}

std::unique_ptr<ModeMotion> ModeMotions::made(const ContactMode& mode, const Given& given,
                                              const ModeDetails& details) const {
  auto out = std::make_unique<ModeMotion>();
  out->mode = mode;
  out->given = given;
  out->stops = details.stops;
  out->program = problem_.library->program(mode, details);
  std::vector<double> parameters = problem_.parameters;
  parameters.insert(parameters.end(), given.values.begin(), given.values.end());
  TaylorOptions options = problem_.options;
  if (std::find(mode.friction.begin(), mode.friction.end(), FrictionState::Slide) != mode.friction.end())
    options.order = order_beside_stops(options);
  out->stepper = std::make_unique<TaylorStepper>(out->program->kernel, parameters, options);
  treat_events(*out);
  return out;
}

bool ModeMotions::covers(double t) const { return stepper().covers(covered(t)); }

void ModeMotions::state(double t, std::span<double> q, std::span<double> v) const {
  stepper().state(covered(t), q, v);
  passed_moment_.move_back(t, stepper().step_start().t, q, v);
}

/// Of the multipliers those of the system's own constraints, with what is given of them.
Sample ModeMotions::with_given(Sample sample) const {
  const std::size_t own = problem_.equations.system->constraints.size();
  if (now_->given.is_preload && sample.multipliers.size() >= own)
    for (std::size_t k = 0, made = sample.multipliers.size() - own; k < own; ++k)
      sample.multipliers[k] += now_->given.preload(made + k, sample.t);
  sample.multipliers.resize(own);
  return sample;
}

Sample ModeMotions::sample(double t) const {
  Sample out = with_given(stepper().sample(covered(t)));
  passed_moment_.move_back(t, stepper().step_start().t, out.q, out.v);
  out.t = t;
  return out;
}

Sample ModeMotions::step_start() const { return with_given(stepper().step_start()); }

void ModeMotions::forget(const ContactMode& mode) {
  std::erase_if(modes_, [&](const auto& entry) { return entry.second->mode == mode && entry.second.get() != now_; });
}

std::optional<Outlook> ModeMotions::outlook_in(const ContactMode& mode, double bound) {
  TaylorStepper& stepper = *in(mode).stepper;
  stepper.start(here_.t, here_.q, here_.v, here_.t_rest);
  Outlook outlook = stepper.outlook(bound);
  if (outlook.ending != StepEnding::None) return std::nullopt;
  return outlook;
}

const EquationsOfMotion& ModeMotions::equations_in(const ContactMode& mode) {
  // Events alone: also the equations that were found for a degenerate Lagrangian.
  if (!problem_.system.has_modes()) return problem_.equations;
  std::unique_ptr<EquationsOfMotion>& slot = equations_[key_of(mode, {slips_.stop_speeds(), false, {}})];
  if (slot) return *slot;
  Diagnostics unheard;  // the system passed its checks with its contacts
  MechanicalSystem in_mode = system_in_mode(problem_.system, mode);
  in_mode.written = nullptr;
  slot = std::make_unique<EquationsOfMotion>(
      *euler_lagrange(std::make_shared<const MechanicalSystem>(std::move(in_mode)), unheard));
  return *slot;
}

}  // namespace maupertuis::hybrid
