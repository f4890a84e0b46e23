#include "system/complex_fields.hpp"

#include <maupertuis/field_statements.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>

namespace maupertuis::elaboration {
namespace {

using syntax::Expression;
using syntax::ExpressionPtr;
using syntax::Operator;
using Node = Expression::Kind;

/// A formula by its parts; no imaginary one: it is real.
struct Parts {
  ExpressionPtr re, im;
  int products = 0;  // of complex values, one within the other: each doubles the length
};

ExpressionPtr node(Expression e) {
  for (const ExpressionPtr& a : e.arguments) e.depth = std::max(e.depth, a->depth + 1);
  return std::make_shared<const Expression>(std::move(e));
}
ExpressionPtr number_at(Span span, const char* digits) {
  Expression e;
  e.kind = Node::Number, e.span = span, e.text = digits;
  return node(std::move(e));
}
ExpressionPtr binary_of(Operator op, ExpressionPtr a, ExpressionPtr b, Span span) {
  Expression e;
  e.kind = Node::Binary, e.op = op, e.span = span, e.bracketed = true, e.arguments = {std::move(a), std::move(b)};
  return node(std::move(e));
}
ExpressionPtr negated(ExpressionPtr a) {
  if (!a) return a;
  Expression e;
  e.kind = Node::Unary, e.op = Operator::Negate, e.span = a->span, e.bracketed = true;
  e.arguments = {std::move(a)};
  return node(std::move(e));
}
ExpressionPtr applied(const char* function, ExpressionPtr a) {
  Expression e;
  e.kind = Node::Call, e.span = e.name_span = a->span, e.text = function, e.arguments = {std::move(a)};
  return node(std::move(e));
}

/// Written alike.
bool same(const ExpressionPtr& a, const ExpressionPtr& b) {
  if (a == b) return true;
  if (!a || !b || a->kind != b->kind || a->text != b->text || a->primes != b->primes || a->op != b->op ||
      a->arguments.size() != b->arguments.size() || a->unit.has_value() != b->unit.has_value())
    return false;
  return std::equal(a->arguments.begin(), a->arguments.end(), b->arguments.begin(), same);
}
bool opposite(const ExpressionPtr& a, const ExpressionPtr& b) {
  const auto is = [](const ExpressionPtr& x, const ExpressionPtr& y) {
    return x && x->kind == Node::Unary && x->op == Operator::Negate && same(x->arguments[0], y);
  };
  return a && b && (is(a, b) || is(b, a));
}

class RealFields {
 public:
  RealFields(const syntax::SyntaxTree& tree, Diagnostics& diagnostics) : tree_(tree), diagnostics_(diagnostics) {}

  bool find_fields() {
    for (const syntax::Statement& s : tree_.statements) {
      declares_i_ = declares_i_ || declares(s, "i");
      const auto* f = std::get_if<syntax::FieldStatement>(&s.body);
      const auto* d = f ? std::get_if<syntax::FieldDeclaration>(&f->said->body) : nullptr;
      if (!d) continue;
      for (const auto& item : d->items)
        if (item.kind.text == "complex") fields_.insert(item.name.text);
    }
    return !fields_.empty();
  }

  syntax::SyntaxTree rewritten() {
    find_definitions();
    syntax::SyntaxTree out = tree_;
    out.statements.clear();
    for (const syntax::Statement& s : tree_.statements) {
      const std::size_t before = out.statements.size();
      rewrite(s, out.statements);
      if (out.statements.size() == before && !refused_) out.statements.push_back(s);
      refused_ = false;
    }
    return out;
  }

 private:
  static bool declares(const syntax::Statement& s, const std::string& name) {
    if (const auto* p = std::get_if<syntax::ParamStatement>(&s.body))
      return std::any_of(p->items.begin(), p->items.end(), [&](const auto& i) { return i.name.text == name; });
    if (const auto* l = std::get_if<syntax::LetStatement>(&s.body))
      return std::any_of(l->items.begin(), l->items.end(), [&](const auto& i) { return i.name.text == name; });
    return false;
  }

  /// Definitions whose value is complex, however many steps away from a field or i.
  void find_definitions() {
    quiet_ = true;
    for (bool more = true; more;) {
      more = false;
      known_.clear();
      for (const syntax::Statement& s : tree_.statements) {
        const auto* let = std::get_if<syntax::LetStatement>(&s.body);
        if (!let) continue;
        for (const auto& item : let->items)
          if (!definitions_.count(item.name.text) && parts(item.value).im)
            more = definitions_.insert(item.name.text).second || more;
      }
    }
    known_.clear();
    quiet_ = refused_ = false;
  }

  // ------------------------------------------------------------------------------------------------------- formulas

  /// ψ_x → ψ_r_x, ψ_i_x; a definition z → z_r, z_i. Nothing where the name is real.
  std::optional<Parts> complex_name(const Expression& x) const {
    const std::string& name = x.text;
    const std::size_t cut = name.find('_');
    const std::string head = name.substr(0, cut), tail = cut == std::string::npos ? "" : name.substr(cut);
    const auto named = [&](const std::string& text) {
      Expression e = x;
      e.text = text;
      return node(std::move(e));
    };
    if (fields_.count(head) && tail != "_r" && tail != "_i" && tail.rfind("_r_", 0) != 0 && tail.rfind("_i_", 0) != 0)
      return Parts{named(head + "_r" + tail), named(head + "_i" + tail)};
    if (definitions_.count(name)) return Parts{named(name + "_r"), named(name + "_i")};
    if (name == "i" && !declares_i_ && x.kind == Node::Name && x.primes == 0)
      return Parts{number_at(x.span, "0"), number_at(x.span, "1")};
    return std::nullopt;
  }

  Parts refuse(const Expression& x, const std::string& message, const std::string& help) {
    if (!quiet_)
      diagnostics_.error("E0294", x.span, message, "Formulas with complex fields fall apart into two real ones.", help);
    refused_ = true;
    return {number_at(x.span, "0"), nullptr, 0};
  }

  static ExpressionPtr sum(ExpressionPtr a, ExpressionPtr b, Span span, Operator op = Operator::Add) {
    if (!b) return a;
    if (!a) return op == Operator::Add ? b : negated(b);
    return binary_of(op, a, b, span);
  }
  static bool is_zero(const ExpressionPtr& a) { return !a || (a->kind == Node::Number && a->text == "0"); }
  static bool is_one(const ExpressionPtr& a) { return a && a->kind == Node::Number && a->text == "1"; }
  static ExpressionPtr times(const ExpressionPtr& a, const ExpressionPtr& b, Span span) {
    if (is_zero(a) || is_zero(b)) return nullptr;
    if (is_one(a)) return b;
    if (is_one(b)) return a;
    return binary_of(Operator::Multiply, a, b, span);
  }
  static ExpressionPtr or_zero(ExpressionPtr a, Span span) { return a ? a : number_at(span, "0"); }

  Parts product(const Parts& a, const Parts& b, Span span) {
    if (same(a.re, b.re) && opposite(a.im, b.im)) return {size_squared(a, span), nullptr};  // z conj(z)
    ExpressionPtr re = sum(times(a.re, b.re, span), times(a.im, b.im, span), span, Operator::Subtract);
    ExpressionPtr im = sum(times(a.re, b.im, span), times(a.im, b.re, span), span);
    Parts out{or_zero(re, span), im, std::max(a.products, b.products) + (a.im && b.im ? 1 : 0)};
    constexpr int most = 12;
    if (out.products <= most) return out;
    Expression whole;
    whole.span = span;
    return refuse(whole, "a product of too many complex values", "Write powers of abs(…), or name a part with `let`.");
  }
  static ExpressionPtr squared(const ExpressionPtr& a, Span span) {
    return binary_of(Operator::Power, a, number_at(span, "2"), span);
  }
  static ExpressionPtr size_squared(const Parts& z, Span span) {
    return z.im ? sum(squared(z.re, span), squared(z.im, span), span) : squared(z.re, span);
  }

  Parts quotient(const Parts& a, const Parts& b, Span span) {
    const auto over = [&](const ExpressionPtr& x, const ExpressionPtr& y) {
      return is_zero(x) ? nullptr : binary_of(Operator::Divide, x, y, span);
    };
    if (!b.im) return {or_zero(over(a.re, b.re), span), over(a.im, b.re)};
    const Parts top = product(a, {b.re, negated(b.im)}, span);
    const ExpressionPtr size = size_squared(b, span);
    return {or_zero(over(top.re, size), span), over(top.im, size)};
  }

  Parts power(const ExpressionPtr& x) {
    const ExpressionPtr& base = x->arguments[0];
    const ExpressionPtr& exponent = x->arguments[1];
    if (parts(exponent).im) return refuse(*exponent, "a complex exponent", "Write exp(…) for it.");
    const bool whole = exponent->kind == Node::Number && exponent->text.size() == 1;
    const int n = whole ? exponent->text[0] - '0' : 0;
    // abs(ψ)^2 is a polynomial
    if (base->kind == Node::Call && base->text == "abs" && whole && n % 2 == 0 && n > 0) {
      const Parts inside = parts(base->arguments[0]);
      if (inside.im) {
        const ExpressionPtr square = size_squared(inside, x->span);
        if (n == 2) return {square, nullptr};
        return {binary_of(Operator::Power, square,
                          number_at(x->span, n == 4   ? "2"
                                             : n == 6 ? "3"
                                                      : "4"),
                          x->span),
                nullptr};
      }
    }
    const Parts z = parts(base);
    if (!z.im) return componentwise(x);
    if (n < 1) return refuse(*x, "a power of a complex value that is no whole number", "Write whole powers alone.");
    Parts out = z;
    for (int k = 1; k < n; ++k) out = product(out, z, x->span);
    return out;
  }

  Parts call(const ExpressionPtr& x) {
    if (const auto field = complex_name(*x)) return *field;  // ψ(1)
    if (x->arguments.size() != 1) return componentwise(x);
    const Parts z = parts(x->arguments[0]);
    if (x->text == "conj") return {z.re, negated(z.im), z.products};
    if (x->text == "re") return {z.re, nullptr};
    if (x->text == "im") return {or_zero(z.im, x->span), nullptr};
    if (!z.im) return componentwise(x);
    if (x->text == "abs") return {applied("sqrt", size_squared(z, x->span)), nullptr};
    if (x->text == "exp") {
      const ExpressionPtr size = is_zero(z.re) ? number_at(x->span, "1") : applied("exp", z.re);
      return {times(size, applied("cos", z.im), x->span), times(size, applied("sin", z.im), x->span)};
    }
    return refuse(*x, fmt::format("`{}` of a complex value", x->text), "Write it with exp, conj, re, im and abs.");
  }

  /// A node whose operands are real, or whose parts are those of its operands: sums, minus signs, (…)'.
  Parts componentwise(const ExpressionPtr& x, bool linear = false) {
    Expression re = *x, im = *x;
    bool complex = false;
    int products = 0;
    for (std::size_t k = 0; k < x->arguments.size(); ++k) {
      const Parts p = parts(x->arguments[k]);
      if (p.im && !linear)
        return refuse(*x->arguments[k], "a complex value stands where a real one is asked for",
                      "Take its real part, re(…), its imaginary part, im(…), or its size, abs(…).");
      re.arguments[k] = p.re;
      im.arguments[k] = or_zero(p.im, x->span);
      complex = complex || p.im;
      products = std::max(products, p.products);
    }
    return {node(std::move(re)), complex ? node(std::move(im)) : nullptr, products};
  }

  /// Each formula once, whatever asks for it.
  Parts parts(const ExpressionPtr& x) {
    if (const auto known = known_.find(x.get()); known != known_.end()) return known->second;
    const Parts found = found_parts(x);
    known_.emplace(x.get(), found);
    return found;
  }
  Parts found_parts(const ExpressionPtr& x) {
    switch (x->kind) {
      case Node::Number:
      case Node::Quantity:
        return {x, nullptr};
      case Node::Name:
        if (const auto name = complex_name(*x)) return *name;
        return {x, nullptr};
      case Node::Call:
        return call(x);
      case Node::Unary:
      case Node::TimeDerivative:
        return componentwise(x, true);
      case Node::Member:
      case Node::Vector:
      case Node::Piecewise:
        return componentwise(x);
      case Node::Binary:
        break;
    }
    if (x->op == Operator::Power) return power(x);
    if (x->op == Operator::Add || x->op == Operator::Subtract) {
      const Parts a = parts(x->arguments[0]), b = parts(x->arguments[1]);
      if (!a.im && !b.im) return componentwise(x);
      return {binary_of(x->op, a.re, b.re, x->span), sum(a.im, b.im, x->span, x->op), std::max(a.products, b.products)};
    }
    const bool product_sign = x->op == Operator::Multiply || x->op == Operator::Juxtapose;
    if (!product_sign && x->op != Operator::Divide) return componentwise(x);
    const Parts a = parts(x->arguments[0]), b = parts(x->arguments[1]);
    if (!a.im && !b.im) return componentwise(x);
    return product_sign ? product(a, b, x->span) : quotient(a, b, x->span);
  }

  ExpressionPtr real(const ExpressionPtr& x) {
    if (!x) return x;
    const Parts p = parts(x);
    if (p.im)
      refuse(*x, "a complex value stands where a real one is asked for",
             "Take its real part, re(…), its imaginary part, im(…), or its size, abs(…).");
    return p.re;
  }

  std::vector<syntax::Equation> equations(const std::vector<syntax::Equation>& all) {
    std::vector<syntax::Equation> out;
    for (const syntax::Equation& one : all) {
      const Parts a = parts(one.left), b = parts(one.right);
      out.push_back({a.re, b.re});
      if (a.im || b.im) out.push_back({or_zero(a.im, one.left->span), or_zero(b.im, one.right->span)});
    }
    return out;
  }

  // ----------------------------------------------------------------------------------------------------- statements

  void rewrite(const syntax::Statement& s, std::vector<syntax::Statement>& out) {
    if (const auto* f = std::get_if<syntax::FieldStatement>(&s.body)) {
      syntax::FieldClause said =
          std::visit([&](const auto& clause) { return syntax::FieldClause{clause_of(clause)}; }, f->said->body);
      out.push_back(
          {syntax::FieldStatement{f->what, std::make_shared<const syntax::FieldClause>(std::move(said))}, s.span});
    } else if (const auto* let = std::get_if<syntax::LetStatement>(&s.body)) {
      syntax::LetStatement real_ones;
      for (const auto& item : let->items) {
        const Parts p = parts(item.value);
        if (!definitions_.count(item.name.text)) {
          real_ones.items.push_back({item.name, p.re});
          continue;
        }
        real_ones.items.push_back({{item.name.text + "_r", item.name.span}, p.re});
        real_ones.items.push_back({{item.name.text + "_i", item.name.span}, or_zero(p.im, item.value->span)});
      }
      out.push_back({std::move(real_ones), s.span});
    } else if (const auto* start = std::get_if<syntax::StartStatement>(&s.body)) {
      syntax::StartStatement both = *start;
      both.items.clear();
      for (const auto& item : start->items) {
        const Parts a = parts(item.variable), b = parts(item.value);
        both.items.push_back({a.re, b.re});
        if (a.im) both.items.push_back({a.im, or_zero(b.im, item.value->span)});
      }
      out.push_back({std::move(both), s.span});
    } else if (const auto* expected = std::get_if<syntax::ExpectStatement>(&s.body)) {
      expect(*expected, s.span, out);
    }
  }

  syntax::FieldDeclaration clause_of(const syntax::FieldDeclaration& d) {
    syntax::FieldDeclaration out = d;
    out.items.clear();
    for (const auto& item : d.items) {
      if (item.kind.text != "complex") {
        out.items.push_back(item);
        continue;
      }
      for (const char* part : {"_r", "_i"}) {
        out.items.push_back(item);
        out.items.back().name.text += part;
      }
    }
    out.boundary = equations(d.boundary);
    return out;
  }
  syntax::DensityText clause_of(const syntax::DensityText& d) {
    syntax::DensityText out = d;
    const Parts p = parts(d.value);
    out.value = p.re, out.imaginary = p.im;
    return out;
  }
  syntax::BoundaryText clause_of(const syntax::BoundaryText& b) { return {b.side, equations(b.conditions)}; }
  syntax::FieldForce clause_of(const syntax::FieldForce& f) { return {real(f.on), real(f.value)}; }

  void expect(const syntax::ExpectStatement& s, Span span, std::vector<syntax::Statement>& out) {
    namespace ex = syntax::expectation;
    const auto push = [&](ex::Kind kind) {
      if (!refused_) out.push_back({syntax::ExpectStatement{s.claim, std::move(kind), s.with}, span});
    };
    if (const auto* e = std::get_if<ex::Equation>(&s.kind)) {
      for (const syntax::Equation& one : equations({*e})) push(one);
    } else if (const auto* v = std::get_if<ex::ValueAt>(&s.kind)) {
      push(ex::ValueAt{real(v->subject), v->time, {real(v->expected.value), v->expected.tolerance}});
    } else if (const auto* at_rest = std::get_if<ex::Equilibrium>(&s.kind)) {
      ex::Equilibrium both{{}, at_rest->word};
      for (const ex::Place& place : at_rest->at) {
        const Parts a = parts(place.value.variable), b = parts(place.value.value);
        both.at.push_back({{a.re, b.re}, place.tolerance});
        if (a.im) both.at.push_back({{a.im, or_zero(b.im, place.value.value->span)}, place.tolerance});
      }
      push(std::move(both));
    } else if (const auto* f = std::get_if<ex::OfField>(&s.kind)) {
      using said = syntax::FieldExpectation;
      const auto of = [&](auto body) { push(ex::OfField{std::make_shared<const said>(said{std::move(body)})}); };
      if (const auto* n = std::get_if<said::Natural>(&f->said->body))
        of(said::Natural{equations(n->conditions)});
      else if (const auto* x = std::get_if<said::Solution>(&f->said->body))
        of(said::Solution{equations(x->fields)});
      else if (const auto* t = std::get_if<said::Total>(&f->said->body))
        of(said::Total{real(t->density), t->time, {real(t->expected.value), t->expected.tolerance}, t->at_equilibrium});
      else if (const auto* c = std::get_if<said::Current>(&f->said->body)) {
        said::Current current{real(c->density), {}};
        for (const ExpressionPtr& flux : c->fluxes) current.fluxes.push_back(real(flux));
        of(std::move(current));
      } else if (const auto* w = std::get_if<said::Frequencies>(&f->said->body); w && fields_.count(w->field.text)) {
        said::Frequencies of_part = *w;  // those of both parts together
        of_part.field.text += "_r";
        of(std::move(of_part));
      } else
        push(s.kind);
    } else {
      push(s.kind);
    }
  }

  const syntax::SyntaxTree& tree_;
  Diagnostics& diagnostics_;
  std::set<std::string> fields_, definitions_;
  std::unordered_map<const Expression*, Parts> known_;  // of the tree's own nodes
  bool declares_i_ = false;
  bool quiet_ = false;    // while definitions are looked for
  bool refused_ = false;  // the statement at hand: it is left out
};

}  // namespace

std::optional<syntax::SyntaxTree> in_real_fields(const syntax::SyntaxTree& tree, Diagnostics& diagnostics) {
  RealFields fields(tree, diagnostics);
  return fields.find_fields() ? std::optional(fields.rewritten()) : std::nullopt;
}

}  // namespace maupertuis::elaboration
