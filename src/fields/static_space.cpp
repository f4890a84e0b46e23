#include "fields/static_space.hpp"

#include "linear_algebra/products.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {

StaticSpace::Line StaticSpace::line(const Along& along, bool periodic, bool smooth) {
  Line out;
  constexpr int beyond = 6;  // of the degree: the density is no polynomial
  out.borders = along.borders;
  out.space.emplace_back(ElementMesh{along.borders, along.degree, along.degree + beyond, periodic},
                         smooth ? ElementSpace::Kind::Smooth : ElementSpace::Kind::Continuous);
  const std::vector<ElementSpace::Point>& points = out.space.front().points();
  const std::size_t each = points.size() / (along.borders.size() - 1);
  out.weight.resize(static_cast<Eigen::Index>(points.size()));
  for (Eigen::MatrixXd& m : out.of)
    m = Eigen::MatrixXd::Zero(out.weight.size(), static_cast<Eigen::Index>(out.space.front().size()));
  for (std::size_t q = 0; q < points.size(); ++q) {
    // Inside of its element, as coefficients may jump at borders.
    const double a = along.borders[q / each], b = along.borders[q / each + 1], near = 1e-13 * (b - a);
    out.x.push_back(std::clamp(points[q].x, a + near, b - near));
    out.weight(static_cast<Eigen::Index>(q)) = points[q].weight;
    for (const ElementSpace::Part& part : points[q].parts)
      for (int k = 0; k < 3; ++k)
        out.of[k](static_cast<Eigen::Index>(q), static_cast<Eigen::Index>(part.dof)) += part.of[k];
  }
  return out;
}

StaticSpace::Line StaticSpace::single() {
  Line out;
  out.x = {0};
  out.weight = Eigen::VectorXd::Ones(1);
  for (Eigen::MatrixXd& m : out.of) m = Eigen::MatrixXd::Zero(1, 1);
  out.of[0](0, 0) = 1;
  return out;
}

std::vector<ElementSpace::Part> StaticSpace::Line::at(double place) const {
  if (space.empty()) return {{0, {1, 0, 0}}};
  return space.front().at(place, place >= borders.back());
}

/// Least squares along the line, for each column of values at its points.
Eigen::MatrixXd StaticSpace::Line::fitted(const Eigen::MatrixXd& values) const {
  const Eigen::VectorXd root = weight.array().sqrt();
  Eigen::MatrixXd rows = of[0], right = values;
  for (Eigen::Index i = 0; i < root.size(); ++i) rows.row(i) *= root(i), right.row(i) *= root(i);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(rows);
  return qr.solve(right);
}

/// Exact at the borders of elements, next to f in the mean square between them.
Eigen::VectorXd StaticSpace::Line::interpolated(const std::function<double(double)>& f,
                                                const std::function<double(double)>& slope) const {
  if (space.empty()) return Eigen::VectorXd::Constant(1, f(0));
  const ElementSpace& s = space.front();
  Eigen::VectorXd c = Eigen::VectorXd::Zero(size());
  std::vector<bool> inner(s.size(), true);
  for (std::size_t b = 0; b < borders.size(); ++b) {
    c(static_cast<Eigen::Index>(s.value_at_border(b))) = f(borders[b]), inner[s.value_at_border(b)] = false;
    if (s.kind() != ElementSpace::Kind::Smooth) continue;
    c(static_cast<Eigen::Index>(s.slope_at_border(b))) = slope(borders[b]), inner[s.slope_at_border(b)] = false;
  }
  Eigen::VectorXd left(weight.size());
  const Eigen::VectorXd by_borders = product(of[0], c);
  for (Eigen::Index q = 0; q < left.size(); ++q)
    left(q) = (f(x[static_cast<std::size_t>(q)]) - by_borders(q)) * std::sqrt(weight(q));
  std::vector<Eigen::Index> kept;
  for (std::size_t i = 0; i < inner.size(); ++i)
    if (inner[i]) kept.push_back(static_cast<Eigen::Index>(i));
  Eigen::MatrixXd rows(left.size(), static_cast<Eigen::Index>(kept.size()));
  for (std::size_t j = 0; j < kept.size(); ++j)
    rows.col(static_cast<Eigen::Index>(j)) = of[0].col(kept[j]).cwiseProduct(Eigen::VectorXd(weight.array().sqrt()));
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(rows);
  const Eigen::VectorXd solved = qr.solve(left);
  for (std::size_t j = 0; j < kept.size(); ++j) c(kept[j]) = solved(static_cast<Eigen::Index>(j));
  return c;
}

StaticSpace::StaticSpace(const FieldEquations& equations, const std::vector<Along>& along,
                         const std::vector<bool>& smooth)
    : varied_(equations.varied) {
  const FieldSystem& s = equations.system();
  first_.push_back(0);
  for (std::size_t a = 0; a < varied_.size(); ++a) {
    lines_.push_back({line(along[0], s.periodic(0), smooth[a]),
                      along.size() > 1 ? line(along[1], s.periodic(1), smooth[a]) : single()});
    first_.push_back(first_.back() + lines_.back()[0].size() * lines_.back()[1].size());
  }
  const Eigen::VectorXd &wx = lines_.front()[0].weight, &wy = lines_.front()[1].weight;
  weight_.resize(wx.size() * wy.size());
  for (Eigen::Index j = 0; j < wy.size(); ++j)
    for (Eigen::Index i = 0; i < wx.size(); ++i) weight_(j * wx.size() + i) = wx(i) * wy(j);
}

double StaticSpace::place(std::size_t direction, Eigen::Index point) const {
  const Line& line = lines_.front()[direction];
  const Eigen::Index n = lines_.front()[0].weight.size();
  return line.x[static_cast<std::size_t>(direction == 0 ? point % n : point / n)];
}

Eigen::MatrixXd StaticSpace::table(std::size_t field, const std::vector<int>& space) const {
  const Eigen::MatrixXd &x = lines_[field][0].of[space[0]], &y = lines_[field][1].of[space.size() > 1 ? space[1] : 0];
  Eigen::MatrixXd out(x.rows() * y.rows(), x.cols() * y.cols());
  for (Eigen::Index r = 0; r < y.rows(); ++r)
    for (Eigen::Index j = 0; j < y.cols(); ++j) out.block(r * x.rows(), j * x.cols(), x.rows(), x.cols()) = y(r, j) * x;
  return out;
}

double StaticSpace::value(const Eigen::VectorXd& c, const FieldJet& jet, double x, double y) const {
  const auto a = static_cast<std::size_t>(std::find(varied_.begin(), varied_.end(), jet.field) - varied_.begin());
  const int dx = jet.space[0], dy = jet.space.size() > 1 ? jet.space[1] : 0;
  const std::vector<ElementSpace::Part> along_x = lines_[a][0].at(x), along_y = lines_[a][1].at(y);
  double sum = 0;
  for (const ElementSpace::Part& j : along_y)
    for (const ElementSpace::Part& i : along_x)
      sum += i.of[dx] * j.of[dy] *
             c(first_[a] + static_cast<Eigen::Index>(j.dof) * lines_[a][0].size() + static_cast<Eigen::Index>(i.dof));
  return sum;
}

bool StaticSpace::has(const FieldJet& jet) const {
  const auto a = static_cast<std::size_t>(std::find(varied_.begin(), varied_.end(), jet.field) - varied_.begin());
  for (std::size_t i = 0; a < varied_.size() && i < jet.space.size(); ++i) {
    const bool smooth = lines_[a][i].space.front().kind() == ElementSpace::Kind::Smooth;
    if (jet.space[i] > (smooth ? 2 : 1)) return false;
  }
  return a < varied_.size();
}

Eigen::Index StaticSpace::function_at(std::size_t field, double place, bool slope) const {
  const Line& line = lines_[field][0];
  std::size_t best = 0;
  for (std::size_t b = 0; b < line.borders.size(); ++b)
    if (std::abs(line.borders[b] - place) < std::abs(line.borders[best] - place)) best = b;
  const ElementSpace& space = line.space.front();
  return first_[field] + static_cast<Eigen::Index>(slope ? space.slope_at_border(best) : space.value_at_border(best));
}

void StaticSpace::fit(std::size_t field, const Function& f, Eigen::VectorXd& c) const {
  const Line &x = lines_[field][0], &y = lines_[field][1];
  Eigen::MatrixXd values(x.weight.size(), y.weight.size());
  for (Eigen::Index j = 0; j < values.cols(); ++j)
    for (Eigen::Index i = 0; i < values.rows(); ++i)
      values(i, j) = f(x.x[static_cast<std::size_t>(i)], y.x[static_cast<std::size_t>(j)]);
  const Eigen::MatrixXd across = x.fitted(values).transpose();
  const Eigen::MatrixXd both = y.fitted(across);  // [along y × along x]
  for (Eigen::Index j = 0; j < both.rows(); ++j)
    for (Eigen::Index i = 0; i < both.cols(); ++i) c(first_[field] + j * x.size() + i) = both(j, i);
}

std::vector<Eigen::Index> StaticSpace::functions_at(std::size_t field, Side side, bool slope) const {
  const std::size_t direction = across(side);
  const Line &line = lines_[field][direction], &other = lines_[field][1 - direction];
  const std::size_t border = side == Side::Right || side == Side::Top ? line.borders.size() - 1 : 0;
  const ElementSpace& space = line.space.front();
  const auto at = static_cast<Eigen::Index>(slope ? space.slope_at_border(border) : space.value_at_border(border));
  std::vector<Eigen::Index> out;
  for (Eigen::Index k = 0; k < other.size(); ++k)
    out.push_back(first_[field] + (direction == 0 ? k * line.size() + at : at * other.size() + k));
  return out;
}

std::vector<StaticSpace::Held> StaticSpace::held(std::size_t field, Side side, bool slope,
                                                 const std::function<double(double)>& f,
                                                 const std::function<double(double)>& slope_along) const {
  const std::vector<Eigen::Index> functions = functions_at(field, side, slope);
  const Eigen::VectorXd c = lines_[field][1 - across(side)].interpolated(f, slope_along);
  std::vector<Held> out;
  for (std::size_t k = 0; k < functions.size(); ++k) out.push_back({functions[k], c(static_cast<Eigen::Index>(k))});
  return out;
}

std::vector<StaticSpace::Held> StaticSpace::loads(std::size_t field, Side side, bool slope,
                                                  const std::function<double(double)>& f) const {
  const std::vector<Eigen::Index> functions = functions_at(field, side, slope);
  const Line& other = lines_[field][1 - across(side)];
  std::vector<Held> out;
  for (std::size_t k = 0; k < functions.size(); ++k) {
    double sum = 0;
    for (Eigen::Index q = 0; q < other.weight.size(); ++q)
      sum += other.weight(q) * f(other.x[static_cast<std::size_t>(q)]) * other.of[0](q, static_cast<Eigen::Index>(k));
    out.push_back({functions[k], sum});
  }
  return out;
}

}  // namespace maupertuis
