#include "symbolic/print/layout.hpp"

#include <algorithm>

/// Where a long formula breaks.
namespace maupertuis {
namespace print {
namespace {

using Pieces = std::vector<Layout>;

Layout sign(const char* text, bool without_left_side = false) {
  Layout layout;
  layout.shape = Shape::Sign;
  layout.text = text;
  layout.negative = without_left_side;
  return layout;
}

Layout row(std::vector<Layout> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  Layout layout;
  layout.shape = Shape::Row;
  layout.parts = std::move(parts);
  return layout;
}

/// Rows inside rows are one row.
void put_before(Layout& piece, std::vector<Layout> parts) {
  if (piece.shape == Shape::Row)
    parts.insert(parts.end(), piece.parts.begin(), piece.parts.end());
  else
    parts.push_back(std::move(piece));
  piece = row(std::move(parts));
}
void put_behind(Layout& piece, const std::vector<Layout>& parts) {
  std::vector<Layout> all = piece.shape == Shape::Row ? std::move(piece.parts) : std::vector<Layout>{std::move(piece)};
  all.insert(all.end(), parts.begin(), parts.end());
  piece = row(std::move(all));
}

class Breaker {
 public:
  explicit Breaker(double line) : line_(line) {}

  /// The pieces of a formula that stands in no brackets: terms with their signs.
  Pieces formula(const Layout& l) const {
    if (l.shape != Shape::Sum || l.negative) return term(l);
    Pieces pieces;
    for (std::size_t i = 0; i < l.parts.size(); ++i) {
      Pieces of_term = needs_brackets(l.parts, i) ? in_brackets(l.parts[i], {}) : term(l.parts[i]);
      if (i > 0)
        put_before(of_term.front(), {sign(l.minus[i] ? "-" : "+")});
      else if (l.minus[i])
        put_before(of_term.front(), {sign("-", true)});
      pieces.insert(pieces.end(), of_term.begin(), of_term.end());
    }
    return pieces;
  }

 private:
  bool fits(const Layout& l) const { return width(l) <= line_; }

  Pieces term(const Layout& l) const {
    if (fits(l)) return {l};
    if (l.negative) {
      Layout positive = l;
      positive.negative = false;
      Pieces pieces = positive.shape == Shape::Sum ? in_brackets(positive, {}) : term(positive);
      put_before(pieces.front(), {sign("-", true)});
      return pieces;
    }
    switch (l.shape) {
      case Shape::Product:
        return product(l.parts);
      case Shape::Quotient:
        return quotient(l.parts[0], l.parts[1]);
      case Shape::Power:
        return in_brackets(l.parts[0], l.parts[1]);
      case Shape::Root:
        return in_brackets(l.parts[0], layouts::number("1/2"));
      case Shape::Apply:
        return application(l);
      case Shape::Sum:
        return formula(l);
      case Shape::Labelled:
        return term(l.parts[0]);
      case Shape::Empty:
      case Shape::Number:
      case Shape::Symbol:
      case Shape::Pi:
      case Shape::Derivative:
      case Shape::Comparison:
      case Shape::Logic:
      case Shape::Cases:
      case Shape::Name:
      case Shape::Bold:
      case Shape::Words:
      case Shape::Indexed:
      case Shape::Partial:
      case Shape::Rate:
      case Shape::Braces:
      case Shape::Matrix:
      case Shape::Row:
      case Shape::Sign:
      case Shape::Open:
      case Shape::Close:
        break;
    }
    return {l};
  }

  /// The pieces between an opening bracket, glued to the first of them, and a closing one with its exponent behind it.
  Pieces in_brackets(const Layout& l, const Layout& exponent, Layout open = {}) const {
    open.shape = Shape::Open;
    Layout close = open;
    close.shape = Shape::Close;
    open.tall = close.tall = is_tall(l);
    if (!exponent.empty()) close.parts = {exponent};
    Pieces pieces = formula(l);
    put_before(pieces.front(), {open});
    put_behind(pieces.back(), {close});
    return pieces;
  }

  Pieces application(const Layout& l) const {
    if (l.parts.size() != 1) return {l};
    Layout open;
    open.function = l.function;
    open.text = l.text;
    return in_brackets(l.parts.front(), {}, open);
  }

  /// The widest factor is broken; what stands before and behind it stays with its first and last piece where it fits.
  Pieces product(const std::vector<Layout>& parts) const {
    std::size_t widest = 0;
    for (std::size_t i = 1; i < parts.size(); ++i)
      if (room_in(parts[i]) > room_in(parts[widest])) widest = i;
    Pieces pieces = needs_brackets(parts, widest) ? in_brackets(parts[widest], {}) : whole(parts[widest]);
    const auto at = parts.begin() + static_cast<std::ptrdiff_t>(widest);
    if (at + 1 != parts.end()) put_product_behind(pieces, factors({at + 1, parts.end()}));
    if (widest == 0) return pieces;
    Pieces before{factors({parts.begin(), at})};
    if (width(before.front()) + width(pieces.front()) <= line_) {
      put_before(pieces.front(), before);
      return pieces;
    }
    if (width(before.front()) > line_) before = term(before.front());
    put_before(pieces.front(), {sign("⋅")});
    before.insert(before.end(), pieces.begin(), pieces.end());
    return before;
  }

  void put_product_behind(Pieces& pieces, const Layout& after) const {
    if (width(pieces.back()) + width(after) <= line_) return put_behind(pieces.back(), {after});
    Pieces more = term(after);
    put_before(more.front(), {sign("⋅")});
    pieces.insert(pieces.end(), more.begin(), more.end());
  }

  /// How much a factor gives when it is broken: an inverse, 1/(a + b), stays as it is.
  static double room_in(const Layout& l) {
    const bool inverse = l.shape == Shape::Quotient && l.parts[0].shape == Shape::Number;
    return inverse ? 0 : width(l);
  }

  /// Broken though it may fit by itself: it stands beside others.
  Pieces whole(const Layout& l) const { return Breaker(std::min(line_, width(l) * 0.99)).term(l); }

  static Layout factors(std::vector<Layout> parts) {
    if (parts.size() > 1 || needs_brackets(parts, 0)) return layouts::product(std::move(parts));
    return std::move(parts.front());
  }

  /// (a + b)/c with a wide numerator reads 1/c (a + b); with a wide denominator the two stand on either side of a
  /// slash.
  Pieces quotient(const Layout& above, const Layout& below) const {
    if (fits(below) && above.shape == Shape::Number) {
      Layout whole;
      whole.shape = Shape::Quotient;
      whole.parts = {above, below};
      return {whole};
    }
    if (fits(below)) {
      Layout inverse;
      inverse.shape = Shape::Quotient;
      inverse.parts = {layouts::number("1"), below};
      std::vector<Layout> parts{inverse};
      if (above.shape == Shape::Product)
        parts.insert(parts.end(), above.parts.begin(), above.parts.end());
      else
        parts.push_back(above);
      return product(parts);
    }
    Pieces pieces = needs_brackets_above_slash(above) ? in_brackets(above, {}) : term(above);
    Pieces rest = in_brackets(below, {});
    put_before(rest.front(), {sign("/")});
    pieces.insert(pieces.end(), rest.begin(), rest.end());
    return pieces;
  }

  double line_;
};

bool is_short(const Pieces& side) { return side.size() == 1 && width(side.front()) <= 1.2; }

}  // namespace
}  // namespace print

std::vector<Layout> pieces(const Layout& left, const Layout& right, double line) {
  const print::Breaker breaker(line);
  std::vector<Layout> all = left.empty() ? std::vector<Layout>{} : breaker.formula(left);
  if (right.empty()) return all;
  std::vector<Layout> further = breaker.formula(right);
  if (all.empty()) return further;
  // `= 0` stays with the last term, and so does what follows a short left side; a longer right side begins with its
  // sign.
  const bool together = print::is_short(further) || (all.size() == 1 && width(all.front()) <= line / 6);
  print::put_before(further.front(), {print::sign("=")});
  if (together) {
    const Layout first = further.front();
    print::put_behind(all.back(), first.parts);
    further.erase(further.begin());
  }
  all.insert(all.end(), further.begin(), further.end());
  return all;
}

std::vector<Layout> broken_lines(const Layout& left, const Layout& right, double first, double further) {
  std::vector<Layout> lines;
  double used = 0;
  for (Layout& piece : pieces(left, right, std::min(first, further))) {
    const double more = width(piece);
    const double limit = lines.size() <= 1 ? first : further;
    if (lines.empty() || used + more > limit) {
      lines.push_back(std::move(piece));
      used = more;
    } else {
      used += more;
      print::put_behind(lines.back(), piece.shape == Shape::Row ? piece.parts : std::vector<Layout>{piece});
    }
  }
  return lines;
}

}  // namespace maupertuis
