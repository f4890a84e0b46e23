#include "simulation/hybrid_motion.hpp"

#include "simulation/motion_kernel.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/motion_kernel.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace maupertuis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double rest_unit = 64 * epsilon;        // of the sizes of terms: below, a gap or a speed is 0
constexpr std::size_t most_at_once = 1000;        // changes at the same time
constexpr std::size_t most_happenings = 10'000'000;
constexpr std::size_t most_choices = 4096;        // modes that are tried

VectorXd vector_of(std::span<const double> x) {
  return Eigen::Map<const VectorXd>(x.data(), static_cast<Index>(x.size()));
}

std::string key_of(const ContactMode& mode) {
  std::string key;
  for (const bool closed : mode.closed) key += closed ? '1' : '0';
  for (const FrictionState state : mode.friction) key += static_cast<char>('a' + static_cast<int>(state));
  for (const std::int8_t sign : mode.normal_sign) key += sign < 0 ? '-' : '+';
  return key;
}

/// Normal forces in multipliers alone.
MechanicalSystem with_plain_normals(const EquationsOfMotion& equations) {
  MechanicalSystem out = *equations.system;
  for (Friction& f : out.frictions)
    if (f.normal) f.normal = with_reactions(equations, {&f.normal, 1}).front();
  return out;
}

bool has_multipliers(Expr e) {
  if (!e) return false;
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() == Role::Multiplier) return true;
  return false;
}

}  // namespace

/// An event function of a mode, and what a root of it means.
struct HybridMotion::Watch {
  enum class What { Until, Event, Gap, Force, Hold, Slip, Normal } what = What::Event;
  std::size_t index = 0;  // of the event, the contact, the friction
  bool keeps_sign() const { return what != What::Until && what != What::Event; }  // must not be negative in its mode
};

struct HybridMotion::ModeMotion {
  ContactMode mode;
  std::unique_ptr<EquationsOfMotion> equations;
  std::vector<Watch> watches;
  std::unique_ptr<TaylorStepper> stepper;
};

/// What a step has met, to be settled before the next one.
struct HybridMotion::Pending {
  std::vector<std::size_t> hit;      // contacts whose gap came to 0
  std::vector<Watch> left;           // conditions of the mode that end here
  std::vector<const ModelEvent*> sets;
  bool begins = false;
};

/// What a contact or a friction may do next, the likeliest first.
struct HybridMotion::Choice {
  std::size_t contact = 0;   // or contacts + friction of a coordinate
  struct Option {
    bool closed = false;
    FrictionState state = FrictionState::None;
    std::int8_t normal_sign = 1;
  };
  std::vector<Option> options;
};

// -------------------------------------------------------------------------------------------------------- the modes

HybridMotion::HybridMotion(const Model& model, const EquationsOfMotion& equations, const WantedFunctions& wanted,
                           std::vector<double> parameters, const TaylorOptions& options)
    : model_(model),
      equations_(equations),
      wanted_(wanted),
      parameters_(std::move(parameters)),
      options_(options),
      system_(with_plain_normals(equations)),
      functions_(equations, parameters_) {
  parameters_.resize(system_.parameters.size());
  ExprVector functions;
  for (const ModelEvent& e : model.experiment.events) functions.push_back(e.function);
  const std::vector<Expr> plain = with_reactions(equations, functions);
  wanted_.events.insert(wanted_.events.end(), plain.begin(), plain.end());
}

HybridMotion::~HybridMotion() = default;

/// Gaps of open contacts; λ of closed ones.
void HybridMotion::watch_contacts(ModeMotion& motion, std::vector<Expr>& events) {
  for (std::size_t i = 0; i < system_.contacts.size(); ++i) {
    const Contact& c = system_.contacts[i];
    motion.watches.push_back({motion.mode.closed[i] ? Watch::What::Force : Watch::What::Gap, i});
    events.push_back(motion.mode.closed[i] ? c.multiplier : c.gap);
  }
}

/// What holds while it sticks, |λ_t| ≤ μ_s N; the direction in which it slides; the sign of its normal force.
void HybridMotion::watch_frictions(ModeMotion& motion, std::vector<Expr>& events) {
  const std::size_t contacts = system_.contacts.size();
  for (std::size_t i = 0; i < motion.mode.friction.size(); ++i) {
    const FrictionState state = motion.mode.friction[i];
    if (state == FrictionState::None) continue;
    const Friction& f = friction_of(system_, i);
    Expr normal = i < contacts ? system_.contacts[i].multiplier : f.normal;
    if (i >= contacts && normal && motion.mode.normal_sign[i - contacts] < 0) normal = -normal;
    if (state == FrictionState::Stick) {
      if (f.sticking) continue;
      const Expr most = normal ? f.static_ * normal : f.static_;
      for (const Expr& event : {most - f.multipliers[0], most + f.multipliers[0]}) {
        motion.watches.push_back({Watch::What::Hold, i});
        events.push_back(event);
      }
    } else {
      motion.watches.push_back({Watch::What::Slip, i});
      events.push_back(state == FrictionState::Forward ? f.slip[0] : -f.slip[0]);
    }
    if (i >= contacts && has_multipliers(normal)) {
      motion.watches.push_back({Watch::What::Normal, i - contacts});
      events.push_back(normal);
    }
  }
}

HybridMotion::ModeMotion& HybridMotion::motion_in(const ContactMode& mode) {
  std::unique_ptr<ModeMotion>& slot = modes_[key_of(mode)];
  if (slot) return *slot;
  slot = std::make_unique<ModeMotion>();
  slot->mode = mode;
  Diagnostics unheard;  // the system passed its checks with its contacts
  MechanicalSystem in_mode = system_in_mode(system_, mode);
  in_mode.written = nullptr;
  slot->equations = std::make_unique<EquationsOfMotion>(
      *euler_lagrange(std::make_shared<const MechanicalSystem>(std::move(in_mode)), unheard));
  Context& context = *system_.context;
  WantedFunctions wanted = wanted_;
  const bool until = wanted_.events.size() > model_.experiment.events.size();
  for (std::size_t i = 0; i < wanted.events.size(); ++i)
    slot->watches.push_back(until && i == 0 ? Watch{Watch::What::Until, 0} : Watch{Watch::What::Event, i - until});
  watch_contacts(*slot, wanted.events);
  watch_frictions(*slot, wanted.events);
  ExprVector rubbed{context.number(0)}, damped{context.number(0)};
  for (std::size_t i = 0; i < mode.friction.size(); ++i) {
    if (mode.friction[i] != FrictionState::Forward && mode.friction[i] != FrictionState::Backward) continue;
    const Friction& f = friction_of(system_, i);
    const std::size_t contacts = system_.contacts.size();
    Expr normal = i < contacts ? system_.contacts[i].multiplier : f.normal;
    if (i >= contacts && mode.normal_sign[i - contacts] < 0) normal = -normal;
    const Expr force = normal ? f.kinetic * normal : f.kinetic;
    rubbed.push_back(mode.friction[i] == FrictionState::Forward ? force * f.slip[0] : -(force * f.slip[0]));
  }
  for (std::size_t i = 0; i < system_.coordinates.size(); ++i)
    damped.push_back(equations_.dissipative_terms[i] * system_.coordinates[i].velocity);
  wanted.integrands = {slot->equations->power, context.sum(rubbed), context.sum(damped)};
  ExprMap open;  // forces that do not act in this mode
  for (std::size_t i = 0; i < mode.closed.size(); ++i)
    if (!mode.closed[i]) open[system_.contacts[i].multiplier] = context.number(0);
  for (auto* list : {&wanted.observables, &wanted.events, &wanted.integrands})
    if (!open.empty() && !list->empty()) *list = substitute(*list, open);
  slot->stepper = std::make_unique<TaylorStepper>(motion_kernel(*slot->equations, wanted), parameters_, options_);
  return *slot;
}

void HybridMotion::leave_mode() {
  if (!now_) return;
  const TaylorStepper& s = *now_->stepper;
  const Sample last = s.sample(s.time());
  for (std::size_t k = 0; k < 3; ++k) carried_[k] += last.integrals[k];
  steps_before_ += s.steps(), rejected_before_ += s.rejected(), switches_before_ += s.switches();
  residual_before_ = std::max(residual_before_, s.constraint_residual());
}

// --------------------------------------------------------------------------------------------------- as any method

int HybridMotion::order() const { return now_->stepper->order(); }

void HybridMotion::start(double t, std::span<const double> q, std::span<const double> v) {
  t_ = t;
  q_.assign(q.begin(), q.end());
  v_.assign(v.begin(), v.end());
  std::fill(std::begin(carried_), std::end(carried_), 0.0);
  steps_before_ = rejected_before_ = switches_before_ = same_time_ = 0;
  residual_before_ = 0;
  fastest_.assign(system_.contacts.size(), 0);
  fastest_slip_.assign(system_.contacts.size() + system_.frictions.size(), 0);
  widest_ = hardest_ = compliance_ = fastest_;
  kind_.clear();
  for (std::size_t i = 0; i < system_.coordinates.size(); ++i) {
    std::size_t k = 0;
    while (!(system_.coordinates[k].dimension == system_.coordinates[i].dimension)) ++k;
    kind_.push_back(k);
  }
  gap_kind_.clear();
  for (std::size_t i = 0; i < system_.contacts.size(); ++i) {
    std::size_t k = 0;
    while (!(system_.contacts[k].dimension == system_.contacts[i].dimension)) ++k;
    gap_kind_.push_back(k);
  }
  speed_.assign(kind_.size(), 0);
  acceleration_ = place_ = speed_;
  bounces_.assign(system_.contacts.size(), {});
  record_ = {};
  started_ = false;
  now_ = &motion_in(open_mode(system_));
  now_->stepper->start(t_, q_, v_);
  pending_ = std::make_unique<Pending>();
  pending_->begins = true;
  forwards_ = true;
  failed_ = settle(t + 1);
  std::fill(std::begin(carried_), std::end(carried_), 0.0);  // work before the first sample
}

double HybridMotion::time() const { return now_->stepper->time(); }
bool HybridMotion::covers(double t) const { return now_->stepper->covers(t); }
std::size_t HybridMotion::steps() const { return steps_before_ + now_->stepper->steps(); }
std::size_t HybridMotion::rejected() const { return rejected_before_ + now_->stepper->rejected(); }
std::size_t HybridMotion::switches() const { return switches_before_ + now_->stepper->switches(); }
double HybridMotion::constraint_residual() const {
  return std::max(residual_before_, now_->stepper->constraint_residual());
}
BackendUse HybridMotion::backend() const { return now_->stepper->backend(); }
void HybridMotion::state(double t, std::span<double> q, std::span<double> v) const { now_->stepper->state(t, q, v); }

Sample HybridMotion::adjusted(Sample sample) const {
  sample.multipliers.resize(equations_.system->constraints.size());
  for (std::size_t k = 0; k < sample.integrals.size(); ++k) sample.integrals[k] += carried_[k];
  return sample;
}
Sample HybridMotion::sample(double t) const { return adjusted(now_->stepper->sample(t)); }
const Sample& HybridMotion::step_start() const { return step_start_ = adjusted(now_->stepper->step_start()); }

Step HybridMotion::ended(StepEnding ending, std::string reason) const {
  Step out;
  out.begin = out.end = time();
  out.ending = ending;
  out.reason = std::move(reason);
  return out;
}

Step HybridMotion::step(double bound) {
  if (failed_) return *failed_;
  forwards_ = bound >= time();
  if (pending_) {
    if (auto failed = settle(bound)) return std::move(*failed);
  }
  Step out = now_->stepper->step(bound);
  if (out.end != out.begin) same_time_ = 0;
  if (out.ending != StepEnding::None) return out;
  if (!system_.contacts.empty())
    if (const auto contact = violated())
      return ended(StepEnding::Paradox,
                   fmt::format("The motion went through the contact {} without a sign of it: bounces have become too small "
                               "to be told apart.",
                               system_.contact_label(*contact)));
  if (!out.events.empty()) classify(out);
  return out;
}

// ------------------------------------------------------------------------------------------------ at an instant

void HybridMotion::remark(const std::string& sentence) {
  if (std::find(record_.remarks.begin(), record_.remarks.end(), sentence) == record_.remarks.end())
    record_.remarks.push_back(sentence);
}

void HybridMotion::add(Happening::Kind kind, const std::string& name, double impulse, double speed,
                       const std::string& text) {
  record_.happenings.push_back({kind, t_, 0, name, impulse, speed, text, {}, q_, v_});
}

/// Roots of the step: events of the model are recorded at once; what changes the mode waits for the next step.
void HybridMotion::classify(Step& step) {
  const auto& s = *now_->stepper;
  t_ = s.time();
  q_.assign(s.q().begin(), s.q().end());
  v_.assign(s.v().begin(), s.v().end());
  step.event.reset();
  auto pending = std::make_unique<Pending>();
  for (const EventRoot& root : step.events) {
    const Watch& watch = now_->watches[root.event];
    if (watch.what == Watch::What::Until) {
      step.event = 0;
    } else if (watch.what == Watch::What::Event) {
      const ModelEvent& event = model_.experiment.events[watch.index];
      if (event.direction != 0 && root.direction != event.direction * (forwards_ ? 1 : -1)) continue;
      add(Happening::Kind::Event, event.name);
      if (event.action == ModelEvent::Action::Stop && !record_.stopped_by) {
        record_.stopped_by = event.name;
        step.event = 0;
      }
      if (event.action == ModelEvent::Action::Set) pending->sets.push_back(&event);
    } else if (root.direction <= 0) {
      if (watch.what == Watch::What::Gap)
        pending->hit.push_back(watch.index);
      else
        pending->left.push_back(watch);
    }
  }
  step.events.clear();
  if (!pending->hit.empty() || !pending->left.empty() || !pending->sets.empty()) pending_ = std::move(pending);
}

/// ġ below this counts as 0.
double HybridMotion::rest_speed(std::size_t contact, const ContactValues& values) const {
  return rest_unit * std::max(values.rate_scale[contact], fastest_[contact]);
}
double HybridMotion::rest_slip(std::size_t friction, const ContactValues& values) const {
  return rest_unit * std::max(values.slip_scale[friction], fastest_slip_[friction]);
}

/// Motions of one kind of coordinates have one size: a pendulum that hangs still among others that swing is at rest to
/// rounding of their motion, not of its own.
void HybridMotion::note_sizes(const ContactValues& values) {
  for (std::size_t i = 0; i < v_.size(); ++i) {
    place_[kind_[i]] = std::max(place_[kind_[i]], std::abs(q_[i]));
    speed_[kind_[i]] = std::max(speed_[kind_[i]], std::abs(v_[i]));
  }
  const auto size_along = [&](const SparseRow& row) {
    double sum = 0;
    for (const auto& [k, x] : row) sum += std::abs(x) * speed_[kind_[k]];
    return sum;
  };
  for (std::size_t i = 0; i < fastest_.size(); ++i)
    fastest_[i] = std::max({fastest_[i], values.rate_scale[i], size_along(values.normal[i])});
  note_gaps(values);
  for (std::size_t i = 0; i < fastest_slip_.size(); ++i)
    fastest_slip_[i] = std::max({fastest_slip_[i], values.slip_scale[i], size_along(values.tangent[i])});
}

/// Gaps of one dimension have one size too.
void HybridMotion::note_gaps(const ContactValues& values) {
  for (std::size_t i = 0; i < widest_.size(); ++i) {
    double& size = widest_[gap_kind_[i]];
    size = std::max(size, values.gap_scale[i]);
  }
  for (std::size_t i = 0; i < widest_.size(); ++i) widest_[i] = widest_[gap_kind_[i]];
}

void HybridMotion::note_accelerations(std::span<const double> a, const ContactValues& values) {
  for (std::size_t i = 0; i < a.size(); ++i)
    acceleration_[kind_[i]] = std::max(acceleration_[kind_[i]], std::abs(a[i]));
  for (std::size_t i = 0; i < hardest_.size(); ++i) {
    if (compliance_[i] == 0) continue;
    double size = 0;
    for (const auto& [k, g] : values.normal[i]) size += std::abs(g) * acceleration_[kind_[k]];
    hardest_[i] = std::max(hardest_[i], size / compliance_[i]);
  }
}

void HybridMotion::note_compliance(const std::vector<std::size_t>& touching, const ContactValues& values) {
  std::vector<SparseRow> rows;
  for (const std::size_t i : touching) rows.push_back(values.normal[i]);
  const Eigen::MatrixXd response = functions_.response(t_, q_, v_, rows);
  for (std::size_t k = 0; k < touching.size(); ++k)
    compliance_[touching[k]] = std::abs(dot(rows[k], response.col(static_cast<Index>(k))));
}

/// An open contact whose gap has become negative though no step saw it close: then nothing of the motion holds.
std::optional<std::size_t> HybridMotion::violated() {
  constexpr double digits = 1e-10;
  const TaylorStepper& s = *now_->stepper;
  const ContactValues& values = functions_.at(s.time(), s.q(), s.v());
  note_gaps(values);
  for (std::size_t i = 0; i < values.gap.size(); ++i)
    if (!now_->mode.closed[i] && values.gap[i] < -digits * widest_[i]) return i;
  return std::nullopt;
}

/// Contacts with g = 0: closed ones, those that were hit, and those whose gap is rounding.
std::vector<std::size_t> HybridMotion::touching(const ContactValues& values) const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < values.gap.size(); ++i) {
    const bool hit = std::find(pending_->hit.begin(), pending_->hit.end(), i) != pending_->hit.end();
    if (hit || now_->mode.closed[i] || std::abs(values.gap[i]) <= rest_unit * widest_[i]) out.push_back(i);
  }
  return out;
}

/// Assigns what events set, all from the values before.
bool HybridMotion::carry_out_sets(std::string& reason) {
  Bindings bindings;
  for (std::size_t i = 0; i < q_.size(); ++i) {
    bindings[system_.coordinates[i].q] = q_[i];
    bindings[system_.coordinates[i].velocity] = v_[i];
  }
  for (std::size_t i = 0; i < parameters_.size(); ++i) bindings[system_.parameters[i].symbol] = parameters_[i];
  bindings[system_.context->time()] = t_;
  const std::string before = pending_->sets.front()->name;
  std::vector<double> q = q_, v = v_;
  for (const ModelEvent* event : pending_->sets)
    for (const ModelEvent::Assignment& a : event->sets)
      (a.order == 0 ? q : v)[a.coordinate] =
          evaluate(in_terms_of_motion(system_, {&a.value, 1}).front(), bindings);
  constexpr double digits = 1e-9;
  if (system_.constrained()) {
    const ConstraintManifold manifold(equations_);
    const MotionState state{t_, q, v};
    const auto off = manifold.relative_values(state), rates = manifold.relative_rates(state);
    for (std::size_t k = 0; k < system_.constraints.size(); ++k)
      if (off[k] > digits || rates[k] > digits) {
        reason = fmt::format("The event `{}` sets a state that violates {}.", before, system_.constraint_label(k));
        return false;
      }
  }
  const ContactValues& values = functions_.at(t_, q, v);
  for (std::size_t i = 0; i < values.gap.size(); ++i)
    if (values.gap[i] < -digits * values.gap_scale[i]) {
      reason = fmt::format("The event `{}` sets a state that violates the contact {}.", before,
                           system_.contact_label(i));
      return false;
    }
  const Expr energy = in_terms_of_motion(system_, {&equations_.energy_function, 1}).front();
  const double energy_before = evaluate(energy, bindings);
  for (std::size_t i = 0; i < q.size(); ++i) {
    bindings[system_.coordinates[i].q] = q[i];
    bindings[system_.coordinates[i].velocity] = v[i];
  }
  carried_[0] += evaluate(energy, bindings) - energy_before;  // what a set puts in is work
  q_ = q, v_ = v;
  return true;
}

/// Sets, impacts, and the mode after them. A step that ended where it cannot go on; nothing where all is well.
std::optional<Step> HybridMotion::settle(double bound) {
  std::string reason;
  if (!forwards_ && (!pending_->hit.empty() || !pending_->left.empty()))
    return ended(StepEnding::Paradox,
                 "Backwards in time the motion meets a change of contact here: what was before an impact or a stop does "
                 "not follow from what is after it.");
  if (++same_time_ > most_at_once || record_.happenings.size() > most_happenings)
    return ended(StepEnding::Unending,
                 same_time_ > most_at_once
                     ? fmt::format("{} changes follow each other at the same time without an end.", most_at_once)
                     : fmt::format("More than {} events and changes of contact.", most_happenings));
  if (!pending_->begins) leave_mode();
  if (!pending_->sets.empty() && !carry_out_sets(reason)) return ended(StepEnding::SingularConstraints, reason);
  const ContactValues& values = functions_.at(t_, q_, v_);
  if (pending_->begins)
    for (std::size_t i = 0; i < values.gap.size(); ++i)
      if (values.gap[i] < -rest_unit * values.gap_scale[i] || !std::isfinite(values.gap[i]))
        return ended(StepEnding::Paradox, fmt::format("The start violates the contact {}.", system_.contact_label(i)));
  note_sizes(values);
  std::vector<std::size_t> touch = touching(values);
  if (!hit(touch, reason)) return ended(StepEnding::Paradox, reason);
  if (!choose_mode(touch, bound, reason)) return ended(StepEnding::Paradox, reason);
  pending_.reset();
  started_ = true;
  return std::nullopt;
}

ImpactProblem HybridMotion::impact_problem(const std::vector<std::size_t>& touching, const ContactValues& values) {
  ImpactProblem p;
  p.contacts = touching;
  for (const std::size_t i : touching) {
    p.normal.push_back(values.normal[i]);
    p.tangent.push_back(values.tangent[i]);
    p.drive.push_back(values.drive[i]);
    double rest = values.slip[i];
    for (const auto& [k, x] : values.tangent[i]) rest -= x * v_[k];
    p.slip_drive.push_back(std::abs(rest) <= rest_slip(i, values) ? 0 : rest);
    p.restitution.push_back(values.restitution[i]);
    p.friction.push_back(values.kinetic[i]);
    p.static_friction.push_back(values.fixed[i]);
    p.sticking.push_back(system_.contacts[i].friction.sticking);
    p.rest.push_back(rest_speed(i, values));
  }
  p.response = functions_.response(t_, q_, v_, p.normal);
  p.tangent_response = functions_.response(t_, q_, v_, p.tangent);
  return p;
}

void HybridMotion::note_order(const ImpactProblem& p, const ImpactResult& first, const VectorXd& v) {
  if (p.contacts.size() < 2 || first.impulses.size() < 2) return;
  const ImpactResult other = sequential_impact(p, v, ImpactOrder::FastestLast);
  const double size = std::max(first.v.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
  if ((other.v - first.v).cwiseAbs().maxCoeff() <= 1e-9 * size) return;
  const auto velocities = [&](const VectorXd& x) {
    std::string out;
    constexpr Index shown = 6;
    for (Index i = 0; i < std::min(x.size(), shown); ++i)
      out += fmt::format("{}{:.6g}", i == 0 ? "" : ", ", x(i));
    return "(" + out + (x.size() > shown ? ", …)" : ")");
  };
  remark(fmt::format("Several contacts are hit at t = {:.9g}, and the result depends on their order: q' = {} with the "
                     "fastest first, as it was done, {} with the fastest last.",
                     t_, velocities(first.v), velocities(other.v)));
}

void HybridMotion::record_impulses(const ImpactResult& result) {
  for (const Impulse& impulse : result.impulses)
    add(Happening::Kind::Impact, system_.contact_label(impulse.contact), impulse.normal, impulse.speed);
  record_.books.impacts += result.loss;
  record_.books.moving += result.moving;
  carried_[0] += result.moving - result.loss;
}

/// When infinitely many bounces come to their end, told from the last three of a contact; nothing while they go on. The
/// flights are then as short as their rounding allows to tell: speeds of a millionth of the fastest.
std::optional<double> HybridMotion::accumulation(std::size_t contact, double speed) {
  auto& last = bounces_[contact].last;
  last.emplace_back(t_, speed);
  if (last.size() > 4) last.erase(last.begin());
  if (last.size() < 4 || !(speed < 3e-6 * fastest_[contact])) return std::nullopt;
  const double ratio = last[3].second / last[2].second, before = last[2].second / last[1].second;
  const double flight = last[3].first - last[2].first;
  if (!(ratio < 0.999 && std::abs(ratio - before) < 1e-3) || !(flight < last[2].first - last[1].first)) return std::nullopt;
  cycle_.clear();  // with those that were hit since its impact before: they come to rest together
  for (std::size_t i = 0; i < bounces_.size(); ++i)
    if (!bounces_[i].last.empty() && bounces_[i].last.back().first >= last[2].first) cycle_.push_back(i);
  return t_ + flight * ratio / (1 - ratio);
}

/// What closing contacts do to the velocities. False, and why, where no impulses are found.
bool HybridMotion::hit(std::vector<std::size_t>& touching, std::string& reason) {
  accumulated_.reset();
  const ContactValues& values = functions_.at(t_, q_, v_);
  const bool closing = std::any_of(touching.begin(), touching.end(),
                                   [&](std::size_t i) { return values.rate[i] < -rest_speed(i, values); });
  if (!closing) return true;
  std::optional<double> end;
  for (const std::size_t i : touching)
    if (values.rate[i] < -rest_speed(i, values))
      if (const auto found = accumulation(i, -values.rate[i])) end = found;
  if (end)
    for (const std::size_t i : cycle_)
      if (std::find(touching.begin(), touching.end(), i) == touching.end()) touching.push_back(i);
  const bool at_once = system_.impact_law == ImpactLaw::Simultaneous;
  const ImpactProblem p = impact_problem(end ? cycle_ : touching, values);
  const VectorXd v = vector_of(v_);
  const ImpactResult result = end       ? end_of_bounces(p, v)
                              : at_once ? simultaneous_impact(p, v, false)
                                        : sequential_impact(p, v, ImpactOrder::FastestFirst);
  if (result.unsolved) {
    reason = "No impulses keep all contacts that are hit here from closing.";
    return false;
  }
  if (!at_once && !end) note_order(p, result, v);
  if (result.bounded)
    remark(fmt::format("At t = {:.9g} impacts followed each other without an end; the rest of them was done at once, "
                       "without bounce.",
                       t_));
  v_.assign(result.v.data(), result.v.data() + result.v.size());
  record_impulses(result);
  if (end) {
    accumulated_ = fmt::format("the end of infinitely many bounces at t = {:.12g}", *end);
    accumulated_at_ = *end;
    for (const std::size_t i : touching) bounces_[i].last.clear();
  }
  return true;
}

// ---------------------------------------------------------------------------------------------------- the mode after

std::vector<HybridMotion::Choice> HybridMotion::choices(const std::vector<std::size_t>& touching,
                                                        const ContactValues& values) const {
  std::vector<Choice> out;
  const auto slides = [&](std::size_t i) {
    return values.slip[i] > rest_slip(i, values)    ? FrictionState::Forward
           : values.slip[i] < -rest_slip(i, values) ? FrictionState::Backward
                                                    : FrictionState::None;
  };
  const auto left = [&](Watch::What what, std::size_t i) {
    return std::any_of(pending_->left.begin(), pending_->left.end(),
                       [&](const Watch& w) { return w.what == what && w.index == i; });
  };
  for (const std::size_t i : touching) {
    if (values.rate[i] > rest_speed(i, values)) continue;  // it opens
    Choice choice{i, {}};
    const Friction& f = system_.contacts[i].friction;
    const FrictionState sliding = f.present() ? slides(i) : FrictionState::None;
    if (!f.present())
      choice.options = {{true, FrictionState::None, 1}};
    else if (f.sticking)
      choice.options = {{true, FrictionState::Stick, 1}};
    else if (sliding != FrictionState::None)
      choice.options = {{true, sliding, 1}};
    else
      choice.options = {{true, FrictionState::Stick, 1}, {true, FrictionState::Forward, 1}, {true, FrictionState::Backward, 1}};
    const Choice::Option open{false, FrictionState::None, 1};
    if (left(Watch::What::Force, i))
      choice.options.insert(choice.options.begin(), open);
    else
      choice.options.push_back(open);
    out.push_back(std::move(choice));
  }
  const std::size_t contacts = system_.contacts.size();
  for (std::size_t i = contacts; i < contacts + system_.frictions.size(); ++i) {
    Choice choice{i, {}};
    const bool signs = has_multipliers(system_.frictions[i - contacts].normal);
    const FrictionState sliding = slides(i);
    for (const std::int8_t sign : {std::int8_t{1}, std::int8_t{-1}}) {
      if (sign < 0 && !signs) continue;
      if (sliding != FrictionState::None)
        choice.options.push_back({false, sliding, sign});
      else
        for (const FrictionState s : {FrictionState::Stick, FrictionState::Forward, FrictionState::Backward})
          choice.options.push_back({false, s, sign});
    }
    out.push_back(std::move(choice));
  }
  return out;
}

/// Whether what a condition does over the length that is judged is lost in rounding.
bool HybridMotion::vanishes(const Watch& watch, double size) const {
  constexpr double digits = 1e-12;
  if (watch.what == Watch::What::Gap) return size <= digits * widest_[watch.index];
  if (watch.what == Watch::What::Force) return size <= digits * hardest_[watch.index];
  return false;
}

/// Whether the motion in a mode keeps its conditions: gaps that do not close, forces that press, friction that holds
/// or opposes. A condition that is 0 here counts by the first of its derivatives that is not. Lenient: what is violated
/// at once is 0 here to rounding.
bool HybridMotion::fits(const ContactMode& mode, const std::vector<std::size_t>& touching, double bound, bool lenient,
                        std::vector<double>* accelerations) {
  ModeMotion& motion = motion_in(mode);
  TaylorStepper& s = *motion.stepper;
  s.start(t_, q_, v_);
  const ContactValues& values = functions_.at(t_, q_, v_);
  std::vector<std::size_t> at_zero;
  for (std::size_t k = 0; k < motion.watches.size(); ++k) {
    const Watch& w = motion.watches[k];
    const bool left = std::any_of(pending_->left.begin(), pending_->left.end(),
                                  [&](const Watch& x) { return x.what == w.what && x.index == w.index; });
    const bool touches = w.what == Watch::What::Gap &&
                         std::find(touching.begin(), touching.end(), w.index) != touching.end();
    const bool starts_to_slide =
        w.what == Watch::What::Slip && std::abs(values.slip[w.index]) <= rest_slip(w.index, values);
    if (touches || starts_to_slide || (left && w.what == Watch::What::Force)) at_zero.push_back(k);
  }
  s.put_at_zero(at_zero);
  std::vector<double> places, speeds;
  for (const std::size_t k : kind_) places.push_back(place_[k]), speeds.push_back(speed_[k]);
  s.set_usual_sizes(places, speeds);
  const TaylorStepper::Outlook outlook = s.outlook(bound);
  if (outlook.ending != StepEnding::None) return false;
  note_accelerations(outlook.accelerations, values);
  if (accelerations) *accelerations = outlook.accelerations;
  double largest_force = 0;
  for (std::size_t k = 0; k < motion.watches.size(); ++k)
    if (motion.watches[k].what == Watch::What::Force || motion.watches[k].what == Watch::What::Hold)
      largest_force = std::max(largest_force, std::abs(outlook.values[k]));
  for (std::size_t k = 0; k < motion.watches.size(); ++k) {
    const Watch& w = motion.watches[k];
    if (!w.keeps_sign()) continue;
    const bool zero = std::find(at_zero.begin(), at_zero.end(), k) != at_zero.end();
    const bool must_move = w.what == Watch::What::Slip && zero;
    const bool lost = vanishes(w, outlook.reach[k]);
    if (w.what == Watch::What::Gap && lost) continue;
    if (w.what == Watch::What::Force && lost && !lenient) return false;  // what does not press needs not be closed
    const bool wrong = outlook.sides[k] < 0 || (must_move && outlook.sides[k] == 0);
    if (!wrong) continue;
    const bool is_force = w.what == Watch::What::Force || w.what == Watch::What::Hold;
    const bool rounding = (is_force && std::abs(outlook.values[k]) <= 1e-12 * largest_force) ||
                          (is_force && std::abs(outlook.values[k]) < 1e-280);
    if (!lenient || !rounding || must_move) return false;
  }
  return true;
}

/// Where more normal force makes a contact close faster (Painlevé), more than one mode may fit.
bool HybridMotion::may_be_several(const ContactMode& mode, const ContactValues& values) {
  for (std::size_t i = 0; i < mode.closed.size(); ++i) {
    if (!mode.closed[i] || mode.friction[i] == FrictionState::None || mode.friction[i] == FrictionState::Stick) continue;
    SparseRow force = values.normal[i];
    const double factor = values.kinetic[i] * (mode.friction[i] == FrictionState::Forward ? -1 : 1);
    for (const auto& [k, x] : values.tangent[i]) force.emplace_back(k, factor * x);
    SparseRow summed;
    for (const auto& [k, x] : force) {
      const auto same = std::find_if(summed.begin(), summed.end(), [&, k = k](const auto& e) { return e.first == k; });
      if (same == summed.end())
        summed.emplace_back(k, x);
      else
        same->second += x;
    }
    const Eigen::MatrixXd response = functions_.response(t_, q_, v_, {&summed, 1});
    if (!(dot(values.normal[i], response.col(0)) > 0)) return true;
  }
  return false;
}

bool HybridMotion::choose_mode(const std::vector<std::size_t>& touching, double bound, std::string& reason) {
  const ContactValues values = functions_.at(t_, q_, v_);
  if (!touching.empty()) note_compliance(touching, values);
  const std::vector<Choice> list = choices(touching, values);
  double count = 1;
  for (const Choice& c : list) count *= static_cast<double>(c.options.size());
  const auto mode_of = [&](const std::vector<std::size_t>& taken) {
    ContactMode mode = open_mode(system_);
    for (std::size_t k = 0; k < list.size(); ++k) {
      const Choice::Option& option = list[k].options[taken[k]];
      if (list[k].contact < mode.closed.size())
        mode.closed[list[k].contact] = option.closed;
      else
        mode.normal_sign[list[k].contact - mode.closed.size()] = option.normal_sign;
      mode.friction[list[k].contact] = option.state;
    }
    return mode;
  };
  /// All combinations, those with the least changes of the likeliest first.
  std::vector<std::vector<std::size_t>> tries{std::vector<std::size_t>(list.size(), 0)};
  for (std::size_t done = 0; done < tries.size() && tries.size() < most_choices; ++done) {
    const std::vector<std::size_t> from = tries[done];
    std::size_t last = 0;  // only later entries are changed, so that each combination comes once
    for (std::size_t k = 0; k < from.size(); ++k)
      if (from[k] != 0) last = k;
    for (std::size_t k = last; k < list.size(); ++k)
      if (from[k] + 1 < list[k].options.size()) {
        tries.push_back(from);
        ++tries.back()[k];
      }
  }
  std::optional<ContactMode> found;
  std::vector<double> first;
  for (const bool lenient : {false, true}) {
    for (const auto& taken : tries) {
      const ContactMode mode = mode_of(taken);
      std::vector<double> accelerations;
      if (!fits(mode, touching, bound, lenient, &accelerations)) continue;
      if (!found) {
        found = mode;
        first = accelerations;
        if (!may_be_several(mode, values)) break;
        continue;
      }
      double off = 0, size = 0;
      for (std::size_t i = 0; i < first.size(); ++i) {
        off = std::max(off, std::abs(first[i] - accelerations[i]));
        size = std::max({size, std::abs(first[i]), std::abs(accelerations[i])});
      }
      if (off <= 1e-9 * size) continue;
      reason = fmt::format(
          "Painlevé's paradox: friction turns the contact force around here, and more than one motion fits: in the mode "
          "`{}` and in the mode `{}`.",
          mode_text(system_, *found), mode_text(system_, mode));
      return false;
    }
    if (found) break;
  }
  if (!found) {
    const bool rubs = std::any_of(list.begin(), list.end(), [](const Choice& c) { return c.options.size() > 2; }) ||
                      std::any_of(touching.begin(), touching.end(),
                                  [&](std::size_t i) { return system_.contacts[i].friction.present(); });
    reason = rubs ? "Painlevé's paradox: no finite forces of contact and friction fit the motion here."
             : count > static_cast<double>(most_choices)
                 ? fmt::format("None of the {} modes that were tried fits the contacts that touch here.", most_choices)
                 : "No forces keep all contacts that touch here from closing.";
    return false;
  }
  static_cast<void>(fits(*found, touching, bound, true, nullptr));
  const ContactMode before = now_->mode;
  now_ = modes_.at(key_of(*found)).get();
  record_changes(before, *found);
  return true;
}

void HybridMotion::record_changes(const ContactMode& before, const ContactMode& after) {
  const std::string text = mode_text(system_, after);
  const std::size_t begin = record_.happenings.size();
  if (!started_) {
    record_.first_mode = text;
  } else {
    for (std::size_t i = 0; i < after.closed.size(); ++i) {
      const std::string label = system_.contact_label(i);
      if (after.closed[i] && !before.closed[i]) {
        add(Happening::Kind::Made, label, 0, 0, accumulated_.value_or(""));
        if (accumulated_) record_.happenings.back().t = accumulated_at_;
      }
      if (!after.closed[i] && before.closed[i]) add(Happening::Kind::Lost, label);
    }
    for (std::size_t i = 0; i < after.friction.size(); ++i) {
      const FrictionState now = after.friction[i];
      if (now == before.friction[i] || now == FrictionState::None) continue;
      const std::string label =
          i < after.closed.size() ? system_.contact_label(i) : system_.frictions[i - after.closed.size()].name;
      add(now == FrictionState::Stick ? Happening::Kind::Stick : Happening::Kind::Slip, label);
    }
  }
  for (std::size_t k = record_.happenings.size(); k-- > 0;) {
    Happening& h = record_.happenings[k];
    if (k < begin && h.t != t_) break;
    h.mode = text;
  }
}

}  // namespace maupertuis
