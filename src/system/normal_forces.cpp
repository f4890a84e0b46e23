#include <maupertuis/transform.hpp>

#include "system/elaboration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

/// Coulomb's friction is μ times the normal force. That is λ |∂g/∂r|, where r is the place of what the contact pushes:
/// λ itself only where g is the distance to the surface.
namespace maupertuis::elaboration {
namespace {

/// ∂f/∂r of the one particle or body that it pushes.
struct Push {
  std::string name;
  Expr square;  // |∂f/∂r|²
};

class Masses {
 public:
  explicit Masses(const MechanicalSystem& system) : system_(system) {
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
      numbers_.emplace(system.coordinates[i].q, i);
      numbers_.emplace(system.coordinates[i].velocity, i);
    }
    for (const Point& p : system.points)
      if (p.mass) add(p.name, p.position);
    for (const Body& b : system.bodies) {
      add(b.name, b.position);
      turning_.merge(named(b.rotation.entries));
    }
  }

  /// f: a gap, or a slip velocity, whose derivatives by the velocities count. Nothing where the place of what is moved
  /// is not known, or the coordinates are not along directions at right angles. Coordinates that turn a body take
  /// torques. Of two masses that a contact pushes apart each takes the same force, and one that moves along a rail says
  /// nothing of what acts across it.
  std::optional<Push> pushed(Expr f, bool is_velocity) const {
    const std::map<std::size_t, Expr> row = slopes(f, is_velocity);
    std::vector<const Mass*> moved, free;
    for (const Mass& m : masses_) {
      const auto count =
          std::count_if(row.begin(), row.end(), [&](const auto& e) { return m.moved_by.count(e.first); });
      if (count == 0) continue;
      moved.push_back(&m);
      if (m.moved_by.size() >= dimensions_of(m)) free.push_back(&m);
    }
    if (moved.size() == 1) return push_on(*moved.front(), row, is_velocity);
    std::optional<Push> out;
    for (const Mass* m : is_velocity ? std::vector<const Mass*>() : free) {
      auto push = push_on(*m, row, is_velocity);
      if (!push || (out && !vanishes_identically(out->square - push->square))) return std::nullopt;
      if (!out) out = std::move(push);
    }
    return out;
  }

  /// Whether ∂f/∂q holds ±1 beside what is neither 0 nor ±1, or more than 1: of lengths that move one point, or two
  /// points apart, that is no direction.
  bool is_no_distance(Expr gap) const {
    bool has_one = false, has_part = false;
    for (const auto& [i, slope] : slopes(gap, false)) {
      if (system_.coordinates[i].kind != "length") continue;
      const Expr square_less_one = slope * slope - system_.context->number(1);
      const bool is_one = vanishes_identically(square_less_one);
      has_one = has_one || is_one;
      has_part = has_part || !is_one;
      if (!is_one && square_less_one.is_number() && square_less_one.number().sign() > 0) return true;
    }
    return has_one && has_part;
  }

  /// Whether |∂f/∂r| is 1 on the surface g = 0.
  bool is_unit(const Push& push, Expr gap) const {
    const Expr off = push.square - system_.context->number(1);
    return vanishes_identically(off) ||
           zero_test_where({&off, 1}, {&gap, 1}, coordinates(), center()).verdict == Verdict::Zero;
  }

 private:
  struct Mass {
    const std::string* name;
    const ExprVector* position;
    std::set<std::size_t> moved_by;
  };

  void add(const std::string& name, const ExprVector& position) {
    masses_.push_back({&name, &position, named(position)});
  }
  /// The coordinates that stand in them, or their velocities.
  std::set<std::size_t> named(const ExprVector& formulas) const {
    std::set<std::size_t> out;
    for (const Expr& symbol : symbols_of(formulas))
      if (const auto found = numbers_.find(symbol); found != numbers_.end()) out.insert(found->second);
    return out;
  }
  /// [coordinates that do not turn a body] that are not 0
  std::map<std::size_t, Expr> slopes(Expr f, bool is_velocity) const {
    std::map<std::size_t, Expr> row;
    for (const std::size_t i : named({f})) {
      const Coordinate& c = system_.coordinates[i];
      const Expr slope = differentiate(f, is_velocity ? c.velocity : c.q);
      if (!slope.is_zero() && turning_.count(i) == 0) row.emplace(i, slope);
    }
    return row;
  }
  /// Of the components of a place those that a coordinate moves.
  std::size_t dimensions_of(const Mass& m) const {
    std::size_t out = 0;
    for (const Expr& component : *m.position) out += named({component}).empty() ? 0 : 1;
    return std::max<std::size_t>(out, 2);
  }

  std::optional<Push> push_on(const Mass& mass, const std::map<std::size_t, Expr>& all, bool is_velocity) const {
    std::map<std::size_t, Expr> row;
    for (const auto& entry : all)
      if (mass.moved_by.count(entry.first) > 0) row.insert(entry);
    if (is_velocity && row.size() != all.size()) return std::nullopt;
    Context& context = *system_.context;
    const ExprVector& r = *mass.position;
    const auto slope = [&](std::size_t k, std::size_t i) { return differentiate(r[k], system_.coordinates[i].q); };
    ExprVector direction(r.size(), context.number(0)), squares;
    for (const auto& [i, value] : row)
      for (std::size_t k = 0; k < r.size(); ++k) direction[k] = direction[k] + value * slope(k, i);
    for (const auto& [i, value] : row) {
      ExprVector rest{-value};
      for (std::size_t k = 0; k < r.size(); ++k) rest.push_back(direction[k] * slope(k, i));
      if (!vanishes_identically(context.sum(rest))) return push_in_plane(mass, row);
    }
    for (const Expr& component : direction) squares.push_back(component * component);
    return Push{*mass.name, context.sum(squares)};
  }

  /// Of a point that two coordinates move in a plane, whatever directions they have, such as polar ones: |d|² of the
  /// direction d with d·∂r/∂q_i = ∂f/∂q_i, by the matrix of the products of the ∂r/∂q_i.
  std::optional<Push> push_in_plane(const Mass& mass, const std::map<std::size_t, Expr>& row) const {
    if (mass.moved_by.size() != 2 || dimensions_of(mass) != 2) return std::nullopt;
    Context& context = *system_.context;
    Expr g[2][2], f[2];
    std::size_t a = 0;
    for (const std::size_t i : mass.moved_by) {
      if (turning_.count(i) > 0) return std::nullopt;
      std::size_t b = 0;
      for (const std::size_t k : mass.moved_by) {
        ExprVector products;
        for (const Expr& component : *mass.position)
          products.push_back(differentiate(component, system_.coordinates[i].q) *
                             differentiate(component, system_.coordinates[k].q));
        g[a][b++] = context.sum(products);
      }
      const auto found = row.find(i);
      f[a++] = found == row.end() ? context.number(0) : found->second;
    }
    const Expr det = g[0][0] * g[1][1] - g[0][1] * g[0][1];
    if (vanishes_identically(det)) return std::nullopt;
    const Expr two = context.number(2);
    return Push{*mass.name, (g[1][1] * f[0] * f[0] - two * g[0][1] * f[0] * f[1] + g[0][0] * f[1] * f[1]) / det};
  }

  ExprVector coordinates() const {
    ExprVector out;
    for (const Coordinate& c : system_.coordinates) out.push_back(c.q);
    return out;
  }

  /// Away from symmetric places.
  Bindings center() const {
    Bindings out;
    for (const Parameter& p : system_.parameters) out[p.symbol] = p.si_value;
    double x = 0.3;
    for (const Coordinate& c : system_.coordinates) {
      out[c.q] = x += 0.17;
      out[c.velocity] = 0.1 * x;
    }
    for (const Input& u : system_.inputs) out[u.symbol] = 0.5;
    out[system_.context->time()] = 0.3;
    return out;
  }

  const MechanicalSystem& system_;
  std::unordered_map<Expr, std::size_t, ExprHash> numbers_;
  std::vector<Mass> masses_;
  std::set<std::size_t> turning_;  // coordinates that turn a body
};

/// W0435 where a component of the slip is not the velocity of what it moves along some direction.
void look_at_slip(const Masses& masses, const Contact& contact, Diagnostics& diagnostics) {
  for (const Expr& slip : contact.friction.slip) {
    const auto push = masses.pushed(slip, true);
    if (!push || masses.is_unit(*push, contact.gap)) continue;
    diagnostics.warning(
        "W0435", contact.friction.span, fmt::format("this slip velocity is no velocity of {}", push->name),
        fmt::format("It is the velocity of {} along the surface times a factor, and so is the friction on {}: not μ "
                    "times the normal force.",
                    push->name, push->name),
        "Divide by the factor, as in slip (x' + 2 a x y')/sqrt(1 + 4 a^2 x^2); leave it where a gear between the two "
        "makes the factor.");
    return;
  }
}

}  // namespace

void set_normal_forces(MechanicalSystem& system, Diagnostics& diagnostics) {
  std::optional<Masses> masses;
  for (std::size_t k = 0; k < system.contacts.size(); ++k) {
    Contact& contact = system.contacts[k];
    if (!contact.friction.present() || contact.friction.sticking) continue;
    if (!masses) masses.emplace(system);
    look_at_slip(*masses, contact, diagnostics);
    const auto push = masses->pushed(contact.gap, false);
    const bool is_length = system.dimensionless || contact.dimension == dimensions::length();
    if (!push && is_length && masses->is_no_distance(contact.gap))
      diagnostics.warning(
          "W0437", contact.span, fmt::format("the gap of {} is no distance", system.contact_label(k)),
          "What it pushes is not known from the energies, so that friction takes λ for the normal force. That is λ "
          "times the length of ∂g/∂r, r the place of what the contact pushes.",
          "Divide the gap by that length, as in (y - a x^2)/sqrt(1 + 4 a^2 x^2) >= 0, or give the masses as points.");
    if (!push || masses->is_unit(*push, contact.gap)) continue;
    const Expr factor = sqrt(push->square);
    const auto scale = [&](Friction& friction) {
      friction.kinetic = friction.kinetic * factor;
      friction.static_ = friction.static_ * factor;
      friction.per_multiplier = factor;
    };
    scale(contact.friction);
    if (!system.written) continue;
    MechanicalSystem written = *system.written;
    scale(written.contacts[k].friction);
    system.written = std::make_shared<const MechanicalSystem>(std::move(written));
  }
}

}  // namespace maupertuis::elaboration
