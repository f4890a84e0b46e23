// Part of engine_code.hpp: the solution of a stage, and what follows from it.
namespace maupertuis::packed::MAUP_ENGINE {
namespace {

constexpr std::size_t most_inverted = 16;

/// 8 × 8 numbers, in three exchanges: of neighbours, pairs and halves.
inline void transpose_rows(Vector (&r)[lanes]) {
  const auto exchange = [&](std::size_t distance, auto low, auto high) {
    for (std::size_t i = 0; i < lanes; ++i) {
      if (i & distance) continue;
      const Vector a = r[i], b = r[i + distance];
      r[i] = low(a, b), r[i + distance] = high(a, b);
    }
  };
  exchange(1, shuffled<0, 8, 2, 10, 4, 12, 6, 14>, shuffled<1, 9, 3, 11, 5, 13, 7, 15>);
  exchange(2, shuffled<0, 1, 8, 9, 4, 5, 12, 13>, shuffled<2, 3, 10, 11, 6, 7, 14, 15>);
  exchange(4, shuffled<0, 1, 2, 3, 8, 9, 10, 11>, shuffled<4, 5, 6, 7, 12, 13, 14, 15>);
}

/// To 1e-12 of the diagonal; not if a number is not finite.
constexpr double symmetry_squared = 1e-24;

template <std::size_t N>
bool is_symmetric(const double*, const Vector (&rows)[N][1]) {
  Vector columns[lanes] = {}, diagonal = all(0), fails = all(0);
  for (std::size_t i = 0; i < N; ++i)
    columns[i] = rows[i][0], diagonal = lane_numbers == all(static_cast<double>(i)) ? rows[i][0] : diagonal;
  transpose_rows(columns);
  for (std::size_t i = 0; i < N; ++i) {
    const Vector difference = rows[i][0] - columns[i], limit = all(symmetry_squared * diagonal[i]) * diagonal;
    fails = difference * difference <= limit ? fails : all(1);
  }
  return largest_lane(fails) == 0;
}

template <std::size_t N>
bool is_symmetric(const double* m, const Vector (&)[N][2]) {
  bool symmetric = true;
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double difference = m[i * N + j] - m[j * N + i];
      symmetric &= difference * difference <= symmetry_squared * m[i * N + i] * m[j * N + j];
    }
  return symmetric;
}

/// One step of Gauss and Jordan in place: column p of M, which is 0 and 1 from then on, is overwritten by column p of
/// the inverse. The column stands in vector V of each row. V is a template argument: if it were computed at run time,
/// the processor could not tell early that what it loads of a row is not what it has just stored, and would wait.
/// False: the pivot is too small.
template <std::size_t V, std::size_t N, std::size_t W>
[[gnu::always_inline]] inline bool eliminate(const double* m, Vector (&rows)[N][W], std::size_t p) {
  constexpr double least_pivot = 1e-10;
  const std::size_t lane = p % lanes;
  const double pivot = rows[p][V][lane];
  if (!(pivot > least_pivot * m[p * N + p])) return false;
  const Vector reciprocal = all(1 / pivot);
  const auto here = lane_numbers == all(static_cast<double>(lane));
  Vector scaled[W];
  for (std::size_t w = 0; w < W; ++w) scaled[w] = rows[p][w] * reciprocal;
  scaled[V] = here ? reciprocal : scaled[V];
#pragma GCC unroll 8
  for (std::size_t i = 0; i < N; ++i) {
    const Vector factor = all(rows[i][V][lane]);
    rows[i][V] = here ? all(0) : rows[i][V];
    for (std::size_t w = 0; w < W; ++w) rows[i][w] -= factor * scaled[w];
  }
  for (std::size_t w = 0; w < W; ++w) rows[p][w] = scaled[w];
  return true;
}

/// All columns: up to 8 written out, with the rows in registers.
template <std::size_t N>
bool eliminate_all(const double* m, Vector (&rows)[N][1]) {
  return [&]<std::size_t... P>(std::index_sequence<P...>) { return (eliminate<0>(m, rows, P) && ...); }
  (std::make_index_sequence<N>());
}
template <std::size_t N>
bool eliminate_all(const double* m, Vector (&rows)[N][2]) {
  for (std::size_t p = 0; p < lanes; ++p)
    if (!eliminate<0>(m, rows, p)) return false;
  for (std::size_t p = lanes; p < N; ++p)
    if (!eliminate<1>(m, rows, p)) return false;
  return true;
}

/// In place, N rows of W vectors.
template <std::size_t N>
bool invert(const double* m, double* inverse) {
  constexpr std::size_t W = (N + lanes - 1) / lanes;
  Vector rows[N][W];
  alignas(64) double row[W * lanes] = {};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) row[j] = m[i * N + j];
    for (std::size_t w = 0; w < W; ++w)
      rows[i][w] = N % lanes == 0 ? load(m + i * N + w * lanes) : load(row + w * lanes);
  }
  if (!is_symmetric(m, rows) || !eliminate_all(m, rows)) return false;
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t w = 0; w < W; ++w) save(inverse + (i * W + w) * lanes, -rows[i][w]);
  return true;
}

using Invert = bool (*)(const double* m, double* inverse);

/// By the number of unknowns less 1.
template <std::size_t... N>
constexpr std::array<Invert, most_inverted> inversions(std::index_sequence<N...>) {
  return {invert<N + 1>...};
}

bool negative_inverse(const double* matrix, std::size_t n, double* inverse) {
  static constexpr auto invert_of = inversions(std::make_index_sequence<most_inverted>());
  if (n == 0) return true;
  return n <= most_inverted && invert_of[n - 1](matrix, inverse);
}

void transpose(const double* from, std::size_t from_stride, double* to, std::size_t to_stride) {
  Vector rows[lanes];
  for (std::size_t i = 0; i < lanes; ++i) rows[i] = load(from + i * from_stride);
  transpose_rows(rows);
  for (std::size_t i = 0; i < lanes; ++i) save(to + i * to_stride, rows[i]);
}

/// V vectors of the solution.
template <std::size_t V>
bool solve_vectors(const double* inverse, std::size_t stride, const double* row, const Slot* residual, std::size_t n,
                   double* solution) {
  Vector even[V], odd[V];
  for (std::size_t v = 0; v < V; ++v) even[v] = odd[v] = all(0);
  const auto add = [&](std::size_t d, Vector* sums) {
    const Vector part = all(row[residual[d]]);
    for (std::size_t v = 0; v < V; ++v) sums[v] += part * load(inverse + d * stride + v * lanes);
  };
  std::size_t d = 0;
  for (; d + 1 < n; d += 2) add(d, even), add(d + 1, odd);
  if (d < n) add(d, even);
  Vector zero = all(0);
  for (std::size_t v = 0; v < V; ++v) {
    const Vector a = even[v] + odd[v];
    save(solution + v * lanes, a);
    zero += a * all(0);
  }
  return are_finite(zero);
}

bool solve_by_inverse(const double* inverse, std::size_t stride, const double* row, const Slot* residual, std::size_t n,
                      double* solution) {
  bool finite = true;
  for (std::size_t i = 0; i < stride;) {
    const auto block = [&]<std::size_t V>() {
      finite &= solve_vectors<V>(inverse + i, stride, row, residual, n, solution + i);
      i += V * lanes;
    };
    const std::size_t left = (stride - i) / lanes;
    if (left >= 4)
      block.template operator()<4>();
    else if (left >= 2)
      block.template operator()<2>();
    else
      block.template operator()<1>();
  }
  return finite;
}

/// In sums that do not wait for each other.
bool rows_are_finite(const double* first, std::size_t stride, std::size_t rows, std::size_t count) {
  Vector sums[4] = {all(0), all(0), all(0), all(0)};
  double rest = 0;
  const double* const last = first + rows * stride;
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const double* row = first + i;
    for (; row + 3 * stride < last; row += 4 * stride)
#pragma GCC unroll 4
      for (std::size_t s = 0; s < 4; ++s) sums[s] += load(row + s * stride) * all(0);
    for (; row < last; row += stride) sums[0] += load(row) * all(0);
  }
  for (; i < count; ++i)
    for (const double* row = first + i; row < last; row += stride) rest += *row * 0;
  return are_finite((sums[0] + sums[1]) + (sums[2] + sums[3])) && rest == 0;
}

/// Numbers beyond `count` take no part in the sizes.
Sizes add(double* values, const double* change, double factor, std::size_t count) {
  Vector of_values = all(0), of_change = all(0);
  for (std::size_t i = 0; i < count; i += lanes) {
    const Vector before = load(values + i), added = all(factor) * load(change + i);
    const auto used = lane_numbers < all(static_cast<double>(count - i));
    of_values = larger(of_values, absolute(used ? before : all(0))),
    of_change = larger(of_change, absolute(used ? added : all(0)));
    save(values + i, before + added);
  }
  return {largest_lane(of_values), largest_lane(of_change)};
}

bool cancel(const double* x, const double* y, const double* most, std::size_t count) {
  Vector fails = all(0);
  for (std::size_t i = 0; i < count; i += lanes)
    fails = absolute(load(x + i) + load(y + i)) <= load(most + i) ? fails : all(1);
  return largest_lane(fails) == 0;
}

void negate(const double* from, double* to, std::size_t count) {
  for (std::size_t i = 0; i < count; i += lanes)
    save(to + i, lane_numbers < all(static_cast<double>(count - i)) ? -load(from + i) : all(0));
}

void set_accelerations(const Tables& tables, int stage, const double* solution, std::size_t unknowns, int sign) {
  double* const next = tables.rows + static_cast<std::size_t>(stage + 2) * tables.stride;
  // A division: the error of a rounded reciprocal would be the same in every step and so add up.
  for (std::size_t i = 0; i < unknowns; i += lanes)
    save(next + i, load(solution + i) / all(sign * (stage + 1.0) * (stage + 2.0)));
}

/// Σ_d weights[d] · rows[d · stride], in sums that do not wait for each other.
template <std::size_t N>
Vector weighted(const Vector (&weights)[N], const double* rows, std::size_t stride) {
  constexpr std::size_t chains = N < 4 ? 1 : N < 12 ? 2 : 4;
  Vector sums[chains];
#pragma GCC unroll 16
  for (std::size_t d = 0; d < N; ++d) {
    const Vector term = weights[d] * load(rows + d * stride);
    sums[d % chains] = d < chains ? term : sums[d % chains] + term;
  }
#pragma GCC unroll 4
  for (std::size_t c = 1; c < chains; ++c) sums[0] += sums[c];
  return sums[0];
}

/// Of what q̈_k changes in coefficients, by lag.
struct Factors {
  explicit Factors(const Stage& s) : of_lag{1 / s.order_of(2).shift_factors[2], s.order_of(1).reciprocal.leading, 1} {}
  double of_lag[3];
};

/// What N directions add to the coefficients of a stage.
template <std::size_t N>
inline void add_directions(const Stage& s, const TangentMatrix& tangents, const double* values,
                           const Vector (&weights)[N]) {
  const Factors factors(s);
  std::size_t i = tangents.first;
  for (int lag = 0; lag <= 2; ++lag) {
    double* const row = s.order_of(lag).row;
    for (const Vector factor = all(factors.of_lag[lag]); i < tangents.end[static_cast<std::size_t>(lag)];
         i += lanes)  // the slots of the next lag begin with a vector
      save(row + i, load(row + i) + factor * weighted(weights, values + i, tangents.stride));
  }
}

template <std::size_t N>
inline void load_weights(const double* numbers, Vector (&weights)[N]) {
#pragma GCC unroll 16
  for (std::size_t d = 0; d < N; ++d) weights[d] = all(numbers[d]);
}

template <std::size_t N>
void correct_by(const Stage& s, const TangentMatrix& tangents, std::size_t first, const double* numbers) {
  Vector weights[N];
  load_weights(numbers + first, weights);
  add_directions(s, tangents, tangents.values + first * tangents.stride, weights);
}

using CorrectBy = void (*)(const Stage&, const TangentMatrix&, std::size_t, const double*);

void correct(const Tables& tables, int stage, const TangentMatrix& tangents, const double* weights) {
  constexpr std::size_t most = 8;
  static constexpr CorrectBy by[] = {nullptr,       correct_by<1>, correct_by<2>, correct_by<3>, correct_by<4>,
                                     correct_by<5>, correct_by<6>, correct_by<7>, correct_by<8>};
  const Stage s(tables, stage);
  for (std::size_t d = 0; d < tangents.directions; d += most)
    by[tangents.directions - d < most ? tangents.directions - d : most](s, tangents, d, weights);
}

/// Up to here what a stage adds is found from its residual at once.
constexpr std::size_t most_answered = 8;

/// Calls for each vector of corrected slots, with its lag and place in a row.
template <class Visit>
inline void for_corrected(const TangentMatrix& tangents, const Visit& visit) {
  std::size_t i = tangents.first;
  for (int lag = 0; lag <= 2; ++lag)
    /// the slots of the next lag begin with a vector
    for (; i < tangents.end[static_cast<std::size_t>(lag)]; i += lanes) visit(lag, i);
}

/// A vector of tangents each of whose lanes follows one unknown, lane by lane those of vector `own` of all: these
/// numbers.
inline Vector own_tangents(const TangentMatrix& tangents, std::size_t place, std::size_t own) {
  Vector out = all(0);
  for (std::size_t d = own * lanes, lane = 0; lane < lanes && d < tangents.directions; ++d, ++lane)
    out[lane] = tangents.values[d * tangents.stride + place + lane];
  return out;
}

/// Of N unknowns: what a stage adds to the corrected slots. Those whose lanes follow one unknown each: by its
/// acceleration. Others, up to most_answered unknowns: by each entry of the residual, what −M₀⁻¹ and the tangents after
/// it make of it, [N][lanes].
template <std::size_t N>
void find_answers(const InverseSolution& in) {
  double* out = in.answers;
  const std::int8_t* own = in.own;
  for_corrected(in.tangents, [&](int, std::size_t i) {
    if (const int vector = *own++; vector >= 0) {
      save(out, own_tangents(in.tangents, i, static_cast<std::size_t>(vector)));
      out += lanes;
      return;
    }
    if constexpr (N <= most_answered) {
      Vector rows[N];
#pragma GCC unroll 16
      for (std::size_t d = 0; d < N; ++d) rows[d] = load(in.tangents.values + d * in.tangents.stride + i);
      for (std::size_t e = 0; e < N; ++e, out += lanes) {
        const double* const column = in.inverse + e * lanes;  // of a symmetric matrix
        Vector even = rows[0] * all(column[0]), odd = all(0);
#pragma GCC unroll 16
        for (std::size_t d = 1; d < N; ++d) (d % 2 == 0 ? even : odd) += rows[d] * all(column[d]);
        save(out, even + odd);
      }
    }
  });
}

/// q̈_k and what follows from it, of N unknowns. What is not finite makes `zero` something else.
template <std::size_t N>
[[gnu::always_inline]] inline void complete(const Stage& s, const InverseSolution& in, Vector& zero) {
  constexpr std::size_t vectors = (N + lanes - 1) / lanes;
  const double* const residual = s.order_of(2).row;
  Vector weights[N], accelerations[vectors];
  if (in.side_by_side)
    load_weights(residual + in.residual[0], weights);
  else
#pragma GCC unroll 16
    for (std::size_t d = 0; d < N; ++d) weights[d] = all(residual[in.residual[d]]);
  for (std::size_t v = 0; v < vectors; ++v) {
    accelerations[v] = weighted(weights, in.inverse + v * lanes, vectors * lanes);
    zero += accelerations[v] * all(0);
    save(s.order_of(0).row + v * lanes, accelerations[v] / all(s.order_of(2).shift_factors[2]));
  }
  if constexpr (N > most_answered) {
    alignas(64) double solution[vectors * lanes];
    for (std::size_t v = 0; v < vectors; ++v) save(solution + v * lanes, accelerations[v]);
    load_weights(solution, weights);
  }
  const Factors factors(s);
  const double* answer = in.answers;
  const std::int8_t* own = in.own;
  for_corrected(in.tangents, [&](int lag, std::size_t i) {
    Vector change;
    if (const int vector = *own++; vector >= 0) {
      change = load(answer) * (vector == 0 ? accelerations[0] : accelerations[vectors - 1]);
      answer += lanes;
    } else if constexpr (N <= most_answered) {
      change = weighted(weights, answer, lanes);
      answer += N * lanes;
    } else {
      change = weighted(weights, in.tangents.values + i, in.tangents.stride);
    }
    double* const place = s.order_of(lag).row + i;
    save(place, load(place) + all(factors.of_lag[lag]) * change);
  });
}

template <std::size_t N>
bool run_stages_of(const Tables& tables, const InverseSolution& in, int first, int last, bool goes_on) {
  if (first == 1) find_answers<N>(in);
  Vector zero = all(0);
  for (int stage = first; stage < last; ++stage) {
    const Stage s(tables, stage);
    for (std::size_t i = 0; i < N; i += lanes) save(s.order_of(0).row + i, all(0));
    run_packs(s);
    complete<N>(s, in, zero);
    if (stage + 1 == last && !goes_on) break;
    renew(s);
  }
  return are_finite(zero);
}

using RunStages = bool (*)(const Tables&, const InverseSolution&, int first, int last, bool goes_on);

template <std::size_t... N>
constexpr std::array<RunStages, most_inverted> by_unknowns(std::index_sequence<N...>) {
  return {run_stages_of<N + 1>...};
}

bool run_stages_by_inverse(const Tables& tables, const InverseSolution& in, int first, int last, bool goes_on) {
  static constexpr auto run_stages = by_unknowns(std::make_index_sequence<most_inverted>());
  return run_stages[in.tangents.directions - 1](tables, in, first, last, goes_on);
}

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE
