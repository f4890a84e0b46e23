#include <maupertuis/evaluate.hpp>
#include <maupertuis/fields.hpp>
#include <maupertuis/print.hpp>

#include <fmt/format.h>

/// Waves on a field at rest.
namespace maupertuis {
namespace {

ComplexExpr times(const ComplexExpr& a, const ComplexExpr& b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

/// (−iω)^n (i k)^m … times c
ComplexExpr wave_factor(const FieldEquations& equations, const FieldJet& jet, Expr c) {
  const FieldModel& model = *equations.model;
  Context& context = *model.system.context;
  Expr size = c * pow(model.omega, Rational(jet.time));
  int quarter_turns = 3 * jet.time;  // −i = i³
  for (std::size_t x = 0; x < jet.space.size(); ++x) {
    size = size * pow(model.wave_numbers[x], Rational(jet.space[x]));
    quarter_turns += jet.space[x];
  }
  const Expr zero = context.number(0);
  switch (quarter_turns % 4) {
    case 0:
      return {size, zero};
    case 1:
      return {zero, size};
    case 2:
      return {-size, zero};
    default:
      return {zero, -size};
  }
}

using Rows = std::vector<std::vector<ComplexExpr>>;

ComplexExpr determinant(const Rows& rows, Context& context) {
  if (rows.size() == 1) return rows[0][0];
  ComplexExpr sum{context.number(0), context.number(0)};
  for (std::size_t j = 0; j < rows.size(); ++j) {
    const ComplexExpr& head = rows[0][j];
    if (head.re.is_zero() && head.im.is_zero()) continue;
    Rows minor;
    for (std::size_t i = 1; i < rows.size(); ++i) {
      minor.push_back(rows[i]);
      minor.back().erase(minor.back().begin() + static_cast<std::ptrdiff_t>(j));
    }
    const ComplexExpr part = times(head, determinant(minor, context));
    sum =
        j % 2 == 0 ? ComplexExpr{sum.re + part.re, sum.im + part.im} : ComplexExpr{sum.re - part.re, sum.im - part.im};
  }
  return sum;
}

}  // namespace

std::optional<ComplexExpr> dispersion(const FieldEquations& equations, std::string& trouble) {
  const FieldSystem& s = equations.system();
  Context& context = *s.context;
  ExprMap rest;
  for (const Expr& r : equations.residuals)
    for (const Expr& jet : s.jets_in(r)) rest[jet] = context.number(0);
  Rows rows;
  for (const Expr& residual : equations.residuals) {
    if (zero_test(s.expanded(substitute(residual, rest))).verdict != Verdict::Zero) {
      trouble = "The field at rest, φ = 0, is no solution: waves on it are not free.";
      return std::nullopt;
    }
    const std::vector<Expr> jets = s.jets_in(residual);
    const std::vector<Expr> slopes = gradient(residual, jets);
    rows.emplace_back(equations.varied.size(), ComplexExpr{context.number(0), context.number(0)});
    for (std::size_t i = 0; i < jets.size(); ++i) {
      const FieldJet jet = *s.jet_of(jets[i]);
      if (s.fields[jet.field].given) continue;
      const Expr c = substitute(slopes[i], rest);
      const Expr roots[] = {c};
      for (const Expr& symbol : symbols_of(roots)) {
        bool varies = symbol.role() == Role::Time;
        for (const SpaceVariable& x : s.space) varies = varies || symbol == x.symbol;
        if (!varies) continue;
        trouble = "The coefficients of the linearized equations change in space or time: there are no plane waves.";
        return std::nullopt;
      }
      std::size_t column = 0;
      while (equations.varied[column] != jet.field) ++column;
      const ComplexExpr part = wave_factor(equations, jet, c);
      ComplexExpr& entry = rows.back()[column];
      entry = {entry.re + part.re, entry.im + part.im};
    }
  }
  if (rows.size() > 6) {
    trouble = "More than six fields: their determinant is not written out.";
    return std::nullopt;
  }
  const ComplexExpr relation = determinant(rows, context);
  const Expr parts[] = {s.expanded(relation.re), s.expanded(relation.im)};
  if (zero_test(parts).verdict == Verdict::Zero) {
    trouble = "The equations are not independent: part of the fields is free, a gauge, and goes with any wave.";
    return std::nullopt;
  }
  const auto begins_with_minus = [&](Expr e) {
    return to_plain(field_layout(s, lay_out(readable(e, equations.order), equations.order))).front() == '-';
  };
  const bool turned = begins_with_minus(relation.re.is_zero() ? relation.im : relation.re);
  return turned ? ComplexExpr{-relation.re, -relation.im} : relation;
}

Expr with_imaginary_unit(const ComplexExpr& relation) {
  if (relation.im.is_zero()) return relation.re;
  return relation.re + relation.im * relation.re.context().symbol("i", Role::Auxiliary);
}

}  // namespace maupertuis
