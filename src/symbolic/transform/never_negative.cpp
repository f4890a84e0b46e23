#include <maupertuis/transform.hpp>

#include <unordered_set>

namespace maupertuis {
namespace {

class NeverNegative {
 public:
  bool operator()(Expr e) {
    if (known_.count(e) > 0) return true;
    const bool is = by_form(e);
    if (is) known_.insert(e);
    return is;
  }

 private:
  bool by_form(Expr e) {
    if (e.is_number()) return e.number().sign() >= 0;
    if (e.is(Kind::Sum) || e.is(Kind::Product)) {
      for (std::size_t i = 0; i < e.size(); ++i)
        if (!(*this)(e[i])) return false;
      return true;
    }
    if (e.is(Kind::Power)) {
      const Rational* exponent = e[1].number_or_null();
      const auto parts = exponent ? exponent->small() : std::nullopt;
      return (*this)(e[0]) || (parts && (parts->numerator % 2 == 0 || parts->denominator % 2 == 0));
    }
    return e.is(Kind::Pi) || e.is(Kind::Abs) || e.is(Kind::Exp) || e.is(Kind::Cosh);
  }

  std::unordered_set<Expr, ExprHash> known_;
};

}  // namespace

bool is_never_negative(Expr e) { return NeverNegative()(e); }

}  // namespace maupertuis
