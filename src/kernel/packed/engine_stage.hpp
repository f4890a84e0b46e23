// Part of engine_code.hpp: every pack at the order that belongs to a stage.
namespace maupertuis::packed::MAUP_ENGINE {
namespace {

template <int W>
void sine_cosine_of(const double* x, double* out) {
  const series::SineCosine<W> value(series::Vec<W>::load(x));
  value.sine.store(out), value.cosine.store(out + lanes);
}

void sine_cosine(const double* x, double* out, int count) {
  return count <= 1 ? sine_cosine_of<1>(x, out) : count <= 2 ? sine_cosine_of<2>(x, out)
         : count <= 4 ? sine_cosine_of<4>(x, out) : sine_cosine_of<8>(x, out);
}

/// What packs of a stage have in common.
struct Stage {
  Stage(const Tables& tables, int number)
      : t(tables), stage(number), by_sums(has_sums_ahead(number)), newest(tables.orders + (number + 2)) {}

  /// Of slots of that lag; not below 0.
  const Order& order_of(int lag) const { return *(newest - lag); }
  bool has_order_of(int lag) const { return stage + 2 >= lag; }
  /// Of a block at order 0.
  const double* cells(std::uint32_t block) const { return t.rows + t.blocks[block].first; }

  const Tables& t;
  int stage;
  bool by_sums;                          // that were made ahead
  const Order* newest;                   // of lag 0
};

// ------------------------------------------------------------------------------------------------------------- copies

[[gnu::noinline]] Vector gathered(const double* row, const Block& block) { return gather(row, block.slots.data()); }

/// One permutation, where the processor has it and two vectors hold all; eight loads else.
inline Vector values_at(const double* row, const Block& block) {
  if (block.is_range) return load(row + block.slots[0]);
#ifdef __AVX512F__
  if (block.in_two_vectors)
    return __builtin_shuffle(load(row + block.vectors[0]), load(row + block.vectors[1]), places_of(block));
#endif
  return gathered(row, block);
}

/// A block that is not direct: from slots of a row to its cells of the same row.
inline void copy(const Stage& s, const Block& block) {
  const Order& order = s.order_of(block.lag);
  const Vector values = values_at(order.row, block);
  save(order.row + block.first, block.weighted ? values * all(order.number) : values);
}

/// An operand at an order that is not final yet, or not there: its copy is not either.
inline void bring(const Stage& s, const Pack& pack, std::uint32_t index) {
  if (index == no_block) return;
  const Block& block = s.t.blocks[index];
  if (!block.direct && block.lag >= pack.lag && s.has_order_of(block.lag)) copy(s, block);
}

// ------------------------------------------------------------------------------------------------------------ columns

[[gnu::noinline]] Vector run_of_columns(const Tables& t, const ColumnRun& run, const double* coefficients,
                                        const double* from) {
  const Column* const columns = t.columns + run.first;
  const std::size_t count = run.last - run.first;
  switch (run.kind) {
    case Column::Broadcast: return columns_of_kind<Column::Broadcast>(columns, count, coefficients, from);
    case Column::Contiguous: return columns_of_kind<Column::Contiguous>(columns, count, coefficients, from);
    case Column::Reversed: return columns_of_kind<Column::Reversed>(columns, count, coefficients, from);
    case Column::Gather: break;
  }
  return columns_of_kind<Column::Gather>(columns, count, coefficients, from);
}

/// d/dt multiplies by k + 1.
inline Vector columns(const Stage& s, const Pack& pack) {
  Vector sum = all(0);
  const Order& order = s.order_of(pack.lag);
  const std::uint32_t first_run = s.stage > 0 ? pack.first_later_run : pack.first_run;
  for (const ColumnRun *run = s.t.runs + first_run, *last = s.t.runs + pack.last_run; run != last; ++run) {
    const Column& first = s.t.columns[run->first];
    const double* const from = order.row + run->shift * s.t.stride;
    const double* const coefficients = s.t.coefficients + first.coefficients;
    const Vector part = run->neighbours
                            ? columns_of_neighbours(from + first.source, run->last - run->first, coefficients)
                            : run_of_columns(s.t, *run, coefficients, from);
    sum += part * all(order.shift_factors[run->shift]);
  }
  return sum;
}

// ----------------------------------------------------------------------------------------------------------- products

/// Σ_{j=first..k−first} a_j a_{k−j}, each pair once.
Vector square(const Stage& s, const double* a, int k, int first) {
  const auto stride = static_cast<std::ptrdiff_t>(s.t.stride);
  Vector sum = all(0);
  for (int j = (k + 1) / 2 - 1; j >= first; --j) sum += load(a + j * stride) * load(a + (k - j) * stride);
  sum += sum;
  if (k % 2 == 0 && k / 2 >= first) {
    const Vector middle = load(a + k / 2 * stride);
    sum += middle * middle;
  }
  return sum;
}

inline Vector product(const Stage& s, const Convolution& c, int k) {
  const double *const a = s.t.rows + c.first_a, *const b = s.t.rows + c.first_b;
  return a == b ? square(s, a, k, 0) : convolution(a, b, k, static_cast<std::ptrdiff_t>(s.t.stride));
}

/// Σ_{j=1..k} a_j b_{k−j}
inline Vector without_first(const Stage& s, const Convolution& c, int k) {
  const auto stride = static_cast<std::ptrdiff_t>(s.t.stride);
  return k == 0 ? all(0) : convolution(s.t.rows + c.first_a + stride, s.t.rows + c.first_b, k - 1, stride);
}

inline bool goes_by_sum(const Stage& s, const Convolution& c) { return s.by_sums && c.goes_ahead; }

/// A convolution by the sum that was made ahead.
inline Vector completed(const Stage& s, const Convolution& c, int k) {
  if (c.copies_a) copy(s, s.t.blocks[c.a]);
  if (c.copies_b) copy(s, s.t.blocks[c.b]);
  return completed_sum(s.t, c, s.stage, k);
}

// -------------------------------------------------------------------------------------------------------------- packs

[[gnu::noinline]] Vector sum_of_pack(const Stage& s, const Pack& pack, const Order& order) {
  Vector result = columns(s, pack);
  const ProductTerm* term = s.t.products + pack.first_product;
  for (const Convolution *c = s.t.convolutions + pack.first_convolution, *last = s.t.convolutions + pack.last_convolution;
       c != last; ++c, ++term) {
    const Vector factor = load(s.t.coefficients + term->coefficients);
    if (goes_by_sum(s, *c)) {
      result += factor * completed(s, *c, order.number);
    } else {
      bring(s, pack, c->a), bring(s, pack, c->b);
      result += factor * product(s, *c, order.number);
    }
  }
  return result;
}

[[gnu::noinline]] void functions(const Tables& t, const Pack& pack) {
  if (pack.pairs == no_block) {
    for (std::uint32_t f = pack.first_function; f < pack.last_function; ++f)
      t.scalar.value(t.scalar.context, t.functions[f], 0);
    return;
  }
  const int count = static_cast<int>(pack.last_function - pack.first_function);
  if (count == 0) return;  // the cosines of the pack before
  alignas(64) double u[lanes], values[2 * lanes];
  const Block& block = t.blocks[pack.a];
  for (unsigned i = 0; i < lanes; ++i) u[i] = t.rows[block.slots[i]];
  sine_cosine(u, values, count);
  for (unsigned i = 0; i < static_cast<unsigned>(count); ++i)
    t.rows[pack.out + i] = values[i], t.rows[pack.pairs + i] = values[lanes + i];
}

/// 1/k comes with its residue: a rounded reciprocal would err the same way in every step. The integral at order k reads
/// w up to order k − 1, where it is final.
[[gnu::noinline]] void integral(const Stage& s, const Pack& pack, const Order& order) {
  const Convolution& c = s.t.convolutions[pack.first_convolution];
  const bool by_sum = goes_by_sum(s, c);
  if (!by_sum) bring(s, pack, pack.a);
  if (order.number == 0) return functions(s.t, pack);
  const Vector sum = (by_sum ? completed(s, c, order.number) : without_first(s, c, order.number)) *
                     load(s.t.coefficients + pack.coefficients);
  save(order.row + pack.out, sum * all(order.reciprocal.rest) + sum * all(order.reciprocal.leading));
}

[[gnu::noinline]] Vector quotient(const Stage& s, const Pack& pack, const Order& order) {
  const Convolution& c = s.t.convolutions[pack.first_convolution];
  bring(s, pack, pack.a), bring(s, pack, pack.b);
  const Vector sum = goes_by_sum(s, c) ? completed(s, c, order.number) : without_first(s, c, order.number);
  return (load(s.cells(pack.a) + order.offset) - sum) / load(s.cells(pack.b));
}

[[gnu::noinline]] Vector square_root(const Stage& s, const Pack& pack, const Order& order) {
  const Convolution& c = s.t.convolutions[pack.first_convolution];
  bring(s, pack, pack.a);
  Vector u = load(s.cells(pack.a) + order.offset);
  const double* const y = s.cells(pack.y);
  if (order.number > 0) {
    const Vector sum = goes_by_sum(s, c) ? completed(s, c, order.number) : square(s, y, order.number, 1);
    return (u - sum) / (load(y) + load(y));
  }
  for (unsigned lane = 0; lane < lanes; ++lane) u[lane] = __builtin_sqrt(u[lane]);
  return u;
}

inline void run_pack(const Stage& s, const Pack& pack) {
  const Order& order = s.order_of(pack.lag);
  double *const row = order.row, *const out = row + pack.out;
  switch (pack.kind) {
    case Pack::Sum:
      return save(out, pack.first_convolution == pack.last_convolution ? columns(s, pack) : sum_of_pack(s, pack, order));
    case Pack::Scan: return save(out, running_sum(columns(s, pack)) + carry_of(pack.carry, row));
    case Pack::ScanDown: return save(out, running_sum_down(columns(s, pack)) + carry_of(pack.carry, row));
    case Pack::Strand: return save(out, columns(s, pack) + (pack.carry == no_slot ? all(0) : load(row + pack.carry)));
    case Pack::Join: return join_strands(pack, load(row + pack.last_strand), row, before_lanes);
    case Pack::JoinDown: return join_strands(pack, load(row + pack.last_strand), row, before_lanes_down);
    case Pack::Integral: return integral(s, pack, order);
    case Pack::Quotient: return save(out, quotient(s, pack, order));
    case Pack::SquareRoot: return save(out, square_root(s, pack, order));
    case Pack::Scalar: return s.t.scalar.value(s.t.scalar.context, pack.instruction, order.number);
  }
}

inline void run_packs(const Stage& s) {
  for (const Pack *pack = s.t.packs, *last = s.t.packs + s.t.pack_count; pack != last; ++pack)
    if (s.has_order_of(pack->lag)) run_pack(s, *pack);
}

void run_stage(const Tables& tables, int stage) {
  const Stage s(tables, stage);
  if (stage > 0)
    for (std::size_t i = 0; i < tables.unknowns; i += lanes) save(s.order_of(0).row + i, all(0));
  run_packs(s);
}

inline void renew(const Stage& s) {
  for (const Block *block = s.t.blocks, *last = s.t.blocks + s.t.block_count; block != last; ++block)
    if (!block->direct && s.has_order_of(block->lag)) copy(s, *block);
  if (begins_sums_ahead(s.stage)) make_sums_ahead(s.t, s.stage);
}
void renew_blocks(const Tables& tables, int stage) { renew(Stage(tables, stage)); }

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE
