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

/// `ByAhead`: by sums that are there, as far as they are.
template <bool ByAhead>
class Stage {
 public:
  Stage(const Tables& tables, int stage)
      : t_(tables), stride_(static_cast<std::ptrdiff_t>(tables.stride)), stage_(stage),
        sums_(ByAhead ? tables.sums + (stage - 1) % rolled_group * static_cast<int>(lanes) : nullptr) {}

  void run() {
    for (std::size_t i = 0; i < t_.pack_count; ++i) {
      const ReadyPack& pack = t_.ready[i];
      k_ = stage_ + 2 - pack.lag;
      if (k_ < 0) continue;
      row_ = t_.rows + k_ * stride_;
      for (std::uint32_t c = pack.first_copy; c < pack.last_copy; ++c)
        if (const Copy& block = t_.brought[c]; !(ByAhead && block.of_coordinates)) copy(block);
      switch (pack.kind) {
        case Pack::Sum: save(row_ + pack.out, products(pack, columns(pack))); break;
        case Pack::Scan: save(row_ + pack.out, running_sum(columns(pack)) + carry_of(pack.carry, row_)); break;
        case Pack::ScanDown: save(row_ + pack.out, running_sum_down(columns(pack)) + carry_of(pack.carry, row_)); break;
        case Pack::Strand: i = strands(i); break;
        case Pack::Join: case Pack::JoinDown: break;  // with its strands
        case Pack::Integral: integral(pack); break;
        case Pack::Quotient: quotient(pack); break;
        case Pack::SquareRoot: square_root(pack); break;
        case Pack::Scalar: t_.scalar.value(t_.scalar.context, pack.pack->instruction, k_); break;
      }
    }
  }

  void renew() {
    for (std::size_t i = 0; i < t_.copy_count; ++i) copy(t_.copies[i]);
  }

 private:
  void copy(const Copy& block) const {
    const int order = stage_ + 2 - block.lag;
    if (order < 0) return;
    double* const row = t_.rows + order * stride_;
    const Vector values = block.kind == Copy::Range ? load(row + block.first)
                          : block.kind == Copy::TwoVectors ? permuted(row, block) : gather(row, block.slots);
    save(row + block.to, block.weighted ? values * all(order) : values);
  }

  static Vector permuted(const double* row, const Copy& block) {
#ifdef __AVX512F__
    return __builtin_shuffle(load(row + block.first), load(row + block.second), *reinterpret_cast<const UnalignedPlaces*>(block.places.data()));
#else
    return gather(row, block.slots);
#endif
  }

  Vector run_of_columns(const ReadyRun& run) const {
    switch (run.kind) {
      case Column::Broadcast: return columns_of_kind<Column::Broadcast>(run, row_);
      case Column::Contiguous: return columns_of_kind<Column::Contiguous>(run, row_);
      case Column::Reversed: return columns_of_kind<Column::Reversed>(run, row_);
      default: return columns_of_kind<Column::Gather>(run, row_);
    }
  }

  /// d/dt multiplies by k + 1.
  Vector shifted(const ReadyRun& run) const {
    const Vector part = run_of_columns(run);
    return run.shift == 0 ? part : all(run.shift == 1 ? k_ + 1.0 : (k_ + 1.0) * (k_ + 2.0)) * part;
  }

  /// Not inline: at each of its places it would leave too few registers (10 % of a step of 8 links).
  [[gnu::noinline]] Vector columns(const ReadyPack& pack) const {
    if (pack.first_run == pack.last_run) return all(0);
    Vector sum = shifted(t_.ready_runs[pack.first_run]);
    for (std::uint32_t r = pack.first_run + 1; r < pack.last_run; ++r) sum += shifted(t_.ready_runs[r]);
    return sum;
  }

  /// All of a running sum from pack `i` on, and the place of its end.
  std::size_t strands(std::size_t i) const {
    Vector sum = all(0);
    for (; t_.ready[i].kind == Pack::Strand; ++i) {
      sum += columns(t_.ready[i]);
      save(row_ + t_.ready[i].out, sum);
    }
    const Pack& join = *t_.ready[i].pack;
    join_strands(join, sum, row_, join.kind == Pack::Join ? before_lanes : before_lanes_down);
    return i;
  }

  Vector products(const ReadyPack& pack, Vector result) const {
    for (std::uint32_t p = pack.first_product; p < pack.last_product; ++p) {
      const ReadyProduct& term = t_.ready_products[p];
      const SumAhead& sum = t_.sums_ahead[pack.first_sum + p - pack.first_product];
      result += load(term.coefficients) * (has_sum(sum)       ? completed(sum, term.a, term.b, true, true)
                                           : term.a == term.b ? self(term.a, 0)
                                                              : convolution(term.a, term.b, k_, stride_));
    }
    return result;
  }

  /// Always, but for operands of t alone that are ahead of q̈.
  static bool has_sum(const SumAhead& sum) { return ByAhead && sum.number != SumAhead::no_sum; }

  /// The convolution of a sum with those ends that take part and were not there yet.
  Vector completed(const SumAhead& ahead, const double* a, const double* b, bool a_ends, bool b_ends) const {
    Vector sum = load(sums_ + ahead.number * (rolled_group * lanes));
    if (a_ends && ahead.a_is_new) sum += load(a + k_ * stride_) * load(b);
    if (b_ends && ahead.b_is_new) sum += load(b + k_ * stride_) * load(a);
    return sum;
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

  void integral(const ReadyPack& pack) const {
    if (k_ == 0) return functions(*pack.pack);
    const Reciprocal& inverse = t_.reciprocals[k_];
    const Vector c = load(pack.coefficients), leading = c * all(inverse.leading), rest = c * all(inverse.rest);
    const SumAhead& ahead = t_.sums_ahead[pack.first_sum];
    const Vector sum = has_sum(ahead) ? completed(ahead, pack.a, pack.b, true, false) : convolution(pack.a + stride_, pack.b, k_ - 1, stride_);
    save(row_ + pack.out, sum * rest + sum * leading);
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

  void quotient(const ReadyPack& pack) const {
    const Vector a = load(pack.a + k_ * stride_);
    const SumAhead& ahead = t_.sums_ahead[pack.first_sum];
    const Vector sum = has_sum(ahead) ? completed(ahead, pack.b, pack.y, true, false)
                       : k_ == 0      ? all(0)
                                      : convolution(pack.b + stride_, pack.y, k_ - 1, stride_);
    save(row_ + pack.out, (a - sum) / load(pack.b));
  }

  void square_root(const ReadyPack& pack) const {
    const Vector u = load(pack.a + k_ * stride_);
    const double* const y = pack.y;
    const SumAhead& ahead = t_.sums_ahead[pack.first_sum];
    Vector result;
    if (k_ == 0)
      for (unsigned lane = 0; lane < lanes; ++lane) result[lane] = __builtin_sqrt(u[lane]);
    else
      result = (u - (has_sum(ahead) ? completed(ahead, y, y, false, false) : self(y, 1))) / (load(y) + load(y));
    save(row_ + pack.out, result);
  }

  const Tables& t_;
  std::ptrdiff_t stride_;
  int stage_, k_ = 0;
  const double* sums_;                   // for this stage; null: none
  double* row_ = nullptr;
};

void run_stage(const Tables& tables, int stage) {
  if (tables.sums && stage > 0) Stage<true>(tables, stage).run();
  else Stage<false>(tables, stage).run();
}
void renew_blocks(const Tables& tables, int stage) { Stage<false>(tables, stage).renew(); }

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE
