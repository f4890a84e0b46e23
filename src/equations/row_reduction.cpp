#include "equations/row_reduction.hpp"

#include "linear_algebra/dense.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {
namespace {

constexpr double preferred = 0.05;  // a constant pivot may be that much smaller than the largest

bool is_constant(Expr e) {
  const std::vector<Expr> symbols = symbols_of({&e, 1});
  return std::none_of(symbols.begin(), symbols.end(),
                      [](Expr s) { return s.role() == Role::Coordinate || s.role() == Role::Time; });
}

void clear_zeros(ExprMatrix& m) {
  for (Expr& e : m.entries)
    if (!e.is_number() && zero_test(e).verdict == Verdict::Zero) e = e.context().number(Rational(0));
}

}  // namespace

std::size_t numerical_rank(const Eigen::MatrixXd& m) {
  if (m.size() == 0) return 0;
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(m).singularValues();
  const double largest = values[0];
  return static_cast<std::size_t>(std::count_if(values.data(), values.data() + values.size(),
                                                [&](double s) { return s > rank_tolerance * largest; }));
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& m, const Eigen::VectorXd& b) {
  return m.colPivHouseholderQr().solve(b);
}

std::vector<std::size_t> independent_rows(const Eigen::MatrixXd& m) {
  std::vector<std::size_t> chosen;
  Eigen::MatrixXd basis(0, m.cols());
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    Eigen::MatrixXd trial(basis.rows() + 1, m.cols());
    trial << basis, m.row(i);
    if (m.row(i).norm() == 0 || numerical_rank(trial) < static_cast<std::size_t>(trial.rows())) continue;
    basis = std::move(trial);
    chosen.push_back(static_cast<std::size_t>(i));
  }
  return chosen;
}

std::vector<std::pair<std::size_t, std::size_t>> reduce_rows(ExprMatrix& m, std::size_t columns, std::size_t count,
                                                             const Bindings& point) {
  std::vector<std::pair<std::size_t, std::size_t>> pivots;
  std::vector<bool> used(m.rows, false);
  while (pivots.size() < count) {
    const std::vector<double> values = evaluate(m.entries, point);
    std::size_t row = m.rows, column = 0;
    double best = 0;
    for (std::size_t i = 0; i < m.rows; ++i)
      for (std::size_t j = 0; j < columns && !used[i]; ++j) {
        if (m.at(i, j).is_zero()) continue;
        const double size = std::abs(values[i * m.columns + j]) * (is_constant(m.at(i, j)) ? 1 / preferred : 1);
        if (size > best) best = size, row = i, column = j;
      }
    if (row == m.rows) break;
    used[row] = true;
    pivots.emplace_back(row, column);
    const Expr pivot = m.at(row, column);
    for (std::size_t j = 0; j < m.columns; ++j) m.at(row, j) = m.at(row, j) / pivot;
    for (std::size_t i = 0; i < m.rows; ++i) {
      const Expr factor = m.at(i, column);
      if (i == row || factor.is_zero()) continue;
      for (std::size_t j = 0; j < m.columns; ++j) m.at(i, j) = m.at(i, j) - factor * m.at(row, j);
    }
    clear_zeros(m);
  }
  return pivots;
}

}  // namespace maupertuis
