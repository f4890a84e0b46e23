#include <maupertuis/stress_energy.hpp>

#include <maupertuis/evaluate.hpp>
#include <maupertuis/interrupt_scope.hpp>

#include "fields/on_shell.hpp"

#include <algorithm>

/// Belinfante's tensor from the boosts and rotations that the search for currents found.
namespace maupertuis {
namespace {

/// ξ and η of a characteristic Q_a = η_a − ξ^μ ∂_μ φ_a with η linear in the fields.
struct Motion {
  std::vector<Expr> xi;                // [space variables + 1], t last
  std::vector<std::vector<Expr>> mix;  // ∂η_a/∂φ_b [varied × varied]
};

class BelinfanteTensor {
 public:
  BelinfanteTensor(const FieldEquations& equations, const FieldCurrents& found)
      : equations_(equations),
        s_(equations.system()),
        context_(*s_.context),
        n_(s_.space.size()),
        density_(s_.expanded(s_.density)),
        sigma_((n_ + 1) * (n_ + 1)),
        shell_(equations) {
    for (const FieldCurrent& c : found.currents)
      if (auto motion = motion_of(c)) motions_.push_back(std::move(*motion));
  }

  std::optional<StressEnergy> tensor() {
    // Friction and forces take from what it counts.
    if (s_.dissipation || std::any_of(s_.forces.begin(), s_.forces.end(), [](const Expr& f) { return bool(f); }))
      return std::nullopt;
    for (const Expr& jet : s_.jets_in(density_))
      if (s_.jet_of(jet)->order() > 1 || s_.fields[s_.jet_of(jet)->field].given) return std::nullopt;
    for (std::size_t i = 0; i < n_; ++i)
      if (!take_boost(i)) return std::nullopt;
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = i + 1; j < n_; ++j)
        if (!take_rotation(i, j)) return std::nullopt;
    StressEnergy out;
    out.dimensions = n_, out.c_squared = c_squared_;
    fill_canonical(out);
    fill_spin(out);
    if (!fill_symmetric(out)) return std::nullopt;
    certify_tensor(out);
    return out.certified() ? std::optional(std::move(out)) : std::nullopt;
  }

 private:
  std::size_t at(std::size_t mu, std::size_t nu) const { return mu * (n_ + 1) + nu; }
  Expr field(std::size_t a) const { return s_.jet_symbol({equations_.varied[a], std::vector<int>(n_, 0), 0}); }
  Expr slope(std::size_t a, std::size_t mu) const {
    FieldJet jet{equations_.varied[a], std::vector<int>(n_, 0), mu == n_ ? 1 : 0};
    if (mu < n_) jet.space[mu] = 1;
    return s_.jet_symbol(jet);
  }
  Expr variable(std::size_t mu) const { return mu == n_ ? context_.time() : s_.space[mu].symbol; }

  std::optional<Motion> motion_of(const FieldCurrent& c) const {
    Motion out;
    ExprMap no_slopes, nothing;
    for (std::size_t a = 0; a < c.characteristic.size(); ++a) {
      nothing[field(a)] = context_.number(0);
      for (std::size_t mu = 0; mu <= n_; ++mu) no_slopes[slope(a, mu)] = context_.number(0);
    }
    for (std::size_t mu = 0; mu <= n_; ++mu) out.xi.push_back(-differentiate(c.characteristic.front(), slope(0, mu)));
    for (const Expr& q : c.characteristic) {
      const Expr eta = substitute(q, no_slopes);
      if (!vanishes_identically(substitute(eta, nothing))) return std::nullopt;
      out.mix.emplace_back();
      for (std::size_t b = 0; b < c.characteristic.size(); ++b) out.mix.back().push_back(differentiate(eta, field(b)));
    }
    return out;
  }

  /// The motion ξ^mu = p x_nu, ξ^nu = r x_mu with factors p and r, all others 0.
  const Motion* find(std::size_t mu, std::size_t nu, Expr& p, Expr& r) const {
    for (const Motion& m : motions_) {
      p = differentiate(m.xi[mu], variable(nu)), r = differentiate(m.xi[nu], variable(mu));
      if (vanishes_identically(p) || vanishes_identically(r)) continue;
      bool pure = true;
      for (std::size_t k = 0; k <= n_; ++k) {
        const Expr expected = k == mu ? p * variable(nu) : k == nu ? r * variable(mu) : context_.number(0);
        pure = pure && vanishes_identically(m.xi[k] - expected);
      }
      if (pure) return &m;
    }
    return nullptr;
  }
  void take(const Motion& m, std::size_t mu, std::size_t nu, Expr omega) {
    for (std::size_t a = 0; a < m.mix.size(); ++a)
      for (std::size_t b = 0; b < m.mix.size(); ++b) {
        sigma_[at(mu, nu)].push_back(m.mix[a][b] / omega);
        sigma_[at(nu, mu)].push_back(-m.mix[a][b] / omega);
      }
  }
  /// ξ^t = α x_i, ξ^i = β t: c² = β/α, ω_{ti} = c² α = β.
  bool take_boost(std::size_t i) {
    Expr alpha = context_.number(0), beta = alpha;
    const Motion* m = find(n_, i, alpha, beta);
    if (!m) return false;
    const Expr c2 = readable(beta / alpha, equations_.order).value;
    if (c_squared_ && !vanishes_identically(c2 - c_squared_)) return false;
    c_squared_ = c2;
    Bindings values;
    for (const Parameter& p : equations_.model->parameters) values[p.symbol] = p.si_value;
    if (!s_.jets_in(c2).empty() || s_.context->depends_on_time(c2.id()) || !(evaluate(s_.expanded(c2), values) > 0))
      return false;
    take(*m, n_, i, beta);
    return true;
  }
  /// ξ^i = κ x_j, ξ^j = −κ x_i: ω_{ij} = −κ.
  bool take_rotation(std::size_t i, std::size_t j) {
    Expr kappa = context_.number(0), back = kappa;
    const Motion* m = find(i, j, kappa, back);
    if (!m || !vanishes_identically(kappa + back)) return false;
    take(*m, i, j, -kappa);
    return true;
  }

  Expr momentum(std::size_t a, std::size_t mu) const { return differentiate(density_, slope(a, mu)); }
  /// g^{νν}
  Expr metric(std::size_t nu) const { return nu == n_ ? context_.number(1) / c_squared_ : context_.number(-1); }

  void fill_canonical(StressEnergy& out) const {
    for (std::size_t mu = 0; mu <= n_; ++mu)
      for (std::size_t nu = 0; nu <= n_; ++nu) {
        Expr mixed = mu == nu ? -density_ : context_.number(0);
        for (std::size_t a = 0; a < equations_.varied.size(); ++a) mixed = mixed + momentum(a, mu) * slope(a, nu);
        out.canonical.push_back(metric(nu) * mixed);
      }
  }
  /// S^{λμν} = Π_a^λ (Σ^{μν})_ab φ_b
  Expr spin_current(std::size_t l, std::size_t m, std::size_t n) const {
    const std::vector<Expr>& sigma = sigma_[at(m, n)];
    const std::size_t fields = equations_.varied.size();
    Expr sum = context_.number(0);
    for (std::size_t a = 0; a < fields && !sigma.empty(); ++a)
      for (std::size_t b = 0; b < fields; ++b) sum = sum + momentum(a, l) * sigma[a * fields + b] * field(b);
    return sum;
  }
  void fill_spin(StressEnergy& out) const {
    for (std::size_t l = 0; l <= n_; ++l)
      for (std::size_t m = 0; m <= n_; ++m)
        for (std::size_t n = 0; n <= n_; ++n)
          out.spin_part.push_back(
              readable(Rational(1, 2) * (spin_current(l, m, n) - spin_current(m, l, n) - spin_current(n, l, m)),
                       equations_.order)
                  .value);
  }
  Expr divergence_of_spin(const StressEnergy& out, std::size_t m, std::size_t n) const {
    Expr sum = context_.number(0);
    for (std::size_t l = 0; l <= n_; ++l) sum = sum + s_.total_derivative(out.spin(l, m, n), l);
    return sum;
  }
  /// e + Σ_a C_a E_a without the derivatives that the equations are solved for; nothing where there is none.
  struct Reduced {
    Expr value;
    std::vector<Expr> factors;  // C_a [varied]
  };
  std::optional<Reduced> reduced(Expr e) const {
    Reduced out{e, std::vector<Expr>(euler_.size(), context_.number(0))};
    constexpr int rounds = 8;
    for (int round = 0; round < rounds; ++round) {
      bool found = false;
      for (std::size_t a = 0; a < euler_.size(); ++a) {
        const Expr slope = differentiate(out.value, shell_.leading(a));
        if (vanishes_identically(slope)) continue;
        found = true;
        const Expr factor = -slope / differentiate(euler_[a], shell_.leading(a));
        out.factors[a] = out.factors[a] + factor;
        const Expr sum = out.value + factor * euler_[a], flat = expand(sum);
        out.value = flat ? flat : sum;
      }
      if (!found) return out;
    }
    return std::nullopt;
  }

  bool fill_symmetric(StressEnergy& out) {
    if (!shell_.complete()) return false;
    for (const Expr& e : equations_.euler) euler_.push_back(s_.expanded(e));
    for (std::size_t m = 0; m <= n_; ++m)
      for (std::size_t n = 0; n <= n_; ++n) {
        interrupt_of(context_).throw_if_asked();
        auto value = reduced(out.canonical[at(m, n)] + divergence_of_spin(out, m, n));
        if (!value) return false;
        out.symmetric.push_back(readable(value->value, equations_.order).value);
        factors_.push_back(std::move(value->factors));
      }
    return true;
  }

  /// Identities off solutions: Θ − T − ∂B = Σ C_a E_a, ∂_μ Θ^{μν} = Σ ∂_μ(C_a^{μν} E_a) − E_a ∂^ν φ_a.
  void certify_tensor(StressEnergy& out) const {
    out.is_symmetric = out.is_conserved = out.differs_by_divergence = true;
    for (std::size_t n = 0; n <= n_; ++n) {
      Expr divergence = context_.number(0);
      for (std::size_t a = 0; a < euler_.size(); ++a) divergence = divergence + metric(n) * euler_[a] * slope(a, n);
      for (std::size_t m = 0; m <= n_; ++m) {
        interrupt_of(context_).throw_if_asked();
        Expr of_equations = context_.number(0);
        for (std::size_t a = 0; a < euler_.size(); ++a) of_equations = of_equations + factors_[at(m, n)][a] * euler_[a];
        const Expr theta = out.symmetric[at(m, n)];
        divergence = divergence + s_.total_derivative(theta - of_equations, m);
        const auto difference = reduced(theta - out.symmetric[at(n, m)]);
        out.is_symmetric = out.is_symmetric && difference && vanishes_identically(difference->value);
        out.differs_by_divergence =
            out.differs_by_divergence &&
            vanishes_identically(theta - out.canonical[at(m, n)] - divergence_of_spin(out, m, n) - of_equations);
        for (std::size_t l = 0; l <= n_; ++l)
          out.differs_by_divergence =
              out.differs_by_divergence && vanishes_identically(out.spin(l, m, n) + out.spin(m, l, n));
      }
      out.is_conserved = out.is_conserved && vanishes_identically(divergence);
    }
  }

  const FieldEquations& equations_;
  const FieldSystem& s_;
  Context& context_;
  std::size_t n_;
  Expr density_, c_squared_;
  std::vector<std::vector<Expr>> sigma_;  // [(n + 1)²] of [varied²]
  std::vector<Motion> motions_;
  OnShell shell_;
  std::vector<Expr> euler_;                 // with the values of definitions
  std::vector<std::vector<Expr>> factors_;  // [(n + 1)²] C_a of Θ^{μν}
};

}  // namespace

bool StressEnergy::has_spin() const {
  return std::any_of(spin_part.begin(), spin_part.end(), [](Expr e) { return !vanishes_identically(e); });
}
Expr StressEnergy::energy_density() const { return c_squared * stress(dimensions, dimensions); }
Expr StressEnergy::energy_flux(std::size_t i) const { return c_squared * stress(i, dimensions); }

std::optional<StressEnergy> stress_energy(const FieldEquations& equations, const FieldCurrents& found) {
  return BelinfanteTensor(equations, found).tensor();
}

}  // namespace maupertuis
