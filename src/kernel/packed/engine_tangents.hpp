// Part of engine_code.hpp: derivatives of order 0.
namespace maupertuis::packed::MAUP_ENGINE {
namespace {

/// As the reference: the highest derivative of q in a slot of lag ℓ enters through operands of lag ℓ alone. W
/// directions at once, so that each pack is looked up once for all of them.
template <int W>
class Tangents {
 public:
  Tangents(const Tables& tables, double* tangents, std::size_t stride)
      : t_(tables), tangents_(tangents), stride_(stride) {}

  void run() const {
    for (std::size_t i = 0; i < t_.pack_count; ++i) {
      const Pack& pack = t_.packs[i];
      switch (pack.kind) {
        case Pack::Sum:
          sum(pack);
          break;
        case Pack::Scan:
          scan(pack, running_sum);
          break;
        case Pack::ScanDown:
          scan(pack, running_sum_down);
          break;
        case Pack::Strand:
          strand(pack);
          break;
        case Pack::Join:
          join(pack, before_lanes);
          break;
        case Pack::JoinDown:
          join(pack, before_lanes_down);
          break;
        case Pack::Integral:
          linear(pack, load(t_.coefficients + pack.coefficients) * value_of(pack.b), all(0));
          break;
        case Pack::Quotient:
          quotient(pack);
          break;
        case Pack::SquareRoot:
          linear(pack, all(0.5) / value_of(pack.y), all(0));
          break;
        case Pack::Scalar:
          for (int d = 0; d < W; ++d) t_.scalar.tangent(t_.scalar.context, pack.instruction, row(d));
          break;
      }
    }
  }

 private:
  double* row(int direction) const { return tangents_ + static_cast<std::size_t>(direction) * stride_; }
  Vector value_of(std::uint32_t index) const { return read(t_.blocks[index], t_.rows); }
  static Vector read(const Block& block, const double* from) {
    return block.direct     ? load(from + block.first)
           : block.is_range ? load(from + block.slots[0])
                            : gather(from, block.slots.data());
  }

  /// One by one: as an array it would be cleared in memory.
  static void clear(Vector* sums) {
#pragma GCC unroll 8
    for (int d = 0; d < W; ++d) sums[d] = all(0);
  }

  void store(const Pack& pack, const Vector* sums) const {
#pragma GCC unroll 8
    for (int d = 0; d < W; ++d) save(row(d) + pack.out, sums[d]);
  }

  /// Adds factor · the tangents of a block's slots, where they pass.
  void add(const Pack& pack, std::uint32_t index, Vector factor, Vector* sums) const {
    const Block& block = t_.blocks[index];
    if (block.lag != pack.lag) return;
    if (block.direct || block.is_range) {
      const double* const first = tangents_ + block.slots[0];
#pragma GCC unroll 8
      for (int d = 0; d < W; ++d) sums[d] += factor * load(first + static_cast<std::size_t>(d) * stride_);
      return;
    }
    for (int d = 0; d < W; ++d) sums[d] += factor * gather(row(d), block.slots.data());
  }

  /// Calls for those that are rare, which would take registers.
  template <Column::Kind kind>
  [[gnu::noinline]] void add_rare_columns(const ColumnRun& run, Vector* sums) const {
    add_columns<kind>(run, sums);
  }

  template <Column::Kind kind>
  void add_columns(const ColumnRun& run, Vector* sums) const {
    const double* c = t_.coefficients + t_.columns[run.first].coefficients;
    for (std::uint32_t i = run.first; i < run.last; ++i, c += lanes) {
      const Column& column = t_.columns[i];
#pragma GCC unroll 8
      for (int d = 0; d < W; ++d) sums[d] += load(c) * column_values<kind>(row(d), column);
    }
  }

  void columns(const Pack& pack, Vector* sums) const {
    for (std::uint32_t r = pack.first_run; r < pack.last_run; ++r) {
      const ColumnRun& run = t_.runs[r];
      if (!run.passes_tangent) continue;
      switch (run.kind) {
        case Column::Broadcast:
          add_columns<Column::Broadcast>(run, sums);
          break;
        case Column::Contiguous:
          add_columns<Column::Contiguous>(run, sums);
          break;
        case Column::Reversed:
          add_rare_columns<Column::Reversed>(run, sums);
          break;
        case Column::Gather:
          add_rare_columns<Column::Gather>(run, sums);
          break;
      }
    }
  }

  void sum(const Pack& pack) const {
    Vector sums[W];
    clear(sums);
    columns(pack, sums);
    for (std::uint32_t p = pack.first_product; p < pack.last_product; ++p) {
      const ProductTerm& term = t_.products[p];
      const Vector c = load(t_.coefficients + term.coefficients);
      add(pack, term.a, c * value_of(term.b), sums);
      add(pack, term.b, c * value_of(term.a), sums);
    }
    store(pack, sums);
  }

  void scan(const Pack& pack, Vector (*sum_of)(Vector)) const {
    Vector sums[W];
    clear(sums);
    columns(pack, sums);
    for (int d = 0; d < W; ++d) save(row(d) + pack.out, sum_of(sums[d]) + carry_of(pack.carry, row(d)));
  }

  void strand(const Pack& pack) const {
    Vector sums[W];
    clear(sums);
    columns(pack, sums);
    for (int d = 0; d < W; ++d)
      save(row(d) + pack.out, pack.carry == no_slot ? sums[d] : sums[d] + load(row(d) + pack.carry));
  }

  void join(const Pack& pack, Vector (*before)(Vector)) const {
    for (int d = 0; d < W; ++d) join_strands(pack, load(row(d) + pack.last_strand), row(d), before);
  }

  /// by_a · ∂a + by_b · ∂b
  void linear(const Pack& pack, Vector by_a, Vector by_b) const {
    Vector sums[W];
    clear(sums);
    add(pack, pack.a, by_a, sums);
    if (pack.kind == Pack::Quotient) add(pack, pack.b, by_b, sums);
    store(pack, sums);
  }

  void quotient(const Pack& pack) const {
    const Vector inverse = all(1) / value_of(pack.b);
    linear(pack, inverse, -value_of(pack.y) * inverse);
  }

  const Tables& t_;
  double* tangents_;
  std::size_t stride_;
};

void tangents(const Tables& tables, double* values, std::size_t stride, std::size_t directions) {
  while (directions > 0) {
    const auto block = [&]<int W>() {
      Tangents<W>(tables, values, stride).run();
      values += W * stride, directions -= W;
    };
    if (directions >= 8)
      block.template operator()<8>();
    else if (directions >= 4)
      block.template operator()<4>();
    else if (directions >= 2)
      block.template operator()<2>();
    else
      block.template operator()<1>();
  }
}

}  // namespace
}  // namespace maupertuis::packed::MAUP_ENGINE
