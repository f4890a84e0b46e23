#include "analysis/action/discrete.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis::action {

const Rule& element_rule(const Rule& rule, Pace pace, std::size_t element, std::size_t elements) {
  if (element == 0 && (pace == Pace::SlowStart || pace == Pace::SlowEnds)) return *rule.flat_begin;
  if (element + 1 == elements && (pace == Pace::SlowEnd || pace == Pace::SlowEnds)) return *rule.flat_end;
  return rule;
}

double Mesh::time(Index k) const {
  const Index e = std::min(k / rule->degree, elements() - 1), j = k - e * rule->degree;
  return k + 1 == elements() * rule->degree + 1 ? t(1) : t(parameter(e, rule->nodes[j]));
}

Mesh even_mesh(std::shared_ptr<const Rule> rule, double start, double end, Index elements, bool closed, Pace pace) {
  Mesh out{std::move(rule), start, end - start, pace, closed, {}, {}};
  for (Index e = 0; e < elements; ++e) {
    const double from = static_cast<double>(e) / static_cast<double>(elements);
    out.begins.push_back(from);
    out.lengths.push_back(static_cast<double>(e + 1) / static_cast<double>(elements) - from);
  }
  return out;
}

Mesh mesh_with_breaks(std::shared_ptr<const Rule> rule, double start, double end, Index elements,
                      const std::vector<double>& inner) {
  if (inner.empty()) return even_mesh(std::move(rule), start, end, elements);
  Mesh out{std::move(rule), start, end - start, Pace::Even, false, {}, {}};
  double from = 0;
  for (std::size_t k = 0; k <= inner.size(); ++k) {
    const double to = k < inner.size() ? (inner[k] - start) / out.whole : 1, length = to - from;
    const auto parts = std::max<Index>(1, std::lround(length * static_cast<double>(elements)));
    for (Index part = 0; part < parts; ++part) {
      out.begins.push_back(from + length * static_cast<double>(part) / static_cast<double>(parts));
      out.lengths.push_back(length / static_cast<double>(parts));
    }
    from = to;
  }
  return out;
}

Place place_of(const Mesh& mesh, Index e, Index g) {
  const Rule& rule = mesh.rule_of(e);
  const double s = mesh.parameter(e, rule.points[g]), rate = mesh.rate(s),
               h = mesh.lengths[static_cast<std::size_t>(e)];
  return {mesh.t(s), h / 2 * rule.weights[g] * rate, rule.value.row(g).transpose(),
          rule.slope.row(g).transpose() * (2 / (h * rate))};
}

Matrix Trial::element(Index e) const {
  const Index p = mesh.rule->degree;
  Matrix out(q.rows(), p + 1);
  for (Index j = 0; j <= p; ++j) {
    out.col(j) = q.col(mesh.node(e, j));
    if (mesh.wraps(e, j)) out.col(j) += advance;
  }
  return out;
}

Trial halved(const Trial& from, const std::vector<bool>& which) {
  const Rule& rule = *from.mesh.rule;
  const Index p = rule.degree;
  Trial out{from.mesh, {}, from.multipliers, from.advance};
  out.mesh.begins.clear();
  out.mesh.lengths.clear();
  std::vector<Matrix> pieces;
  for (Index e = 0; e < from.mesh.elements(); ++e) {
    const auto at = static_cast<std::size_t>(e);
    const double begin = from.mesh.begins[at], length = from.mesh.lengths[at];
    const Matrix values = from.element(e);
    const int parts = which[at] ? 2 : 1;
    for (int part = 0; part < parts; ++part) {
      out.mesh.begins.push_back(begin + part * length / parts);
      out.mesh.lengths.push_back(length / parts);
      if (parts == 1) {
        pieces.push_back(values);
        continue;
      }
      Matrix piece(values.rows(), p + 1);
      for (Index j = 0; j <= p; ++j)
        piece.col(j) = values * from.mesh.rule_of(e).value_at(rule.nodes[j] / 2 + (part == 0 ? -0.5 : 0.5));
      if (part == 0)
        piece.col(0) = values.col(0);
      else
        piece.col(p) = values.col(p);
      pieces.push_back(std::move(piece));
    }
  }
  out.q.resize(from.q.rows(), out.mesh.nodes());
  for (Index e = 0; e < out.mesh.elements(); ++e)
    for (Index j = 0; j <= p; ++j)
      if (!out.mesh.wraps(e, j)) out.q.col(out.mesh.node(e, j)) = pieces[static_cast<std::size_t>(e)].col(j);
  return out;
}

ActionPath to_path(const Trial& trial) {
  ActionPath out;
  out.rule = trial.mesh.rule;
  out.degree = static_cast<std::size_t>(trial.mesh.rule->degree);
  out.coordinates = static_cast<std::size_t>(trial.q.rows());
  out.start = trial.mesh.start;
  out.end = trial.mesh.t(1);
  out.pace = trial.mesh.pace;
  out.breaks = trial.mesh.begins;
  out.breaks.push_back(1);
  for (Index e = 0; e < trial.mesh.elements(); ++e) {
    const Matrix values = trial.element(e);
    out.nodes.insert(out.nodes.end(), values.data(), values.data() + values.size());
  }
  return out;
}

namespace {

/// |M_ii| on the diagonal, where M itself is no norm.
Vector norm_of(const Matrix& mass) {
  const Vector sizes = mass.diagonal().cwiseAbs();
  return sizes.cwiseMax(1e-12 * sizes.maxCoeff());
}

/// Σ over points of the products of weights of two nodes times blocks [n × n]: all points of an element at once, as one
/// product of matrices.
class BlockSum {
 public:
  BlockSum(Index n, Index nodes, Index terms)
      : n_(n), nodes_(nodes), blocks_(n * n, terms), pairs_(terms, nodes * nodes) {}

  void add(const Matrix& block, const Vector& a, const Vector& b, double weight) {
    blocks_.col(next_) = block.reshaped();
    pairs_.row(next_++) = (weight * a * b.transpose()).reshaped().transpose();
  }
  Matrix total() const {
    const Matrix all = blocks_ * pairs_;
    Matrix out(n_ * nodes_, n_ * nodes_);
    for (Index l = 0; l < nodes_; ++l)
      for (Index j = 0; j < nodes_; ++j) out.block(j * n_, l * n_, n_, n_) = all.col(j + nodes_ * l).reshaped(n_, n_);
    return out;
  }

 private:
  Index n_, nodes_, next_ = 0;
  Matrix blocks_, pairs_;
};

struct Assembler {
  Functional& functional;
  const Trial& trial;
  int order;
  Assembly out;
  Density density;
  ExactSum action{};

  void element(Index e) {
    const Rule& rule = *trial.mesh.rule;
    const Matrix nodes = trial.element(e);
    const Vector anchor = nodes.col(trial.mesh.rule_of(e).anchor);
    const Matrix apart = nodes.colwise() - anchor;  // so that a path far from 0 has slopes as exact as one near it
    const Index n = nodes.rows(), count = order == 2 ? rule.points.size() : 0;
    BlockSum hessian(n, rule.degree + 1, 4 * count), kinetic(n, rule.degree + 1, count),
        displacement(n, rule.degree + 1, count);
    for (Index g = 0; g < rule.points.size(); ++g) {
      const auto [t, w, phi, dphi] = place_of(trial.mesh, e, g);
      const Vector q = anchor + apart * phi, v = apart * dphi;
      functional.evaluate(t, q.data(), v.data(), trial.multipliers, order, density);
      out.finite = out.finite && density.finite;
      if (!out.finite) return;
      action.add(w * density.lagrangian);
      out.integrals += w * density.integrals;
      if (order > 0) add_gradient(e, phi, dphi, w);
      if (order == 2) add_hessian(hessian, kinetic, displacement, phi, dphi, w);
    }
    const bool second = order == 2;
    Matrix bordered = second ? hessian.total() : Matrix();
    for (std::size_t k = 0; k < functional.orders().momenta.size(); ++k) join_at_nodes(e, k, nodes, bordered);
    if (!second) return;
    out.hessians.push_back(std::move(bordered));
    out.kinetic.push_back(kinetic.total());
    out.displacement.push_back(displacement.total());
  }

  /// −p v of L* = L + p (q' − v), summed at the nodes and not at Gauss's points: then q' = v holds at each of them, and
  /// no p that changes from node to node is all but unseen.
  void join_at_nodes(Index e, std::size_t k, const Matrix& nodes, Matrix& hessian) {
    const OrderOfCoordinates& orders = functional.orders();
    const Index v = orders.rates_of_others[k], p = orders.momenta[k], n = nodes.rows();
    const Matrix more =
        trial.mesh.lengths[static_cast<std::size_t>(e)] * trial.mesh.whole / 2 * trial.mesh.rule->lumping;
    const Vector by_p = more * nodes.row(v).transpose(), by_v = more * nodes.row(p).transpose();
    action.add(nodes.row(p).dot(by_p));
    for (Index j = 0; order > 0 && j < by_p.size(); ++j) {
      const Index first = trial.mesh.node(e, j) * n;
      out.gradient[first + p] += by_p[j];
      out.gradient[first + v] += by_v[j];
      for (Index l = 0; order == 2 && l < by_p.size(); ++l)
        hessian(j * n + p, l * n + v) += more(j, l), hessian(l * n + v, j * n + p) += more(j, l);
    }
  }

  void add_gradient(Index e, const Vector& phi, const Vector& dphi, double w) {
    const Index n = functional.freedoms();
    for (Index j = 0; j < phi.size(); ++j) {
      const Index first = trial.mesh.node(e, j) * n;
      out.gradient.segment(first, n) += w * (phi[j] * density.gradient.head(n) + dphi[j] * density.gradient.tail(n));
      out.gradient_terms.segment(first, n) += w * (std::abs(phi[j]) * density.gradient.head(n).cwiseAbs() +
                                                   std::abs(dphi[j]) * density.gradient.tail(n).cwiseAbs());
      if (functional.integrals() > 0)
        out.integral_gradients.middleRows(first, n) +=
            w * (phi[j] * density.integral_gradients.topRows(n) + dphi[j] * density.integral_gradients.bottomRows(n));
    }
  }

  void add_hessian(BlockSum& hessian, BlockSum& kinetic, BlockSum& displacement, const Vector& phi, const Vector& dphi,
                   double w) {
    const Index n = functional.freedoms();
    const Matrix qv = density.hessian.topRightCorner(n, n), vv = density.hessian.bottomRightCorner(n, n);
    hessian.add(density.hessian.topLeftCorner(n, n), phi, phi, w);
    hessian.add(qv, phi, dphi, w);
    hessian.add(qv.transpose(), dphi, phi, w);
    hessian.add(vv, dphi, dphi, w);
    kinetic.add(norm_of(vv).asDiagonal(), dphi, dphi, w);
    displacement.add(norm_of_displacement(vv).asDiagonal(), phi, phi, w);
  }

  /// |M| ξ²/T², and |M| ξ²/T⁴ of a q whose q'' stands in L: a shift of it, which has no v, would have no size else.
  Vector norm_of_displacement(const Matrix& vv) const {
    const OrderOfCoordinates& orders = functional.orders();
    const double square = trial.mesh.whole * trial.mesh.whole;
    Vector out = norm_of(vv) / square;
    for (std::size_t k = 0; k < orders.bases.size(); ++k)
      out[orders.bases[k]] = out[orders.rates_of_others[k]] / square;
    return out;
  }
};

}  // namespace

Assembly assemble(Functional& functional, const Trial& trial, int order) {
  Assembler a{functional, trial, order, {}, {}};
  const Index unknowns = trial.q.size(), k = functional.integrals();
  a.out.integrals = Vector::Zero(k);
  a.out.gradient = a.out.gradient_terms = Vector::Zero(order > 0 ? unknowns : 0);
  a.out.integral_gradients = Matrix::Zero(order > 0 ? unknowns : 0, k);
  for (Index e = 0; e < trial.mesh.elements() && a.out.finite; ++e) a.element(e);
  a.out.action = a.action.value();
  return std::move(a.out);
}

namespace {

/// Σ of a function of the time, the values and slopes at the points of Gauss, their weight and the nodes they are made
/// of.
template <typename Term>
double sum_over_points(const Trial& trial, const Term& term) {
  double sum = 0;
  for (Index e = 0; e < trial.mesh.elements(); ++e) {
    const Matrix nodes = trial.element(e);
    const Vector anchor = nodes.col(trial.mesh.rule_of(e).anchor);
    const Matrix apart = nodes.colwise() - anchor;
    for (Index g = 0; g < trial.mesh.rule->points.size(); ++g) {
      const Place at = place_of(trial.mesh, e, g);
      sum += std::abs(at.weight) * term(at, anchor, apart);
    }
  }
  return sum;
}

}  // namespace

double size_of_action(Functional& functional, const Trial& trial) {
  return sum_over_points(trial, [&](const Place& at, const Vector& anchor, const Matrix& apart) {
    const Vector q = anchor + apart * at.value, v = apart * at.slope;
    return functional.sensitivity(at.t, q.data(), v.data(), trial.multipliers).terms;
  });
}

double rounding_of_action(Functional& functional, const Trial& trial) {
  const double latest = std::abs(trial.mesh.start) + std::abs(trial.mesh.whole);
  return rounding_unit * sum_over_points(trial, [&](const Place& at, const Vector& anchor, const Matrix& apart) {
           const Vector q = anchor + apart * at.value, v = apart * at.slope;
           const Vector q_terms = anchor.cwiseAbs() + apart.cwiseAbs() * at.value.cwiseAbs(),
                        v_terms = apart.cwiseAbs() * at.slope.cwiseAbs();
           const Sensitivity by = functional.sensitivity(at.t, q.data(), v.data(), trial.multipliers);
           return by.terms + by.by_q.dot(q_terms) + by.by_v.dot(v_terms) + by.by_time * latest;
         });
}

}  // namespace maupertuis::action

namespace maupertuis {

double pace(Pace which, double s) {
  const double left = 1 - s;
  switch (which) {
    case Pace::Even:
      return s;
    case Pace::SlowStart:
      return s * s * s;
    case Pace::SlowEnd:
      return 1 - left * left * left;
    case Pace::SlowEnds:
      return s * s * s * (10 - 15 * s + 6 * s * s);
  }
  return s;
}

double pace_rate(Pace which, double s) {
  const double left = 1 - s;
  switch (which) {
    case Pace::Even:
      return 1;
    case Pace::SlowStart:
      return 3 * s * s;
    case Pace::SlowEnd:
      return 3 * left * left;
    case Pace::SlowEnds:
      return 30 * s * s * left * left;
  }
  return 1;
}

namespace {

/// s of a part of the way.
double parameter_of(Pace which, double part) {
  if (which == Pace::Even || part <= 0 || part >= 1) return std::clamp(part, 0.0, 1.0);
  if (which == Pace::SlowStart) return std::cbrt(part);
  if (which == Pace::SlowEnd) return 1 - std::cbrt(1 - part);
  double low = 0, high = 1;
  for (int turn = 0; turn < 64; ++turn) {
    const double middle = (low + high) / 2;
    (pace(which, middle) < part ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

MotionState ActionPath::at(double t) const {
  using action::Index;
  const double s = parameter_of(pace, (t - start) / (end - start));
  const auto above = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, s);
  const auto e = static_cast<std::size_t>(above - breaks.begin() - 1);
  const double h = breaks[e + 1] - breaks[e], rate = (end - start) * pace_rate(pace, s);
  const action::Rule& polynomials = action::element_rule(*rule, pace, e, elements());
  const double xi = std::clamp(2 * (s - breaks[e]) / h - 1, -1.0, 1.0);
  const auto n = static_cast<Index>(coordinates);
  const Eigen::Map<const action::Matrix> values(nodes.data() + e * (degree + 1) * coordinates, n,
                                                polynomials.degree + 1);
  const action::Vector q = values * polynomials.value_at(xi), v = values * polynomials.slope_at(xi) * (2 / (h * rate));
  return {t, {q.data(), q.data() + n}, {v.data(), v.data() + n}};
}

}  // namespace maupertuis
