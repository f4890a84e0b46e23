#include "drawing/contact_places.hpp"

#include "drawing/outlines.hpp"
#include "linear_algebra/dense.hpp"

#include <maupertuis/constraint_manifold.hpp>
#include <maupertuis/reactions.hpp>
#include <maupertuis/transform.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace maupertuis::drawing {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr std::size_t most_contacts = 400, most_numbers = 4'000'000;
constexpr double agrees = 1e-9;

/// Values at states near the run, where what the model says has values.
class Samples {
 public:
  Samples(const MechanicalSystem& system, const Bindings& parameters, const Trajectory& run) : system_(system) {
    const std::size_t rows = run.rows();
    double seed = 0.37;
    for (const std::size_t row : {std::size_t{0}, rows / 3, rows / 2, 2 * rows / 3, rows - 1}) {
      Bindings state = parameters;
      state[system.context->time()] = run.times[row] + 0.01;
      for (const Coordinate& c : system.coordinates) {
        const std::size_t q = *run.column(c.name);
        double size = 0;
        for (std::size_t r = 0; r < rows; r += 1 + rows / 50) size = std::max(size, std::abs(run.at(r, q)));
        seed = std::fmod(seed * 1.618033988749895 + 0.2718281828, 1.0);
        state[c.q] = run.at(row, q) + (seed - 0.4) * (size > 0 ? 0.05 * size : 0.02);
        state[c.velocity] = seed - 0.5;
      }
      states.push_back(std::move(state));
    }
  }

  std::vector<double> values(const ExprVector& functions, std::size_t sample) const {
    return evaluate(in_terms_of_motion(system_, functions), states[sample]);
  }

  std::vector<Bindings> states;

 private:
  const MechanicalSystem& system_;
};

/// w with Jᵀ w = ∇g by least squares, and by how much it fails.
struct Fit {
  Vector push;
  double residual = 0;
  Eigen::Index rank = 0;
};

Fit fit(const Matrix& jacobian, const Vector& slope) {
  Eigen::CompleteOrthogonalDecomposition<Matrix> solver(Matrix(jacobian.transpose()));
  solver.setThreshold(agrees);
  Fit out;
  out.rank = solver.rank();
  out.push = solver.solve(slope);
  out.residual = (jacobian.transpose() * out.push - slope).norm() / slope.norm();
  return out;
}

/// In the order of `with_slopes`: the rows of `count` functions after those at `from`.
Matrix slopes_of(const std::vector<double>& values, std::size_t functions, std::size_t from, std::size_t count,
                 std::size_t n) {
  Matrix out(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(n));
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t i = 0; i < n; ++i)
      out(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = values[functions + (from + k) * n + i];
  return out;
}

class Finder {
 public:
  Finder(const MechanicalSystem& system, const Bindings& parameters, const Trajectory& run)
      : system_(system), parameters_(parameters), samples_(system, parameters, run), n_(system.coordinates.size()) {
    const auto add = [&](const std::string& name, const ExprVector& position) {
      if (!same_everywhere(system, position, parameters)) candidates_.push_back({name, position});
      if (candidates_.size() > symbols_.size()) symbols_.push_back(coordinates_in(position));
    };
    for (const Point& p : system.points)
      if (p.mass) add(p.name, p.position);
    for (const Body& b : system.bodies) add(b.name, b.position);
    for (const Point& p : system.points)
      if (!p.mass) add(p.name, p.position);
  }

  std::optional<ContactPlaces> find(std::size_t contact) {
    gap_ = system_.contacts[contact].gap;
    const std::set<std::size_t> tied = coordinates_in({gap_});
    ContactPlaces out;
    out.contact = contact;
    const bool angle = !system_.dimensionless && system_.contacts[contact].dimension.is_one();
    if (is_distance_of_candidate(tied, angle, out)) return out;
    for (const Body& body : system_.bodies)
      if (const auto place = angle ? std::nullopt : place_on(body, tied); place && depends_on(*place, false, out))
        return out;
    return pair_of(tied, out);
  }

 private:
  using Place = ContactPlaces::Place;

  std::set<std::size_t> coordinates_in(const ExprVector& expressions) const {
    std::set<std::size_t> out;
    for (const Expr& s : symbols_of(in_terms_of_motion(system_, expressions)))
      for (std::size_t i = 0; i < n_; ++i)
        if (system_.coordinates[i].q == s) out.insert(i);
    return out;
  }
  static bool holds(const std::set<std::size_t>& all, const std::set<std::size_t>& some) {
    return std::includes(all.begin(), all.end(), some.begin(), some.end());
  }

  /// With as many coordinates as a place has freedoms any function of them is one of the place: the place is meant in
  /// which the gap is written, else the one that moves least, and of several the one whose distance the gap is.
  bool is_distance_of_candidate(const std::set<std::size_t>& tied, bool angle, ContactPlaces& out) const {
    bool found = false;
    double best = 0;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      ContactPlaces one;
      if (!holds(symbols_[i], tied) || !depends_on(candidates_[i], angle, one)) continue;
      const double merit = (one.places[0].slope.empty() ? 0 : 4) + (one.freedoms == 1 ? 2 : 0) + (is_distance_ ? 1 : 0);
      if (found && merit <= best) continue;
      found = true;
      best = merit;
      out.freedoms = one.freedoms;
      out.places = one.places;
    }
    return found;
  }

  /// Whether the gap is a function of this place and the time. A bound of an angle shows as a stop on the way of a
  /// place that this angle alone moves.
  bool depends_on(const Place& place, bool angle, ContactPlaces& out) const {
    is_distance_ = true;
    const ExprVector functions = with_slopes(system_, {gap_, place.position[0], place.position[1]});
    std::size_t freedoms = 0;
    for (std::size_t s = 0; s < samples_.states.size(); ++s) {
      const std::vector<double> values = samples_.values(functions, s);
      const Vector slope = slopes_of(values, 3, 0, 1, n_).transpose();
      const Fit found = fit(slopes_of(values, 3, 1, 2, n_), slope);
      if (!(found.residual <= agrees)) return false;
      is_distance_ = is_distance_ && std::abs(found.push.norm() - 1) < 1e-6;
      freedoms = std::max(freedoms, static_cast<std::size_t>(found.rank));
    }
    if (angle && freedoms != 1) return false;
    out.freedoms = freedoms;
    out.places = {place};
    out.places[0].slope = written_slope(place);
    return true;
  }

  /// ∂g/∂P where g holds the coordinates as parts of P alone, `sqrt(P.x^2 + P.y^2) >= R`.
  ExprVector written_slope(const Place& place) const {
    Context& c = *system_.context;
    const ExprVector names{c.symbol("x of contact", Role::Auxiliary), c.symbol("y of contact", Role::Auxiliary)};
    ExprMap in, back;
    for (std::size_t k = 0; k < 2; ++k) {
      if (coordinates_in({place.position[k]}).empty()) continue;
      in.emplace(place.position[k], names[k]);
      back.emplace(names[k], place.position[k]);
    }
    const Expr written = substitute(gap_, in);
    if (!coordinates_in({written}).empty()) return {};
    return {substitute(differentiate(written, names[0]), back), substitute(differentiate(written, names[1]), back)};
  }

  /// The place on a body through which the force of the contact goes however the body is turned.
  std::optional<Place> place_on(const Body& body, const std::set<std::size_t>& tied) const {
    if (body.rotation.entries.empty() || body.angular_velocity.empty()) return std::nullopt;
    ExprVector where = body.position;
    where.insert(where.end(), body.rotation.entries.begin(), body.rotation.entries.end());
    if (!holds(coordinates_in(where), tied)) return std::nullopt;
    ExprVector functions = with_slopes(system_, {gap_, body.position[0], body.position[1]});
    for (const Coordinate& c : system_.coordinates)
      functions.push_back(differentiate(body.angular_velocity[0], c.velocity));
    functions.insert(functions.end(), body.rotation.entries.begin(), body.rotation.entries.end());
    const auto count = static_cast<Eigen::Index>(samples_.states.size());
    Matrix lines(count, 2);
    Vector moments(count);
    for (std::size_t s = 0; s < samples_.states.size(); ++s) {
      const std::vector<double> values = samples_.values(functions, s);
      Matrix twist(3, static_cast<Eigen::Index>(n_));
      twist.topRows(2) = slopes_of(values, 3, 1, 2, n_);
      for (std::size_t i = 0; i < n_; ++i) twist(2, static_cast<Eigen::Index>(i)) = values[3 + 3 * n_ + i];
      const Fit found = fit(twist, slopes_of(values, 3, 0, 1, n_).transpose());
      if (!(found.residual <= agrees) || found.rank < 3) return std::nullopt;
      const double* r = &values[3 + 4 * n_];
      const auto row = static_cast<Eigen::Index>(s);
      lines(row, 0) = r[0] * found.push(1) - r[2] * found.push(0);
      lines(row, 1) = r[1] * found.push(1) - r[3] * found.push(0);
      moments(row) = found.push(2);
    }
    const Eigen::ColPivHouseholderQR<Matrix> solver(lines);
    if (solver.rank() < 2) return std::nullopt;
    const Vector local = solver.solve(moments);
    if (!((lines * local - moments).norm() <= agrees * std::max(moments.norm(), 1e-300))) return std::nullopt;
    Context& c = *system_.context;
    const Expr a = c.number(Rational::from_double(local(0))), b = c.number(Rational::from_double(local(1)));
    Place place;
    for (std::size_t k = 0; k < 2; ++k)
      place.position.push_back(body.position[k] + body.rotation.at(k, 0) * a + body.rotation.at(k, 1) * b);
    return place;
  }

  /// Two places with opposite forces where they touch.
  std::optional<ContactPlaces> pair_of(const std::set<std::size_t>& tied, ContactPlaces& out) const {
    for (std::size_t i = 0; i < candidates_.size(); ++i)
      for (std::size_t k = i + 1; k < candidates_.size(); ++k) {
        std::set<std::size_t> both = symbols_[i];
        both.insert(symbols_[k].begin(), symbols_[k].end());
        if (!holds(both, tied) || !touch(candidates_[i], candidates_[k])) continue;
        out.places = {candidates_[i], candidates_[k]};
        return out;
      }
    return std::nullopt;
  }

  bool touch(const Place& one, const Place& other) const {
    const ExprVector functions =
        with_slopes(system_, {gap_, one.position[0], one.position[1], other.position[0], other.position[1]});
    for (Bindings state : samples_.states) {
      std::vector<double> values;
      for (int round = 0; round < 20; ++round) {  // to where they touch
        values = evaluate(functions, state);
        const Vector slope = slopes_of(values, 5, 0, 1, n_).transpose();
        for (std::size_t i = 0; i < n_; ++i)
          state[system_.coordinates[i].q] -= values[0] * slope(static_cast<Eigen::Index>(i)) / slope.squaredNorm();
      }
      const Fit found = fit(slopes_of(values, 5, 1, 4, n_), slopes_of(values, 5, 0, 1, n_).transpose());
      if (!(found.residual <= agrees)) return false;
      const double sum = std::hypot(found.push(0) + found.push(2), found.push(1) + found.push(3));
      if (!(sum <= 1e-6 * found.push.norm())) return false;
    }
    return true;
  }

  const MechanicalSystem& system_;
  const Bindings& parameters_;
  Samples samples_;
  std::size_t n_;
  std::vector<Place> candidates_;
  std::vector<std::set<std::size_t>> symbols_;  // [candidates] coordinates that they depend on
  Expr gap_;
  mutable bool is_distance_ = false;  // of the place that was looked at last: |∂g/∂P| = 1
};

}  // namespace

ExprVector with_slopes(const MechanicalSystem& system, const ExprVector& functions) {
  ExprVector out = in_terms_of_motion(system, functions);
  for (std::size_t k = 0; k < functions.size(); ++k)
    for (const Coordinate& c : system.coordinates) out.push_back(differentiate(out[k], c.q));
  return out;
}

ContactTracks::ContactTracks(const Model& model, const Bindings& parameters, const Trajectory& run,
                             const EquationsOfMotion* equations)
    : system_(model.system) {
  if (system_.space_dimension != 2 || system_.contacts.empty() || system_.contacts.size() > most_contacts) return;
  Finder finder(system_, parameters, run);
  for (std::size_t i = 0; i < system_.contacts.size(); ++i)
    if (auto found = finder.find(i)) contacts.push_back(std::move(*found));
  add_formulas(system_, run, equations);
}

void ContactTracks::add_formulas(const MechanicalSystem& system, const Trajectory& run,
                                 const EquationsOfMotion* equations) {
  const std::vector<Reaction> all = equations ? reactions(*equations) : std::vector<Reaction>();
  Context& context = *system.context;
  ExprMap at_rest;
  for (const Coordinate& c : system.coordinates) at_rest.emplace(c.velocity, context.number(0));
  for (const ContactPlaces& c : contacts) {
    const Contact& contact = system.contacts[c.contact];
    Formulas f;
    ExprVector functions{contact.gap};
    for (const auto& place : c.places) functions.insert(functions.end(), place.position.begin(), place.position.end());
    f.values = with_slopes(system, functions);
    Expr share = context.number(0);
    for (const Reaction& r : all)
      if (r.symbol == contact.reaction && r.value) {
        f.reaction = run.column("reaction(" + r.name + ")");
        share = substitute(r.value, {{contact.multiplier, context.number(1)}});
      }
    f.values.push_back(share);
    f.slips = contact.friction.slip.size() == 1 && c.places.size() == 1;
    if (f.slips && !contact.name.empty()) f.friction = run.column("friction(" + contact.name + ")");
    if (f.slips) {
      const Expr slip = in_terms_of_motion(system, {&contact.friction.slip[0], 1}).front();
      f.values.push_back(substitute(slip, at_rest));
      for (const Coordinate& q : system.coordinates) f.values.push_back(differentiate(slip, q.velocity));
    }
    f.written = c.places.size() == 1 && !c.places[0].slope.empty();
    if (f.written) {
      const ExprVector slope = in_terms_of_motion(system, c.places[0].slope);
      f.values.insert(f.values.end(), slope.begin(), slope.end());
    }
    formulas_.push_back(std::move(f));
  }
}

void ContactTracks::add_frame(const Bindings& state, const std::function<double(std::size_t)>& column) {
  const std::size_t n = system_.coordinates.size();
  if (contacts.empty() || states.size() > most_numbers) return contacts.clear();
  for (const Coordinate& c : system_.coordinates) states.push_back(state.at(c.q));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    ContactPlaces& c = contacts[i];
    const Formulas& f = formulas_[i];
    const std::size_t places = c.places.size(), functions = 1 + 2 * places;
    const std::vector<double> values = evaluate(f.values, state);
    const Matrix jacobian = slopes_of(values, functions, 1, 2 * places, n);
    const Vector push = fit(jacobian, slopes_of(values, functions, 0, 1, n).transpose()).push;
    c.gap.push_back(values[0]);
    for (std::size_t p = 0; p < places; ++p)
      for (std::size_t k = 0; k < 2; ++k) {
        c.places[p].at.push_back(values[1 + 2 * p + k]);
        c.places[p].push.push_back(push(static_cast<Eigen::Index>(2 * p + k)));
      }
    const std::size_t after = functions * (1 + n);
    for (std::size_t k = 0; k < 2 && f.written; ++k)
      c.places[0].push[c.places[0].push.size() - 2 + k] = values[values.size() - 2 + k];
    if (f.reaction) c.multiplier.push_back(values[after] != 0 ? column(*f.reaction) / values[after] : 0);
    if (!f.slips) continue;
    Vector lever(static_cast<Eigen::Index>(n));  // ∂v_t/∂q' = s Jᵀ τ, but for what turns
    for (std::size_t k = 0; k < n; ++k) lever(static_cast<Eigen::Index>(k)) = values[after + 2 + k];
    const double nx = c.places[0].push.end()[-2], ny = c.places[0].push.end()[-1], size = std::hypot(nx, ny);
    const Vector across = jacobian.transpose() * Vector{{ny / size, -nx / size}};
    const double square = across.squaredNorm(), share = square > 0 ? across.dot(lever) / square : 0;
    c.surface_speed.push_back(share != 0 ? -values[after + 1] / share : 0);
    if (f.friction) c.friction.push_back(share * column(*f.friction));
  }
}

}  // namespace maupertuis::drawing
