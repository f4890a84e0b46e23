#include <maupertuis/rates.hpp>

#include "equations/rate_kinematics.hpp"

#include <algorithm>

namespace maupertuis {

struct RateNotation::Impl {
  const EquationsOfMotion& equations;
  std::vector<Rate> rates;
  ReadingOrder order;
  UnitQuaternions spheres;
  std::optional<RateKinematics> kinematics;

  explicit Impl(const EquationsOfMotion& e)
      : equations(e.shown()),
        rates(equations.system->rates.empty() ? body_rates(*equations.system) : equations.system->rates),
        order(order_with_rates(equations, rates)),
        spheres(*equations.system) {
    if (rates.empty() || rates.size() > equations.system->coordinates.size()) return;
    std::string reason;
    kinematics = rate_kinematics(equations, rates, order, spheres, reason);
    if (kinematics && kinematics->free < rates.size()) kinematics.reset();
  }
};

RateNotation::RateNotation(const EquationsOfMotion& equations) : impl_(std::make_unique<const Impl>(equations)) {}
RateNotation::~RateNotation() = default;

const ReadingOrder& RateNotation::order() const { return impl_->order; }

std::optional<ReadableForm> RateNotation::shorter(Expr e, const ReadableForm& shown) const {
  if (!impl_->kinematics) return std::nullopt;
  const RateKinematics& k = *impl_->kinematics;
  const Expr whole = k.in_rates(*impl_->equations.system, expand_time_derivatives(e));
  const Expr tidied = k.by_coefficients(substitute(whole, k.on_constraints()), impl_->order, impl_->spheres);
  ReadableForm form = readable(tidied, impl_->order);
  const auto length = [](const ReadableForm& f, const ReadingOrder& order) {
    double all = width(lay_out(f, order));
    for (const Intermediate& i : f.intermediates) all += width(lay_out(i.value, order));
    return all;
  };
  if (length(form, impl_->order) >= length(shown, impl_->equations.order)) return std::nullopt;
  // The two are the same wherever the constraints hold: shown only if that is seen.
  Expr difference = form.value;
  for (auto i = form.intermediates.rbegin(); i != form.intermediates.rend(); ++i)
    difference = substitute(difference, {{i->symbol, i->value}});
  difference = difference - substitute(expand_time_derivatives(e), k.replacements(*impl_->equations.system));
  difference = substitute(substitute(difference, k.on_constraints()), impl_->spheres.parametrization());
  difference = substitute(difference, impl_->equations.system->definition_values());
  return zero_test(difference).verdict == Verdict::Zero ? std::optional(std::move(form)) : std::nullopt;
}

}  // namespace maupertuis
