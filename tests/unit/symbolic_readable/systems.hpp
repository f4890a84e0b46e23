#pragma once
#include <maupertuis/print.hpp>
#include <maupertuis/transform.hpp>

#include <string>
#include <vector>

namespace maupertuis::test {

/// A Lagrangian system put together by hand, for the tests of the readable form.
struct Lagrangian {
  Context context;
  ReadingOrder order;
  Expr value;  // L

  Expr parameter(const std::string& name) {
    const Expr p = context.symbol(name, Role::Parameter);
    order.parameters.push_back(p);
    return p;
  }
  Expr coordinate(const std::string& name) {
    const Expr q = context.symbol(name, Role::Coordinate);
    order.coordinates.push_back(q);
    return q;
  }
  Expr number(const Rational& v) { return context.number(v); }

  /// ½ m (d/dt r)² of a particle.
  Expr kinetic(Expr mass, std::initializer_list<Expr> position) {
    Expr square = number(0);
    for (const Expr& x : position) square = square + pow(context.time_derivative(x), Rational(2));
    return Rational(1, 2) * mass * square;
  }

  Expr dot(Expr e) { return context.time_derivative(e); }
  std::string text(Expr e) { return to_plain(readable(e, order).value, order); }

  std::vector<Expr> residuals() { return variational_residual(value, order.coordinates); }
  std::vector<ReadableForm> forms() { return readable_equations(residuals(), order); }
  std::vector<std::string> equations() {
    std::vector<std::string> lines;
    for (const ReadableForm& form : forms()) lines.push_back(to_plain(form, order));
    return lines;
  }
};

inline Expr square(Expr e) { return pow(e, Rational(2)); }

}  // namespace maupertuis::test
