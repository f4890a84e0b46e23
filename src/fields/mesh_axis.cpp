#include "fields/mesh_axis.hpp"

#include <algorithm>
#include <cmath>

namespace maupertuis {

MeshAxis::MeshAxis() : xi_{0}, weights_{1} {
  for (int smooth = 0; smooth < 2; ++smooth) {
    tables_[smooth] = {{1}, {0}, {0}};
    samples_[smooth] = {{0, 0}};
    projections_[smooth] = {1};
  }
}

MeshAxis::MeshAxis(double from, double to, int cells, int degree, bool periodic, bool of_plane)
    : cells_(static_cast<std::size_t>(cells)),
      from_(from),
      width_((to - from) / cells),
      periodic_(periodic),
      elements_{Element(false, degree), Element(true, std::max(degree, 3))} {
  const GaussRule rule(degree + 2);
  xi_ = rule.x;
  for (const double w : rule.w) weights_.push_back(w * width_ / 2);
  for (const bool smooth : {false, true}) {
    sizes_[smooth ? 1 : 0].assign(element(smooth).size(), 1);
    if (of_plane) find_sizes(smooth);
    make_tables(smooth), make_projection(smooth);
  }
}

/// P_n integrated once is of size 1/(2n + 1), twice of the square of it.
void MeshAxis::find_sizes(bool smooth) {
  const Element& e = element(smooth);
  for (std::size_t i = 0; i < e.inner(); ++i) {
    const double once = 2 * static_cast<double>(i + (smooth ? 2 : 1)) + 1;
    sizes_[smooth ? 1 : 0][2 * e.at_end() + i] = smooth ? once * once : once;
  }
}

void MeshAxis::make_tables(bool smooth) {
  const Element& e = element(smooth);
  for (int k = 0; k < 3; ++k) {
    std::vector<double> table(points() * e.size());
    for (std::size_t q = 0; q < points(); ++q) {
      double* row = table.data() + q * e.size();
      e.at(xi_[q], k, row);
      if (k > 0) row[0] = -row[e.at_end()];
      for (std::size_t i = 0; i < e.size(); ++i) row[i] *= std::pow(2 / width_, k) * sizes_[smooth ? 1 : 0][i];
    }
    tables_[smooth ? 1 : 0].push_back(std::move(table));
  }
}

void MeshAxis::make_projection(bool smooth) {
  const Element& e = element(smooth);
  const GaussRule fine(2 * e.degree() + 4);
  const auto scale = [&](std::size_t k) { return std::pow(width_ / 2, static_cast<double>(k)); };
  std::vector<Sample>& samples = samples_[smooth ? 1 : 0];
  for (const double end : {-1.0, 1.0})
    for (std::size_t k = 0; k < e.at_end(); ++k) samples.push_back({end, static_cast<int>(k)});
  const std::size_t ends = samples.size();
  for (const double xi : fine.x) samples.push_back({xi, static_cast<int>(e.at_end())});
  std::vector<double>& matrix = projections_[smooth ? 1 : 0];
  matrix.assign(e.size() * samples.size(), 0);
  for (std::size_t i = 0; i < ends; ++i) matrix[i * samples.size() + i] = scale(i % e.at_end());
  std::vector<double> highest(fine.x.size()), inner(e.inner());
  for (std::size_t q = 0; q < fine.x.size(); ++q) {
    std::fill(highest.begin(), highest.end(), 0.0);
    highest[q] = scale(e.at_end());
    e.project(fine, highest, inner.data());
    for (std::size_t i = 0; i < e.inner(); ++i)
      matrix[(ends + i) * samples.size() + ends + q] = inner[i] / sizes_[smooth ? 1 : 0][ends + i];
  }
}

std::size_t MeshAxis::at(bool smooth, int k, double x, std::vector<double>& out) const {
  if (is_point()) {
    out.assign(1, k == 0 ? 1 : 0);
    return 0;
  }
  const double place = (x - from_) / width_;
  const int cell = std::clamp(static_cast<int>(std::floor(place + 1e-9)), 0, static_cast<int>(cells_) - 1);
  out.resize(size(smooth));
  element(smooth).at(2 * (place - cell) - 1, k, out.data());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] *= std::pow(2 / width_, k) * sizes_[smooth ? 1 : 0][i];
  return static_cast<std::size_t>(cell);
}

MeshAxis::Number MeshAxis::number(bool smooth, std::size_t cell, std::size_t function) const {
  if (is_point()) return {};
  const auto folded = [&](std::size_t node) {
    if (!periodic_) return node;
    node %= cells_;
    return 2 * node < cells_ ? 2 * node : 2 * (cells_ - 1 - node) + 1;
  };
  const auto number = [](std::size_t rank, std::size_t own) {
    return Number{static_cast<std::uint32_t>(rank), static_cast<std::uint32_t>(own)};
  };
  const std::size_t end = at_end(smooth);
  if (function < 2 * end) return number(2 * folded(cell + function / end), function % end);
  return number(2 * folded(cell) + 1, function - 2 * end);
}

std::vector<double> MeshAxis::project(bool smooth, const std::function<double(int derivative, double x)>& f) const {
  const std::vector<Sample>& s = samples(smooth);
  const std::size_t functions = size(smooth);
  std::vector<double> out(cells_ * functions, 0), values(s.size());
  for (std::size_t cell = 0; cell < cells_; ++cell) {
    for (std::size_t i = 0; i < s.size(); ++i) values[i] = f(s[i].derivative, place(cell, s[i].xi));
    for (std::size_t i = 0; i < functions; ++i)
      for (std::size_t j = 0; j < s.size(); ++j)
        out[cell * functions + i] += projection(smooth)[i * s.size() + j] * values[j];
  }
  return out;
}

}  // namespace maupertuis
