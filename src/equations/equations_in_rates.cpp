#include <maupertuis/integral_symbol.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/rates.hpp>

#include "equations/rate_kinematics.hpp"
#include "equations/simplified.hpp"

#include <algorithm>

/// The equations of Boltzmann and Hamel. With L̃(q,σ,t) = L, p = ∂L̃/∂σ over all σ, those of the constraints included,
/// and D̃, Q likewise,
///
///     ṗ_a + Σ_c p_c X_ia w_ci − X_ia ∂L̃/∂q_i + ∂D̃/∂σ_a = X_ia Q_i
///     w_ci = Σ_j (∂Y_ci/∂q_j − ∂Y_cj/∂q_i) q̇_j + ∂Y_ci/∂t − ∂y_c/∂q_i
///
/// which is Xᵀ R, since p_c w_ci is what d/dt and ∂/∂q of p_c σ_c leave. The σ of constraints are set to 0 only after
/// differentiating. What comes out is compared with Xᵀ R itself, in which neither p nor w occurs.
namespace maupertuis {
namespace {

class HamelEquations {
 public:
  HamelEquations(const EquationsOfMotion& equations, const RateKinematics& kinematics, const ReadingOrder& order,
                 const UnitQuaternions& spheres)
      : equations_(equations),
        system_(*equations.system),
        k_(kinematics),
        order_(order),
        spheres_(spheres),
        held_(kinematics.on_constraints()),
        velocities_(kinematics.replacements(system_)),
        lagrangian_(k_.by_coefficients(in_rates(equations.lagrangian_expanded), order, spheres)) {
    for (const Expr& s : k_.sigma) momenta_.push_back(differentiate(lagrangian_, s));
    find_curls();
  }

  Expr lagrangian() const { return substitute(lagrangian_, held_); }
  Expr momentum(std::size_t a) const { return substitute(momenta_[a], held_); }

  /// The parts of row a: d/dt of its momentum; what the turning of the rates adds, Σ_c p_c X_ia w_ci; ∂L/∂q, ∂D/∂σ and
  /// Q along the rate.
  struct Parts {
    Expr inertial, turning, potential, dissipative, forced;
    Expr row() const { return inertial + turning - potential + dissipative - forced; }
  };
  Parts parts(std::size_t a) const {
    Context& context = *system_.context;
    Parts out;
    out.inertial = substitute(total_time_derivative(momentum(a)), velocities_);
    ExprVector turning, potential, forces;
    for (std::size_t c = 0; c < k_.sigma.size(); ++c)
      if (const Expr g = coefficient(c, a); !g.is_zero()) turning.push_back(momentum(c) * g);
    out.turning = context.sum(turning);
    const Expr l = lagrangian();
    for (const Expr& part : split(l)) potential.push_back(tidy(along(a, slopes(part))));
    out.potential = context.sum(potential);
    const Expr d = expand_time_derivatives(system_.dissipation_function());
    out.dissipative = tidy(substitute(differentiate(in_rates(d), k_.sigma[a]), held_));
    for (const Expr& q : equations_.generalized_forces) forces.push_back(substitute(in_rates(q), held_));
    out.forced = tidy(along(a, forces));
    return out;
  }

 private:
  Expr tidy(Expr e) const { return spheres_.shortest(e, order_); }

  Expr in_rates(Expr e) const { return k_.in_rates(system_, e); }

  /// w_c, a component a coordinate, in q̇; empty where it vanishes: integrable σ.
  void find_curls() {
    for (std::size_t c = 0; c < k_.sigma.size(); ++c) {
      curls_.emplace_back();
      if (k_.is_velocity[c]) continue;
      ExprVector curl;
      bool any = false;
      for (const Coordinate& q : system_.coordinates) {
        const Expr y = differentiate(k_.values[c], q.velocity);
        const Expr w = tidy(total_time_derivative(y) - differentiate(k_.values[c], q.q));
        any |= !w.is_zero();
        curl.push_back(w);
      }
      if (any) curls_.back() = std::move(curl);
    }
  }

  /// Σ_i X_ia w_ci on the constraints, linear in the rates; numbers where they are constant, as those of a group.
  Expr coefficient(std::size_t c, std::size_t a) const {
    if (curls_[c].empty()) return system_.context->number(0);
    const Expr whole = substitute(along(a, curls_[c]), velocities_);
    ExprMap at_rest;
    for (const Expr& s : k_.sigma) at_rest.emplace(s, system_.context->number(0));
    ExprVector terms{tidy(substitute(whole, at_rest))};
    for (std::size_t b = 0; b < k_.free; ++b)
      terms.push_back(constant_or_tidy(differentiate(whole, k_.sigma[b])) * k_.sigma[b]);
    return system_.context->sum(terms);
  }

  /// A number, if it is one everywhere.
  Expr constant_or_tidy(Expr e) const {
    if (e.is_zero()) return e;
    for (const int candidate : {0, 1, -1})
      if (const Expr difference = substitute(e - Rational(candidate), spheres_.parametrization());
          zero_test(difference).verdict == Verdict::Zero)
        return system_.context->number(candidate);
    return tidy(e);
  }

  /// Σ_i X_ia v_i
  Expr along(std::size_t a, const ExprVector& v) const {
    ExprVector terms;
    for (std::size_t i = 0; i < v.size(); ++i) terms.push_back(k_.x.at(i, a) * v[i]);
    return system_.context->sum(terms);
  }

  /// ∂/∂q
  ExprVector slopes(Expr e) const {
    ExprVector q;
    for (const Coordinate& c : system_.coordinates) q.push_back(c.q);
    return gradient(e, q);
  }

  /// The terms of different monomials in σ, whose coefficients have nothing in common; a sum of one otherwise.
  ExprVector split(Expr l) const {
    if (!l.is(Kind::Sum)) return {l};
    ExprVector parts;
    for (std::size_t i = 0; i < l.size(); ++i) parts.push_back(l[i]);
    return parts;
  }

  const EquationsOfMotion& equations_;
  const MechanicalSystem& system_;
  const RateKinematics& k_;
  const ReadingOrder& order_;
  const UnitQuaternions& spheres_;
  ExprMap held_, velocities_;
  Expr lagrangian_;
  ExprVector momenta_;             // [n] over all σ
  std::vector<ExprVector> curls_;  // [n] of [n], or empty
};

Expr put_back(const ReadableForm& form) {
  Expr e = form.value;
  for (auto i = form.intermediates.rbegin(); i != form.intermediates.rend(); ++i)
    e = substitute(e, {{i->symbol, i->value}});
  return e;
}

/// Xᵀ R with q̇ and q̈ replaced, of which p and w know nothing; that σ(q, q̇) is σ, and that q̇ obeys the constraints.
ZeroTest compared(const EquationsInRates& shown, const RateKinematics& k, const EquationsOfMotion& equations,
                  const UnitQuaternions& spheres) {
  const MechanicalSystem& system = *equations.system;
  ExprMap motion = k.replacements(system);
  const ExprMap velocities = motion;
  for (const Coordinate& c : system.coordinates)
    motion.emplace(c.acceleration, substitute(total_time_derivative(velocities.at(c.velocity)), velocities));
  const ExprVector residual = substitute(expand_time_derivatives(equations.residual), motion);
  ExprVector differences;
  for (std::size_t a = 0; a < shown.rows.size(); ++a) {
    ExprVector terms{put_back(shown.rows[a].form)};
    for (std::size_t i = 0; i < residual.size(); ++i)
      terms.push_back(-(shown.rows[a].factor * k.x.at(i, a) * residual[i]));
    differences.push_back(system.context->sum(terms));
  }
  for (std::size_t a = 0; a < k.free; ++a) differences.push_back(substitute(k.values[a], velocities) - k.sigma[a]);
  for (const Expr& c : expand_time_derivatives(equations.constraint_rates))
    differences.push_back(substitute(c, velocities));
  for (const EquationsInRates::Velocity& v : shown.kinematics)
    differences.push_back(put_back(v.form) - velocities.at(system.coordinates[v.coordinate].velocity));
  return zero_test(substitute(substitute(differences, system.definition_values()), spheres.parametrization()));
}

bool has_denominator(Expr e) {
  for (const Expr& node : topological_order({&e, 1}))
    if (node.is(Kind::Power) && node[1].is_number() && node[1].number().sign() < 0) return true;
  return false;
}

/// ω3 − cos θ (ω1 sin ψ + ω2 cos ψ)/sin θ: the terms with denominators together, and the others.
ReadableForm by_denominators(const ReadableForm& form, const ReadingOrder& order) {
  if (!form.value.is(Kind::Sum)) return form;
  ExprVector with, without;
  for (std::size_t i = 0; i < form.value.size(); ++i)
    (has_denominator(form.value[i]) ? with : without).push_back(form.value[i]);
  if (with.empty() || without.empty()) return form;
  Context& context = form.value.context();
  ReadableForm below = readable(context.sum(with), order);
  below.value = context.sum(without) + below.value;
  return below;
}

/// Half of a sum, or minus half, where that is shorter than halves in each term.
ReadableForm readable_velocity(Expr e, const ReadingOrder& order) {
  const auto cost = [&](const ReadableForm& form) {
    const std::string text = to_plain(form, order);
    return std::pair(text.size(), std::count(text.begin(), text.end(), '-'));
  };
  ReadableForm best = readable(e, order);
  if (ReadableForm form = by_denominators(best, order); form.intermediates.empty() && cost(form) < cost(best))
    best = std::move(form);
  for (const int times : {2, -2}) {
    ReadableForm form = readable(Rational(times) * e, order);
    form.value = Rational(1, times) * form.value;
    if (form.intermediates.empty() && cost(form) < cost(best)) best = std::move(form);
  }
  return best;
}

bool is_moving(Expr e) {
  for (const Expr& s : symbols_of({&e, 1}))
    if (s.role() == Role::Coordinate || s.role() == Role::Time || s.role() == Role::Input) return true;
  return false;
}

/// 1/c for the one acceleration of a row, c σ_a' + … = 0, where c changes with the motion: momentum equations are
/// written p' = …. Otherwise 1.
Expr divisor(Expr row, std::size_t a, const RateKinematics& k, const ReadingOrder& order,
             const UnitQuaternions& spheres) {
  Context& context = row.context();
  Expr factor = context.number(1);
  for (std::size_t b = 0; b < k.free; ++b) {
    const Expr acceleration = context.time_derivative(k.sigma[b]);
    const Expr coefficient = differentiate(row, acceleration);
    if (coefficient.is_zero()) continue;
    const Expr best = spheres.shortest(coefficient, order);
    if (best.is_zero()) continue;
    if (a != b || !is_moving(best)) return context.number(1);
    factor = context.number(1) / best;
  }
  return factor;
}

/// The path to the rows: rates, velocities, L and then the parts of each row.
std::vector<DerivationStep> steps_of(const EquationsInRates& e, const std::vector<HamelEquations::Parts>& parts) {
  std::vector<DerivationStep> steps;
  std::string section;
  const auto add = [&](Layout left, ReadableForm right, const std::string& rule) {
    steps.push_back({section, rule, std::move(left), right.value, {}, std::move(right.intermediates)});
  };
  const auto formula = [&](Layout left, Expr right, const std::string& rule) {
    add(std::move(left), readable(right, e.order), rule);
  };
  section = "Rates";
  for (std::size_t a = 0; a < e.rates.size(); ++a)
    if (e.definitions[a] != e.rates[a])
      formula(lay_out(e.rates[a], e.order), e.definitions[a], "definition of the rate");
  section = "Velocities by the rates";
  for (const EquationsInRates::Velocity& v : e.kinematics)
    add(lay_out(v.velocity, e.order), v.form, "rates and constraints solved for the velocities");
  section = "Lagrangian in rates";
  formula(layouts::name("L"), e.lagrangian, "velocities replaced, constraints obeyed");
  for (std::size_t a = 0; a < e.rows.size(); ++a) {
    section = "Equation of " + e.rows[a].rate;
    const Layout sigma = lay_out(e.rates[a], e.order), momentum = layouts::partial(layouts::name("L"), sigma);
    add(momentum, e.momenta[a], "partial derivative");
    formula(layouts::rate(momentum, layouts::name("t"), true), parts[a].inertial, "total time derivative");
    if (!parts[a].turning.is_zero())
      formula(layouts::words("turning of the rates"), parts[a].turning, "Hamel: momenta times the curls of the rates");
    if (!parts[a].potential.is_zero())
      formula(layouts::words("slope of L along the rate"), parts[a].potential, "Xᵀ ∂L/∂q");
    if (!parts[a].dissipative.is_zero())
      formula(layouts::partial(layouts::name("D"), sigma), parts[a].dissipative,
              "partial derivative of the dissipation function");
    if (!parts[a].forced.is_zero()) formula(layouts::words("force along the rate"), parts[a].forced, "Xᵀ Q");
    add(layouts::number("0"), e.rows[a].form, "Boltzmann-Hamel, collected and simplified");
  }
  return steps;
}

std::size_t length(const ReadableForm& form, const ReadingOrder& order) {
  return form.intermediates.empty() ? to_plain(form, order).size() : std::string::npos;
}

}  // namespace

RatesResult equations_in_rates(const EquationsOfMotion& equations) {
  return equations_in_rates(equations, equations.shown().system->rates);
}

RatesResult equations_in_rates(const EquationsOfMotion& derived, const std::vector<Rate>& rates) {
  const EquationsOfMotion& equations = derived.shown();
  RatesResult result;
  EquationsInRates out;
  out.order = order_with_rates(equations, rates);
  const UnitQuaternions spheres(*equations.system);
  const auto k = rate_kinematics(equations, rates, out.order, spheres, result.reason);
  if (!k) return result;

  const HamelEquations hamel(equations, *k, out.order, spheres);
  out.lagrangian = hamel.lagrangian();
  ExprVector rows;
  std::vector<HamelEquations::Parts> parts;
  for (std::size_t a = 0; a < k->free; ++a) {
    parts.push_back(hamel.parts(a));
    rows.push_back(parts.back().row());
    out.rates.push_back(k->sigma[a]);
    out.definitions.push_back(k->values[a]);
    out.momenta.push_back(readable(hamel.momentum(a), out.order));
  }
  std::vector<ReadableForm> forms = readable_equations(rows, out.order);
  for (std::size_t a = 0; a < forms.size(); ++a) {
    forms[a].own = equations.system->context->symbol(k->sigma[a].name(), Role::Coordinate);
    Expr factor = divisor(rows[a], a, *k, out.order, spheres);
    if (!factor.is_one()) {
      ReadableForm divided = readable_equations(ExprVector{factor * put_back(forms[a])}, out.order).front();
      if (length(divided, out.order) < length(forms[a], out.order)) {
        divided.own = forms[a].own;
        forms[a] = std::move(divided);
      } else {
        factor = equations.system->context->number(1);
      }
    }
    out.rows.push_back({symbol_to_plain(k->sigma[a]), std::move(forms[a]), factor});
  }
  const ExprMap velocities = k->replacements(*equations.system);
  for (std::size_t i = 0; i < k->velocities.size(); ++i) {
    const Coordinate& c = equations.system->coordinates[i];
    const bool stays = std::any_of(k->sigma.begin(), k->sigma.end(), [&](Expr s) { return s == c.velocity; });
    if (!stays) out.kinematics.push_back({i, c.velocity, readable_velocity(velocities.at(c.velocity), out.order)});
  }
  out.certificate = compared(out, *k, equations, spheres);
  if (out.certificate.verdict == Verdict::Nonzero) {
    result.reason = "They differ from Lagrange's equations. Please report this model.";
    return result;
  }
  ExprVector roots{out.lagrangian};
  for (const auto& row : out.rows) roots.push_back(row.form.value);
  for (const auto& velocity : out.kinematics) roots.push_back(velocity.form.value);
  out.intermediates = definitions_used(*equations.system, roots);
  out.steps = steps_of(out, parts);
  result.equations = std::move(out);
  return result;
}

std::vector<Rate> body_rates(const MechanicalSystem& system) {
  std::vector<Rate> rates;
  for (const Body& body : system.bodies) {
    if (body.angular_velocity.size() != 3) continue;
    const ExprVector omega = expand_time_derivatives(body.angular_velocity);
    const char* axes[] = {".ω.x", ".ω.y", ".ω.z"};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string name = body.name + axes[i];
      const Dimension rate = system.dimensionless ? Dimension{} : dimensions::angle() / dimensions::time();
      rates.push_back({name, rate_of_integral(*system.context, name), omega[i], rate, body.span});
    }
  }
  return rates;
}

namespace {

/// Bodies beyond which a comparison is not worth its time, and coordinates likewise.
constexpr std::size_t most_bodies = 3, most_coordinates = 14;

/// Whether the rates of the bodies may stand in the place of as many velocities. Constraints beside the norms of
/// quaternions have forces that body rates do not shorten.
bool may_be_shorter(const MechanicalSystem& system, const std::vector<Rate>& rates) {
  const bool free = std::all_of(system.constraints.begin(), system.constraints.end(),
                                [](const Constraint& c) { return !c.body.empty(); });
  return free && !rates.empty() && rates.size() <= 3 * most_bodies && system.coordinates.size() <= most_coordinates &&
         rates.size() + system.constraints.size() <= system.coordinates.size();
}

bool has_all(const EquationsInRates& found, const std::vector<Rate>& rates) {
  return std::all_of(rates.begin(), rates.end(), [&](const Rate& rate) {
    return std::find(found.rates.begin(), found.rates.end(), rate.symbol) != found.rates.end();
  });
}

}  // namespace

std::optional<EquationsInRates> equations_in_own_rates(const EquationsOfMotion& equations) {
  const MechanicalSystem& system = *equations.shown().system;
  const bool named = !system.rates.empty();
  const std::vector<Rate> rates = named ? system.rates : body_rates(system);
  if (!named && !may_be_shorter(system, rates)) return std::nullopt;
  RatesResult result = equations_in_rates(equations, rates);
  if (!result.equations || result.equations->certificate.verdict != Verdict::Zero) return std::nullopt;
  if (!named && !has_all(*result.equations, rates)) return std::nullopt;
  return std::move(result.equations);
}

}  // namespace maupertuis
