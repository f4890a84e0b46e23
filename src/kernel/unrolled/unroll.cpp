#include "kernel/unrolled/unroll.hpp"

#include "kernel/program/point_orders.hpp"
#include "kernel/unrolled/unrolling.hpp"

namespace maupertuis::unrolled {

Unrolling::Unrolling(const packed::PackedProgram& program, std::size_t stride, int order)
    : packed_(program),
      p_(program.program),
      stride_(stride),
      order_(order),
      n_(static_cast<std::uint32_t>(p_.unknowns)),
      step_of_(p_.slots, -1) {
  const auto orders = static_cast<std::size_t>(order - p_.first_stage + 2);
  final_.assign(orders * p_.slots, none), early_ = final_;
  for (const packed::Pack& pack : packed_.packs) add_steps(pack);
  looks_ahead_ = can_look_ahead();
  if (are_points_unrolled(p_)) add_points();
}

straight::StraightLine Unrolling::run() {
  for (stage_ = p_.first_stage; stage_ < order_; ++stage_) {
    rates_.clear();
    if (stage_ == -2 || stage_ == -1) give_coordinates(stage_ + 2);
    for (const Step& step : steps_) find(step);
    if (stage_ == 0) factor();
    if (stage_ >= 0) solve(), correct();
    if (stage_ <= 0) find_points();
    if (stage_ == 1 && looks_ahead_) look_ahead();
  }
  for (std::uint32_t i = 0; i < n_; ++i) to_.require_finite(to_.lane(check_, i));
  return to_.finish(arrays, 1, 0);
}

straight::StraightLine unroll(const packed::PackedProgram& program, std::size_t stride, int order) {
  return Unrolling(program, stride, order).run();
}

}  // namespace maupertuis::unrolled
