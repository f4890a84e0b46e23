// Systems of sizes at which anything that grows with the square of the coordinates, or faster, is seen: by its counts,
// or because it would not come back.
#include "../model_text.hpp"
#include "equations/row_reduction.hpp"
#include "equations/sparse_rows.hpp"
#include "equations/sparse_step.hpp"

#include <maupertuis/constraint_analysis.hpp>
#include <maupertuis/couplings.hpp>
#include <maupertuis/jacobian.hpp>

#include <eigen3/Eigen/LU>

#include <algorithm>
#include <random>

using namespace maupertuis;

namespace {

std::string list(int first, int last, const std::string& name) {
  std::string out;
  for (int i = first; i <= last; ++i)
    out += (i == first ? "" : i % 8 == 0 ? ",\n    " : ", ") + name + std::to_string(i);
  return out;
}

std::string pendulum_chain(int links) {
  std::string text = "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord " + list(1, links, "θ") + " : angle\n";
  for (int i = 1; i <= links; ++i) {
    const std::string n = std::to_string(i), before = i == 1 ? "" : "P" + std::to_string(i - 1) + " + ";
    text += "point P" + n + " mass m at " + before + "l (sin θ" + n + ", -cos θ" + n + ")\n";
  }
  return text + "gravity (0, -g)\n";
}

std::string chain_of_rods(int links) {
  std::string text = "param m = 1 kg, l = 1 m, g = 9.81 m/s^2\ncoord " + list(1, links, "x") + ", " +
                     list(1, links, "y") + " : length\n";
  for (int i = 1; i <= links; ++i) {
    const std::string n = std::to_string(i), p = std::to_string(i - 1);
    text += "point P" + n + " mass m at (x" + n + ", y" + n + ")\n";
    const std::string dx = i == 1 ? "x1" : "(x" + n + " - x" + p + ")",
                      dy = i == 1 ? "y1" : "(y" + n + " - y" + p + ")";
    text += "constraint " + dx + "^2 + " + dy + "^2 = l^2 name rod" + n + "\n";
  }
  return text + "gravity (0, -g)\n";
}

std::string chain_of_equalities(int count, const std::string& more) {
  std::string text = "param m = 1 kg\ncoord " + list(0, count, "x") + " : length\n";
  for (int i = 0; i <= count; ++i)
    text += "point P" + std::to_string(i) + " mass m at (x" + std::to_string(i) + ", 0)\n";
  for (int i = 1; i <= count; ++i) text += "constraint x" + std::to_string(i) + " = x" + std::to_string(i - 1) + "\n";
  return text + more;
}

Eigen::MatrixXd dense(const SparseRows& a) {
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(a.rows.size()), static_cast<Eigen::Index>(a.columns));
  for (std::size_t i = 0; i < a.rows.size(); ++i)
    for (const auto& [column, value] : a.rows[i])
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(column)) = value;
  return out;
}

}  // namespace

TEST_CASE("ranks and dependent rows by sparse elimination are those by singular values") {
  std::mt19937_64 random(7);
  const auto unit = [&] { return std::generate_canonical<double, 53>(random) * 2 - 1; };
  for (int trial = 0; trial < 40; ++trial) {
    SparseRows a{20, {}};
    for (int i = 0; i < 14; ++i) {
      SparseRows::Row row;
      for (std::size_t j = 0; j < a.columns; ++j)
        if (unit() > 0.6) row.emplace_back(j, unit());
      a.rows.push_back(row);
    }
    // Two rows that are combinations, and one that is empty.
    for (const auto& [first, second] : {std::pair{2, 5}, std::pair{0, 9}}) {
      Eigen::RowVectorXd sum = 2 * dense(a).row(first) - 0.5 * dense(a).row(second);
      SparseRows::Row row;
      for (Eigen::Index j = 0; j < sum.size(); ++j)
        if (sum[j] != 0) row.emplace_back(static_cast<std::size_t>(j), sum[j]);
      a.rows.push_back(row);
    }
    a.rows.emplace_back();
    const RowDependence found = dependence_of(a);
    const Eigen::MatrixXd full = dense(a);
    CHECK(found.independent.size() == numerical_rank(full));
    CHECK(found.independent.size() + found.dependent.size() == a.rows.size());
    for (const DependentRow& d : found.dependent) {
      Eigen::RowVectorXd rest = full.row(static_cast<Eigen::Index>(d.row));
      for (const auto& [k, weight] : d.combination) {
        CHECK(k < d.row);
        rest -= weight * full.row(static_cast<Eigen::Index>(k));
      }
      CHECK(rest.norm() < 1e-9);
    }
  }
}

TEST_CASE("the sparse step onto the constraints is the least one in the metric of M") {
  const std::size_t n = 6;
  std::mt19937_64 random(11);
  const auto unit = [&] { return std::generate_canonical<double, 53>(random) * 2 - 1; };
  Eigen::MatrixXd root(6, 6), a = Eigen::MatrixXd::Zero(2, 6);
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < 6; ++j) root(i, j) = unit();
  const Eigen::MatrixXd mass = root * root.transpose() + Eigen::MatrixXd::Identity(6, 6);
  std::vector<MatrixEntry> entries, of_mass;
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = i; j < n; j += 2) {
      a(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = unit();
      entries.push_back({i, j, a(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j))});
    }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      of_mass.push_back({i, j, mass(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j))});
  SparseStep step(n, {0, 1, 2, 3, 4, 5});
  const Eigen::VectorXd weight = step.set_rows(entries, {0, 1});
  step.set_metric(of_mass);
  const Eigen::VectorXd error = Eigen::Vector2d(0.3, -0.7);
  const Eigen::VectorXd found = step.solve(error.cwiseProduct(weight));
  const Eigen::MatrixXd inverse = mass.inverse();
  const Eigen::MatrixXd between = a * inverse * a.transpose();
  const Eigen::VectorXd expected = -inverse * a.transpose() * between.inverse() * error;
  CHECK((found - expected).norm() < 1e-9 * expected.norm());
}

TEST_CASE("a thousand rods: the constraints are counted") {
  const ModelText m(chain_of_rods(1000));
  const ConstraintAnalysis analysis = analyse_constraints(m.equations);
  CHECK(analysis.rank == 1000);
  CHECK(analysis.configuration_freedoms == 1000);
  CHECK_FALSE(analysis.redundant());
}

TEST_CASE("a redundant one among hundreds of chained constraints is found with all that it follows from") {
  const ModelText m(chain_of_equalities(400, "constraint x400 = x0 name closing\n"));
  const ConstraintAnalysis analysis = analyse_constraints(m.equations);
  CHECK(analysis.rank == 400);
  CHECK(analysis.constraints.back().redundant);
  CHECK(analysis.constraints.back().depends_on.size() == 400);
  CHECK(analysis.undetermined.size() == 401);
}

TEST_CASE("a long chain of pendulums is written by shared parts, a few for each link, and they mean the same") {
  const std::size_t links = 1200;
  const ModelText m(pendulum_chain(links));
  REQUIRE(couples_too_much_to_read(m.equations));
  const Derivation d = readable_derivation(m.equations, false);
  CHECK(d.intermediates.size() <= 8 * links);
  ExprVector written;
  for (const ReadableForm& row : d.equations) written.push_back(row.value);
  for (const Intermediate& i : d.intermediates) written.push_back(i.value);
  CHECK(topological_order(written).size() <= 40 * links);
  ExprMap meaning;
  for (const Intermediate& i : d.intermediates) meaning[i.symbol] = substitute(i.value, meaning);
  ExprVector differences;
  for (std::size_t i = 0; i < links; ++i)
    differences.push_back(substitute(d.equations[i].value, meaning) - m.equations.residual[i]);
  CHECK(zero_test(differences).verdict == Verdict::Zero);
}

TEST_CASE("what is conserved of a long chain is told without a test of every force by itself") {
  const ModelText m(pendulum_chain(800));
  const ConservedQuantities conserved = conserved_quantities(m.equations);
  CHECK(conserved.cyclic.empty());
  CHECK(conserved.energy_conserved);
}

TEST_CASE("short chains and large systems with few couplings are not written by shared parts") {
  CHECK_FALSE(couples_too_much_to_read(ModelText(pendulum_chain(20)).equations));
  CHECK_FALSE(couples_too_much_to_read(ModelText(chain_of_rods(200)).equations));
}

TEST_CASE("the sparse gradient is the gradient without its zeros") {
  const ModelText m(pendulum_chain(5));
  ExprVector symbols;
  for (const Coordinate& c : m.system->coordinates) symbols.insert(symbols.end(), {c.q, c.velocity});
  for (const Expr& e : m.equations.momenta) {
    ExprVector full(symbols.size(), m.system->context->number(0));
    for (const auto& [column, value] : SparseGradient(symbols)(e)) full[column] = value;
    CHECK(full == gradient(e, symbols));
  }
}
