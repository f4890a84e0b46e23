#include "simulation/contact/impact.hpp"

#include "linear_algebra/complementarity.hpp"
#include "linear_algebra/plane_impulse.hpp"
#include "simulation/contact/space_impulse.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace maupertuis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::size_t most_impulses = 1000;  // a contact

double rate(const ImpactProblem& p, std::size_t i, const VectorXd& v) { return dot(p.normal[i], v) + p.drive[i]; }

/// The closing contact that comes next; nothing where none closes.
std::optional<std::size_t> next_contact(const ImpactProblem& p, const VectorXd& v, ImpactOrder order) {
  std::optional<std::size_t> best;
  double best_speed = 0;
  for (std::size_t i = 0; i < p.contacts.size(); ++i) {
    const double closing = -rate(p, i, v);
    if (!(closing > p.rest[i])) continue;
    const double speed = closing / std::sqrt(dot(p.normal[i], p.response.col(at(i))));
    const bool first = order == ImpactOrder::FastestFirst;
    // Equal speeds: the first of the text, or the last.
    if (!best || (first ? speed > best_speed * (1 + 1e-12) : speed <= best_speed * (1 + 1e-12)))
      best = i, best_speed = speed;
  }
  return best;
}

bool has_friction(const ImpactProblem& p, std::size_t i) {
  return !p.tangent[i].empty() && (p.sticking[i] || p.friction[i] > 0 || p.static_friction[i] > 0);
}

bool is_in_space(const ImpactProblem& p, std::size_t i) {
  return i < p.second_tangent.size() && !p.second_tangent[i].empty();
}

/// Friction in space: the same along two tangents.
void apply_in_space(const ImpactProblem& p, std::size_t i, VectorXd& v, Impulse& impulse, ImpactResult& out) {
  const SparseRow* const rows[] = {&p.normal[i], &p.tangent[i], &p.second_tangent[i]};
  const VectorXd responses[] = {p.response.col(at(i)), p.tangent_response.col(at(i)), p.second_response.col(at(i))};
  const Eigen::Vector3d drive(p.drive[i], p.slip_drive[i], p.second_drive[i]);
  const auto rates = [&]() -> Eigen::Vector3d {
    return Eigen::Vector3d(dot(*rows[0], v), dot(*rows[1], v), dot(*rows[2], v)) + drive;
  };
  SpaceImpact impact;
  impact.velocity = rates();
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) impact.response(a, b) = dot(*rows[a], responses[b]);
  impact.friction = p.friction[i], impact.static_friction = p.static_friction[i];
  impact.restitution = p.restitution[i], impact.sticking = p.sticking[i];
  const Eigen::Vector3d found = impulse_in_space(impact);
  impulse.normal = found(0), impulse.tangential = found(1), impulse.second_tangential = found(2);
  for (int a = 0; a < 3; ++a) v += found(a) * responses[a];
  impulse.loss = -0.5 * found.dot(impact.velocity + rates());
  out.moving -= found(1) * p.slip_drive[i] + found(2) * p.second_drive[i];
}

/// ġ as a sum hi + lo, in which nothing of its terms is rounded.
struct ExactRate {
  double hi, lo = 0;

  ExactRate(const ImpactProblem& p, std::size_t i, const VectorXd& v) : hi(p.drive[i]) {
    for (const auto& [k, x] : p.normal[i]) {
      const double y = v(at(k)), product = x * y, sum = hi + product, part = sum - hi;
      lo += ((hi - (sum - part)) + (product - part)) + std::fma(x, y, -product);
      hi = sum;
    }
  }
};

/// The rounding of w and of ġ leans one way where w is next to a power of 2, as 4 is of a wall R² ≥ x² + y², and the
/// energy of a billiard would grow with the number of its impacts: what they leave of ġ⁺ = −e ġ⁻ is taken out.
void bounce(const ImpactProblem& p, std::size_t i, VectorXd& v, Impulse& impulse, double w) {
  const ExactRate before(p, i, v);
  const double e = p.restitution[i];
  impulse.normal = (1 + e) * -before.hi / w;
  v += impulse.normal * p.response.col(at(i));
  const ExactRate after(p, i, v);
  const double more = -(std::fma(e, before.hi, after.hi) + (e * before.lo + after.lo)) / w;
  if (!std::isfinite(more)) return;
  impulse.normal += more;
  v += more * p.response.col(at(i));
}

/// −Λ ġ averaged over the impulse is what it takes from the motion; without friction ½ Λ (1 − e)|ġ⁻| for contacts at
/// rest. With friction kinetic energy before and after tells.
Impulse apply(const ImpactProblem& p, std::size_t i, VectorXd& v, ImpactResult& out) {
  const double before = rate(p, i, v), w = dot(p.normal[i], p.response.col(at(i)));
  Impulse impulse;
  impulse.contact = p.contacts[i];
  impulse.speed = -before;
  if (!has_friction(p, i)) {
    bounce(p, i, v, impulse, w);
    impulse.loss = 0.5 * impulse.normal * (1 - p.restitution[i]) * -before;
  } else if (is_in_space(p, i)) {
    apply_in_space(p, i, v, impulse, out);
  } else {
    const double slip = dot(p.tangent[i], v) + p.slip_drive[i];
    const double w_nt = dot(p.normal[i], p.tangent_response.col(at(i))),
                 w_tt = dot(p.tangent[i], p.tangent_response.col(at(i)));
    const PlaneImpulse found = frictional_impulse(w, w_nt, w_tt, before, slip, p.friction[i], p.static_friction[i],
                                                  p.sticking[i], p.restitution[i]);
    impulse.normal = found.normal, impulse.tangential = found.tangential;
    v += found.normal * p.response.col(at(i)) + found.tangential * p.tangent_response.col(at(i));
    const double after = rate(p, i, v), slip_after = dot(p.tangent[i], v) + p.slip_drive[i];
    impulse.loss = -0.5 * (found.normal * (before + after) + found.tangential * (slip + slip_after));
    out.moving -= found.tangential * p.slip_drive[i];
  }
  out.moving -= impulse.normal * p.drive[i];
  out.loss += impulse.loss;
  return impulse;
}

/// The least impulses that do it: contacts that depend on others share them, and no pivot of rounding is divided by.
VectorXd least_solution(const Eigen::MatrixXd& w, const VectorXd& right) {
  constexpr double dependent = 1e-11;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(dependent);
  return solver.compute(w).solve(right);
}

/// Rates of these contacts as they are to be, but for the rounding of the velocities as they are now: what solving left
/// of larger ones is taken out once more.
void polish(const ImpactProblem& p, const std::vector<std::size_t>& contacts, const std::vector<double>& rates,
            VectorXd& v) {
  Eigen::MatrixXd w(at(contacts.size()), at(contacts.size()));
  VectorXd off(at(contacts.size()));
  for (std::size_t a = 0; a < contacts.size(); ++a) {
    for (std::size_t b = 0; b < contacts.size(); ++b)
      w(at(a), at(b)) = dot(p.normal[contacts[a]], p.response.col(at(contacts[b])));
    off(at(a)) = rates[a] - rate(p, contacts[a], v);
  }
  if (contacts.empty() || !(off.cwiseAbs().maxCoeff() > 0)) return;
  const VectorXd more = least_solution(w, off);
  for (std::size_t a = 0; a < contacts.size(); ++a) v += more(at(a)) * p.response.col(at(contacts[a]));
}

/// `before`, `after`: ġ.
Impulse without_friction(std::size_t contact, double normal, double before, double after) {
  Impulse out;
  out.contact = contact, out.normal = normal, out.speed = -before;
  out.loss = -0.5 * normal * (before + after);
  return out;
}

/// Many impulses leave what is nearly closed at some roundings of zero: it is closed.
void settle(const ImpactProblem& p, ImpactResult& out) {
  constexpr double roundings = 16;
  std::vector<std::size_t> closed;
  for (std::size_t i = 0; i < p.contacts.size(); ++i)
    if (std::abs(rate(p, i, out.v)) <= roundings * p.rest[i]) closed.push_back(i);
  if (closed.size() > 1) polish(p, closed, std::vector<double>(closed.size(), 0.0), out.v);
}

}  // namespace

ImpactResult sequential_impact(const ImpactProblem& p, const VectorXd& v, ImpactOrder order) {
  ImpactResult out;
  out.v = v;
  while (const auto i = next_contact(p, out.v, order)) {
    if (out.impulses.size() >= most_impulses * p.contacts.size()) {
      ImpactResult rest = simultaneous_impact(p, out.v, true);
      rest.impulses.insert(rest.impulses.begin(), out.impulses.begin(), out.impulses.end());
      rest.moving += out.moving, rest.loss += out.loss;
      rest.bounded = true;
      return rest;
    }
    out.impulses.push_back(apply(p, *i, out.v, out));
  }
  settle(p, out);
  return out;
}

ImpactResult simultaneous_impact(const ImpactProblem& p, const VectorXd& v, bool plastic) {
  ImpactResult out;
  out.v = v;
  const std::size_t count = p.contacts.size();
  // Those that open too: what is hit beside them may turn them round.
  std::vector<std::size_t> in(count);
  std::iota(in.begin(), in.end(), std::size_t{0});
  Eigen::MatrixXd w(at(in.size()), at(in.size()));
  VectorXd q(at(in.size()));
  for (std::size_t a = 0; a < in.size(); ++a) {
    for (std::size_t b = 0; b < in.size(); ++b) w(at(a), at(b)) = dot(p.normal[in[a]], p.response.col(at(in[b])));
    const double before = rate(p, in[a], v);
    q(at(a)) = (1 + (plastic || before > 0 ? 0 : p.restitution[in[a]])) * before;
  }
  const auto found = linear_complementarity(w, q);
  if (!found) {
    out.unsolved = true;
    return out;
  }
  std::vector<std::size_t> pressed;
  std::vector<double> rates;
  for (std::size_t a = 0; a < in.size(); ++a) {
    out.v += (*found)(at(a)) * p.response.col(at(in[a]));
    constexpr double rounding = 1e-9;  // what is left of a force where the contact opens
    if (!((*found)(at(a)) > rounding * found->maxCoeff())) continue;
    pressed.push_back(in[a]);
    rates.push_back(rate(p, in[a], v) - q(at(a)));
  }
  polish(p, pressed, rates, out.v);
  for (std::size_t a = 0; a < in.size(); ++a) {
    const double impulse = (*found)(at(a));
    if (!(impulse > 0)) continue;
    const double before = rate(p, in[a], v), after = rate(p, in[a], out.v);
    out.impulses.push_back(without_friction(p.contacts[in[a]], impulse, before, after));
    out.moving -= impulse * p.drive[in[a]];
    out.loss += out.impulses.back().loss;
  }
  return out;
}

ImpactResult impact_at_once(const ImpactProblem& p, const VectorXd& v) {
  ImpactResult out = simultaneous_impact(p, v, false);
  constexpr double rounding = 1e-9;
  double largest = 0;
  for (const Impulse& i : out.impulses) largest = std::max(largest, i.normal);
  const auto rubs = std::find_if(out.impulses.begin(), out.impulses.end(), [&](const Impulse& i) {
    const auto k = std::find(p.contacts.begin(), p.contacts.end(), i.contact) - p.contacts.begin();
    return i.normal > rounding * largest && has_friction(p, static_cast<std::size_t>(k));
  });
  if (rubs == out.impulses.end()) return out;
  ImpactResult alone = sequential_impact(p, v, ImpactOrder::FastestFirst);
  if (std::all_of(alone.impulses.begin(), alone.impulses.end(),
                  [&](const Impulse& i) { return i.contact == alone.impulses.front().contact; }))
    return alone;
  out.rubs_at_once = rubs->contact;
  return out;
}

namespace {

/// Friction of a contact that slides on through its impulse: Λ_t = Λ (along, second), opposite to the slip.
struct Sliding {
  double along = 0, second = 0;
};

Sliding sliding_of(const ImpactProblem& p, std::size_t i, const VectorXd& v) {
  if (!has_friction(p, i) || p.sticking[i]) return {};
  const double slip = dot(p.tangent[i], v) + p.slip_drive[i],
               second = is_in_space(p, i) ? dot(p.second_tangent[i], v) + p.second_drive[i] : 0;
  const double size = std::hypot(slip, second);
  const double changed = p.friction[i] * std::abs(rate(p, i, v)) * dot(p.tangent[i], p.tangent_response.col(at(i))) /
                         dot(p.normal[i], p.response.col(at(i)));
  if (!(size > changed)) return {};  // it would not slide on
  return {-p.friction[i] * slip / size, -p.friction[i] * second / size};
}

/// What the velocities change by an impulse 1 with its friction.
VectorXd response_of(const ImpactProblem& p, std::size_t i, const Sliding& sliding) {
  VectorXd out = p.response.col(at(i));
  if (sliding.along != 0) out += sliding.along * p.tangent_response.col(at(i));
  if (sliding.second != 0) out += sliding.second * p.second_response.col(at(i));
  return out;
}

/// ġ⁺ = 0 by impulses with these parts of friction.
ImpactResult closed_with(const ImpactProblem& p, const VectorXd& v, const std::vector<Sliding>& sliding) {
  ImpactResult out;
  out.v = v;
  const std::size_t count = p.contacts.size();
  Eigen::MatrixXd w(at(count), at(count)), responses(v.size(), at(count));
  VectorXd q(at(count));
  for (std::size_t b = 0; b < count; ++b) responses.col(at(b)) = response_of(p, b, sliding[b]);
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) w(at(a), at(b)) = dot(p.normal[a], responses.col(at(b)));
    q(at(a)) = -rate(p, a, v);
  }
  const VectorXd impulses = least_solution(w, q);
  out.v += responses * impulses;
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  polish(p, all, std::vector<double>(count), out.v);
  for (std::size_t a = 0; a < count; ++a) {
    const double before = rate(p, a, v), after = rate(p, a, out.v), impulse = impulses(at(a));
    out.moving -= impulse * p.drive[a];
    out.loss -= 0.5 * impulse * (before + after);
    const auto rubs = [&](const SparseRow& tangent, double drive, double part) {
      out.moving -= impulse * part * drive;
      out.loss -= 0.5 * impulse * part * (dot(tangent, v) + dot(tangent, out.v) + 2 * drive);
    };
    if (sliding[a].along != 0) rubs(p.tangent[a], p.slip_drive[a], sliding[a].along);
    if (sliding[a].second != 0) rubs(p.second_tangent[a], p.second_drive[a], sliding[a].second);
    if (before < -p.rest[a]) out.impulses.push_back(without_friction(p.contacts[a], impulse, before, after));
  }
  return out;
}

}  // namespace

ImpactResult end_of_bounces(const ImpactProblem& p, const VectorXd& v) {
  return closed_with(p, v, std::vector<Sliding>(p.contacts.size()));
}

ImpactResult end_of_flights(const ImpactProblem& p, const VectorXd& v) {
  std::vector<Sliding> sliding;
  for (std::size_t i = 0; i < p.contacts.size(); ++i) sliding.push_back(sliding_of(p, i, v));
  return closed_with(p, v, sliding);
}

PlaneImpulse frictional_impulse(double w_nn, double w_nt, double w_tt, double v_n, double v_t, double friction,
                                double static_friction, bool sticking, double restitution) {
  const ImpulseOf<double> found =
      impulse_in_plane<double>({w_nn, w_nt, w_tt, friction, static_friction, sticking, v_n, v_t}, restitution);
  return {found.normal, found.tangential};
}

}  // namespace maupertuis
