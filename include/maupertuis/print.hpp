#pragma once
#include <maupertuis/expression.hpp>
#include <maupertuis/layout.hpp>
#include <maupertuis/transform.hpp>

#include <string>

namespace maupertuis {

/// Plain text as in the model language, so that it can be read back: `m2 l1 l2 cos(θ1 - θ2) θ2'' + m g l sin θ`.
/// Terms: second derivatives first, then velocities, then forces; factors: number, parameters, functions, coordinates,
/// velocities, accelerations.
std::string to_plain(Expr e, const ReadingOrder& order);
/// The left side of an equation, with the terms of its own coordinate first. So for the other two notations.
std::string to_plain(const ReadableForm& form, const ReadingOrder& order);
/// LaTeX of math mode, without dollars: `m_2\, l_1\, l_2 \cos(\theta_1 - \theta_2)\, \ddot{\theta}_2`.
std::string to_latex(Expr e, const ReadingOrder& order);
std::string to_latex(const ReadableForm& form, const ReadingOrder& order);
/// Presentation MathML: the children of a <math> element (one <mrow>).
std::string to_mathml(Expr e, const ReadingOrder& order);
std::string to_mathml(const ReadableForm& form, const ReadingOrder& order);
/// The DAG, one node a line, `%12 = mul %3 %7`: `--emit`.
std::string to_dag_text(std::span<const Expr> roots);

/// The name of one symbol in each notation, with its primes or dots: θ1'', \ddot{\theta}_1.
std::string symbol_to_plain(Expr symbol);
std::string symbol_to_latex(Expr symbol);

}  // namespace maupertuis
