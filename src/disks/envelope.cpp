#include "disks/envelope.hpp"

#include <maupertuis/slopes.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace maupertuis {

Envelope::Envelope(const Program& program, std::span<const int> degrees)
    : program_(program),
      degrees_(degrees.begin(), degrees.end()),
      needs_size_(program.slots, 0),
      rates_(program.slots, 0),
      values_(program.slots),
      place_(program.slots, -1) {
  find_needs();
}

/// Backwards: products, quotients and powers need the size of what they are made of, sines and derivatives do not.
void Envelope::find_needs() {
  const auto want = [this](Slot slot, int rates) {
    rates_[slot] = std::max(rates_[slot], static_cast<std::int8_t>(std::min(rates, 2)));
  };
  for (auto run = program_.runs[Dynamics].rbegin(); run != program_.runs[Dynamics].rend(); ++run)
    for (std::uint32_t at = run->last; at-- > run->first;) {
      const Instruction& i = program_.instructions[at];
      const int rates = i.second == no_slot ? rates_[i.out] : std::max(rates_[i.out], rates_[i.second]);
      const bool is_sum = i.op == Op::Linear || i.op == Op::Products || i.op == Op::Select;
      const bool is_angle = i.op == Op::SinCos || i.op == Op::Derivative;
      for (std::uint32_t t = i.first_term; is_sum && t < i.last_term; ++t) {
        const Term& term = program_.terms[t];
        const bool is_product = i.op == Op::Products && t >= i.first_product;
        if (is_product)
          needs_size_[term.a] = needs_size_[term.b] = 1, want(term.b, rates);
        else if (term.shift == 0 && needs_size_[i.out])
          needs_size_[term.a] = 1;
        want(term.a, rates + static_cast<int>(term.shift));
      }
      for (const Slot slot : {i.a, i.b}) {
        if (is_sum || slot == no_slot) continue;
        if (!is_angle) needs_size_[slot] = 1;
        if (i.op == Op::SquareRoot || i.op == Op::Power || i.op == Op::Function ||
            (i.op == Op::Quotient && slot == i.b))
          observe(slot);
        want(slot, i.op == Op::Derivative ? rates + 1 : rates);
      }
      if (i.op == Op::Function) observe(i.out);
    }
}

void Envelope::observe(Slot slot) {
  if (place_[slot] >= 0 || slot == program_.one) return;
  place_[slot] = static_cast<int>(observed_.size());
  observed_.push_back(slot);
}

void Envelope::evaluate(const double* constants, const MotionSizes& sizes, double radius, int order) {
  order_ = order;
  sizes_ = sizes;
  for (std::size_t i = 0; i < program_.unknowns; ++i)
    set(static_cast<Slot>(i), {sizes.centre[i],
                               sizes.reach[i],
                               0,
                               {sizes.centre[i] + sizes.reach[i], sizes.rate[i], sizes.acceleration[i]},
                               {0, 0, 0}});
  if (program_.one != no_slot) values_[program_.one] = {1, 0, 1, {1, 0, 0}, {0, 0, 0}};
  if (program_.time != no_slot) set(program_.time, {sizes.time, radius, 0, {sizes.time + radius, 1, 0}, {0, 0, 0}});
  for (const Run& run : program_.runs[Dynamics])
    for (std::uint32_t at = run.first; at < run.last; ++at) {
      const Instruction& i = program_.instructions[at];
      Value value = evaluate(i, constants);
      if (degrees_[i.out] < order_) std::fill(value.tail, value.tail + 3, 0.0);
      if (i.second != no_slot) set(i.second, value);
      if (i.op == Op::SinCos) value.centre = std::min(1.0, values_[i.a].centre);
      set(i.out, value);
    }
}

/// What is observed of a value holds besides.
void Envelope::set(Slot slot, Value value) {
  if (const int at = place_[slot]; at >= 0) {
    const double least = sizes_.least[static_cast<std::size_t>(at)], most = sizes_.most[static_cast<std::size_t>(at)];
    value.centre = std::min(value.centre, std::max(std::abs(least), std::abs(most)));
    value.high[0] = std::min(value.high[0], value.centre + value.reach);
    value.low = std::max({value.low, least - value.reach, -most - value.reach});
  }
  values_[slot] = value;
}

Envelope::Value Envelope::evaluate(const Instruction& i, const double* constants) const {
  switch (i.op) {
    case Op::One:
    case Op::Time:
    case Op::Coordinate:
    case Op::Companion:
      break;
    case Op::Linear:
    case Op::Products:
      return sum(i, constants);
    case Op::Square:
      return product(i.a, i.a);
    case Op::Quotient:
      return quotient(i);
    case Op::SquareRoot:
      return power(values_[i.a], 0.5);
    case Op::Power:
      return power(values_[i.a], constants[i.constant]);
    case Op::SinCos:
      return circular(values_[i.a], false);
    case Op::SinhCosh:
      return circular(values_[i.a], true);
    case Op::Function:
      return function(i);
    case Op::Derivative: {
      const Value& a = values_[i.a];
      return {a.high[1],
              2 * a.high[1],
              0,
              {a.high[1], a.high[2], infinity},
              {a.tail[1], a.tail[2], a.tail[2] == 0 ? 0 : infinity}};
    }
    case Op::Select: {
      std::uint32_t t = i.first_term;
      while (t + 1 < i.last_term && constants[program_.terms[t].coefficient] == 0) ++t;
      return values_[program_.terms[t].a];
    }
  }
  throw std::logic_error("an envelope met an operation that it does not know; please report");
}

/// What a term with c adds, `shift` derivatives up. The loops are of one length, so that they become vectors.
void Envelope::add(Value& total, double& largest, double c, const Value& f, int shift) {
  if (shift == 0) {
    total.centre += c * f.centre;
    total.reach += c * f.reach;
    for (int d = 0; d < 3; ++d) total.high[d] += c * f.high[d];
    for (int d = 0; d < 3; ++d) total.tail[d] += c * f.tail[d];
    largest = std::max(largest, c * (f.low + f.high[0]));
    return;
  }
  total.centre += c * f.high[shift];
  total.reach += 2 * c * f.high[shift];
  for (int d = 0; d < 3; ++d) {
    const bool is_known = shift + d < 3;
    total.high[d] += c * (is_known ? f.high[shift + d] : infinity);
    total.tail[d] += c * (is_known ? f.tail[shift + d] : f.tail[2] == 0 ? 0.0 : infinity);
  }
  largest = std::max(largest, c * f.high[shift]);
}

/// The modulus of a sum is at least the largest lower bound of a term less the upper bounds of the others. Derivatives
/// that no one wants may be anything.
Envelope::Value Envelope::sum(const Instruction& i, const double* constants) const {
  Value total{.centre = 0, .reach = 0, .low = 0, .high = {0, 0, 0}, .tail = {0, 0, 0}};
  double largest = 0;  // of low + high
  const bool has_products = i.op == Op::Products;
  for (std::uint32_t t = i.first_term; t < i.last_term; ++t) {
    const Term& term = program_.terms[t];
    const double c = std::abs(constants[term.coefficient]);
    if (c == 0) continue;
    if (has_products && t >= i.first_product) {
      Value f = product(term.a, term.b);
      if (degrees_[term.a] + degrees_[term.b] < order_) f.tail[0] = f.tail[1] = f.tail[2] = 0;
      add(total, largest, c, f, static_cast<int>(term.shift));
    } else {
      add(total, largest, c, values_[term.a], static_cast<int>(term.shift));
    }
  }
  total.low = total.high[0] < infinity ? std::max(0.0, largest - total.high[0]) : 0.0;
  return total;
}

/// (u v)˙ = u̇ v + u v̇. All of it counts as tail: two polynomials give one of a degree beyond the kept one.
Envelope::Value Envelope::product(Slot a, Slot b) const {
  const Value &u = values_[a], &v = values_[b];
  Value f;
  f.centre = u.centre * v.centre;
  f.low = u.low * v.low;
  f.high[0] = u.high[0] * v.high[0];
  f.high[1] = u.high[1] * v.high[0] + u.high[0] * v.high[1];
  f.high[2] = u.high[2] * v.high[0] + 2 * u.high[1] * v.high[1] + u.high[0] * v.high[2];
  f.reach = std::min(u.centre * v.reach + v.centre * u.reach + u.reach * v.reach, f.high[0] + f.centre);
  f.tail[0] = f.reach, f.tail[1] = f.high[1], f.tail[2] = f.high[2];
  return f;
}

/// f = u/v: ḟ = (u̇ − f v̇)/v, f̈ = (ü − 2 ḟ v̇ − f v̈)/v.
Envelope::Value Envelope::quotient(const Instruction& i) const {
  const Value &u = values_[i.a], &v = values_[i.b];
  const double over = v.low > 0 ? 1 / v.low : infinity;
  Value f;
  f.high[0] = u.high[0] * over;
  f.high[1] = (u.high[1] + f.high[0] * v.high[1]) * over;
  f.high[2] = (u.high[2] + 2 * f.high[1] * v.high[1] + f.high[0] * v.high[2]) * over;
  f.centre = f.high[0];
  f.low = u.low / v.high[0];
  f.reach = std::min((u.reach + f.centre * v.reach) * over, 2 * f.high[0]);
  f.tail[0] = f.reach, f.tail[1] = f.high[1], f.tail[2] = f.high[2];
  return f;
}

/// f = w^c: ḟ = c w^{c−1} ẇ, f̈ = c w^{c−1} ẅ + c (c − 1) w^{c−2} ẇ². A disk about 0 is one of whole positive powers
/// alone.
Envelope::Value Envelope::power(const Value& w, double c) const {
  const bool is_whole = c > 0 && c == std::nearbyint(c);
  const auto largest = [&](double exponent, double factor) {  // of |factor w^exponent|
    return factor == 0 ? 0.0
                       : std::abs(factor) * (exponent == 0  ? 1.0
                                             : exponent > 0 ? std::pow(w.high[0], exponent)
                                             : w.low > 0    ? std::pow(w.low, exponent)
                                                            : infinity);
  };
  if (!is_whole && !(w.low > 0)) return {};
  const double slope = largest(c - 1, c), bend = largest(c - 2, c * (c - 1));
  Value f;
  f.high[0] = largest(c, 1);
  f.high[1] = slope * w.high[1];
  f.high[2] = slope * w.high[2] + bend * w.high[1] * w.high[1];
  f.centre = f.high[0];
  f.low = c > 0 ? std::pow(w.low, c) : std::pow(w.high[0], c);
  f.reach = std::min(slope * w.reach, 2 * f.high[0]);
  f.tail[0] = f.reach, f.tail[1] = f.high[1], f.tail[2] = f.high[2];
  return f;
}

/// Sine and cosine of what is real at the centre are at most cosh δ, and all their derivatives; those of hyperbolic
/// ones cosh(|w| + δ).
Envelope::Value Envelope::circular(const Value& w, bool hyperbolic) const {
  const double d = w.reach, cosh = hyperbolic ? std::cosh(w.centre + d) : std::cosh(d), sinh = std::sinh(d);
  Value f;
  f.centre = hyperbolic ? std::cosh(w.centre) : 1.0;
  f.low = 0;
  f.high[0] = cosh;
  f.high[1] = cosh * w.high[1];
  f.high[2] = cosh * (w.high[2] + w.high[1] * w.high[1]);
  f.reach = std::min(hyperbolic ? cosh * d : 0.5 * d * sinh + sinh, cosh + f.centre);  // cosh − 1 ≤ ½ d sinh
  f.tail[0] = f.reach, f.tail[1] = f.high[1], f.tail[2] = f.high[2];
  return f;
}

/// By the largest slope over the disks of all arguments; second derivatives are not looked at.
Envelope::Value Envelope::function(const Instruction& i) const {
  const Value& w = values_[i.a];
  if (i.b != no_slot || place_[i.a] < 0) return {};
  const auto at = static_cast<std::size_t>(place_[i.a]);
  const double least = sizes_.least[at], most = sizes_.most[at], d = 0.5 * (most - least) + w.reach;
  if (!(d < infinity)) return {};
  const double slope = largest_slope(i.function, 0.5 * (least + most), d, w.low);
  Value f;
  f.reach = w.reach == 0 ? 0.0 : slope * w.reach;
  if (i.function == Kind::Exp) {
    f.low = std::exp(least - w.reach), f.centre = std::exp(most);
    f.reach = std::min(f.reach, std::exp(most + w.reach));
  }
  f.high[0] = f.centre + f.reach;
  f.high[1] = slope * w.high[1];
  f.tail[0] = f.reach, f.tail[1] = f.high[1];
  return f;
}

}  // namespace maupertuis
