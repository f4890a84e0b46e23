// No include guard: each engine_*.cpp compiles this once, for its own instruction set, in a namespace of its own.
#include "kernel/jet/sine_cosine.hpp"
#include "kernel/packed/engine.hpp"

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

inline Vector column_values(const double* from, const Column& column) {
  switch (column.kind) {
    case Column::Broadcast: return all(from[column.source]);
    case Column::Contiguous: return load(from + column.source);
    case Column::Reversed: return __builtin_shuffle(load(from + column.source - (lanes - 1)), Places{7, 6, 5, 4, 3, 2, 1, 0});
    default: return gather(from, column.sources.data());
  }
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

/// Σ_{j=0..N} a_j b_{N−j}, from the middle outward in four chains. Written out for each N, so that no loop ends in a branch that the processor
/// did not foresee.
template <int N>
Vector convolution_of(const double* a, const double* b, std::ptrdiff_t stride) {
  Vector sums[4] = {all(0), all(0), all(0), all(0)};
  constexpr int middle = N / 2;
#pragma GCC unroll 64
  for (int i = 0; i <= N; ++i) {
    const int j = i % 2 == 0 ? middle - i / 2 : middle + (i + 1) / 2;
    if (j < 0 || j > N) continue;
    sums[i % 4] += load(a + j * stride) * load(b + (N - j) * stride);
  }
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

inline Vector long_convolution(const double* a, const double* b, int n, std::ptrdiff_t stride) {
  Vector even = all(0), odd = all(0);
  for (int j = 0; j < n; j += 2) {
    even += load(a + j * stride) * load(b + (n - j) * stride);
    odd += load(a + (j + 1) * stride) * load(b + (n - j - 1) * stride);
  }
  if (n % 2 == 0) even += load(a + n * stride) * load(b);
  return even + odd;
}

using Convolution = Vector (*)(const double*, const double*, std::ptrdiff_t);
const Convolution convolutions[] = {
    convolution_of<0>,  convolution_of<1>,  convolution_of<2>,  convolution_of<3>,  convolution_of<4>,  convolution_of<5>,
    convolution_of<6>,  convolution_of<7>,  convolution_of<8>,  convolution_of<9>,  convolution_of<10>, convolution_of<11>,
    convolution_of<12>, convolution_of<13>, convolution_of<14>, convolution_of<15>, convolution_of<16>, convolution_of<17>,
    convolution_of<18>, convolution_of<19>, convolution_of<20>, convolution_of<21>, convolution_of<22>, convolution_of<23>};
constexpr int most_written_out = 23;

/// Σ_{j=0..n} a_j b_{n−j}
inline Vector convolution(const double* a, const double* b, int n, std::ptrdiff_t stride) {
  return n <= most_written_out ? convolutions[n](a, b, stride) : long_convolution(a, b, n, stride);
}

template <int W>
void sine_cosine_of(const double* x, double* out) {
  const jet::SineCosine<W> value(jet::Vec<W>::load(x));
  value.sine.store(out), value.cosine.store(out + lanes);
}

void sine_cosine(const double* x, double* out, int count) {
  return count <= 1 ? sine_cosine_of<1>(x, out) : count <= 2 ? sine_cosine_of<2>(x, out)
         : count <= 4 ? sine_cosine_of<4>(x, out) : sine_cosine_of<8>(x, out);
}

class Stage {
 public:
  Stage(const Tables& tables, int stage) : t_(tables), stride_(static_cast<std::ptrdiff_t>(tables.stride)), stage_(stage) {}

  void run() {
    for (std::size_t i = 0; i < t_.pack_count; ++i) {
      const Pack& pack = t_.packs[i];
      k_ = stage_ + 2 - pack.lag;
      if (k_ < 0) continue;
      row_ = t_.rows + k_ * stride_;
      switch (pack.kind) {
        case Pack::Sum: save(row_ + pack.out, products(pack, columns(pack))); break;
        case Pack::Scan: save(row_ + pack.out, running_sum(columns(pack)) + all(row_[pack.carry])); break;
        case Pack::ScanDown: save(row_ + pack.out, running_sum_down(columns(pack)) + all(row_[pack.carry])); break;
        case Pack::Integral: integral(pack); break;
        case Pack::Quotient: quotient(pack); break;
        case Pack::SquareRoot: square_root(pack); break;
        case Pack::Scalar: t_.scalar.value(t_.scalar.context, pack.instruction, k_); break;
      }
    }
  }

  void renew() {
    for (std::size_t i = 0; i < t_.block_count; ++i) {
      const Block& block = t_.blocks[i];
      const int order = stage_ + 2 - block.lag;
      if (!block.direct && order >= 0) copy(block, order);
    }
  }

 private:
  const double* coefficients(std::uint32_t first) const { return t_.coefficients + first; }
  const double* cells(std::uint32_t block) const { return t_.rows + t_.blocks[block].first; }

  void copy(const Block& block, int order) const {
    double* const row = t_.rows + order * stride_;
    const Vector values = block.is_range ? load(row + block.slots[0]) : gather(row, block.slots.data());
    save(row + block.first, block.weighted ? values * all(order) : values);
  }

  /// An operand of the order that is being computed is not final, and its copy not there.
  void bring(std::uint32_t index) const {
    const Block& block = t_.blocks[index];
    const int order = stage_ + 2 - block.lag;
    if (!block.direct && order >= 0 && order <= k_) copy(block, order);
  }

  Vector columns(const Pack& pack) const {
    Vector plain = all(0), once = all(0), twice = all(0);
    for (std::uint32_t c = pack.first_column; c < pack.last_column; ++c) {
      const Column& column = t_.columns[c];
      const Vector term = load(coefficients(column.coefficients)) * column_values(row_ + column.shift * stride_, column);
      if (column.shift == 0) plain += term;
      else if (column.shift == 1) once += term;
      else twice += term;
    }
    return plain + (all(k_ + 1.0) * once + all((k_ + 1.0) * (k_ + 2.0)) * twice);
  }

  Vector products(const Pack& pack, Vector result) const {
    for (std::uint32_t p = pack.first_product; p < pack.last_product; ++p) {
      const ProductTerm& term = t_.products[p];
      bring(term.a);
      if (term.b != term.a) bring(term.b);
      const double *a = cells(term.a), *b = cells(term.b);
      result += load(coefficients(term.coefficients)) *
                (term.a == term.b ? self(a, 0) : convolution(a, b, k_, stride_));
    }
    return result;
  }

  /// Σ_{j=first..k−first} a_j a_{k−j}, each pair once.
  Vector self(const double* a, int first) const {
    Vector sum = all(0);
    for (int j = (k_ + 1) / 2 - 1; j >= first; --j) sum += load(a + j * stride_) * load(a + (k_ - j) * stride_);
    sum += sum;
    if (k_ % 2 == 0 && k_ / 2 >= first) {
      const Vector middle = load(a + k_ / 2 * stride_);
      sum += middle * middle;
    }
    return sum;
  }

  void integral(const Pack& pack) const {
    if (k_ == 0) return functions(pack);
    bring(pack.a);
    bring(pack.b);
    const Vector sum = convolution(cells(pack.a) + stride_, cells(pack.b), k_ - 1, stride_);
    save(row_ + pack.out, load(coefficients(pack.coefficients)) * sum / all(k_));
  }

  void functions(const Pack& pack) const {
    if (pack.pairs == no_block) {
      for (std::uint32_t f = pack.first_function; f < pack.last_function; ++f) t_.scalar.value(t_.scalar.context, t_.functions[f], 0);
      return;
    }
    const int count = static_cast<int>(pack.last_function - pack.first_function);
    if (count == 0) return;  // the cosines of the pack before
    alignas(64) double u[lanes], values[2 * lanes];
    const Block& block = t_.blocks[pack.a];
    for (unsigned i = 0; i < lanes; ++i) u[i] = row_[block.slots[i]];
    sine_cosine(u, values, count);
    for (unsigned i = 0; i < static_cast<unsigned>(count); ++i) row_[pack.out + i] = values[i], row_[pack.pairs + i] = values[lanes + i];
  }

  void quotient(const Pack& pack) const {
    bring(pack.a), bring(pack.b);
    const Vector a = load(row_ + t_.blocks[pack.a].first);
    const double *b = cells(pack.b), *y = cells(pack.y);
    const Vector sum = k_ == 0 ? all(0) : convolution(b + stride_, y, k_ - 1, stride_);
    save(row_ + pack.out, (a - sum) / load(b));
  }

  void square_root(const Pack& pack) const {
    bring(pack.a);
    const Vector u = load(row_ + t_.blocks[pack.a].first);
    const double* const y = cells(pack.y);
    Vector result;
    if (k_ == 0)
      for (unsigned lane = 0; lane < lanes; ++lane) result[lane] = __builtin_sqrt(u[lane]);
    else
      result = (u - self(y, 1)) / (load(y) + load(y));
    save(row_ + pack.out, result);
  }

  const Tables& t_;
  std::ptrdiff_t stride_;
  int stage_, k_ = 0;
  double* row_ = nullptr;
};

void run_stage(const Tables& tables, int stage) { Stage(tables, stage).run(); }
void renew_blocks(const Tables& tables, int stage) { Stage(tables, stage).renew(); }

/// As the reference: the highest derivative of q in a slot of lag ℓ enters through operands of lag ℓ alone.
class Tangents {
 public:
  Tangents(const Tables& tables, double* tangent) : t_(tables), tangent_(tangent) {}

  void run() const {
    for (std::size_t i = 0; i < t_.pack_count; ++i) {
      const Pack& pack = t_.packs[i];
      switch (pack.kind) {
        case Pack::Sum: save(tangent_ + pack.out, products(pack, columns(pack))); break;
        case Pack::Scan: save(tangent_ + pack.out, running_sum(columns(pack)) + all(tangent_[pack.carry])); break;
        case Pack::ScanDown: save(tangent_ + pack.out, running_sum_down(columns(pack)) + all(tangent_[pack.carry])); break;
        case Pack::Integral: integral(pack); break;
        case Pack::Quotient: quotient(pack); break;
        case Pack::SquareRoot: save(tangent_ + pack.out, of(pack, pack.a) / (load(value(pack.y)) + load(value(pack.y)))); break;
        case Pack::Scalar: t_.scalar.tangent(t_.scalar.context, pack.instruction, tangent_); break;
      }
    }
  }

 private:
  const double* value(std::uint32_t block) const { return t_.rows + t_.blocks[block].first; }
  Vector value_of(std::uint32_t index) const {
    const Block& block = t_.blocks[index];
    return block.direct ? load(t_.rows + block.first) : gather(t_.rows, block.slots.data());
  }
  /// The tangents of a block's slots where they pass, else 0.
  Vector of(const Pack& pack, std::uint32_t index) const {
    const Block& block = t_.blocks[index];
    if (block.lag != pack.lag) return all(0);
    return block.direct ? load(tangent_ + block.first) : gather(tangent_, block.slots.data());
  }

  Vector columns(const Pack& pack) const {
    Vector result = all(0);
    for (std::uint32_t c = pack.first_column; c < pack.last_column; ++c)
      if (const Column& column = t_.columns[c]; column.passes_tangent)
        result += load(t_.coefficients + column.coefficients) * column_values(tangent_, column);
    return result;
  }

  Vector products(const Pack& pack, Vector result) const {
    for (std::uint32_t p = pack.first_product; p < pack.last_product; ++p) {
      const ProductTerm& term = t_.products[p];
      const Vector change = of(pack, term.a) * value_of(term.b) + value_of(term.a) * of(pack, term.b);
      result += load(t_.coefficients + term.coefficients) * change;
    }
    return result;
  }

  void integral(const Pack& pack) const {
    save(tangent_ + pack.out, load(t_.coefficients + pack.coefficients) * value_of(pack.b) * of(pack, pack.a));
  }

  void quotient(const Pack& pack) const {
    const Vector y = value_of(pack.y);
    save(tangent_ + pack.out, (of(pack, pack.a) - y * of(pack, pack.b)) / value_of(pack.b));
  }

  const Tables& t_;
  double* tangent_;
};

void tangents(const Tables& tables, double* tangent) { Tangents(tables, tangent).run(); }

void combine(double* out, const double* columns, std::size_t stride, const double* factors, std::size_t count, std::size_t size) {
  for (std::size_t i = 0; i < size; i += lanes) {
    Vector even = load(out + i), odd = all(0);
    std::size_t d = 0;
    for (; d + 1 < count; d += 2) {
      even += all(factors[d]) * load(columns + d * stride + i);
      odd += all(factors[d + 1]) * load(columns + (d + 1) * stride + i);
    }
    if (d < count) even += all(factors[d]) * load(columns + d * stride + i);
    save(out + i, even + odd);
  }
}

/// Even and odd powers apart, each by Horner's rule, so that half as many operations wait for each other.
void increments(const double* first, std::size_t stride, std::size_t count, int degree, double tau, double* dq, double* dv) {
  const auto step = static_cast<std::ptrdiff_t>(stride);
  const Vector t = all(tau), square = t * t;
  for (std::size_t i = 0; i < count; i += lanes) {
    Vector q_even = all(0), q_odd = all(0), v_even = all(0), v_odd = all(0);
    int k = degree;
    const double* c = first + k * step + static_cast<std::ptrdiff_t>(i);
    if (k % 2 == 1) q_odd = load(c), v_odd = q_odd * all(k), --k, c -= step;
    for (; k > 2; k -= 2, c -= 2 * step) {
      const Vector even = load(c), odd = load(c - step);
      q_even = q_even * square + even, v_even = v_even * square + even * all(k);
      q_odd = q_odd * square + odd, v_odd = v_odd * square + odd * all(k - 1);
    }
    const Vector second = load(c);
    q_even = q_even * square + second, v_even = v_even * square + second * all(2);
    save(dq + i, (q_even + q_odd * t) * t);
    save(dv + i, (v_even + v_odd * t) * t);
  }
}

inline Vector larger(Vector x, Vector y) { return x > y ? x : y; }
inline Vector absolute(Vector x) { return x < 0 ? -x : x; }

const Vector lane_numbers = {0, 1, 2, 3, 4, 5, 6, 7};

inline double largest_lane(Vector v, std::size_t count) {
  const auto fold = [&v](Places places) {
    const Vector other = __builtin_shuffle(v, places);
    v = larger(v, other);
  };
  if (count > 4) fold(Places{4, 5, 6, 7, 0, 1, 2, 3});
  if (count > 2) fold(Places{2, 3, 0, 1, 6, 7, 4, 5});
  if (count > 1) fold(Places{1, 0, 3, 2, 5, 4, 7, 6});
  return v[0];
}

bool decay(const double* first, std::size_t stride, std::size_t count, int order, int lowest, double h, double* largest) {
  const auto step = static_cast<std::ptrdiff_t>(stride);
  constexpr int most = 8;
  Vector ratio[most];
  for (int k = order; k >= lowest; --k) ratio[order - k] = all(0);
  for (std::size_t i = 0; i < count; i += lanes) {
    const double* const c = first + i;
    const auto velocity = [&](int k) { return absolute(load(c + (k + 1) * step)) * all(k + 1); };
    Vector size = all(0x1p-52 / h) * absolute(load(c));
    double power = 1;
    for (int k = 0; k <= 3 && k <= order - 2; ++k, power *= h) size = larger(size, velocity(k) * all(power));
    const Vector inverse = all(1) / (lane_numbers < all(static_cast<double>(count - i)) ? size : all(1));
    for (int k = order; k >= lowest; --k) {
      const Vector last = velocity(k);
      const Vector share = last * inverse;  // infinite where the size is 0 and the velocity is not
      ratio[order - k] = larger(ratio[order - k], share == share ? share : all(0));
    }
  }
  bool defined = true;
  for (int k = order; k >= lowest; --k) {
    const double value = largest_lane(ratio[order - k], count);
    defined = defined && value < __builtin_huge_val();
    largest[order - k] = value;
  }
  return defined;
}

}  // namespace

extern const Engine engine;
const Engine engine{MAUP_ENGINE_NAME, run_stage, renew_blocks, tangents, sine_cosine, combine, increments, decay};

}  // namespace maupertuis::packed::MAUP_ENGINE
