#include "fields/wave_mesh.hpp"

#include <algorithm>
#include <cstdint>

namespace maupertuis {

std::vector<Expr> WaveMesh::time_derivatives(Expr value) const {
  std::vector<Expr> out{value};
  for (std::size_t k = 1; k <= kOrder + 2; ++k) out.push_back(differentiate(out.back(), s_.context->time()));
  return out;
}

void fill_randomly(FieldValues& w) {
  std::uint64_t seed = 1;
  for (auto& row : w)
    for (double& x : row)
      x = (seed = seed * 6364136223846793005ull + 1442695040888963407ull, static_cast<double>(seed >> 33) / 4e9 - 0.5);
}

namespace {

double root_mean_square(const FieldValues& x) {
  double sum = 0, count = 0;
  for (const auto& row : x) {
    count += static_cast<double>(row.size());
    for (const double value : row) sum += value * value;
  }
  return std::sqrt(sum / count);
}

/// A little off u in the direction of w.
void move_along(FieldValues& to, const FieldValues& u, const FieldValues& w, double share) {
  for (std::size_t f = 0; f < w.size(); ++f)
    for (std::size_t n = 0; n < w[f].size(); ++n) to[f][n] = u[f][n] + share * w[f][n];
}

/// (a − b)/by, into a.
void set_difference(FieldValues& a, const FieldValues& b, double by) {
  for (std::size_t f = 0; f < a.size(); ++f)
    for (std::size_t n = 0; n < a[f].size(); ++n) a[f][n] = (a[f][n] - b[f][n]) / by;
}

}  // namespace

/// All rounds share their buffers: on large meshes fresh ones took most of the time.
double largest_frequency(const FieldValues& u, FieldValues w, const Accelerations& accelerations, int rounds,
                         const std::string& trouble, const Interrupt& interrupt) {
  double size = 1;
  for (const auto& row : u)
    for (const double x : row) size = std::max(size, std::abs(x));
  const double epsilon = 1e-7 * size;
  FieldValues moved = u, at_rest = u;
  accelerations(moved, at_rest);
  double norm = root_mean_square(w), omega_squared = 0;
  for (int round = 0; round < rounds && trouble.empty(); ++round) {
    interrupt.throw_if_asked();
    if (!(norm > 0)) return 0;
    move_along(moved, u, w, epsilon / norm);
    accelerations(moved, w);
    set_difference(w, at_rest, epsilon);
    norm = omega_squared = root_mean_square(w);
  }
  return std::sqrt(omega_squared);
}

bool invert_mass(std::vector<double> a, std::vector<double>& inverse, std::size_t n) {
  inverse.assign(n * n, 0);
  for (std::size_t i = 0; i < n; ++i) inverse[i * n + i] = 1;
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c; r < n; ++r)
      if (std::abs(a[r * n + c]) > std::abs(a[pivot * n + c])) pivot = r;
    if (!(std::abs(a[pivot * n + c]) > 0)) return false;
    for (std::size_t j = 0; j < n; ++j)
      std::swap(a[c * n + j], a[pivot * n + j]), std::swap(inverse[c * n + j], inverse[pivot * n + j]);
    const double d = a[c * n + c];
    for (std::size_t j = 0; j < n; ++j) a[c * n + j] /= d, inverse[c * n + j] /= d;
    for (std::size_t r = 0; r < n; ++r) {
      const double factor = a[r * n + c];
      if (r == c || factor == 0) continue;
      for (std::size_t j = 0; j < n; ++j)
        a[r * n + j] -= factor * a[c * n + j], inverse[r * n + j] -= factor * inverse[c * n + j];
    }
  }
  return true;
}

bool invert_mass(std::vector<double> a, std::vector<double>& inverse, const std::vector<bool>& held) {
  const std::size_t n = held.size();
  const std::vector<double> whole = a;
  for (std::size_t h = 0; h < n; ++h)
    for (std::size_t i = 0; held[h] && i < n; ++i) a[h * n + i] = a[i * n + h] = i == h ? 1 : 0;
  if (!invert_mass(std::move(a), inverse, n)) return false;
  const std::vector<double> of_free = inverse;
  for (std::size_t h = 0; h < n; ++h)
    for (std::size_t f = 0; held[h] && f < n; ++f)
      for (std::size_t g = 0; !held[f] && g < n; ++g)
        if (!held[g]) inverse[f * n + h] -= of_free[f * n + g] * whole[g * n + h];
  return true;
}

}  // namespace maupertuis
