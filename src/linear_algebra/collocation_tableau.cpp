#include "linear_algebra/collocation_tableau.hpp"

#include "linear_algebra/banded.hpp"
#include "linear_algebra/dense.hpp"
#include "linear_algebra/quadrature.hpp"

namespace maupertuis {

CollocationTableau::CollocationTableau(int count, Points points)
    : stages(static_cast<std::size_t>(count)), order(points == Points::Gauss ? 2 * count : 2 * count - 1) {
  const GaussRule rule(count);
  const Radau radau(count);  // with the left end
  const std::size_t s = stages;
  c.resize(s), b.resize(s), a.assign(s * s, 0), continuation.assign(s * s, 0), d.assign(s, 0);
  for (std::size_t i = 0; i < s; ++i)
    c[i] = points == Points::Gauss ? (1 + rule.x[i]) / 2 : (1 - radau.x[s - 1 - i]) / 2,
    b[i] = (points == Points::Gauss ? rule.w[i] : radau.w[s - 1 - i]) / 2;
  const auto lagrange = [&](std::size_t j, double x) {
    double product = 1;
    for (std::size_t k = 0; k < s; ++k)
      if (k != j) product *= (x - c[k]) / (c[j] - c[k]);
    return product;
  };
  Eigen::MatrixXd matrix(count, count);
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j < s; ++j) {
      for (std::size_t m = 0; m < s; ++m)  // ∫_0^c_i ℓ_j
        a[i * s + j] += c[i] * rule.w[m] / 2 * lagrange(j, c[i] * (1 + rule.x[m]) / 2);
      continuation[i * s + j] = lagrange(j, 1 + c[i]);
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = a[i * s + j];
    }
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(Eigen::MatrixXd(matrix.transpose()));
  Eigen::VectorXd weights(count);
  for (std::size_t i = 0; i < s; ++i) weights(static_cast<Eigen::Index>(i)) = b[i];
  const Eigen::VectorXd solved = lu.solve(weights);
  for (std::size_t i = 0; i < s; ++i) d[i] = solved(static_cast<Eigen::Index>(i));
  Eigen::EigenSolver<Eigen::MatrixXd> solver;
  solver.compute(matrix, true);
  BandedMatrix<std::complex<double>> columns(s, s, s);
  const auto vectors = solver.eigenvectors();
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t k = 0; k < s; ++k)
      columns.at(i, k) = vectors(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
  basis.resize(s * s), inverse.resize(s * s), lambda.resize(s);
  for (std::size_t i = 0; i < s; ++i) {
    lambda[i] = solver.eigenvalues()(static_cast<Eigen::Index>(i));
    for (std::size_t k = 0; k < s; ++k) basis[i * s + k] = columns.at(i, k);
  }
  columns.factor();
  for (std::size_t j = 0; j < s; ++j) {
    std::vector<std::complex<double>> unit(s, 0);
    unit[j] = 1;
    columns.solve(unit.data());
    for (std::size_t i = 0; i < s; ++i) inverse[i * s + j] = unit[i];
  }
}

}  // namespace maupertuis
