#include "symbolic/transform/candidates.hpp"
#include "symbolic/transform/power_form.hpp"

#include <array>

/// Candidates that differ in how sines and cosines are written.
namespace maupertuis::terms {

Expr CandidateChooser::best_basis(const Polynomial& p) {
  const bool multiples = has_multiple_angle(algebra_, p, reader_.angle_units());
  if (p.size() == 1 && !multiples) return flat(p);
  const std::string key = key_text(p);
  if (const auto known = known_bases_.find(key); known != known_bases_.end()) return known->second;
  const Expr value = search_basis(p);
  known_bases_.emplace(key, value);
  return value;
}

/// From the Fourier form downhill: the angle and the choice of Pythagoras that help most, until none helps; and the
/// forms with every angle as powers, in case that the way there leads over a hill.
Expr CandidateChooser::search_basis(const Polynomial& p) {
  constexpr std::size_t largest_searched = 200;
  Choice choice;
  const auto offer = [&](const Polynomial& form) {
    consider(choice, without_content(form));
    if (!rational_content(form).is_integer()) consider(choice, flat(form));  // J + 1/4 m l^2 beside 1/4 (4 J + m l^2)
    if (form.size() > 1) consider(choice, factored(form));
  };
  offer(p);
  auto angles = candidate_angles(algebra_, p, reader_.angle_units());
  if (angles.empty() || p.size() > largest_searched) return choice.value;
  constexpr std::array ways{Eliminate::SineSquared, Eliminate::CosineSquared};
  for (const Eliminate way : ways) {
    Polynomial all = p;
    for (const auto& angle : angles)
      if (angle.size() == 1 && all.size() <= 4 * largest_searched) all = power_form(algebra_, all, angle, way);
    offer(all);
  }
  Polynomial current = p;
  double current_cost = cost_(flat(p));
  for (bool improved = true; improved;) {
    improved = false;
    Polynomial next;
    for (const auto& angle : angles)
      for (const Eliminate way : ways) {
        Polynomial form = power_form(algebra_, current, angle, way);
        const double cost = cost_(flat(form));
        if (form.size() > 1 || cost < current_cost) offer(form);
        if (cost < current_cost - 1e-9) {
          current_cost = cost;
          next = std::move(form);
          improved = true;
        }
      }
    if (improved) current = std::move(next);
  }
  return choice.value;
}

}  // namespace maupertuis::terms
