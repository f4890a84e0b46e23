#include "simulation/hybrid_impacts.hpp"

#include "simulation/contact/contact_forces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

namespace maupertuis::hybrid {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double slow_flight = 1e-6;  // of the fastest so far: never what is to be seen

/// Whether a contact has friction.
bool rub(const std::vector<std::size_t>& contacts, const ContactValues& values) {
  return std::any_of(contacts.begin(), contacts.end(), [&](std::size_t i) { return !values.tangent[i].empty(); });
}

VectorXd vector_of(std::span<const double> x) {
  return Eigen::Map<const VectorXd>(x.data(), static_cast<Index>(x.size()));
}

/// The last impact of a series without end, with the friction of all those that are left out: after it the contacts
/// stay closed, and press as the bounces would have pressed on the average.
ImpactResult last_impact(const ImpactProblem& p, const VectorXd& v) {
  ImpactResult first = sequential_impact(p, v, ImpactOrder::FastestFirst);
  if (p.contacts.size() == 1) return first;
  ImpactResult rest = end_of_bounces(p, first.v);
  rest.impulses.insert(rest.impulses.begin(), first.impulses.begin(), first.impulses.end());
  rest.loss += first.loss, rest.moving += first.moving;
  return rest;
}

}  // namespace

Impacts::Outcome Impacts::hit(std::vector<std::size_t>& touching) {
  end_of_bounces_.reset();
  const ContactValues& values = here_.values();
  if (std::none_of(touching.begin(), touching.end(), [&](std::size_t i) { return closes(i, values); })) return {};
  for (const std::size_t i : touching)
    if (closes(i, values)) note_bounce(i, -values.rate[i], values.restitution[i]);
  const std::optional<double> end = accumulation_among(touching, values);
  ImpactProblem p = problem_of(end ? cycle_ : touching, values);
  if (!end) {
    sizes_.note_compliances(p.contacts, p.normal, p.response);
    sizes_.set_knows_compliances(true);
  }
  const bool rests = !end && is_lost_in_rounding(touching, values);
  if (end || rests) std::fill(p.restitution.begin(), p.restitution.end(), 0.0);
  VectorXd v = vector_of(here_.v);
  const bool at_once = problem_.system.impact_law == ImpactLaw::Simultaneous || (rests && !rub(touching, values));
  ImpactResult result = end       ? last_impact(p, v)
                        : at_once ? impact_at_once(p, v)
                                  : sequential_impact(p, v, ImpactOrder::FastestFirst);
  if (end) press_all(result, touching, values);
  if (auto why = trouble_of(result, touching, values)) return {std::move(why), std::nullopt};
  if (!at_once && !end) tell_order(p, result, v);
  carry_out(result, touching, p.contacts.size(), end || rests);
  if (end) {
    end_of_bounces_ = EndOfBounces{*end};
    for (const std::size_t i : touching) bounces_[i].last.clear();
  }
  return {std::nullopt, Impact{std::move(p), std::move(result), std::move(v), end.has_value()}};
}

bool Impacts::closes(std::size_t i, const ContactValues& values) const {
  return values.rate[i] < -sizes_.rest_speed(i, values);
}

/// What rests beside contacts whose bounces have ended is not pressed through.
void Impacts::press_all(ImpactResult& result, const std::vector<std::size_t>& touching,
                        const ContactValues& values) const {
  ImpactProblem all = problem_of(touching, values);
  std::fill(all.restitution.begin(), all.restitution.end(), 0.0);
  const ImpactResult more = rub(touching, values) ? sequential_impact(all, result.v, ImpactOrder::FastestFirst)
                                                  : simultaneous_impact(all, result.v, true);
  result.v = more.v;
  // What rounding leaves of the bounces that have ended is no impact.
  std::copy_if(more.impulses.begin(), more.impulses.end(), std::back_inserter(result.impulses),
               [&](const Impulse& i) { return i.speed > sizes_.rest_speed(i.contact, values); });
  result.loss += more.loss, result.moving += more.moving;
  result.unsolved = more.unsolved;
}

std::optional<std::string> Impacts::trouble_of(const ImpactResult& result, const std::vector<std::size_t>& touching,
                                               const ContactValues& values) const {
  if (result.unsolved) return "No impulses keep all contacts that are hit here from closing.";
  if (!result.v.allFinite()) {
    const auto hit = std::find_if(touching.begin(), touching.end(), [&](std::size_t i) { return closes(i, values); });
    return fmt::format(
        "The constraints move the contact {} through zero, and leave nothing that an impact could change: no motion "
        "obeys both.",
        problem_.system.contact_label(*hit));
  }
  if (result.rubs_at_once)
    return fmt::format(
        "Several contacts are hit here, {} with friction among them, and `impact simultaneous` says nothing of "
        "friction: leave it out, and one contact after the other is hit, with its friction.",
        problem_.system.contact_label(*result.rubs_at_once));
  return std::nullopt;
}

/// `contacts`: their number in the impact. `last`: of a series of bounces, those that would follow are left out.
void Impacts::carry_out(const ImpactResult& result, const std::vector<std::size_t>& touching, std::size_t contacts,
                        bool last) {
  if (result.bounded)
    journal_.remark(
        fmt::format("At t = {:.9g} impacts followed each other without an end; the rest of them was done at once, "
                    "without bounce and without friction.",
                    here_.t));
  here_.v.assign(result.v.data(), result.v.data() + result.v.size());
  record_impulses(result, last);
  if (result.impulses.size() > 4 * contacts) end_series(touching);
}

ImpactProblem Impacts::problem_of(const std::vector<std::size_t>& touching, const ContactValues& values) const {
  ImpactProblem p;
  p.contacts = touching;
  for (const std::size_t i : touching) {
    p.normal.push_back(values.normal[i]);
    p.tangent.push_back(values.tangent[i]);
    p.drive.push_back(values.drive[i]);
    double rest = values.slip[i];
    for (const auto& [k, x] : values.tangent[i]) rest -= x * here_.v[k];
    p.slip_drive.push_back(std::abs(rest) <= sizes_.rest_slip(i, values) ? 0 : rest);
    p.restitution.push_back(values.restitution[i]);
    p.friction.push_back(values.kinetic[i]);
    p.static_friction.push_back(values.fixed[i]);
    p.sticking.push_back(problem_.system.contacts[i].friction.sticking);
    p.rest.push_back(sizes_.rest_speed(i, values));
  }
  p.response = here_.response(p.normal);
  p.tangent_response = here_.response(p.tangent);
  for (const std::size_t i : touching) {
    p.second_tangent.push_back(values.second_tangent[i]);
    double rest = values.second_slip[i];
    for (const auto& [k, x] : values.second_tangent[i]) rest -= x * here_.v[k];
    p.second_drive.push_back(std::abs(rest) <= sizes_.rest_slip(i, values) ? 0 : rest);
  }
  p.second_response = here_.response(p.second_tangent);
  return p;
}

/// A series of bounces goes on while each impact is what the one before left, give or take a thousand times. What drag
/// slowed, or another body throws down anew, begins another one: a millionth of the old one may be all that moves.
void Impacts::note_bounce(std::size_t contact, double speed, double restitution) {
  constexpr double most = 1e3;
  Bounces& bounces = bounces_[contact];
  const double left = restitution * bounces.before;
  const bool goes_on = most * speed >= left && speed <= most * left;
  bounces.fastest = goes_on ? std::max(bounces.fastest, speed) : speed;
  bounces.before = speed;
}

/// When infinitely many bounces come to their end, told from the last three of a contact; nothing while they go on. The
/// flights are then as short as their rounding allows to tell: speeds of a millionth of the fastest impact of the
/// series.
std::optional<double> Impacts::accumulation(std::size_t contact, double speed) {
  auto& last = bounces_[contact].last;
  last.emplace_back(here_.t, speed);
  if (last.size() > 4) last.erase(last.begin());
  if (last.size() < 4 || !(speed < 3e-6 * bounces_[contact].fastest)) return std::nullopt;
  const double ratio = last[3].second / last[2].second, before = last[2].second / last[1].second;
  const double flight = last[3].first - last[2].first, flight_before = last[2].first - last[1].first;
  constexpr double slowest = 0.999;
  // Flights of a spring last as long however low they are: speeds alone come to no end.
  if (!(ratio < slowest && std::abs(ratio - before) < 1e-3) || !(flight < slowest * flight_before)) return std::nullopt;
  cycle_.clear();  // with those that were hit since its impact before: they come to rest together
  for (std::size_t i = 0; i < bounces_.size(); ++i)
    if (!bounces_[i].last.empty() && bounces_[i].last.back().first >= last[2].first) cycle_.push_back(i);
  return here_.t + flight * ratio / (1 - ratio);
}

/// Where the last flights say that infinitely many bounces end; then all contacts of their cycle are touching.
std::optional<double> Impacts::accumulation_among(std::vector<std::size_t>& touching, const ContactValues& values) {
  std::optional<double> end;
  for (const std::size_t i : touching)
    if (closes(i, values))
      if (const auto found = accumulation(i, -values.rate[i])) end = found;
  if (!end || slips_may_stop_before(*end, touching, values)) return std::nullopt;
  for (const std::size_t i : cycle_)
    if (std::find(touching.begin(), touching.end(), i) == touching.end()) touching.push_back(i);
  return end;
}

/// Whether a slip may come to its end during the bounces that would be left out: when it does so depends on each of
/// them. Those that are left in a billionth of the fastest are left out all the same.
bool Impacts::slips_may_stop_before(double end, const std::vector<std::size_t>& touching,
                                    const ContactValues& values) const {
  constexpr double slow = 1e-9, share = 4;
  for (const std::size_t i : touching) {
    if (values.tangent[i].empty() || !(-values.rate[i] > slow * bounces_[i].fastest)) continue;
    const double force = sizes_.acceleration_along(values.tangent[i]), slip = slip_speed(i, values);
    if (slip > sizes_.rest_slip(i, values) && slip <= share * force * std::abs(end - here_.t)) return true;
  }
  return false;
}

/// How high a contact flies that leaves with this speed: by the acceleration of the run so far; or as long as it flew
/// before, since the force of a spring vanishes where it is at rest, and its flights last however low they are.
double Impacts::height_of_flight(std::size_t contact, double speed, const ContactValues& values) const {
  const double acceleration = sizes_.acceleration_along(values.normal[contact]);
  const double by_force = speed * speed / (2 * acceleration);
  const auto& last = bounces_[contact].last;
  if (last.size() < 2) return by_force;
  return std::max(by_force, speed * (last.back().first - last[last.size() - 2].first) / 4);
}

/// Bounces whose flights are lower than the gap is known end at once: whether all of them that close here are so low. A
/// contact without loss is left alone.
bool Impacts::is_lost_in_rounding(const std::vector<std::size_t>& touching, const ContactValues& values) const {
  for (const std::size_t i : touching) {
    const double speed = -values.rate[i];
    if (speed <= sizes_.rest_speed(i, values)) continue;
    const bool is_low = height_of_flight(i, speed, values) <= rest_unit * sizes_.widest(i);
    if (!(values.restitution[i] < 1) || !is_low || speed > slow_flight * bounces_[i].fastest) return false;
  }
  return true;
}

void Impacts::tell_order(const ImpactProblem& p, const ImpactResult& first, const VectorXd& v) {
  if (p.contacts.size() < 2 || first.impulses.size() < 2) return;
  const ImpactResult other = sequential_impact(p, v, ImpactOrder::FastestLast);
  const double size = std::max(first.v.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
  if ((other.v - first.v).cwiseAbs().maxCoeff() <= 1e-9 * size) return;
  const auto velocities = [&](const VectorXd& x) {
    std::string out;
    constexpr Index shown = 6;
    for (Index i = 0; i < std::min(x.size(), shown); ++i) out += fmt::format("{}{:.6g}", i == 0 ? "" : ", ", x(i));
    return "(" + out + (x.size() > shown ? ", …)" : ")");
  };
  journal_.remark(
      fmt::format("Several contacts are hit at t = {:.9g}, and the result depends on their order: q' = {} with the "
                  "fastest first, as it was done, {} with the fastest last.",
                  here_.t, velocities(first.v), velocities(other.v)));
}

/// What impulses take, and what contacts that move give by them.
void Impacts::book_energy(const ImpactResult& result) {
  journal_.books().impacts += result.loss;
  journal_.books().moving += result.moving;
  carried_.put_in(result.moving - result.loss);
}

void Impacts::record_impulses(const ImpactResult& result, bool last) {
  book_energy(result);
  constexpr std::size_t most_told = 32;
  if (result.impulses.size() <= most_told) {
    for (const Impulse& impulse : result.impulses)
      journal_.add(Happening::Kind::Impact, problem_.system.contact_label(impulse.contact), impulse.normal,
                   impulse.speed,
                   last && bounces(impulse.contact) ? "without bounce, those after it are left out" : "");
    return;
  }
  // A chain of contacts whose impulses follow each other without end, each smaller: their sum for each contact.
  std::vector<std::size_t> order;
  std::map<std::size_t, std::pair<Impulse, std::size_t>> sums;
  for (const Impulse& impulse : result.impulses) {
    const auto [sum, is_new] = sums.try_emplace(impulse.contact, impulse, 1);
    if (is_new)
      order.push_back(impulse.contact);
    else
      sum->second.first.normal += impulse.normal, ++sum->second.second;
  }
  for (const std::size_t contact : order) {
    const auto& [impulse, count] = sums.at(contact);
    journal_.add(Happening::Kind::Impact, problem_.system.contact_label(contact), impulse.normal, impulse.speed,
                 count > 1 ? fmt::format("the sum of {} impacts", count) : std::string());
  }
}

/// Impacts that follow each other in one instant, each smaller, as of a disc that rolls into a corner, end below what
/// the rates of gaps are known to: what they leave of slips that they bring to rest is no motion.
void Impacts::end_series(const std::vector<std::size_t>& touching) {
  constexpr double left = 1e-10;  // of the fastest slip
  const ContactValues& values = here_.values();
  std::vector<std::size_t> resting;
  for (const std::size_t i : touching) {
    if (values.rate[i] > sizes_.rest_speed(i, values) || values.tangent[i].empty()) continue;
    const double slip = slip_speed(i, values);
    if (slip > 0 && slip <= left * sizes_.fastest_slip(i)) resting.push_back(i);
  }
  if (!resting.empty()) space_.take_out_slips(resting, touching);
}

bool Impacts::is_slow(std::size_t i, const ContactValues& values) const {
  return values.rate[i] > sizes_.rest_speed(i, values) && values.rate[i] <= slow_flight * sizes_.fastest(i);
}

void Impacts::close_lowest_flights(const std::vector<std::size_t>& touching, const Met& met, double bound) {
  const ContactValues& values = here_.values();
  const auto any_is_slow = [&](const std::vector<std::size_t>& list) {
    return std::any_of(list.begin(), list.end(), [&](std::size_t i) { return is_slow(i, values); });
  };
  if (!any_is_slow(touching)) return;
  const auto [pressed, flight] = pressed_through_flights(touching, met, values, bound);
  if (!any_is_slow(pressed)) return;
  if (flight > 0) end_of_bounces_ = EndOfBounces{here_.t + flight};
  ImpactResult closed = end_of_flights(problem_of(pressed, values), vector_of(here_.v));
  if (pressed.size() < touching.size()) {  // what touches beside them is not pressed through
    const ImpactResult all = simultaneous_impact(problem_of(touching, values), closed.v, true);
    if (!all.unsolved) {
      closed.v = all.v;
      closed.loss += all.loss, closed.moving += all.moving;
    }
  }
  book_energy(closed);
  here_.v.assign(closed.v.data(), closed.v.data() + closed.v.size());
}

/// Contacts that press though they open, so slowly that they are closed. One that flies higher presses on nothing: the
/// forces of the others are sought without it. And how long their flights would last, 2 ġ/a for the first and e of the
/// one before for each that follows.
Impacts::LowFlights Impacts::pressed_through_flights(const std::vector<std::size_t>& touching, const Met& met,
                                                     const ContactValues& values, double bound) {
  std::vector<Choice> list;
  for (const std::size_t i : touching)
    if (values.rate[i] <= slow_flight * sizes_.fastest(i)) list.push_back(choices_.of_contact(i, values, met));
  LowFlights out;
  for (bool all_are_low = false; !all_are_low;) {
    const auto problem = forces_.problem_of(list, values, bound);
    const auto forces = problem ? contact_forces(*problem) : std::nullopt;
    if (!forces) return {};
    out = {};
    std::vector<Choice> low;
    for (std::size_t k = 0; k < list.size(); ++k) {
      const std::size_t i = list[k].contact;
      const double falls = forces->normal[k] * dot(problem->contacts[k].normal, problem->response.col(at(k)));
      const bool presses = forces->normal[k] > 0;
      const double speed = values.rate[i];
      if (presses && is_slow(i, values) && speed * speed > 2 * falls * rest_unit * sizes_.widest(i)) continue;
      low.push_back(list[k]);
      if (!presses) continue;
      out.contacts.push_back(i);
      if (const double e = values.restitution[i]; is_slow(i, values) && e > 0 && e < 1)
        out.duration = std::max(out.duration, 2 * speed / (falls * (1 - e)));
    }
    all_are_low = low.size() == list.size();
    list = std::move(low);
  }
  return out;
}

void Impacts::begin_anew(const std::vector<double>& q, const std::vector<double>& v, const ContactValues& values) {
  for (std::size_t i = 0; i < bounces_.size(); ++i)
    for (const auto& [k, g] : values.normal[i])
      if (q[k] != here_.q[k] || v[k] != here_.v[k]) bounces_[i].before = 0;
}

}  // namespace maupertuis::hybrid
