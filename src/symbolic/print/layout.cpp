#include "symbolic/print/layout.hpp"

#include "symbolic/expression/kind_table.hpp"
#include "symbolic/print/reading_rank.hpp"
#include "symbolic/print/symbol_name.hpp"

#include <maupertuis/decimal_places.hpp>
#include <maupertuis/interrupt_scope.hpp>
#include <maupertuis/kinds.hpp>
#include <maupertuis/require.hpp>

#include <algorithm>

namespace maupertuis {
namespace print {
namespace {

Layout combined(Shape shape, std::vector<Layout> parts) {
  Layout layout;
  layout.shape = shape;
  layout.parts = std::move(parts);
  return layout;
}

Layout with_text(Shape shape, std::string text, std::vector<Layout> parts = {}) {
  Layout layout = combined(shape, std::move(parts));
  layout.text = std::move(text);
  return layout;
}

Layout number_text(std::string text) { return with_text(Shape::Number, std::move(text)); }

/// Turning the argument around turns the value around, or leaves it. sign keeps its argument as it was written.
Parity parity_of(Kind kind) { return kind == Kind::Sign ? Parity::None : kind_info(kind).parity; }

/// The only body or frame with coordinates of its own, ball.qw, …, or with `rates`, ∫ball.ω.x; empty where there are
/// none or several.
std::string lone_body(const ReadingOrder& order, bool rates) {
  std::string found;
  for (const Expr& q : order.coordinates) {
    if (is_integral(q.name()) != rates) continue;
    const std::string_view name = std::string_view(q.name()).substr(rates ? integral_sign.size() : 0);
    const std::size_t dot = name.find('.');
    if (dot == std::string_view::npos) continue;
    if (!found.empty() && found != name.substr(0, dot)) return {};
    found = name.substr(0, dot);
  }
  return found;
}

class Builder {
 public:
  explicit Builder(const ReadingOrder& order)
      : ranks_(order), body_(lone_body(order, false)), turning_(lone_body(order, true)) {}

  /// The whole expression: only here does the row's own coordinate come first.
  Layout build_top(Expr e) const { return e.is(Kind::Sum) ? sum(e, SumPlace::Top) : build(e); }

 private:
  enum class SumPlace { Top, Inside, Angle };

  Layout build(Expr e) const {
    switch (family_of(e.kind())) {
      case Family::Leaf:
        return leaf(e);
      case Family::Algebra:
        return e.is(Kind::Sum) ? sum(e, SumPlace::Inside) : product(e);
      case Family::TimeDerivative: {
        Layout layout = combined(Shape::Derivative, {build(e[0])});
        layout.text = independent_name(e.context());
        return layout;
      }
      case Family::Comparison:
        return with_function(Shape::Comparison, e);
      case Family::Logic:
        return with_function(Shape::Logic, e);
      case Family::Piecewise:
        return with_function(Shape::Cases, e);
      case Family::Function:
      case Family::Switch:
      case Family::Angle:
      case Family::Extremum:
        return function(e, {});
    }
    throw unknown_kind(e.kind(), "the printer");
  }

  Layout leaf(Expr e) const {
    if (e.is_number()) return number(e.number());
    if (e.is(Kind::Pi)) return combined(Shape::Pi, {});
    Layout layout = layouts::symbol(e);
    if (!body_.empty()) layout.text = name_within_body(e.name(), body_);
    if (layout.text.empty() && !turning_.empty() && is_integral(e.name()))
      layout.text = name_within_body(e.name(), turning_);
    return layout;
  }

  static Layout number(const Rational& value) {
    Layout layout = lay_out_number(abs(value));
    layout.negative = value.sign() < 0;
    return layout;
  }

  Layout with_function(Shape shape, Expr e) const {
    Layout layout = combined(shape, {});
    layout.function = e.kind();
    constexpr std::size_t many = 64;  // pieces of a table
    for (std::size_t i = 0; i < e.size(); ++i) {
      if (i % many == many - 1) interrupt_of(e.context()).throw_if_asked();
      layout.parts.push_back(build(e[i]));
    }
    return layout;
  }

  /// A sum under a sum with coefficient 1 is no structure that a reader can see.
  static void flatten(Expr sum, std::vector<Expr>& terms) {
    for (std::size_t i = 0; i < sum.size(); ++i) {
      if (sum[i].is(Kind::Sum))
        flatten(sum[i], terms);
      else
        terms.push_back(sum[i]);
    }
  }

  Layout sum(Expr e, SumPlace place) const {
    std::vector<Expr> terms;
    flatten(e, terms);
    std::vector<std::pair<Rank, Layout>> ordered;
    for (const Expr& term : terms)
      ordered.emplace_back(
          place == SumPlace::Angle ? ranks_.angle_term(term) : ranks_.term(term, place == SumPlace::Top), build(term));
    std::stable_sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    // a − b, not −b + a: the first positive term leads, except before accelerations, whose order means something.
    const bool equation = place != SumPlace::Angle && ordered.front().first.front() == 0;
    const auto positive =
        std::find_if(ordered.begin(), ordered.end(), [](const auto& t) { return !t.second.negative; });
    if (!equation && positive != ordered.end()) std::rotate(ordered.begin(), positive, positive + 1);
    Layout layout = combined(Shape::Sum, {});
    for (auto& [rank, part] : ordered) {
      layout.minus.push_back(part.negative);
      part.negative = false;
      layout.parts.push_back(std::move(part));
    }
    return layout;
  }

  /// The argument of an even or odd function, turned so that its first coordinate is positive: θ1 − θ2.
  Layout oriented_argument(Expr argument, bool& turned) const {
    turned = false;
    if (!argument.is(Kind::Sum)) return build(argument);
    Expr first = argument[0];
    for (std::size_t i = 1; i < argument.size(); ++i)
      if (ranks_.angle_term(argument[i]) < ranks_.angle_term(first)) first = argument[i];
    turned = split_coefficient(first).coefficient.sign() < 0;
    if (!turned) return sum(argument, SumPlace::Angle);
    std::vector<Expr> terms;
    for (std::size_t i = 0; i < argument.size(); ++i) terms.push_back(-argument[i]);
    return sum(argument.context().sum(terms), SumPlace::Angle);
  }

  Layout function(Expr e, std::string exponent) const {
    Layout layout = combined(Shape::Apply, {});
    layout.function = e.kind();
    layout.text = std::move(exponent);
    const Parity parity = parity_of(e.kind());
    if (parity == Parity::None) {
      for (std::size_t i = 0; i < e.size(); ++i) layout.parts.push_back(build(e[i]));
      return layout;
    }
    bool turned = false;
    layout.parts.push_back(oriented_argument(e[0], turned));
    const bool odd_power = layout.text.empty() || (layout.text.back() - '0') % 2 == 1;
    layout.negative = turned && parity == Parity::Odd && odd_power;
    return layout;
  }

  /// base^exponent for an exponent that is not negative.
  Layout power(Expr base, Expr exponent) const {
    const Rational* e = exponent.number_or_null();
    if (e && e->is_one()) return build(base);
    if (e && *e == Rational(1, 2)) return combined(Shape::Root, {build(base)});
    if (e && e->is_integer() && is_circular(base.kind())) return function(base, e->to_string());
    Layout exponent_layout = e ? lay_out_number(*e) : build(exponent);
    return combined(Shape::Power, {build(base), std::move(exponent_layout)});
  }

  Layout product(Expr e) const {
    std::vector<Expr> above, below;
    Rational coefficient = 1;
    gather(e, above, below, coefficient);
    merge_symbolic_powers(above, below);
    const auto by_rank = [&](const Expr& a, const Expr& b) { return ranks_.factor(a) < ranks_.factor(b); };
    std::stable_sort(above.begin(), above.end(), by_rank);
    std::stable_sort(below.begin(), below.end(), by_rank);
    bool negative = coefficient.sign() < 0;
    // Above a fraction bar 1/2 m/r becomes m/(2 r); without one the number stands in front.
    Rational over = abs(coefficient), under = 1;
    const bool exact_parts = lay_out_number(over).shape == Shape::Quotient;
    if (!below.empty() && exact_parts) {
      over = *Rational::parse(abs(coefficient).numerator_string());
      under = *Rational::parse(abs(coefficient).denominator_string());
    }
    Layout numerator = row(over, above, negative);
    if (below.empty()) return signed_layout(std::move(numerator), negative);
    Layout denominator = row(under, below, negative);
    return signed_layout(combined(Shape::Quotient, {std::move(numerator), std::move(denominator)}), negative);
  }

  /// A minus sign before a sum is a product to the writers: they put brackets.
  static Layout signed_layout(Layout layout, bool negative) {
    if (negative && layout.shape == Shape::Sum) layout = combined(Shape::Product, {std::move(layout)});
    layout.negative = negative;
    return layout;
  }

  /// A number and factors side by side; signs that factors bring along go to `negative`.
  Layout row(const Rational& number, const std::vector<Expr>& factors, bool& negative) const {
    std::vector<Layout> parts;
    if (!number.is_one() || factors.empty()) parts.push_back(lay_out_number(number));
    for (const Expr& f : factors) {
      const bool power_node = f.is(Kind::Power);
      parts.push_back(power_node ? power(f[0], f[1]) : build(f));
      negative ^= parts.back().negative;
      parts.back().negative = false;
    }
    if (parts.size() == 1) return std::move(parts.front());
    return combined(Shape::Product, std::move(parts));
  }

  static void gather(Expr e, std::vector<Expr>& above, std::vector<Expr>& below, Rational& coefficient) {
    if (e.is(Kind::Product)) {
      for (std::size_t i = 0; i < e.size(); ++i) gather(e[i], above, below, coefficient);
    } else if (e.is_number()) {
      coefficient *= e.number();
    } else if (const PowerOf p = split_power(e); p.exponent.sign() < 0) {
      below.push_back(pow(p.base, -p.exponent));
    } else {
      above.push_back(e);
    }
  }

  /// x^2 · x^s reads x^(s + 2), x^s/x reads x^(s - 1).
  static void merge_symbolic_powers(std::vector<Expr>& above, std::vector<Expr>& below) {
    for (Expr& f : above) {
      if (!f || !f.is(Kind::Power) || f[1].is_number()) continue;
      const Expr base = f[0];
      for (auto* side : {&above, &below})
        for (Expr& other : *side) {
          if (!other || other == f || split_power(other).base != base) continue;
          const Rational exponent = split_power(other).exponent;
          f = base.context().power(base, f[1] + (side == &above ? exponent : -exponent));
          other = Expr();
        }
    }
    for (auto* side : {&above, &below}) std::erase_if(*side, [](const Expr& f) { return !f; });
  }

  ReadingRanks ranks_;
  std::string body_;     // ball.qw is shown as q_w where no other body has such coordinates
  std::string turning_;  // ball.ω.x as ω_1 where no other body has rates
};

std::string decimal_text(const Rational& value, int digits) {
  std::string text = (value * maupertuis::pow(Rational(10), digits)).numerator_string();
  if (text.size() <= static_cast<std::size_t>(digits))
    text.insert(0, static_cast<std::size_t>(digits) + 1 - text.size(), '0');
  text.insert(text.size() - static_cast<std::size_t>(digits), ".");
  return text;
}

}  // namespace

Layout lay_out_number(const Rational& value) {
  if (value.is_integer()) return number_text(value.numerator_string());
  // Halves, thirds, fifths are fractions to a reader; 981/100 is 9.81.
  const std::string denominator = value.denominator_string();
  const auto places = decimal_places(value);
  const bool plain_fraction =
      denominator.size() == 1 || (denominator.size() == 2 && denominator.back() != '0' && denominator != "25");
  if (places && !plain_fraction) return number_text(decimal_text(value, *places));
  return combined(Shape::Quotient, {number_text(value.numerator_string()), number_text(denominator)});
}

bool is_circular(Kind kind) { return kind_info(kind).bare; }

bool starts_with_number(const Layout& layout) {
  if (layout.shape == Shape::Symbol) return layout.symbol.role() == Role::Constant;
  if (layout.shape == Shape::Power)  // (2 [m])^2 has brackets of its own
    return is_simple_base(layout.parts.front()) && starts_with_number(layout.parts.front());
  return layout.shape == Shape::Number;
}

namespace {

/// Nothing closes the brace of cases: what follows would be read as part of them.
bool ends_with_cases(const Layout& l) {
  return l.shape == Shape::Cases || (l.shape == Shape::Product && ends_with_cases(l.parts.back()));
}

}  // namespace

bool needs_brackets(const std::vector<Layout>& parts, std::size_t i) {
  const Layout& l = parts[i];
  if (i + 1 < parts.size() && ends_with_cases(l)) return true;
  return l.negative || l.shape == Shape::Sum || l.shape == Shape::Comparison || l.shape == Shape::Logic;
}

bool is_simple_base(const Layout& base) {
  if (base.negative) return false;
  if (base.shape == Shape::Labelled) return is_simple_base(base.parts[0]);  // v_A²
  if (base.shape == Shape::Symbol) return base.symbol.role() != Role::Constant;
  return base.shape == Shape::Number || base.shape == Shape::Pi || base.shape == Shape::Name ||
         base.shape == Shape::Bold || base.shape == Shape::Indexed;
}

bool has_bare_argument(const Layout& apply) {
  const Layout& first = apply.parts.front();
  if (!is_circular(apply.function) || first.negative) return false;
  return first.shape == Shape::Pi || (first.shape == Shape::Symbol && first.symbol.role() != Role::Constant);
}

bool needs_brackets_above_slash(const Layout& numerator) {
  return numerator.negative || numerator.shape == Shape::Sum || numerator.shape == Shape::Cases ||
         numerator.shape == Shape::Quotient || numerator.shape == Shape::Comparison || numerator.shape == Shape::Logic;
}

bool needs_brackets_below_slash(const Layout& denominator) {
  return needs_brackets_above_slash(denominator) || denominator.shape == Shape::Product;
}

bool is_tall(const Layout& l) {
  if (l.shape == Shape::Quotient || l.shape == Shape::Root || l.shape == Shape::Cases || l.shape == Shape::Matrix ||
      l.shape == Shape::Derivative || l.shape == Shape::Partial || l.shape == Shape::Rate)
    return true;
  const std::size_t count = l.shape == Shape::Power ? 1 : l.parts.size();  // an exponent stands on one line
  return std::any_of(l.parts.begin(), l.parts.begin() + static_cast<std::ptrdiff_t>(count), is_tall);
}

}  // namespace print

Layout lay_out(Expr e, const ReadingOrder& order) { return print::Builder(order).build_top(e); }

Layout lay_out(const ReadableForm& form, const ReadingOrder& order) {
  places_of(order);  // before the copy, which shares them
  ReadingOrder with_own = order;
  with_own.own = form.own;
  return lay_out(form.value, with_own);
}

namespace layouts {

using print::combined;
using print::with_text;

Layout number(std::string text) { return with_text(Shape::Number, std::move(text)); }
Layout bold(std::string text, int dots) {
  Layout layout = with_text(Shape::Bold, std::move(text));
  layout.dots = dots;
  return layout;
}
Layout name(std::string text, int dots, bool primes) {
  Layout layout = with_text(Shape::Name, std::move(text));
  layout.dots = dots;
  layout.primes = primes;
  return layout;
}
Layout symbol(Expr symbol) {
  Layout layout = combined(Shape::Symbol, {});
  layout.symbol = symbol;
  return layout;
}
Layout words(std::string text) { return with_text(Shape::Words, std::move(text)); }
Layout indexed(Layout base, std::vector<Layout> below) {
  below.insert(below.begin(), std::move(base));
  return combined(Shape::Indexed, std::move(below));
}
Layout power(Layout base, Layout exponent) { return combined(Shape::Power, {std::move(base), std::move(exponent)}); }
Layout product(std::vector<Layout> factors) { return combined(Shape::Product, std::move(factors)); }
Layout sum(std::vector<Layout> terms) {
  Layout layout = combined(Shape::Sum, std::move(terms));
  layout.minus.assign(layout.parts.size(), false);
  return layout;
}
Layout partial(Layout of, Layout by) { return combined(Shape::Partial, {std::move(of), std::move(by)}); }
Layout rate(Layout of, Layout by, bool in_front) {
  if (!in_front) return combined(Shape::Rate, {std::move(of), std::move(by)});
  return combined(Shape::Row, {combined(Shape::Rate, {Layout{}, std::move(by)}), std::move(of)});
}
Layout braces(Layout a, Layout b) { return combined(Shape::Braces, {std::move(a), std::move(b)}); }
Layout matrix(std::vector<Layout> entries, std::size_t columns) {
  Layout layout = combined(Shape::Matrix, std::move(entries));
  layout.columns = columns;
  return layout;
}
Layout labelled(std::string plain, Layout typeset) {
  return with_text(Shape::Labelled, std::move(plain), {std::move(typeset)});
}

}  // namespace layouts
}  // namespace maupertuis
