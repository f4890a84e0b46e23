// Part of engine_code.hpp: vectors of 8 lanes.
namespace maupertuis::packed::MAUP_ENGINE {
namespace {

typedef double Vector __attribute__((vector_size(64), aligned(64)));
typedef double Unaligned __attribute__((vector_size(64), aligned(8)));

inline Vector load(const double* p) { return *reinterpret_cast<const Unaligned*>(p); }
inline void save(double* p, Vector v) { *reinterpret_cast<Unaligned*>(p) = v; }
inline Vector all(double x) { return Vector{x, x, x, x, x, x, x, x}; }
inline Vector gather(const double* p, const Slot* slots) {
  return Vector{p[slots[0]], p[slots[1]], p[slots[2]], p[slots[3]], p[slots[4]], p[slots[5]], p[slots[6]], p[slots[7]]};
}

/// Of the lanes of a and then those of b, which count from 8 on, these.
template <int... from>
struct Shuffle {
  Vector operator()(Vector a, Vector b) const { return __builtin_shufflevector(a, b, from...); }
  Vector operator()(Vector v) const { return __builtin_shufflevector(v, v, from...); }
};
template <int... from>
constexpr Shuffle<from...> shuffled;

typedef long long Places __attribute__((vector_size(64)));
typedef long long UnalignedPlaces __attribute__((vector_size(64), aligned(8)));

inline Places places_of(const Block& block) { return *reinterpret_cast<const UnalignedPlaces*>(block.places.data()); }

/// What a column of one kind reads.
template <Column::Kind kind>
inline Vector column_values(const double* from, const Column& column) {
  if constexpr (kind == Column::Broadcast)
    return all(from[column.source]);
  else if constexpr (kind == Column::Contiguous)
    return load(from + column.source);
  else if constexpr (kind == Column::Reversed)
    return shuffled<7, 6, 5, 4, 3, 2, 1, 0>(load(from + column.source - (lanes - 1)));
  else
    return gather(from, column.sources.data());
}

/// Σ_i term(i), in sums that do not wait for each other.
template <class Term>
[[gnu::always_inline]] inline Vector sum_of(std::size_t count, const Term& term) {
  if (count == 1) return term(0);
  Vector sums[4] = {all(0), all(0), all(0), all(0)};
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4)
#pragma GCC unroll 4
    for (std::size_t j = 0; j < 4; ++j) sums[j] += term(i + j);
  if (count & 2) sums[0] += term(i), sums[1] += term(i + 1), i += 2;
  if (count & 1) sums[2] += term(i);
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

/// Σ of coefficients · columns, whose coefficients follow each other.
template <Column::Kind kind>
inline Vector columns_of_kind(const Column* columns, std::size_t count, const double* coefficients,
                              const double* from) {
  return sum_of(count,
                [&](std::size_t i) { return load(coefficients + i * lanes) * column_values<kind>(from, columns[i]); });
}
/// The same of slots side by side, from `first` on. Often as many as a vector has lanes.
[[gnu::always_inline]] inline Vector columns_of_neighbours(const double* first, std::size_t count,
                                                           const double* coefficients) {
  const auto term = [&](std::size_t i) { return all(first[i]) * load(coefficients + i * lanes); };
  if (count != lanes) return sum_of(count, term);
  Vector sums[4];
#pragma GCC unroll 4
  for (std::size_t j = 0; j < 4; ++j) sums[j] = term(j) + term(j + 4);
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

/// Each lane with all lanes before it.
inline Vector running_sum(Vector v) {
  const Vector zero = all(0);
  v += shuffled<8, 0, 1, 2, 3, 4, 5, 6>(v, zero);
  v += shuffled<8, 8, 0, 1, 2, 3, 4, 5>(v, zero);
  return v + shuffled<8, 8, 8, 8, 0, 1, 2, 3>(v, zero);
}
inline Vector running_sum_down(Vector v) {
  const Vector zero = all(0);
  v += shuffled<1, 2, 3, 4, 5, 6, 7, 8>(v, zero);
  v += shuffled<2, 3, 4, 5, 6, 7, 8, 8>(v, zero);
  return v + shuffled<4, 5, 6, 7, 8, 8, 8, 8>(v, zero);
}

/// All lanes before each.
inline Vector before_lanes(Vector v) {
  return running_sum(shuffled<8, 0, 1, 2, 3, 4, 5, 6>(v, all(0)));
}
inline Vector before_lanes_down(Vector v) {
  return running_sum_down(shuffled<1, 2, 3, 4, 5, 6, 7, 8>(v, all(0)));
}

/// What a running sum adds to.
inline Vector carry_of(Slot carry, const double* row) { return carry == no_slot ? all(0) : all(row[carry]); }

/// Of a running sum in eight parts (Pack::Join): all its vectors add what the lanes before each came to in the last
/// one.
inline void join_strands(const Pack& pack, Vector last, double* row, Vector (*before)(Vector)) {
  const Vector missing = before(last) + carry_of(pack.carry, row);
  for (double* strand = row + pack.out; strand != row + pack.out + pack.strands * lanes; strand += lanes)
    save(strand, load(strand) + missing);
}

const Vector lane_numbers = {0, 1, 2, 3, 4, 5, 6, 7};

inline Vector larger(Vector x, Vector y) { return x > y ? x : y; }
inline Vector absolute(Vector x) { return reinterpret_cast<Vector>(reinterpret_cast<Places>(x) & 0x7fffffffffffffff); }

inline double largest_lane(Vector v) {
  v = larger(v, shuffled<4, 5, 6, 7, 0, 1, 2, 3>(v));
  v = larger(v, shuffled<2, 3, 0, 1, 6, 7, 4, 5>(v));
  return v[0] > v[1] ? v[0] : v[1];
}

/// Infinity and NaN times 0 are NaN.
inline bool are_finite(Vector v) {
  Vector zero = v * all(0);
  zero += shuffled<4, 5, 6, 7, 0, 1, 2, 3>(zero);
  zero += shuffled<2, 3, 0, 1, 6, 7, 4, 5>(zero);
  return zero[0] + zero[1] == 0;
}

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE
