#include "fields/charge_meter.hpp"

#include "fields/careful_sum.hpp"
#include "fields/given_fields.hpp"

#include <maupertuis/evaluate.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr std::size_t kStencil = 8;

/// ∫_a^b of the polynomial through values 1 at node m and 0 at the others, for all m; exact up to degree 7.
std::vector<double> weights_of(const std::vector<double>& nodes, double a, double b) {
  constexpr double x[] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
  constexpr double w[] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461, 0.3478548451374538};
  std::vector<double> out(nodes.size(), 0);
  for (std::size_t m = 0; m < nodes.size(); ++m)
    for (int q = 0; q < 4; ++q) {
      const double t = 0.5 * (a + b) + 0.5 * (b - a) * x[q];
      double product = 0.5 * (b - a) * w[q];
      for (std::size_t o = 0; o < nodes.size(); ++o)
        if (o != m) product *= (t - nodes[o]) / (nodes[m] - nodes[o]);
      out[m] += product;
    }
  return out;
}

bool holds(const std::vector<Expr>& list, Expr e) { return std::find(list.begin(), list.end(), e) != list.end(); }

/// Whether all jets in e are among those that are known.
bool knows(const FieldSystem& s, const std::vector<Expr>& known, Expr e) {
  const std::vector<Expr> jets = s.jets_in(e);
  return std::all_of(jets.begin(), jets.end(), [&](Expr jet) { return holds(known, jet); });
}

std::unique_ptr<FunctionWorkspace> functions(const std::vector<Parameter>& parameters, std::vector<Expr> inputs,
                                             std::vector<Expr> outputs) {
  FunctionSource source{std::move(inputs), {}, std::move(outputs)};
  std::vector<double> values;
  for (const Parameter& p : parameters) source.parameters.push_back(p.symbol), values.push_back(p.si_value);
  auto out = std::make_unique<FunctionWorkspace>(build_function(source));
  out->set_parameters(values);
  return out;
}

}  // namespace

void SampledIntegral::add(double t, std::vector<double> values) {
  constexpr double hardly = 1e-4;  // of the interval before
  const std::size_t n = window_.size();
  beyond_.assign(functions_, 0);
  if (n > 1 && t - window_[n - 1].t < hardly * (window_[n - 1].t - window_[n - 2].t)) {
    for (std::size_t f = 0; f < functions_; ++f)
      beyond_[f] = 0.5 * (t - window_[n - 1].t) * (values[f] + window_[n - 1].values[f]);
    return;
  }
  window_.push_back({t, std::move(values)}), ++count_;
  if (sum_.empty()) sum_.assign(functions_, 0), known_.push_back({0, sum_});
  if (window_.size() < kStencil) return;
  while (done_ < kStencil / 2) integrate_to(done_ + 1);
  if (window_.size() == kStencil) return;
  window_.pop_front(), --done_;
  integrate_to(done_ + 1);
}

void SampledIntegral::integrate_to(std::size_t sample) {
  const std::size_t from = 0, to = std::min(window_.size(), kStencil);
  std::vector<double> nodes;
  for (std::size_t i = from; i < to; ++i) nodes.push_back(window_[i].t);
  const std::vector<double> weights = weights_of(nodes, window_[sample - 1].t, window_[sample].t);
  for (std::size_t f = 0; f < functions_; ++f)
    for (std::size_t i = 0; i < nodes.size(); ++i) sum_[f] += weights[i] * window_[i].values[f];
  done_ = sample;
  known_.push_back({count_ - (window_.size() - sample), sum_});
}

void SampledIntegral::finish() {
  while (done_ + 1 < window_.size()) integrate_to(done_ + 1);
}

ChargeMeter::ChargeMeter(const FieldMotion& motion, const FieldEquations& equations, const FieldCurrents& currents)
    : equations_(equations), out_(0) {
  const FieldSystem& s = equations.system();
  if (s.dissipation ||
      std::any_of(s.forces.begin(), s.forces.end(), [](const Expr& f) { return static_cast<bool>(f); }))
    return;
  std::vector<Expr> densities, fluxes;
  for (const FieldCurrent& c : currents.currents) {
    const Expr density = with_given_fields(s, c.density);
    if (!knows(s, motion.point_inputs(), density)) continue;
    FieldCharge charge;
    charge.current = static_cast<std::size_t>(&c - currents.currents.data());
    charge.name = c.name, charge.meaning = c.meaning;
    charges_.push_back(charge);
    densities.push_back(density);
    flows_.emplace_back();
    for (std::size_t x = 0; x < s.space.size(); ++x) {
      const Expr flux = with_given_fields(s, c.fluxes[x]);
      const std::vector<Expr> symbols = symbols_of({&flux, 1});
      // Around a ring as much comes in as goes out, where the flux is the same function on both sides.
      flows_.back().push_back(!flux.is_zero() && !(s.periodic(x) && !holds(symbols, s.space[x].symbol)));
      any_flow_ = any_flow_ || flows_.back().back();
      fluxes.push_back(flux);
      for (const Expr& jet : s.jets_in(flux))
        if (flows_.back().back() && !holds(jets_, jet)) jets_.push_back(jet);
    }
  }
  if (charges_.empty()) return;
  for (std::size_t i = 0; i < fluxes.size(); ++i)
    if (!flows_[i / s.space.size()][i % s.space.size()]) fluxes[i] = s.context->number(0);
  std::vector<Expr> inputs = jets_;
  for (const SpaceVariable& x : s.space) inputs.push_back(x.symbol);
  inputs.push_back(s.context->time());
  outputs_ = fluxes.size();
  densities_ = functions(equations.model->parameters, motion.point_inputs(), std::move(densities));
  fluxes_ = functions(equations.model->parameters, std::move(inputs), std::move(fluxes));
  size_.assign(charges_.size(), 0);
  out_ = SampledIntegral(charges_.size());
}

void ChargeMeter::note_flux(FieldMotion& motion) {
  std::vector<double> flow(charges_.size(), 0), values(outputs_);
  const std::size_t directions = equations_.system().space.size(), inputs = jets_.size() + directions + 1;
  if (any_flow_)
    motion.visit_sides(jets_, [&](const FieldMotion::SidePoint& point, const double* at) {
      fluxes_->evaluate({at, inputs}, values);
      for (std::size_t c = 0; c < flow.size(); ++c)
        if (flows_[c][point.along])
          flow[c] += (point.far ? 1 : -1) * point.weight * values[c * directions + point.along];
    });
  balance();  // before: rows of the moments so far are there
  out_.add(motion.time(), std::move(flow));
}

void ChargeMeter::measure(FieldMotion& motion) {
  std::vector<CarefulSum> sums(charges_.size());
  std::vector<double> sizes(charges_.size(), 0), values(charges_.size());
  const std::size_t inputs = motion.point_inputs().size();
  motion.visit_points([&](double weight, const double* at) {
    densities_->evaluate({at, inputs}, values);
    for (std::size_t c = 0; c < values.size(); ++c)
      sums[c].add(weight * values[c]), sizes[c] += std::abs(weight * values[c]);
  });
  Row row{out_.moment(), {}, out_.beyond()};
  for (std::size_t c = 0; c < sums.size(); ++c) {
    row.q.push_back(sums[c].value());
    size_[c] = std::max(size_[c], sizes[c]);
  }
  rows_.push_back(std::move(row));
}

/// Of the rows up to where the integral of the flux is known.
void ChargeMeter::balance() {
  out_.take([&](std::size_t moment, const std::vector<double>& out) {
    for (; !rows_.empty() && rows_.front().moment <= moment; rows_.pop_front())
      for (std::size_t c = 0; c < charges_.size(); ++c) {
        FieldCharge& charge = charges_[c];
        const double q = rows_.front().q[c], left = out[c] + rows_.front().beyond[c];
        if (!charge.measured) charge.start = q, charge.measured = true;
        charge.end = q, charge.outflow = left;
        size_[c] = std::max(size_[c], std::abs(left));
        const double off = std::abs(q - charge.start + left);
        if (!(off <= charge.imbalance)) charge.imbalance = off;  // NaN as well
      }
  });
}

std::string FieldCharge::label() const { return name.rfind("shift", 0) == 0 ? "shift " + meaning : name; }

std::vector<FieldCharge> ChargeMeter::finish() {
  if (idle()) return {};
  out_.finish();
  balance();
  for (std::size_t c = 0; c < charges_.size(); ++c) {
    charges_[c].size = size_[c];
    charges_[c].booked = std::isfinite(charges_[c].outflow);
  }
  return charges_;
}

}  // namespace maupertuis
