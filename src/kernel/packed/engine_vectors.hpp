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

typedef long long Places __attribute__((vector_size(64)));
typedef long long UnalignedPlaces __attribute__((vector_size(64), aligned(8)));

/// Reads columns of one kind, each with its coefficients.
template <Column::Kind kind>
inline Vector column_values(const double* from, Slot place, const Column& column) {
  if constexpr (kind == Column::Broadcast) return all(from[place]);
  else if constexpr (kind == Column::Contiguous) return load(from + place);
  else if constexpr (kind == Column::Reversed) return __builtin_shuffle(load(from + place - (lanes - 1)), Places{7, 6, 5, 4, 3, 2, 1, 0});
  else return gather(from + (place - column.source), column.sources.data());
}

/// Σ of coefficients · columns, in sums that do not wait for each other.
template <Column::Kind kind>
inline Vector columns_of_kind(const ReadyRun& run, const double* from) {
  const auto term = [&](std::size_t i) {
    return load(run.coefficients + i * lanes) * column_values<kind>(from, run.places[i], run.columns[i]);
  };
  const std::size_t count = run.count;
  if (count == 1) return term(0);
  Vector even = term(0), odd = term(1);
  std::size_t i = 2;
  for (; i + 1 < count; i += 2) even += term(i), odd += term(i + 1);
  if (i < count) even += term(i);
  return even + odd;
}

/// Each lane with all lanes before it.
inline Vector running_sum(Vector v) {
  const Vector zero = all(0);
  v += __builtin_shuffle(v, zero, Places{8, 0, 1, 2, 3, 4, 5, 6});
  v += __builtin_shuffle(v, zero, Places{8, 8, 0, 1, 2, 3, 4, 5});
  return v + __builtin_shuffle(v, zero, Places{8, 8, 8, 8, 0, 1, 2, 3});
}
inline Vector running_sum_down(Vector v) {
  const Vector zero = all(0);
  v += __builtin_shuffle(v, zero, Places{1, 2, 3, 4, 5, 6, 7, 8});
  v += __builtin_shuffle(v, zero, Places{2, 3, 4, 5, 6, 7, 8, 8});
  return v + __builtin_shuffle(v, zero, Places{4, 5, 6, 7, 8, 8, 8, 8});
}

/// All lanes before each.
inline Vector before_lanes(Vector v) { return running_sum(__builtin_shuffle(v, all(0), Places{8, 0, 1, 2, 3, 4, 5, 6})); }
inline Vector before_lanes_down(Vector v) { return running_sum_down(__builtin_shuffle(v, all(0), Places{1, 2, 3, 4, 5, 6, 7, 8})); }

/// What a running sum adds to.
inline Vector carry_of(Slot carry, const double* row) { return carry == no_slot ? all(0) : all(row[carry]); }

/// A running sum whose lanes are each right but for the lanes before.
inline void join_strands(const Pack& pack, Vector last, double* row, Vector (*before)(Vector)) {
  const Vector owed = before(last) + carry_of(pack.carry, row);
  for (double* strand = row + pack.out; strand != row + pack.out + pack.strands * lanes; strand += lanes) save(strand, load(strand) + owed);
}

const Vector lane_numbers = {0, 1, 2, 3, 4, 5, 6, 7};

inline Vector larger(Vector x, Vector y) { return x > y ? x : y; }
inline Vector absolute(Vector x) { return reinterpret_cast<Vector>(reinterpret_cast<Places>(x) & 0x7fffffffffffffff); }

inline double largest_lane(Vector v) {
  v = larger(v, __builtin_shuffle(v, Places{4, 5, 6, 7, 0, 1, 2, 3}));
  v = larger(v, __builtin_shuffle(v, Places{2, 3, 0, 1, 6, 7, 4, 5}));
  return v[0] > v[1] ? v[0] : v[1];
}

/// Infinity and NaN times 0 are NaN.
inline bool are_finite(Vector v) {
  Vector zero = v * all(0);
  zero += __builtin_shuffle(zero, Places{4, 5, 6, 7, 0, 1, 2, 3});
  zero += __builtin_shuffle(zero, Places{2, 3, 0, 1, 6, 7, 4, 5});
  return zero[0] + zero[1] == 0;
}

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE
