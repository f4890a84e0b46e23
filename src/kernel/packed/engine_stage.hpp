// Part of engine_code.hpp: every pack at the order that belongs to a stage.
namespace maupertuis::packed::MAUP_ENGINE {
namespace {

template <int W>
void sine_cosine_of(const double* x, double* out) {
  const jet::SineCosine<W> value(jet::Vec<W>::load(x));
  value.sine.store(out), value.cosine.store(out + lanes);
}

void sine_cosine(const double* x, double* out, int count) {
  return count <= 1 ? sine_cosine_of<1>(x, out) : count <= 2 ? sine_cosine_of<2>(x, out)
         : count <= 4 ? sine_cosine_of<4>(x, out) : sine_cosine_of<8>(x, out);
}

/// What packs of a stage have in common.
struct Stage {
  Stage(const Tables& tables, int number)
      : t(tables), stage(number), late(number > first_late_stage), position((number - 1) % rolled_group * static_cast<int>(lanes)),
        newest(tables.orders + (number + 2)) {}

  /// Of slots of that lag; not below 0.
  const Order& order_of(int lag) const { return *(newest - lag); }
  bool has_order_of(int lag) const { return stage + 2 >= lag; }

  const Tables& t;
  int stage;
  bool late;                             // sums made ahead are without what the stage before has found
  std::ptrdiff_t position;               // of sums made ahead for this stage
  const Order* newest;                   // of lag 0
};

// ------------------------------------------------------------------------------------------------------------- copies

inline Vector permuted(const double* row, const Copy& copy) {
#ifdef __AVX512F__
  return __builtin_shuffle(load(row + copy.first), load(row + copy.second), *reinterpret_cast<const UnalignedPlaces*>(copy.places.data()));
#else
  return gather(row, copy.slots);
#endif
}
[[gnu::noinline]] Vector gathered(const double* row, const Copy& copy) { return gather(row, copy.slots); }

inline void make(const Stage& s, const Copy& copy) {
  double* const row = s.order_of(copy.lag).row;
  const Vector values = copy.kind == Copy::Range ? load(row + copy.first) : copy.kind == Copy::TwoVectors ? permuted(row, copy) : gathered(row, copy);
  save(row + copy.to, copy.weighted ? values * all(s.order_of(copy.lag).number) : values);
}

// ------------------------------------------------------------------------------------------------------------ columns

[[gnu::noinline]] Vector run_of_columns(const ReadyRun& run, const double* row) {
  switch (run.kind) {
    case Column::Broadcast: return columns_of_kind<Column::Broadcast>(run, row);
    case Column::Contiguous: return columns_of_kind<Column::Contiguous>(run, row);
    case Column::Reversed: return columns_of_kind<Column::Reversed>(run, row);
    case Column::Gather: break;
  }
  return columns_of_kind<Column::Gather>(run, row);
}

/// d/dt multiplies by k + 1.
inline Vector columns(const Stage& s, const ReadyPack& pack) {
  Vector sum = all(0);
  const Order& order = s.order_of(pack.lag);
  for (const ReadyRun* run = s.stage > 0 ? pack.later_runs : pack.runs; run != pack.last_run; ++run) {
    const Vector part = run->neighbours ? columns_of_neighbours(*run, order.row) : run_of_columns(*run, order.row);
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

[[gnu::noinline]] Vector product(const Stage& s, const ReadyProduct& term, int k) {
  return term.a == term.b ? square(s, term.a, k, 0) : convolution(term.a, term.b, k, static_cast<std::ptrdiff_t>(s.t.stride));
}

/// Σ_{j=1..k} a_j b_{k−j}
[[gnu::noinline]] Vector without_first(const Stage& s, const double* a, const double* b, int k) {
  const auto stride = static_cast<std::ptrdiff_t>(s.t.stride);
  return k == 0 ? all(0) : convolution(a + stride, b, k - 1, stride);
}

/// The convolution of a sum made ahead with those ends that were not there yet.
inline Vector completed(const Stage& s, const ReadyProduct& term, std::ptrdiff_t offset) {
  Vector sum = load(term.sum + s.position);
  for (const EndTerm* end = s.late ? term.ends : term.new_ends; end != term.last_end; ++end) sum += load(end->operand + offset) * load(end->factor);
  return sum;
}

// -------------------------------------------------------------------------------------------------------------- packs

/// Runs a pack; returns the last one that is done with it.
using RunPack = const ReadyPack* (*)(const Stage&, const ReadyPack*);

/// `ByAhead`: by sums made ahead, as far as they are: always, but for operands of t alone that are ahead of q̈.
template <bool ByAhead>
bool has_sum(const ReadyProduct& term) { return ByAhead && term.sum; }

template <bool ByAhead>
const ReadyPack* run_sum(const Stage& s, const ReadyPack* pack) {
  const Order& order = s.order_of(pack->lag);
  Vector result = columns(s, *pack);
  for (const ReadyProduct* term = pack->products; term != pack->last_product; ++term)
    result += load(term->coefficients) * (has_sum<ByAhead>(*term) ? completed(s, *term, order.offset) : product(s, *term, order.number));
  save(order.row + pack->out, result);
  return pack;
}

const ReadyPack* run_neighbours(const Stage& s, const ReadyPack* pack) {
  const ReadyRun& run = *pack->later_runs;
  const Order& order = s.order_of(pack->lag);
  save(order.row + pack->out, columns_of_neighbours(run, order.row) * all(order.shift_factors[run.shift]));
  return pack;
}

const ReadyPack* run_products(const Stage& s, const ReadyPack* pack) {
  const Order& order = s.order_of(pack->lag);
  Vector result = all(0);
  for (const ReadyProduct* term = pack->products; term != pack->last_product; ++term)
    result += load(term->coefficients) * completed(s, *term, order.offset);
  save(order.row + pack->out, result);
  return pack;
}

const ReadyPack* run_scan(const Stage& s, const ReadyPack* pack) {
  double* const row = s.order_of(pack->lag).row;
  const Vector terms = columns(s, *pack);
  save(row + pack->out, (pack->kind == Pack::Scan ? running_sum(terms) : running_sum_down(terms)) + carry_of(pack->carry, row));
  return pack;
}

/// All of a running sum.
const ReadyPack* run_strands(const Stage& s, const ReadyPack* pack) {
  double* const row = s.order_of(pack->lag).row;
  Vector sum = all(0);
  for (; pack->kind == Pack::Strand; ++pack) {
    sum += columns(s, *pack);
    save(row + pack->out, sum);
  }
  const Pack& join = *pack->pack;
  join_strands(join, sum, row, join.kind == Pack::Join ? before_lanes : before_lanes_down);
  return pack;
}

[[gnu::noinline]] void functions(const Tables& t, const Pack& pack) {
  if (pack.pairs == no_block) {
    for (std::uint32_t f = pack.first_function; f < pack.last_function; ++f) t.scalar.value(t.scalar.context, t.functions[f], 0);
    return;
  }
  const int count = static_cast<int>(pack.last_function - pack.first_function);
  if (count == 0) return;  // the cosines of the pack before
  alignas(64) double u[lanes], values[2 * lanes];
  const Block& block = t.blocks[pack.a];
  for (unsigned i = 0; i < lanes; ++i) u[i] = t.rows[block.slots[i]];
  sine_cosine(u, values, count);
  for (unsigned i = 0; i < static_cast<unsigned>(count); ++i) t.rows[pack.out + i] = values[i], t.rows[pack.pairs + i] = values[lanes + i];
}

/// 1/k comes with its residue: a rounded reciprocal would err the same way in every step.
inline void save_integral(const Order& order, const ReadyPack& pack, Vector sum) {
  sum *= load(pack.coefficients);
  save(order.row + pack.out, sum * all(order.reciprocal.rest) + sum * all(order.reciprocal.leading));
}

const ReadyPack* run_integral(const Stage& s, const ReadyPack* pack) {
  const Order& order = s.order_of(pack->lag);
  if (order.number == 0) functions(s.t, *pack->pack);
  else save_integral(order, *pack, without_first(s, pack->a, pack->b, order.number));
  return pack;
}

const ReadyPack* run_integral_by_sum(const Stage& s, const ReadyPack* pack) {
  const Order& order = s.order_of(pack->lag);
  save_integral(order, *pack, completed(s, *pack->products, order.offset));
  return pack;
}

template <bool ByAhead>
const ReadyPack* run_quotient(const Stage& s, const ReadyPack* pack) {
  const Order& order = s.order_of(pack->lag);
  const Vector sum = has_sum<ByAhead>(*pack->products) ? completed(s, *pack->products, order.offset) : without_first(s, pack->b, pack->y, order.number);
  save(order.row + pack->out, (load(pack->a + order.offset) - sum) / load(pack->b));
  return pack;
}

template <bool ByAhead>
const ReadyPack* run_square_root(const Stage& s, const ReadyPack* pack) {
  const Order& order = s.order_of(pack->lag);
  const Vector u = load(pack->a + order.offset);
  const double* const y = pack->y;
  Vector result;
  if (order.number == 0)
    for (unsigned lane = 0; lane < lanes; ++lane) result[lane] = __builtin_sqrt(u[lane]);
  else
    result = (u - (has_sum<ByAhead>(*pack->products) ? completed(s, *pack->products, order.offset) : square(s, y, order.number, 1))) / (load(y) + load(y));
  save(order.row + pack->out, result);
  return pack;
}

const ReadyPack* run_scalar(const Stage& s, const ReadyPack* pack) {
  s.t.scalar.value(s.t.scalar.context, pack->pack->instruction, s.order_of(pack->lag).number);
  return pack;
}

/// By Pack::Kind, joins being done with their strands; with sums made ahead by Way.
constexpr RunPack by_itself[] = {run_sum<false>, run_scan, run_scan, run_strands, nullptr, nullptr, run_integral, run_quotient<false>, run_square_root<false>, run_scalar};
constexpr RunPack by_way[] = {run_sum<true>,      run_scan,   run_scan,       run_strands,  nullptr,           nullptr, run_integral, run_quotient<true>,
                              run_square_root<true>, run_scalar, run_neighbours, run_products, run_integral_by_sum};

/// Stages up to 0, and all where no sums are made ahead.
void run_by_itself(const Stage& s) {
  const ReadyPack* const last = s.t.ready + s.t.pack_count;
  for (const ReadyPack* pack = s.t.ready; pack != last; ++pack) {
    if (!s.has_order_of(pack->lag)) continue;
    for (const Copy* copy = pack->copies; copy != pack->last_copy; ++copy)
      if (s.has_order_of(copy->lag)) make(s, *copy);
    pack = by_itself[pack->kind](s, pack);
  }
}

/// Later stages.
inline void run_by_sums(const Stage& s) {
  const ReadyPack* const last = s.t.ready + s.t.pack_count;
  for (const ReadyPack* pack = s.t.ready; pack != last; ++pack) {
    for (const Copy* copy = pack->copies; copy != pack->last_copy_ahead; ++copy) make(s, *copy);
    pack = by_way[pack->way](s, pack);
  }
}

inline void run_packs(const Stage& s) {
  if (s.t.has_sums && s.stage > 0) run_by_sums(s);
  else run_by_itself(s);
}

void run_stage(const Tables& tables, int stage) {
  const Stage s(tables, stage);
  if (stage > 0)
    for (std::size_t i = 0; i < tables.unknowns; i += lanes) save(s.order_of(0).row + i, all(0));
  run_packs(s);
}

inline void renew(const Stage& s) {
  const Copy* const last = s.t.copies + s.t.copy_count;
  for (const Copy* copy = s.t.copies; copy != last; ++copy)
    if (s.has_order_of(copy->lag)) make(s, *copy);
}
void renew_blocks(const Tables& tables, int stage) { renew(Stage(tables, stage)); }

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE
