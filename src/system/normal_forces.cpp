#include <maupertuis/normal_force.hpp>
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
  ExprVector along;                         // ∂f/∂r [dimension]
  Expr square;                              // |∂f/∂r|²
  std::map<std::size_t, ExprVector> moves;  // by coordinate ∂(r − r')/∂q
};

/// ∂f/∂q of the coordinates of which it is not 0.
using Row = std::map<std::size_t, Expr>;

/// Of several ways to the same force.
class Agreed {
 public:
  void add(std::optional<Push> push) {
    if (!push) return;
    clash_ = clash_ || (first_ && !vanishes_identically(first_->square - push->square));
    if (!first_) first_ = std::move(push);
  }
  bool any() const { return first_.has_value(); }
  std::optional<Push> push() const { return clash_ ? std::nullopt : first_; }

 private:
  std::optional<Push> first_;
  bool clash_ = false;
};

class Masses {
 public:
  explicit Masses(const MechanicalSystem& system) : system_(system) {
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
      numbers_.emplace(system.coordinates[i].q, i);
      numbers_.emplace(system.coordinates[i].velocity, i);
    }
    for (const Point& p : system.points) (p.mass ? masses_ : marks_).push_back(mass_at(p.name, p.position));
    for (const Body& b : system.bodies) {
      masses_.push_back(mass_at(b.name, b.position));
      turning_.merge(named(b.rotation.entries));
    }
  }

  /// f: a gap, or a slip velocity, whose derivatives by the velocities count. Where it is the distance or the velocity
  /// of a point without mass, such as the tip of a lever, that is meant. Coordinates that turn a body take torques, and
  /// say nothing of it.
  std::optional<Push> pushed(Expr f, bool is_velocity) const {
    const Row row = slopes(f, is_velocity);
    std::optional<Push> out = pushed_mass(row, is_velocity);
    if (out && is_one(out->square)) return out;
    for (const Mass& mark : marks_)
      if (auto push = push_on(mark, nullptr, mark.moved_by, row); push && is_one(push->square)) return push;
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

  /// A coordinate whose rate stands in the slip, and which moves what the contact pushes along the normal alone.
  std::optional<std::size_t> opens_by(const Push& gap, Expr slip) const {
    for (const auto& [i, slope] : slopes(slip, true)) {
      const auto move = gap.moves.find(i);
      if (move != gap.moves.end() && are_parallel(move->second, gap.along)) return i;
    }
    return std::nullopt;
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

  Mass mass_at(const std::string& name, const ExprVector& position) const {
    return {&name, &position, named(position)};
  }
  /// The coordinates that stand in them, or their velocities.
  std::set<std::size_t> named(const ExprVector& formulas) const {
    std::set<std::size_t> out;
    for (const Expr& symbol : symbols_of(formulas))
      if (const auto found = numbers_.find(symbol); found != numbers_.end()) out.insert(found->second);
    return out;
  }
  /// [coordinates that do not turn a body] that are not 0
  Row slopes(Expr f, bool is_velocity) const {
    Row row;
    for (const std::size_t i : named({f})) {
      const Coordinate& c = system_.coordinates[i];
      const Expr slope = differentiate(f, is_velocity ? c.velocity : c.q);
      if (!slope.is_zero() && turning_.count(i) == 0) row.emplace(i, slope);
    }
    return row;
  }
  /// Neither of them 0.
  static bool are_parallel(const ExprVector& a, const ExprVector& b) {
    if (std::all_of(a.begin(), a.end(), [](const Expr& x) { return x.is_zero(); })) return false;
    for (std::size_t k = 0; k < a.size(); ++k)
      for (std::size_t l = 0; l < k; ++l)
        if (!vanishes_identically(a[k] * b[l] - a[l] * b[k])) return false;
    return true;
  }
  /// Of the components of a place those that a coordinate moves.
  std::size_t dimensions_of(const Mass& m) const {
    std::size_t out = 0;
    for (const Expr& component : *m.position) out += named({component}).empty() ? 0 : 1;
    return std::max<std::size_t>(out, 2);
  }

  /// It pushes one mass, or two apart, or pulls each of several by the same force as a rope does: the first of these
  /// that fits. Nothing where none does, or where some do with different forces.
  std::optional<Push> pushed_mass(const Row& row, bool is_velocity) const {
    std::vector<const Mass*> moved;
    for (const Mass& m : masses_)
      if (std::any_of(row.begin(), row.end(), [&](const auto& e) { return m.moved_by.count(e.first) > 0; }))
        moved.push_back(&m);
    Agreed alone, apart, each;
    for (const Mass* m : moved) alone.add(push_on(*m, nullptr, m->moved_by, row));
    if (alone.any()) return alone.push();
    for (const Mass* m : moved)
      for (const Mass& other : masses_) apart.add(push_apart(*m, other, row));
    if (apart.any() || is_velocity) return apart.push();
    for (const Mass* m : moved) each.add(pull_on(*m, row));
    return each.push();
  }

  bool is_one(Expr square) const { return vanishes_identically(square - system_.context->number(1)); }

  /// Where coordinates carry a mass along with another one, that one may take the opposite force: a block whose height
  /// above a wedge is a coordinate. On the one that is declared first, so that gap and slip speak of the same.
  std::optional<Push> push_apart(const Mass& mass, const Mass& other, const Row& row) const {
    if (&other == &mass) return std::nullopt;
    if (&other < &mass) return push_apart(other, mass, row);
    std::set<std::size_t> both = mass.moved_by;
    both.insert(other.moved_by.begin(), other.moved_by.end());
    return push_on(mass, &other, both, row);
  }

  /// By the coordinates that move no other mass, where they are enough.
  std::optional<Push> pull_on(const Mass& mass, const Row& row) const {
    std::set<std::size_t> own = mass.moved_by;
    for (const Mass& other : masses_)
      if (&other != &mass)
        for (const std::size_t i : other.moved_by) own.erase(i);
    if (own.size() < dimensions_of(mass)) return std::nullopt;
    Row part;
    for (const auto& entry : row)
      if (own.count(entry.first) > 0) part.insert(entry);
    return push_on(mass, nullptr, own, part);
  }

  /// What a coordinate does to the place of one mass, beside that of another.
  struct Column {
    std::size_t coordinate;
    ExprVector r;  // ∂(r − r')/∂q [dimension]
    Expr slope;    // ∂f/∂q
  };

  /// d with d·∂(r − r')/∂q = ∂f/∂q for each of the coordinates: the force on the mass per λ; −d is that on the other.
  /// As many of them as r − r' has directions give d, the others have to agree.
  std::optional<Push> push_on(const Mass& mass, const Mass* other, const std::set<std::size_t>& by,
                              const Row& row) const {
    if (std::any_of(row.begin(), row.end(), [&](const auto& e) { return by.count(e.first) == 0; })) return std::nullopt;
    const std::vector<Column> columns = columns_of(mass, other, by, row);
    std::vector<std::size_t> directions;  // components that change
    for (std::size_t k = 0; k < mass.position->size(); ++k)
      if (std::any_of(columns.begin(), columns.end(), [&](const Column& c) { return !c.r[k].is_zero(); }))
        directions.push_back(k);
    const std::optional<ExprVector> d = solved(columns, directions);
    if (!d) return std::nullopt;
    Push out{*mass.name, ExprVector(mass.position->size(), system_.context->number(0)), {}, {}};
    for (const Column& c : columns) out.moves.emplace(c.coordinate, c.r);
    ExprVector squares;
    for (std::size_t k = 0; k < directions.size(); ++k) {
      out.along[directions[k]] = (*d)[k];
      squares.push_back((*d)[k] * (*d)[k]);
    }
    out.square = system_.context->sum(squares);
    return out;
  }

  /// Those of numbers first, as of x and y: they give the shortest formulas.
  std::vector<Column> columns_of(const Mass& mass, const Mass* other, const std::set<std::size_t>& by,
                                 const Row& row) const {
    std::vector<Column> out;
    for (const std::size_t i : by) {
      if (turning_.count(i) > 0) continue;
      const Expr q = system_.coordinates[i].q;
      const auto slope = row.find(i);
      Column c{i, {}, slope == row.end() ? system_.context->number(0) : slope->second};
      for (std::size_t k = 0; k < mass.position->size(); ++k) {
        const Expr own = differentiate((*mass.position)[k], q);
        c.r.push_back(other ? own - differentiate((*other->position)[k], q) : own);
      }
      out.push_back(std::move(c));
    }
    std::stable_partition(out.begin(), out.end(), [](const Column& c) {
      return std::all_of(c.r.begin(), c.r.end(), [](const Expr& e) { return e.is_number(); });
    });
    return out;
  }

  /// Gauss and Jordan over the chosen components, row by row as far as a pivot is left; nothing where some component of
  /// d stays open, or a row asks for another d.
  std::optional<ExprVector> solved(std::vector<Column> rows, const std::vector<std::size_t>& directions) const {
    std::vector<Column> reduced;  // of each direction the row with its pivot, 1
    std::vector<std::size_t> pivots;
    for (Column& c : rows) {
      for (std::size_t p = 0; p < pivots.size(); ++p) subtract(c, reduced[p], c.r[pivots[p]]);
      const auto pivot = std::find_if(directions.begin(), directions.end(), [&](std::size_t k) {
        return !c.r[k].is_zero() && !vanishes_identically(c.r[k]);
      });
      if (pivot == directions.end()) {
        if (!vanishes_identically(c.slope)) return std::nullopt;
        continue;
      }
      const Expr by = c.r[*pivot];
      for (Expr& component : c.r) component = component / by;
      c.slope = c.slope / by;
      for (Column& other : reduced) subtract(other, c, other.r[*pivot]);
      reduced.push_back(c);
      pivots.push_back(*pivot);
    }
    if (pivots.size() < directions.size() || pivots.empty()) return std::nullopt;
    ExprVector d;
    for (const std::size_t k : directions)
      d.push_back(reduced[static_cast<std::size_t>(std::find(pivots.begin(), pivots.end(), k) - pivots.begin())].slope);
    return d;
  }
  static void subtract(Column& from, const Column& row, const Expr factor) {
    if (factor.is_zero()) return;
    for (std::size_t k = 0; k < from.r.size(); ++k) from.r[k] = from.r[k] - factor * row.r[k];
    from.slope = from.slope - factor * row.slope;
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
  std::vector<Mass> masses_, marks_;  // marks: points without mass
  std::set<std::size_t> turning_;     // coordinates that turn a body
};

/// What a slip velocity has to be less ġ times so that its direction is along the surface: on the surface ġ is 0, and
/// the slip what is written. Friction would have a part across it else, as by s' of a place (s cos α, n + s sin α).
/// Empty: nothing, or not known.
Expr share_of_gap_rate(const Masses& masses, const Contact& contact, const Push& gap, Expr slip) {
  const auto push = masses.pushed(slip, true);
  if (!push || push->name != gap.name) return {};
  ExprVector products;
  for (std::size_t k = 0; k < gap.along.size(); ++k) products.push_back(gap.along[k] * push->along[k]);
  const Expr share = contact.gap.context().sum(products) / gap.square;
  return vanishes_identically(share) ? Expr() : share;
}

/// E0265 where a slip holds the rate of a coordinate that does nothing but open the contact: friction along it would do
/// work where nothing slides. False then.
bool slips_along_surface(const Masses& masses, const MechanicalSystem& system, std::size_t k, const Push& gap,
                         Diagnostics& diagnostics) {
  const Contact& contact = system.contacts[k];
  for (const Expr& slip : contact.friction.slip) {
    const auto i = masses.opens_by(gap, slip);
    if (!i) continue;
    diagnostics.error(
        "E0265", contact.friction.span, "this slip velocity is not along the surface",
        fmt::format("{}' is the velocity of {} along the normal, at which the contact opens: friction does no work "
                    "there.",
                    system.coordinates[*i].name, gap.name),
        "Write the velocity along the surface alone, such as slip x' where the contact is z >= 0.");
    return false;
  }
  return true;
}

/// Of the contact and of its written twin.
void lay_slip_along_surface(const Masses& masses, MechanicalSystem& system, std::size_t k, const Push& gap) {
  const Contact contact = system.contacts[k];
  for (std::size_t i = 0; i < contact.friction.slip.size(); ++i) {
    const Expr share = share_of_gap_rate(masses, contact, gap, contact.friction.slip[i]);
    if (!share) continue;
    const auto lay = [&](Contact& c) {
      c.friction.slip[i] = c.friction.slip[i] - share * total_time_derivative(c.gap);
    };
    lay(system.contacts[k]);
    if (!system.written) continue;
    MechanicalSystem written = *system.written;
    lay(written.contacts[k]);
    system.written = std::make_shared<const MechanicalSystem>(std::move(written));
  }
}

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

/// W0437 where nothing tells what the contact pushes, and its gap is plainly no distance.
void look_at_gap(const Masses& masses, const MechanicalSystem& system, std::size_t k, Diagnostics& diagnostics) {
  const Contact& contact = system.contacts[k];
  const bool is_length = system.dimensionless || contact.dimension == dimensions::length();
  if (!is_length || !masses.is_no_distance(contact.gap)) return;
  diagnostics.warning(
      "W0437", contact.span, fmt::format("the gap of {} is no distance", system.contact_label(k)),
      "What it pushes is not known from the energies, so that friction takes λ for the normal force. That is λ "
      "times the length of ∂g/∂r, r the place of what the contact pushes.",
      "Divide the gap by that length, as in (y - a x^2)/sqrt(1 + 4 a^2 x^2) >= 0, or give the masses as points.");
}

/// Coefficients of λ instead of N = λ `factor`, of the contact and of its written twin.
void scale_friction(MechanicalSystem& system, std::size_t k, Expr factor) {
  const auto scale = [&](Friction& friction) {
    friction.kinetic = friction.kinetic * factor;
    friction.static_ = friction.static_ * factor;
    friction.per_multiplier = factor;
  };
  scale(system.contacts[k].friction);
  if (!system.written) return;
  MechanicalSystem written = *system.written;
  scale(written.contacts[k].friction);
  system.written = std::make_shared<const MechanicalSystem>(std::move(written));
}

}  // namespace

void set_normal_forces(MechanicalSystem& system, Diagnostics& diagnostics) {
  std::optional<Masses> masses;
  for (std::size_t k = 0; k < system.contacts.size(); ++k) {
    const Contact& contact = system.contacts[k];
    if (!contact.friction.present()) continue;
    if (!masses) masses.emplace(system);
    const auto push = masses->pushed(contact.gap, false);
    if (push && !slips_along_surface(*masses, system, k, *push, diagnostics)) continue;
    if (push) lay_slip_along_surface(*masses, system, k, *push);
    if (contact.friction.sticking) continue;  // held whatever the normal force
    look_at_slip(*masses, contact, diagnostics);
    if (!push)
      look_at_gap(*masses, system, k, diagnostics);
    else if (!masses->is_unit(*push, contact.gap))
      scale_friction(system, k, sqrt(push->square));
  }
}

}  // namespace maupertuis::elaboration

namespace maupertuis {

Expr normal_force_per_multiplier(const MechanicalSystem& system, const Contact& contact) {
  const auto push = elaboration::Masses(system).pushed(contact.gap, false);
  return push ? sqrt(push->square) : Expr();
}

}  // namespace maupertuis
