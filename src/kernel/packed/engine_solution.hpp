// Part of engine_code.hpp: the solution of a stage, and what follows from it.
namespace maupertuis::packed::MAUP_ENGINE {
namespace {

constexpr std::size_t most_inverted = 16;

bool is_symmetric(const double* m, std::size_t n) {
  constexpr double tolerance = 1e-12;
  bool symmetric = true;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double difference = m[i * n + j] - m[j * n + i];
      symmetric &= difference * difference <= tolerance * tolerance * m[i * n + i] * m[j * n + j];
    }
  return symmetric;
}

/// The columns p of vector V: each gives its room to that of the inverse. V is known when this is compiled, since an address that is not
/// lets every load wait for the stores before it. False: a pivot is too small.
template <std::size_t W, std::size_t V>
bool eliminate(const double* m, std::size_t n, Vector (*rows)[W]) {
  constexpr double least_pivot = 1e-10;
  for (std::size_t p = V * lanes; p < n && p < (V + 1) * lanes; ++p) {
    const std::size_t lane = p % lanes;
    const double pivot = rows[p][V][lane];
    if (!(pivot > least_pivot * m[p * n + p])) return false;
    const Vector reciprocal = all(1 / pivot);
    const auto here = lane_numbers == all(static_cast<double>(lane));
    Vector scaled[W];
    for (std::size_t w = 0; w < W; ++w) scaled[w] = rows[p][w] * reciprocal;
    scaled[V] = here ? reciprocal : scaled[V];
    for (std::size_t i = 0; i < n; ++i) {
      const Vector factor = all(rows[i][V][lane]);
      rows[i][V] = here ? all(0) : rows[i][V];
      for (std::size_t w = 0; w < W; ++w) rows[i][w] -= factor * scaled[w];
    }
    for (std::size_t w = 0; w < W; ++w) rows[p][w] = scaled[w];
  }
  return true;
}

/// In place, W vectors a row.
template <std::size_t W>
bool invert(const double* m, std::size_t n, double* inverse) {
  Vector rows[most_inverted][W];
  alignas(64) double row[W * lanes] = {};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) row[j] = m[i * n + j];
    for (std::size_t w = 0; w < W; ++w) rows[i][w] = load(row + w * lanes);
  }
  const bool sound = [&]<std::size_t... V>(std::index_sequence<V...>) { return (eliminate<W, V>(m, n, rows) && ...); }(std::make_index_sequence<W>());
  if (!sound) return false;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t w = 0; w < W; ++w) save(inverse + (i * W + w) * lanes, -rows[i][w]);
  return true;
}

bool negative_inverse(const double* matrix, std::size_t n, double* inverse, std::size_t stride) {
  if (n > most_inverted || !is_symmetric(matrix, n)) return false;
  return stride == lanes ? invert<1>(matrix, n, inverse) : invert<2>(matrix, n, inverse);
}

/// In three exchanges: of neighbours, pairs and halves.
void transpose(const double* from, double* to, std::size_t stride) {
  Vector r[lanes];
  for (std::size_t i = 0; i < lanes; ++i) r[i] = load(from + i * stride);
  const auto exchange = [&](std::size_t distance, Places low, Places high) {
    for (std::size_t i = 0; i < lanes; ++i) {
      if (i & distance) continue;
      const Vector a = r[i], b = r[i + distance];
      r[i] = __builtin_shuffle(a, b, low), r[i + distance] = __builtin_shuffle(a, b, high);
    }
  };
  exchange(1, Places{0, 8, 2, 10, 4, 12, 6, 14}, Places{1, 9, 3, 11, 5, 13, 7, 15});
  exchange(2, Places{0, 1, 8, 9, 4, 5, 12, 13}, Places{2, 3, 10, 11, 6, 7, 14, 15});
  exchange(4, Places{0, 1, 2, 3, 8, 9, 10, 11}, Places{4, 5, 6, 7, 12, 13, 14, 15});
  for (std::size_t i = 0; i < lanes; ++i) save(to + i * stride, r[i]);
}

bool solve_by_inverse(const double* inverse, std::size_t stride, const double* row, const Slot* residual, std::size_t n, double* solution) {
  bool finite = true;
  for (std::size_t i = 0; i < stride; i += lanes) {
    Vector even = all(0), odd = all(0);
    std::size_t d = 0;
    for (; d + 1 < n; d += 2) {
      even += all(row[residual[d]]) * load(inverse + d * stride + i);
      odd += all(row[residual[d + 1]]) * load(inverse + (d + 1) * stride + i);
    }
    if (d < n) even += all(row[residual[d]]) * load(inverse + d * stride + i);
    const Vector a = even + odd;
    save(solution + i, a);
    finite &= are_finite(a);
  }
  return finite;
}

/// In sums that do not wait for each other.
bool rows_are_finite(const double* first, std::size_t stride, std::size_t rows, std::size_t count) {
  Vector sums[4] = {all(0), all(0), all(0), all(0)};
  double rest = 0;
  for (const double* row = first; row != first + rows * stride; row += stride) {
    std::size_t i = 0;
    for (; i + 4 * lanes <= count; i += 4 * lanes)
      for (std::size_t s = 0; s < 4; ++s) sums[s] += load(row + i + s * lanes) * all(0);
    for (; i + lanes <= count; i += lanes) sums[i / lanes % 4] += load(row + i) * all(0);
    for (; i < count; ++i) rest += row[i] * 0;
  }
  return are_finite((sums[0] + sums[1]) + (sums[2] + sums[3])) && rest == 0;
}

/// Numbers beyond `count` take no part in the sizes.
Sizes add(double* values, const double* change, double factor, std::size_t count) {
  Vector of_values = all(0), of_change = all(0);
  for (std::size_t i = 0; i < count; i += lanes) {
    const Vector before = load(values + i), added = all(factor) * load(change + i);
    const auto used = lane_numbers < all(static_cast<double>(count - i));
    of_values = larger(of_values, absolute(used ? before : all(0))), of_change = larger(of_change, absolute(used ? added : all(0)));
    save(values + i, before + added);
  }
  return {largest_lane(of_values), largest_lane(of_change)};
}

void set_accelerations(const Tables& tables, int stage, const double* solution, std::size_t unknowns, int sign) {
  double* const next = tables.rows + static_cast<std::size_t>(stage + 2) * tables.stride;
  // A division: the error of a rounded reciprocal would be the same in every step and so add up.
  for (std::size_t i = 0; i < unknowns; i += lanes) save(next + i, load(solution + i) / all(sign * (stage + 1.0) * (stage + 2.0)));
}

/// What W directions add.
template <std::size_t W>
void add_directions(double* out, std::size_t size, const double* tangents, std::size_t stride, const double* weights, double factor) {
  for (std::size_t i = 0; i < size; i += lanes) {
    const auto term = [&](std::size_t d) { return all(weights[d]) * load(tangents + d * stride + i); };
    Vector even = term(0);
    for (std::size_t d = 2; d < W; d += 2) even += term(d);
    if constexpr (W > 1) {
      Vector odd = term(1);
      for (std::size_t d = 3; d < W; d += 2) odd += term(d);
      even += odd;
    }
    save(out + i, load(out + i) + all(factor) * even);
  }
}

void correct(const Tables& tables, int stage, const TangentMatrix& tangents, const double* weights) {
  const double factors[3] = {1 / ((stage + 1.0) * (stage + 2.0)), 1 / (stage + 1.0), 1};
  double* const next = tables.rows + static_cast<std::size_t>(stage + 2) * tables.stride;
  Slot first = tangents.first;
  for (std::size_t lag = 0; lag <= 2; ++lag) {
    double* const out = next - lag * tables.stride + first;
    for (std::size_t d = 0; d < tangents.directions;) {
      const auto block = [&]<std::size_t W>() {
        add_directions<W>(out, tangents.end[lag] - first, tangents.values + d * tangents.stride + first, tangents.stride, weights + d, factors[lag]);
        d += W;
      };
      const std::size_t left = tangents.directions - d;
      if (left >= 8) block.template operator()<8>();
      else if (left >= 4) block.template operator()<4>();
      else if (left >= 2) block.template operator()<2>();
      else block.template operator()<1>();
    }
    first = (tangents.end[lag] + lanes - 1) / lanes * lanes;  // where the slots of the next lag begin
  }
}

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE
