#include "simulation/hybrid_cones.hpp"

#include <cmath>

namespace maupertuis::hybrid {

Eigen::MatrixXd along_rows(const std::vector<SparseRow>& rows, const Eigen::MatrixXd& response) {
  Eigen::MatrixXd out(at(rows.size()), response.cols());
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (Eigen::Index c = 0; c < response.cols(); ++c) out(at(r), c) = dot(rows[r], response.col(c));
  return out;
}

std::vector<Pressed> ContactCones::pressed_of(const std::vector<std::size_t>& touching,
                                              const ContactValues& values) const {
  std::vector<Pressed> out;
  for (const std::size_t i : touching) {
    if (values.rate[i] > sizes_.rest_speed(i, values)) continue;
    const Friction& f = problem_.system.contacts[i].friction;
    const bool slides =
        problem_.rubs(i, values) && !f.sticking &&
        (f.in_space() ? slips_.slides(i, values) : std::abs(values.slip[i]) > sizes_.rest_slip(i, values));
    out.push_back({i, slides ? std::optional(slips_.sliding_force(i, values)) : std::nullopt});
  }
  return out;
}

std::vector<Pressed> ContactCones::pressed_in(const ContactMode& mode, const ContactValues& values) const {
  std::vector<Pressed> out;
  for (std::size_t i = 0; i < mode.closed.size(); ++i) {
    if (!mode.closed[i]) continue;
    const FrictionState state = mode.friction[i];
    out.push_back({i, std::nullopt});
    if (state == FrictionState::Slide) out.back().sliding = slips_.sliding_force(i, values);
    if (state == FrictionState::Forward || state == FrictionState::Backward)
      out.back().sliding =
          sum_of(values.normal[i], values.tangent[i], (state == FrictionState::Forward ? -1 : 1) * values.kinetic[i]);
  }
  return out;
}

Cones ContactCones::of(const std::vector<Pressed>& pressed, const ContactValues& values,
                       std::span<const double> accelerations) const {
  return of(pressed, {}, choices_.mode_without_contacts(values), values, accelerations);
}

Cones ContactCones::of(const std::vector<Pressed>& pressed, const std::vector<std::size_t>& holding,
                       const ContactMode& base, const ContactValues& values,
                       std::span<const double> accelerations) const {
  const std::span<const double> drifts = here_.drifts();
  const std::size_t contacts = values.gap.size(), seconds = drifts.size() - contacts;
  Cones out;
  std::vector<double> free;
  const auto add = [&](const SparseRow& row, const SparseRow& force, double drift) {
    out.rows.push_back(row);
    out.forces.push_back(force);
    free.push_back(drift + product(row, accelerations));
  };
  for (const auto& [i, sliding] : pressed) {
    const Friction& f = problem_.system.contacts[i].friction;
    out.contacts.push_back(i);
    out.slides.push_back(sliding.has_value());
    out.first.push_back(out.rows.size());
    add(values.normal[i], sliding ? *sliding : values.normal[i], drifts[i]);
    ConeProblem::Contact contact{0, 0};
    if (problem_.rubs(i, values) && !sliding) {
      contact = {f.in_space() ? 2 : 1, f.sticking ? held_fast : values.fixed[i]};
      add(values.tangent[i], values.tangent[i], drifts[contacts + i]);
      if (f.in_space()) add(values.second_tangent[i], values.second_tangent[i], drifts[seconds + i]);
    }
    out.problem.contacts.push_back(contact);
  }
  for (const std::size_t i : holding) {
    add(values.tangent[i], values.tangent[i], drifts[contacts + i]);
    out.problem.limits.push_back(values.fixed[i]);
  }
  for (std::size_t i = contacts; i < base.friction.size(); ++i)
    if (base.friction[i] == FrictionState::Stick) out.held.push_back(values.tangent[i]);
  out.response = here_.response(out.forces, out.held);
  out.problem.response = along_rows(out.rows, out.response);
  out.problem.free = Eigen::Map<const Eigen::VectorXd>(free.data(), at(free.size()));
  return out;
}

}  // namespace maupertuis::hybrid
