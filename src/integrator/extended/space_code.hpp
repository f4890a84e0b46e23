#pragma once
#include "integrator/extended/modes_code.hpp"

/// Friction in the planes of contacts in space: how slips begin, and how slow ones stop (hybrid_space.cpp and
/// hybrid_slips.cpp of simulation, over T).
namespace maupertuis::extended {

template <class T>
bool Modes<T>::rubs_in_space(std::size_t f) const {
  const auto& friction = problem_.contacts.frictions[f];
  return friction.present && friction.in_space && !friction.sticking;
}

template <class T>
void Modes<T>::note_slips() {
  for (std::size_t f = 0; f < problem_.contacts.frictions.size(); ++f) {
    if (!problem_.contacts.frictions[f].in_space) continue;
    const T size = abs(point_->second_drive[f]) + size_along(point_->second_tangent[f], speed_);
    fastest_slip_[f] = std::max(fastest_slip_[f], size);
    slip_in_space_[f] = std::max(slip_in_space_[f], point_->slip_speed(f));
  }
}

/// The speed at which a slip counts as stopped, well above what is rounding of it: what its direction turns from there
/// on is lost in rounding of the place. In steps of ten, so that the motion of a mode serves many of them.
template <class T>
T Modes<T>::stop_speed(std::size_t c) const {
  constexpr double part = 0.7, above_rounding = 100;
  const T speed = std::max({T(epsilon_to<T>(part) * slip_in_space_[c]), T(above_rounding * rest_slip(c)),
                            T(std::numeric_limits<double>::min() * 1e20)});
  return T(std::pow(10.0, std::floor(log2_size(speed) * std::log10(2.0))));
}

template <class T>
typename Modes<T>::Choice Modes<T>::choice_in_space(std::size_t c) const {
  if (point_->slip_speed(c) > rest_slip(c)) return {c, {{true, Slides::Slide, 1, false}}};
  return {c, {{true, Slides::Stick, 1, false}, {true, Slides::Slide, 1, true}}};
}

/// One that has just begun has not yet the speed at which it counts as stopped.
template <class T>
bool Modes<T>::keeps_slip_in_space(const InMode& candidate, std::size_t c, std::int8_t side) const {
  return side >= 0 || just_began_[c] || candidate.mode.stops[c] > static_cast<double>(slip_in_space_[c]);
}

/// The directions of slips that begin, as parameters of the motion.
template <class T>
void Modes<T>::begin_slips(InMode& made) {
  if (bound_ < t_ || !made.program.slips) return;
  const auto& begins = made.mode.begins;
  DirectedSlips<T> slips(*made.program.slips, problem_.contacts.direction_degree, parameters_, t_, q_, v_);
  SlipDirections<T> directions(slips, static_cast<std::size_t>(std::count(begins.begin(), begins.end(), true)));
  if (!directions.find()) return;
  const T length = directions.length(T(bound_ - t_));
  if (!(t_ + length > t_)) return;
  if (t_ + length < bound_) made.end = t_ + length;
  std::vector<T> parameters = parameters_;
  const std::vector<T> given = slips.given();
  parameters.insert(parameters.end(), given.begin(), given.end());
  made.stepper = std::make_unique<Stepper<T>>(made.program.kernel, parameters, options_, log2_tolerance_);
}

template <class T>
T Modes<T>::end_of_mode() const {
  return now_->end && *now_->end < bound_ ? *now_->end : bound_;
}

template <class T>
bool Modes<T>::slips_go_on() const {
  if (now_->end && t_ >= *now_->end) return true;
  const ExtendedMode& mode = now_->mode;
  for (std::size_t c = 0; c < mode.stops.size() && point_; ++c)
    if (mode.friction[c] == Slides::Slide && (mode.begins.empty() || !mode.begins[c]) &&
        T(mode.stops[c]) < rest_slip(c))
      return true;
  return false;
}

/// A slip that is slow and falls comes to rest after v_t²/(−v_t·v̇_t): the motion moves on to there, where both
/// components are 0.
template <class T>
void Modes<T>::come_to_rest(const std::vector<std::size_t>& touching, Met& met) {
  const auto is_slow = [&](const ExtendedWatch& w) { return w.what == What::Slip && rubs_in_space(w.index); };
  if (std::none_of(met.left.begin(), met.left.end(), is_slow) || bound_ < t_) return;
  stepper().start(t_, q_, v_);
  const auto outlook = stepper().outlook(bound_);
  if (outlook.ending != StepEnding::None) return;
  std::vector<T> times(problem_.contacts.count, T(0));  // until they stop; 0: they do not
  T by = T(0);
  for (std::size_t k = 0; k < watches().size(); ++k) {
    const std::size_t c = watches()[k].index;
    if (!is_slow(watches()[k])) continue;
    const T falls = -outlook.slopes[k] / 2, speed = point_->slip_speed(c);  // of v_t²
    if (falls > 0) times[c] = speed * speed / falls;
    if (through_modes::holds(met.left, What::Slip, c)) by = std::max(by, times[c]);
  }
  by = std::min(by, T(bound_ - t_));
  if (!(by > 0)) return;
  const T together = T(0.05), as_slow = T(1000);
  std::vector<std::size_t> stopping;
  for (const std::size_t c : touching)
    if (times[c] > 0 && point_->slip_speed(c) <= as_slow * stop_speed(c) && abs(times[c] - by) <= together * by)
      stopping.push_back(c);
  moment_ = Moment{t_, q_, v_, outlook.accelerations};
  for (std::size_t i = 0; i < q_.size(); ++i) {
    q_[i] += by * (v_[i] + by * outlook.accelerations[i] / 2);
    v_[i] += by * outlook.accelerations[i];
  }
  t_ += by;
  if (!evaluate()) return;
  take_out_slips(stopping, touching);
}

/// What the moment leaves of slips that stop: the least change of velocities that ends them and opens no contact.
template <class T>
void Modes<T>::take_out_slips(const std::vector<std::size_t>& stopping, const std::vector<std::size_t>& touching) {
  std::vector<std::vector<T>> rows;
  std::vector<T> wanted;
  for (const std::size_t c : stopping) {
    rows.push_back(point_->tangent[c]), wanted.push_back(-point_->slip[c]);
    rows.push_back(point_->second_tangent[c]), wanted.push_back(-point_->second_slip[c]);
  }
  if (rows.empty()) return;
  for (const std::size_t c : touching)
    if (!(point_->rate[c] > rest_rate(c))) rows.push_back(point_->normal[c]), wanted.push_back(T(0));
  const Responses<T> responses(base_);
  std::vector<std::vector<T>> changes;
  for (const auto& row : rows) changes.push_back(responses.of(row));
  std::vector<T> matrix;
  for (const auto& row : rows)
    for (const auto& change : changes) matrix.push_back(along<T>(row, change));
  LinearSolver<T> solver;
  solver.factor(matrix, rows.size(), epsilon_to<T>(0.5));
  solver.solve(wanted);
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (std::size_t i = 0; i < v_.size(); ++i) v_[i] += wanted[k] * changes[k][i];
  for (std::size_t i = 0; i < v_.size(); ++i)  // what rounding leaves of all that stops is no motion
    if (abs(v_[i]) <= through_modes::roundings * epsilon<T>() * speed_[problem_.contacts.kind[i]]) v_[i] = T(0);
  static_cast<void>(evaluate());
}

}  // namespace maupertuis::extended
