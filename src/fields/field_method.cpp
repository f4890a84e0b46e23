#include "fields/field_method.hpp"

#include "fields/plane_mesh.hpp"

#include <maupertuis/evaluate.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr int usual_order = 3, usual_smooth_order = 7;
constexpr double stability = 3.2;  // h ω_max
constexpr int stages = 4;          // of Gauss's collocation
constexpr double goal = 1e-12;     // of its steps, beside the field, over the whole run

}  // namespace

std::optional<FieldMethod> FieldMethod::of(const FieldEquations& equations, Diagnostics& diagnostics) {
  FieldMethod out;
  const int written = equations.system().element_order;
  if (needs_collocation(equations)) {
    out.stiff_ = density_form(equations, diagnostics);
    out.order_ = written ? written : usual_smooth_order;
  } else {
    out.waves_ = point_form(equations, diagnostics);
    out.order_ = written ? written : usual_order;
  }
  return out.waves_ || out.stiff_ ? std::optional(std::move(out)) : std::nullopt;
}

FieldMethod FieldMethod::sharper(int orders) const {
  FieldMethod out = *this;
  out.order_ += orders;
  out.part_ = 0.75;
  return out;
}

std::string FieldMethod::name() const {
  return waves_ ? fmt::format("Taylor steps of order {}", kOrder)
                : fmt::format("steps of {}'s collocation of order {}", stiff_->damps ? "Radau" : "Gauss",
                              order_of_collocation());
}

int FieldMethod::order_of_collocation() const { return stiff_->damps ? 2 * stages - 1 : 2 * stages; }

std::unique_ptr<FieldMotion> FieldMethod::mesh(const FieldEquations& equations, const Cells& cells, bool first) const {
  if (stiff_) return std::make_unique<CollocationMotion>(equations, *stiff_, cells, order_, stages);
  if (cells.size() == 2) return std::make_unique<PlaneMesh>(equations, *waves_, cells[0], cells[1], order_);
  auto out = std::make_unique<FieldMesh>(equations, *waves_, cells[0], order_);
  if (!first) out->lengthen_steps(part_ > 0 ? part_ : 2);
  return out;
}

double FieldMethod::bytes(const FieldEquations& equations, const Cells& cells) const {
  if (stiff_) return CollocationMotion::bytes(*stiff_, cells, order_, stages);
  return cells.size() == 2 ? PlaneMesh::bytes(equations, *waves_, cells[0], cells[1], order_)
                           : FieldMesh::bytes(equations, *waves_, cells[0], order_);
}

double FieldMethod::longest_step(FieldMotion& mesh, double duration, double every, const Interrupt& interrupt,
                                 double& omega) {
  if (waves_) {
    omega = dynamic_cast<WaveMesh&>(mesh).omega_max(interrupt);
    return omega > 0 ? stability / omega : duration;
  }
  auto& motion = dynamic_cast<CollocationMotion&>(mesh);
  motion.watch(interrupt);
  if (part_ > 0) return part_ * step_;
  if (step_ > 0) return step_ * std::round(motion.width_of_cell() / width_);
  width_ = motion.width_of_cell();
  return step_ = motion.choose_step(std::min(every, duration), duration, goal, interrupt);
}

int FieldMethod::power(const FieldEquations& equations, const FieldQuestion& question, const Cells& half) const {
  if (waves_) return power_of_waves(equations, question, half);
  const bool smooth = std::find(stiff_->smooth.begin(), stiff_->smooth.end(), true) != stiff_->smooth.end();
  const int degree = smooth ? std::max(order_, 3) : order_;
  int lost = smooth ? 2 : 0;  // of the whole, energies for example: twice what the derivatives in ℒ leave
  if (question.total) return std::min(2 * degree - lost, order_of_collocation());
  lost = 0;
  for (const PlaceValue& place : equations.model->places) {
    const Expr value[] = {question.value};
    const std::vector<Expr> symbols = symbols_of(value);
    if (std::find(symbols.begin(), symbols.end(), place.symbol) != symbols.end())
      lost = std::max(lost, equations.system().jet_of(place.jet)->space[0]);
  }
  return std::min(std::max(degree + 1 - lost, 1), order_of_collocation());
}

std::vector<double> FieldMethod::looks_at(double time, double begin) const {
  std::vector<double> out{time};
  for (double steps = 1; before_ > 0 && steps <= nodes_ && time - steps * before_ > begin; steps *= 2)
    out.push_back(time - steps * before_);
  return out;
}

double FieldMethod::width_of_cell(const FieldEquations& equations, const Cells& cells) const {
  const FieldSystem& s = equations.system();
  Bindings values;
  for (const Parameter& p : equations.model->parameters) values[p.symbol] = p.si_value;
  const SpaceVariable& x = s.space.front();
  return (evaluate(s.expanded(x.to), values) - evaluate(s.expanded(x.from), values)) / cells.front();
}

bool FieldMethod::stands_on_borders(const FieldEquations& equations, const FieldQuestion& question,
                                    const Cells& cells) {
  const FieldSystem& s = equations.system();
  Bindings values;
  for (const Parameter& p : equations.model->parameters) values[p.symbol] = p.si_value;
  const auto number = [&](Expr e) { return evaluate(s.expanded(e), values); };
  const std::vector<Expr> asked = symbols_of({&question.value, 1});
  for (const PlaceValue& place : equations.model->places) {
    if (std::find(asked.begin(), asked.end(), place.symbol) == asked.end()) continue;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double from = number(s.space[i].from), width = number(s.space[i].to) - from;
      const double cell = (number(place.place[i]) - from) / width * cells[i];
      if (std::abs(cell - std::round(cell)) > 1e-9 * cells[i]) return false;
    }
  }
  return true;
}

/// p + 2 (up to that of the steps) where elements meet, 2p in integrals, p + 1 between, p of a slope. The power 2p of
/// the elements where they meet is not that of a start: what its nodes leave out of it moves at once.
int FieldMethod::power_of_waves(const FieldEquations& equations, const FieldQuestion& question,
                                const Cells& half) const {
  const int power = std::min(2 * order_, static_cast<int>(kOrder));
  if (question.total) return power;
  const FieldSystem& s = equations.system();
  const std::vector<Expr> asked = symbols_of({&question.value, 1});
  for (const PlaceValue& place : equations.model->places) {
    if (std::find(asked.begin(), asked.end(), place.symbol) == asked.end()) continue;
    if (const FieldJet jet = *s.jet_of(place.jet); jet.order() > jet.time) return std::min(power, order_);
  }
  return std::min(power, stands_on_borders(equations, question, half) ? order_ + 2 : order_ + 1);
}

}  // namespace maupertuis
