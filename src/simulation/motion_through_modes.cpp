#include <maupertuis/motion_through_modes.hpp>

#include "simulation/energy_terms.hpp"
#include "simulation/hybrid_motion.hpp"

#include <maupertuis/evaluate.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace maupertuis {

struct MotionThroughModes::Impl {
  HybridMotion motion;
};

namespace {

WantedFunctions wanted_of(const EquationsOfMotion& equations, Expr until) {
  WantedFunctions out;
  out.observables = energy_terms(equations);
  if (until) out.events.push_back(until);
  return out;
}

}  // namespace

bool jumps_on_its_way(const Model& model) {
  const auto& events = model.experiment.events;
  return model.system.has_modes() || std::any_of(events.begin(), events.end(), [](const ModelEvent& e) {
           return e.action != ModelEvent::Action::Record;
         });
}

MotionThroughModes::MotionThroughModes(const Model& model, const EquationsOfMotion& equations, Expr until,
                                       const TaylorOptions& options)
    : impl_(
          std::unique_ptr<Impl>(new Impl{{std::make_shared<ModeLibrary>(model, equations, wanted_of(equations, until)),
                                          parameter_values(model.system), options}})) {}
MotionThroughModes::~MotionThroughModes() = default;
MotionThroughModes::MotionThroughModes(MotionThroughModes&&) noexcept = default;

void MotionThroughModes::keep_instants() { impl_->motion.keep_instants(); }
void MotionThroughModes::start(double t, std::span<const double> q, std::span<const double> v) {
  impl_->motion.start(t, q, v);
}
void MotionThroughModes::set_usual_sizes(std::span<const double> q, std::span<const double> v) {
  impl_->motion.set_usual_sizes(q, v);
}
Step MotionThroughModes::step(double bound) { return impl_->motion.step(bound); }
double MotionThroughModes::time() const { return impl_->motion.time(); }
std::size_t MotionThroughModes::steps() const { return impl_->motion.steps(); }
Sample MotionThroughModes::sample(double t) const { return impl_->motion.sample(t); }
void MotionThroughModes::state(double t, std::span<double> q, std::span<double> v) const {
  impl_->motion.state(t, q, v);
}
MotionState MotionThroughModes::state() const {
  const Sample here = impl_->motion.sample(impl_->motion.time());
  return {here.t, here.q, here.v};
}
const ModeInstant* MotionThroughModes::instant() const { return impl_->motion.instant(); }
const ContactMode& MotionThroughModes::mode() const { return impl_->motion.mode(); }
bool MotionThroughModes::begins_to_slide() const { return impl_->motion.begins_to_slide(); }
const EquationsOfMotion& MotionThroughModes::equations_in(const ContactMode& mode) {
  return impl_->motion.equations_in(mode);
}
const std::optional<std::string>& MotionThroughModes::stopped_by() const { return impl_->motion.record().stopped_by; }

// ----------------------------------------------------------------------------------------------------- one impact

struct SingleImpact::Impl {
  const EquationsOfMotion& equations;
  ContactFunctions functions;
};

SingleImpact::SingleImpact(const EquationsOfMotion& equations)
    : impl_(std::unique_ptr<Impl>(
          new Impl{equations, ContactFunctions(equations, parameter_values(*equations.system))})) {}
SingleImpact::~SingleImpact() = default;

double SingleImpact::rate(std::size_t contact, const MotionState& state) {
  return impl_->functions.at(state.t, state.q, state.v).rate[contact];
}

std::vector<double> SingleImpact::after(std::size_t contact, const MotionState& state) {
  const ContactValues& values = impl_->functions.at(state.t, state.q, state.v);
  const MechanicalSystem& system = *impl_->equations.system;
  const Eigen::VectorXd v =
      Eigen::Map<const Eigen::VectorXd>(state.v.data(), static_cast<Eigen::Index>(state.v.size()));
  ImpactProblem p;
  p.contacts = {contact};
  p.normal = {values.normal[contact]};
  p.tangent = {values.tangent[contact]};
  p.drive = {values.drive[contact]};
  p.slip_drive = {values.slip[contact] - dot(values.tangent[contact], v)};
  p.restitution = {values.restitution[contact]};
  p.friction = {values.kinetic[contact]};
  p.static_friction = {values.fixed[contact]};
  p.sticking = {system.contacts[contact].friction.sticking};
  p.rest = {0};
  p.response = impl_->functions.response(state.t, state.q, state.v, p.normal);
  p.second_tangent = {values.second_tangent[contact]};
  p.second_drive = {values.second_slip[contact] - dot(values.second_tangent[contact], v)};
  p.tangent_response = impl_->functions.response(state.t, state.q, state.v, p.tangent);
  p.second_response = impl_->functions.response(state.t, state.q, state.v, p.second_tangent);
  const ImpactResult found = sequential_impact(p, v, ImpactOrder::FastestFirst);
  return {found.v.data(), found.v.data() + found.v.size()};
}

}  // namespace maupertuis
