#include <maupertuis/degenerate.hpp>
#include <maupertuis/expression_lock.hpp>
#include <maupertuis/rounded_value.hpp>
#include <maupertuis/simulation.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

/// The start in stages: what is written, positions on the constraints, velocities on the constraints, what was moved.
namespace maupertuis {
namespace {

constexpr int searches = 40;
/// A written value that moves by less was meant: its digits end there.
constexpr double rounding_of_digits = 1e-9;

/// "from 2 to 2.00000003": with digits enough to see two places of the change.
std::string change_text(double from, double to) {
  for (int digits = 6; digits < 17; ++digits) {
    const std::string before = fmt::format("{:.{}g}", from, digits), after = fmt::format("{:.{}g}", to, digits);
    const double shown = std::strtod(after.c_str(), nullptr) - std::strtod(before.c_str(), nullptr);
    if (std::abs(shown - (to - from)) <= 0.05 * std::abs(to - from)) return fmt::format("from {} to {}", before, after);
  }
  return fmt::format("from {} to {}", from, to);
}

class Start {
 public:
  Start(const Model& model, const EquationsOfMotion& equations, Diagnostics& diagnostics)
      : model_(model),
        system_(model.system),
        equations_(equations),
        placed_(with_places()),
        diagnostics_(diagnostics),
        bindings_(parameter_bindings(model.system)),
        n_(model.system.coordinates.size()) {}

  std::optional<ConsistentStart> find() {
    if (!read()) return std::nullopt;
    if (equations_.degenerate) return refuse_conditions() ? std::nullopt : find_on_degenerate();
    if (!system_.constrained() && model_.experiment.start_conditions.empty()) return ConsistentStart{state_, {}, false};
    const ConstraintManifold manifold(equations_, rates());
    if (placed_) {
      const ConstraintManifold places(*placed_);
      if (!place(places)) return std::nullopt;
      look_around(places);
    } else if (!place(manifold)) {
      return std::nullopt;
    }
    if (!set_going(manifold)) return std::nullopt;
    ConsistentStart out{state_, {}, searched_ || others_};
    list(out.adjustments, state_.q, written_state_.q, written_q_, 0);
    list(out.adjustments, state_.v, written_state_.v, written_v_, 1);
    warn(out);
    return out;
  }

 private:
  /// Positions and velocities together: a constraint of a degenerate Lagrangian may tie a coordinate to velocities.
  std::optional<ConsistentStart> find_on_degenerate() {
    const StateRelations relations(equations_, *equations_.degenerate);
    ConsistentStart out;
    out.searched = relations.settle(state_, written_q_, written_v_) == Settled::Elsewhere;
    if (!out.searched && !relations.hold(state_)) {
      if (model_.experiment.start_exactly || relations.settle(state_, nothing(), nothing()) == Settled::Nowhere) {
        const std::string worst = relations.worst_at(written_state_);
        diagnostics_.error("E0629", span(), fmt::format("the start does not fulfil {}", worst),
                           "A degenerate Lagrangian asks this of every state of a motion, and no choice of the values "
                           "that the start leaves open fulfils it.",
                           "`maup derive` shows the constraints; correct the start, or give less of it.");
        return std::nullopt;
      }
    }
    out.state = state_;
    list(out.adjustments, state_.q, written_state_.q, written_q_, 0);
    list(out.adjustments, state_.v, written_state_.v, written_v_, 1);
    warn(out);
    return out;
  }

  double value_of(Expr e) const { return rounded_value(in_terms_of_motion(system_, {&e, 1}).front(), bindings_); }

  bool read() {
    state_.q.assign(n_, 0);
    state_.v.assign(n_, 0);
    written_q_.assign(n_, false);
    written_v_.assign(n_, false);
    if (model_.experiment.start_time) state_.t = value_of(model_.experiment.start_time);
    for (const StartValue& start : model_.experiment.start) {
      const double value = value_of(start.value);
      if (!std::isfinite(value)) {
        diagnostics_.error("E0702", start.span, "this start value is not a finite number",
                           "A motion can only begin from a definite state.",
                           "Look for a division by zero or a root of a negative number in it.");
        return false;
      }
      (start.order == 0 ? state_.q : state_.v)[start.coordinate] = value;
      // A body's quaternion begins at 1 where the model gives none: a guess, in the place of the body itself.
      const bool given = start.span != system_.coordinates[start.coordinate].span;
      (start.order == 0 ? written_q_ : written_v_)[start.coordinate] = given;
    }
    written_state_ = state_;
    return true;
  }

  bool refuse_conditions() {
    if (model_.experiment.start_conditions.empty()) return false;
    const StartCondition& c = model_.experiment.start_conditions.front();
    diagnostics_.error("E0504", c.span, fmt::format("a start of `{}` beside a degenerate Lagrangian", c.name),
                       "Its constraints tie positions and velocities to each other, and are solved for coordinates and "
                       "velocities that are given or left open.",
                       "Give the coordinates and velocities that belong to it.");
    return true;
  }

  /// Equations in which places that the start gives, P.x = 1 m, are constraints: so the positions are sought. Nothing
  /// where it gives none.
  std::optional<EquationsOfMotion> with_places() const {
    if (model_.experiment.start_conditions.empty()) return std::nullopt;
    const auto system = std::make_shared<MechanicalSystem>(system_);
    EquationsOfMotion out = equations_;
    for (const StartCondition& c : model_.experiment.start_conditions) {
      if (!c.is_of_positions()) continue;
      Constraint place;
      place.name = fmt::format("the start of `{}`", c.name);
      place.value = c.formula - c.value;
      place.span = c.span;
      system->constraints.push_back(place);
      out.constraint_rates.push_back(total_time_derivative(place.value));
    }
    if (system->constraints.size() == system_.constraints.size()) return std::nullopt;
    out.system = system;
    return out;
  }
  const MechanicalSystem& placed() const { return placed_ ? *placed_->system : system_; }

  std::vector<Expr> rates() const {
    std::vector<Expr> out;
    for (const StartCondition& c : model_.experiment.start_conditions)
      if (!c.is_of_positions()) out.push_back(c.formula - c.value);
    return out;
  }

  /// Each once: both components of a point that is given have its name.
  std::string labels(const std::vector<std::size_t>& of) const {
    std::vector<std::string> names;
    for (const std::size_t k : of)
      if (const std::string name = placed().constraint_label(k);
          std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
    std::string out;
    for (std::size_t k = 0; k < names.size(); ++k)
      out += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + names[k];
    return out;
  }

  std::optional<Span> span() const {
    if (!model_.experiment.start.empty()) return model_.experiment.start.front().span;
    if (!model_.experiment.start_conditions.empty()) return model_.experiment.start_conditions.front().span;
    return std::nullopt;
  }

  std::vector<bool> nothing() const { return std::vector<bool>(n_, false); }

  // ------------------------------------------------------------------------------------------------ positions

  /// The written coordinates stay; then a search over the others; then, unless they are exact, all may move.
  bool place(const ConstraintManifold& manifold) {
    if (placed().constraints.empty() || try_from(manifold, state_, written_q_)) return true;
    if (search(manifold, written_q_)) return true;
    if (model_.experiment.start_exactly && !possible_elsewhere(manifold)) return refuse_clash(manifold);
    if (model_.experiment.start_exactly) return refuse_written(manifold);
    if (try_from(manifold, written_state_, nothing()) || search(manifold, nothing())) return true;
    return refuse_clash(manifold);
  }

  bool try_from(const ConstraintManifold& manifold, const MotionState& from, const std::vector<bool>& fixed) {
    MotionState trial = from;
    trial.v.assign(n_, 0);
    if (!manifold.move_positions(trial, fixed)) return false;
    state_.q = trial.q;
    return true;
  }

  /// Coordinates that may move, and the constraints on them: another group shares none of them.
  struct Group {
    std::vector<bool> rows, coordinates;  // [m], [n]
  };

  std::vector<Group> groups(const ConstraintManifold& manifold, const std::vector<bool>& fixed) const {
    const std::size_t m = placed().constraints.size();
    std::vector<Group> out;
    for (std::size_t k = 0; k < m; ++k) {
      if (placed().constraints[k].level != Constraint::Level::Position) continue;
      out.push_back({std::vector<bool>(m, false), nothing()});
      out.back().rows[k] = true;
    }
    const auto group_of = [&](std::size_t row) {
      return std::find_if(out.begin(), out.end(), [&](const Group& g) { return g.rows[row]; });
    };
    std::vector<std::optional<std::size_t>> row_of(n_);  // one that holds the coordinate
    for (const MatrixEntry& e : manifold.matrix_entries(written_state_)) {
      const auto group = group_of(e.row);
      if (fixed[e.column] || group == out.end()) continue;
      group->coordinates[e.column] = true;
      if (!row_of[e.column]) row_of[e.column] = e.row;
      const auto other = group_of(*row_of[e.column]);
      if (other == group) continue;
      for (std::size_t k = 0; k < m; ++k) other->rows[k] = other->rows[k] || group->rows[k];
      for (std::size_t i = 0; i < n_; ++i) other->coordinates[i] = other->coordinates[i] || group->coordinates[i];
      out.erase(group);
    }
    return out;
  }

  /// Constraints that share no coordinate one group after the other: what none of them holds stays as it is, and so
  /// does, but for a least change, what fits where it is.
  bool search(const ConstraintManifold& manifold, const std::vector<bool>& fixed) {
    MotionState found = written_state_;
    found.v.assign(n_, 0);
    for (const Group& group : groups(manifold, fixed))
      if (!search(manifold, group, found)) return false;
    state_.q = found.q;
    searched_ = true;
    return true;
  }

  /// Newton from the values that are there, then from scattered ones: first near, then far. The same in every run.
  bool search(const ConstraintManifold& manifold, const Group& group, MotionState& found) const {
    std::mt19937_64 random(1744);
    double length = 0;
    for (const Parameter& p : system_.parameters)
      if (p.dimension == dimensions::length()) length = std::max(length, std::abs(p.si_value));
    std::vector<bool> others = group.coordinates;
    others.flip();
    for (int attempt = -1; attempt < searches; ++attempt) {
      MotionState trial = found;
      for (std::size_t i = 0; i < n_ && attempt >= 0; ++i) {
        if (others[i]) continue;
        const bool is_length = system_.coordinates[i].kind == "length" && length > 0;
        const double size = (is_length ? length : attempt < searches / 2 ? 0.5 : 3.0);
        trial.q[i] += size * (std::generate_canonical<double, 53>(random) * 2 - 1 + (attempt == 0 ? 1 : 0));
      }
      if (!manifold.move_positions(trial, others, group.rows)) continue;
      found.q = trial.q;
      return true;
    }
    return false;
  }

  /// A point may be reached in several ways: (r, φ) and (−r, φ + π), the elbow of an arm on either side. Lengths that
  /// are sought are to be positive where they can be; that there are others is told.
  void look_around(const ConstraintManifold& manifold) {
    constexpr int looks = 24;
    constexpr std::size_t most = 100;  // coordinates
    if (n_ > most) return;
    std::mt19937_64 random(1788);
    std::vector<bool> held = written_q_;
    const std::vector<Group> all = groups(manifold, written_q_);
    for (std::size_t i = 0; i < n_; ++i)
      held[i] = held[i] || std::none_of(all.begin(), all.end(), [&](const Group& g) { return g.coordinates[i]; });
    const std::vector<double> found = state_.q;
    for (int look = 0; look < looks; ++look) {
      MotionState trial{state_.t, found, std::vector<double>(n_, 0)};
      for (std::size_t i = 0; i < n_; ++i) {
        if (held[i]) continue;
        const double part = std::generate_canonical<double, 53>(random) * 2 - 1;
        trial.q[i] = is_length(i) ? std::abs(found[i]) : found[i] + 3.2 * part;
      }
      if (!manifold.move_positions(trial, held) || is_same(trial.q, found)) continue;
      others_ = true;
      if (negative_lengths(trial.q, held) < negative_lengths(state_.q, held)) state_.q = trial.q;
    }
  }
  bool is_length(std::size_t i) const { return system_.coordinates[i].kind == "length"; }
  std::size_t negative_lengths(const std::vector<double>& q, const std::vector<bool>& held) const {
    std::size_t out = 0;
    for (std::size_t i = 0; i < n_; ++i) out += !held[i] && is_length(i) && q[i] < 0 ? 1 : 0;
    return out;
  }
  /// But for turns of angles.
  bool is_same(const std::vector<double>& a, const std::vector<double>& b) const {
    constexpr double turn = 2 * 3.14159265358979323846, near = 1e-6;
    for (std::size_t i = 0; i < n_; ++i) {
      const double off = system_.coordinates[i].kind == "angle" ? std::remainder(a[i] - b[i], turn) : a[i] - b[i];
      if (std::abs(off) > near * (1 + std::abs(b[i]))) return false;
    }
    return true;
  }

  bool possible_elsewhere(const ConstraintManifold& manifold) {
    const MotionState keep = state_;
    const bool possible = try_from(manifold, written_state_, nothing()) || search(manifold, nothing());
    state_ = keep;
    return possible;
  }

  bool refuse_written(const ConstraintManifold& manifold) {
    const auto off = manifold.relative_values(written_state_);
    const auto worst = static_cast<std::size_t>(std::max_element(off.begin(), off.end()) - off.begin());
    diagnostics_.error(
        "E0707", span(), fmt::format("the start violates {}", placed().constraint_label(worst)),
        "`start exactly` keeps the written values, and no choice of the others satisfies the constraints.",
        "Correct the values, give fewer of them, or leave out `exactly`.");
    return false;
  }

  bool refuse_clash(const ConstraintManifold& manifold) {
    MotionState trial = written_state_;
    trial.v.assign(n_, 0);
    std::mt19937_64 random(1788);  // zero is a singular place of many constraints: none of them is met from there
    for (std::size_t i = 0; placed_ && i < n_; ++i)
      if (!written_q_[i]) trial.q[i] += 0.1 + std::generate_canonical<double, 53>(random);
    const std::vector<std::size_t> clash = manifold.smallest_clash(trial);
    const std::string names = labels(clash);
    const std::optional<Span> place =
        clash.empty() ? std::nullopt : std::optional(placed().constraints[clash.back()].span);
    diagnostics_.error("E0708", place, fmt::format("no configuration satisfies {}", names),
                       "These constraints exclude each other from where the motion starts: the loop cannot close.",
                       "Check the lengths in them, or start nearer to a configuration that is possible.");
    return false;
  }

  // ----------------------------------------------------------------------------------------------- velocities

  bool set_going(const ConstraintManifold& manifold) {
    if (!rates().empty() && move(manifold, what_no_rate_names())) return true;
    if (move(manifold, written_v_)) return true;
    const auto off = manifold.relative_rates(written_state_at(state_.q));
    const auto worst = static_cast<std::size_t>(std::max_element(off.begin(), off.end()) - off.begin());
    const bool is_rate = worst >= manifold.constraints();
    const StartCondition* const rate = is_rate ? rate_of_start(worst - manifold.constraints()) : nullptr;
    const std::string label = rate ? fmt::format("the start of `{}`", rate->name) : system_.constraint_label(worst);
    if (model_.experiment.start_exactly) {
      diagnostics_.error(
          "E0707", span(), fmt::format("the velocities of the start violate {}", label),
          "`start exactly` keeps the written values, and no choice of the others satisfies the constraints.",
          "Correct the values, give fewer of them, or leave out `exactly`.");
      return false;
    }
    if (move(manifold, nothing())) return true;
    const auto clash = is_rate ? std::vector<std::size_t>{} : manifold.smallest_clash(written_state_at(state_.q));
    diagnostics_.error("E0709", rate ? rate->span : system_.constraints[worst].span,
                       fmt::format("no velocities satisfy {} at the start", clash.empty() ? label : labels(clash)),
                       "At this configuration the constraints on the velocities exclude each other.",
                       "Start from another configuration, or check the constraints.");
    return false;
  }

  /// Velocities that are written, and those in no rate that the start gives: B.ω turns a body, and nothing else has to
  /// go.
  std::vector<bool> what_no_rate_names() const {
    std::vector<bool> out = written_v_;
    const std::vector<Expr> given = rates();
    for (std::size_t i = 0; i < n_; ++i)
      out[i] = out[i] || std::none_of(given.begin(), given.end(), [&](const Expr& rate) {
                 return !differentiate(rate, system_.coordinates[i].velocity).is_zero();
               });
    return out;
  }

  /// Of those that velocities give.
  const StartCondition* rate_of_start(std::size_t index) const {
    for (const StartCondition& c : model_.experiment.start_conditions)
      if (!c.is_of_positions() && index-- == 0) return &c;
    return nullptr;
  }

  MotionState written_state_at(const std::vector<double>& q) const { return {state_.t, q, written_state_.v}; }

  bool move(const ConstraintManifold& manifold, const std::vector<bool>& fixed) {
    MotionState trial = written_state_at(state_.q);
    if (!manifold.move_velocities(trial, fixed)) return false;
    state_.v = trial.v;
    return true;
  }

  // --------------------------------------------------------------------------------------------------- report

  static void list(std::vector<StartAdjustment>& out, const std::vector<double>& now, const std::vector<double>& before,
                   const std::vector<bool>& written, int order) {
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double change = std::abs(now[i] - before[i]);
      if (change > (written[i] ? rounding_of_digits * std::abs(before[i]) : 0))
        out.push_back({i, order, before[i], now[i], written[i]});
    }
  }

  /// The start value whose unit the model writes; null where it writes none.
  const StartValue* written_in_unit(const StartAdjustment& a) const {
    for (const StartValue& v : model_.experiment.start)
      if (v.coordinate == a.coordinate && v.order == a.order && !v.unit.empty()) return &v;
    return nullptr;
  }

  std::string moved_text(const StartAdjustment& a) const {
    const std::string name = system_.coordinates[a.coordinate].name + (a.order == 0 ? "" : "'");
    const StartValue* given = written_in_unit(a);
    if (!given) return name + " " + change_text(a.from, a.to);
    const double by = given->unit_factor;
    return fmt::format("{} {} {}", name, change_text(a.from / by, a.to / by), given->unit);
  }

  void warn(const ConsistentStart& out) {
    std::string moved;
    bool in_si = false;
    for (const StartAdjustment& a : out.adjustments) {
      if (!a.written) continue;
      in_si = in_si || !written_in_unit(a);
      moved += (moved.empty() ? "" : ", ") + moved_text(a);
    }
    if (!moved.empty())
      diagnostics_.warning("W0701", span(),
                           fmt::format("the start was moved onto the constraints: {}{}", moved,
                                       in_si && !system_.dimensionless ? " (SI where no unit stands)" : ""),
                           "The written values contradict the constraints, so that the least kinetic change was made.",
                           "Correct the values, or give fewer of them.");
    else if (out.searched)
      diagnostics_.note(
          "N0701", span(),
          others_ ? "the start is one of several that give the points their places" : "the start was found by a search",
          others_
              ? "Points are reached in more ways than one, as by an elbow on either side."
              : "There is no solution near zero for the coordinates that the start does not give; others may exist.",
          "Give more start values to choose how the system is assembled.");
  }

  const Model& model_;
  const MechanicalSystem& system_;
  const EquationsOfMotion& equations_;
  std::optional<EquationsOfMotion> placed_;
  Diagnostics& diagnostics_;
  Bindings bindings_;
  std::size_t n_;
  MotionState state_, written_state_;
  std::vector<bool> written_q_, written_v_;
  bool searched_ = false;
  bool others_ = false;  // configurations that give the points of the start their places
};

}  // namespace

std::optional<ConsistentStart> consistent_start(const Model& model, const EquationsOfMotion& equations,
                                                Diagnostics& diagnostics) {
  const ExpressionLock lock(*equations.system->context);
  return Start(model, equations, diagnostics).find();
}

}  // namespace maupertuis
