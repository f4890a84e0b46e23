// Part of engine_code.hpp: every pack at the order that belongs to a stage.
namespace maupertuis::packed::MAUP_ENGINE {
namespace {

template <int W>
void sine_cosine_of(const double* x, double* out) {
  const series::SineCosine<W> value(series::Vec<W>::load(x));
  value.sine.store(out), value.cosine.store(out + lanes);
}

void sine_cosine(const double* x, double* out, int count) {
  return count <= 1   ? sine_cosine_of<1>(x, out)
         : count <= 2 ? sine_cosine_of<2>(x, out)
         : count <= 4 ? sine_cosine_of<4>(x, out)
                      : sine_cosine_of<8>(x, out);
}

/// What packs of a stage have in common.
struct Stage {
  Stage(const Tables& tables, int number)
      : t(tables),
        stage(number),
        newest(tables.orders + (number + 2)) {}

  /// Of slots of that lag; not below 0.
  const Order& order_of(int lag) const { return *(newest - lag); }
  bool has_order_of(int lag) const { return stage + 2 >= lag; }
  /// Of a block at order 0.
  const double* cells(std::uint32_t block) const { return t.rows + t.blocks[block].first; }

  const Tables& t;
  int stage;
  const Order* newest;  // of lag 0
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
    case Column::Broadcast:
      return columns_of_kind<Column::Broadcast>(columns, count, coefficients, from);
    case Column::Contiguous:
      return columns_of_kind<Column::Contiguous>(columns, count, coefficients, from);
    case Column::Reversed:
      return columns_of_kind<Column::Reversed>(columns, count, coefficients, from);
    case Column::Gather:
      break;
  }
  return columns_of_kind<Column::Gather>(columns, count, coefficients, from);
}

/// d/dt multiplies by k + 1.
inline Vector columns_of(const Stage& s, const ColumnRun& run, const Order& order) {
  const double* const from = order.row + run.shift * s.t.stride;
  const double* const coefficients = s.t.coefficients + run.coefficients;
  return (run.neighbours ? columns_of_neighbours(from + run.source, run.last - run.first, coefficients)
                         : run_of_columns(s.t, run, coefficients, from)) *
         all(order.shift_factors[run.shift]);
}

inline Vector columns(const Stage& s, const Pack& pack, const Order& order) {
  Vector sum = all(0);
  const std::uint32_t first = s.stage > 0 ? pack.first_later_run : pack.first_run;
  for (const ColumnRun *run = s.t.runs + first, *last = s.t.runs + pack.last_run; run != last; ++run)
    sum += columns_of(s, *run, order);
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

[[gnu::noinline]] Vector product(const Stage& s, const Pack& pack, const Convolution& c, int k) {
  bring(s, pack, c.a), bring(s, pack, c.b);
  const double *const a = s.t.rows + c.first_a, *const b = s.t.rows + c.first_b;
  return a == b ? square(s, a, k, 0) : convolution(a, b, k, static_cast<std::ptrdiff_t>(s.t.stride));
}

/// Σ_{j=1..k} a_j b_{k−j}
[[gnu::noinline]] Vector without_first(const Stage& s, const Convolution& c, int k) {
  const auto stride = static_cast<std::ptrdiff_t>(s.t.stride);
  return k == 0 ? all(0) : convolution(s.t.rows + c.first_a + stride, s.t.rows + c.first_b, k - 1, stride);
}

// -------------------------------------------------------------------------------------------------------------- packs

/// Runs a pack; returns the last one that is done with it.
using RunPack = const Pack* (*)(const Stage&, const Pack*);

const Pack* run_sum(const Stage& s, const Pack* pack) {
  const Order& order = s.order_of(pack->lag);
  Vector result = columns(s, *pack, order);
  const ProductTerm* term = s.t.products + pack->first_product;
  const Convolution* const last = s.t.convolutions + pack->last_convolution;
  for (const Convolution* c = s.t.convolutions + pack->first_convolution; c != last; ++c, ++term) {
    const Vector sum = product(s, *pack, *c, order.number);
    result += load(s.t.coefficients + term->coefficients) * sum;
  }
  save(order.row + pack->out, result);
  return pack;
}

const Pack* run_neighbours(const Stage& s, const Pack* pack) {
  const Order& order = s.order_of(pack->lag);
  const ColumnRun& run = s.t.runs[pack->first_later_run];
  const Vector sum = columns_of_neighbours(order.row + run.shift * s.t.stride + run.source, run.last - run.first,
                                           s.t.coefficients + run.coefficients);
  save(order.row + pack->out, sum * all(order.shift_factors[run.shift]));
  return pack;
}

template <Vector (*running)(Vector)>
const Pack* run_scan(const Stage& s, const Pack* pack) {
  const Order& order = s.order_of(pack->lag);
  save(order.row + pack->out, running(columns(s, *pack, order)) + carry_of(pack->carry, order.row));
  return pack;
}

/// All of a running sum in eight parts.
const Pack* run_strands(const Stage& s, const Pack* pack) {
  const Order& order = s.order_of(pack->lag);
  Vector sum = all(0);
  for (; pack->kind == Pack::Strand; ++pack) save(order.row + pack->out, sum += columns(s, *pack, order));
  join_strands(*pack, sum, order.row, pack->kind == Pack::Join ? before_lanes : before_lanes_down);
  return pack;
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

/// 1/k comes with its residue: a rounded reciprocal would err the same way in every step.
inline void save_integral(const Stage& s, const Pack& pack, const Order& order, Vector sum) {
  sum *= load(s.t.coefficients + pack.coefficients);
  save(order.row + pack.out, sum * all(order.reciprocal.rest) + sum * all(order.reciprocal.leading));
}

/// The integral at order k reads w up to order k − 1, where it is final.
const Pack* run_integral(const Stage& s, const Pack* pack) {
  const Order& order = s.order_of(pack->lag);
  bring(s, *pack, pack->a);
  if (order.number == 0)
    functions(s.t, *pack);
  else
    save_integral(s, *pack, order, without_first(s, s.t.convolutions[pack->first_convolution], order.number));
  return pack;
}

const Pack* run_quotient(const Stage& s, const Pack* pack) {
  const Order& order = s.order_of(pack->lag);
  const Convolution& c = s.t.convolutions[pack->first_convolution];
  bring(s, *pack, pack->a), bring(s, *pack, pack->b);
  const Vector sum = without_first(s, c, order.number);
  save(order.row + pack->out, (load(s.cells(pack->a) + order.offset) - sum) / load(s.cells(pack->b)));
  return pack;
}

const Pack* run_square_root(const Stage& s, const Pack* pack) {
  const Order& order = s.order_of(pack->lag);
  bring(s, *pack, pack->a);
  Vector u = load(s.cells(pack->a) + order.offset);
  const double* const y = s.cells(pack->y);
  if (order.number > 0) {
    const Vector sum = square(s, y, order.number, 1);
    u = (u - sum) / (load(y) + load(y));
  } else {
    for (unsigned lane = 0; lane < lanes; ++lane) u[lane] = __builtin_sqrt(u[lane]);
  }
  save(order.row + pack->out, u);
  return pack;
}

const Pack* run_scalar(const Stage& s, const Pack* pack) {
  s.t.scalar.value(s.t.scalar.context, pack->instruction, s.order_of(pack->lag).number);
  return pack;
}

/// By Pack::Kind, joins being done with their strands.
constexpr RunPack run_of[] = {run_sum,
                              run_scan<running_sum>,
                              run_scan<running_sum_down>,
                              run_strands,
                              nullptr,
                              nullptr,
                              run_integral,
                              run_quotient,
                              run_square_root,
                              run_scalar};

/// Up to stage 0.
void run_first_packs(const Stage& s) {
  for (const Pack *pack = s.t.packs, *last = s.t.packs + s.t.pack_count; pack != last; ++pack)
    if (s.has_order_of(pack->lag)) pack = run_of[pack->kind](s, pack);
}

inline void run_packs(const Stage& s) {
  if (s.stage <= 0) return run_first_packs(s);
  const Pack *pack = s.t.packs, *const last = s.t.packs + s.t.pack_count;
  for (; pack != last; ++pack) pack = (pack->is_neighbours ? run_neighbours : run_of[pack->kind])(s, pack);
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
}
void renew_blocks(const Tables& tables, int stage) { renew(Stage(tables, stage)); }

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE
