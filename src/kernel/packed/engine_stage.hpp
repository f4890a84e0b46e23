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

  Vector run_of_columns(const ColumnRun& run) const {
    const Column* const column = t_.columns + run.first;
    const Slot* const place = t_.places + run.first;
    const double* const c = coefficients(column->coefficients);
    const std::size_t count = run.last - run.first;
    switch (run.kind) {
      case Column::Broadcast: return columns_of_kind<Column::Broadcast>(column, place, c, count, row_);
      case Column::Contiguous: return columns_of_kind<Column::Contiguous>(column, place, c, count, row_);
      case Column::Reversed: return columns_of_kind<Column::Reversed>(column, place, c, count, row_);
      default: return columns_of_kind<Column::Gather>(column, place, c, count, row_);
    }
  }

  /// d/dt multiplies by k + 1.
  Vector columns(const Pack& pack) const {
    const double factors[3] = {1, k_ + 1.0, (k_ + 1.0) * (k_ + 2.0)};
    Vector sum = all(0);
    for (std::uint32_t r = pack.first_run; r < pack.last_run; ++r) sum += all(factors[t_.runs[r].shift]) * run_of_columns(t_.runs[r]);
    return sum;
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
    const Reciprocal& inverse = t_.reciprocals[k_];
    const Vector value = load(coefficients(pack.coefficients)) * sum;
    save(row_ + pack.out, value * all(inverse.leading) + value * all(inverse.rest));
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

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE
