#include "kernel/llvm/trial_lowering.hpp"

#include "kernel/llvm/emitters.hpp"

#include <algorithm>

namespace maupertuis::grouped {

Lowering::Lowering(const packed::PackedProgram& program, std::size_t stride, int order)
    : p_(program), stride_(stride), order_(order), n_(static_cast<std::uint32_t>(program.program.unknowns)),
      wide_(width_of(n_)), pack_of_(program.program.slots, nullptr), tangents_(program.packs.size()) {
  for (const Pack& pack : p_.packs) {
    if (pack.kind == Pack::Scalar) throw llvm_backend::Declined("trial: scalar");
    for (unsigned lane = 0; lane < pack.width; ++lane) pack_of_[pack.out + lane] = &pack;
  }
}

Line Lowering::run() {
  find_awaited();
  look_ahead_ = !follows_ && can_look_ahead();
  for (int stage = p_.program.first_stage; stage < order_; ++stage) {
    begin(stage);
    const auto waits = [&](const Pack& pack) { return follows_ && stage >= 0 && !awaited_[index_of(pack)]; };
    for (const Pack& pack : p_.packs)
      if (!waits(pack)) dynamics(pack);
    if (stage == 0) factor();
    if (stage >= 0) solve(), correct();
    for (const Pack& pack : p_.packs)
      if (waits(pack)) dynamics(pack);
    if (stage == 1 && look_ahead_) {
      for (const Pack& pack : p_.packs)
        if (is_moved(pack)) second_tangents(pack);
      for (std::uint32_t d = 0; d < n_; ++d)
        for (const Part part : {A, B}) {
          std::vector<Term> terms;
          for (std::uint32_t i = 0; i < n_; ++i)
            terms.push_back({line_.spread(tangent_at(part, p_.program.residual[i], static_cast<int>(d)), wide_), inverse_columns_[i]});
          (part == A ? ahead_a_ : ahead_b_).push_back(line_.sum(terms));
        }
    }
  }
  line_.finite = check_;
  return std::move(line_);
}

void Lowering::begin(int stage) {
  stage_ = stage, line_.stage = stage;
  rates_.clear();
  const int k = stage + 2;
  if (stage < 0 && k >= 0 && k < 2)
    for (Slot i = 0; i < n_; ++i)
      final_[{i, k}] = n_ <= 4 ? Number{line_.given(k == 0 ? Positions : Velocities, i, 1), 0}
                               : Number{i == 0 ? line_.given(Rows, cell(k, 0), wide_) : final_[{0, k}].node, i};
}

void Lowering::find_awaited() {
  awaited_.assign(p_.packs.size(), false);
  Slots open(p_.program.residual.begin(), p_.program.residual.end());
  while (!open.empty()) {
    const Slot slot = open.back();
    open.pop_back();
    if (slot < n_ || !pack_of_[slot] || awaited_[index_of(*pack_of_[slot])]) continue;
    awaited_[index_of(*pack_of_[slot])] = true;
    for (const Slot operand : read_at_once(*pack_of_[slot])) open.push_back(operand);
  }
  follows_ = std::none_of(p_.packs.begin(), p_.packs.end(),
                          [&](const Pack& pack) { return awaited_[index_of(pack)] && is_corrected(pack.out); });
}

Lowering::Slots Lowering::read_at_once(const Pack& pack) const {
  Slots out;
  const auto add_block = [&](std::uint32_t index, int delay) {
    if (index == packed::no_block || p_.blocks[index].lag != pack.lag + delay) return;
    const Slots all = slots_of(p_.blocks[index]);
    out.insert(out.end(), all.begin(), all.end());
  };
  for (std::uint32_t c = pack.first_aligned; pack.kind == Pack::Sum && c < pack.last_aligned; ++c)
    for (const Slot slot : sources_of(p_.columns[c], pack.width))
      if (p_.program.lags[slot] + p_.columns[c].shift >= pack.lag) out.push_back(slot);
  for (std::uint32_t t = pack.first_product; pack.kind == Pack::Sum && t < pack.last_product; ++t)
    add_block(p_.products[t].a, 0), add_block(p_.products[t].b, 0);
  for (const std::uint32_t block : {pack.a, pack.b}) add_block(block, 0), add_block(block, 1);
  return out;
}

// ---------------------------------------------------------------------------------------------------------- values

Number Lowering::at(Slot slot, int order) {
  if (const auto found = final_.find({slot, order}); found != final_.end()) return found->second;
  if (slot < n_ && stage_ >= 0 && order == stage_ + 2) return {line_.literal(0, 1), 0};
  if (slot == p_.program.one) return {line_.literal(order == 0 ? 1 : 0, 1), 0};
  return final_[{slot, order}] = {line_.given(Rows, cell(order, slot), 1), 0};
}

Node Lowering::gather(const Slots& slots, int order, std::uint32_t w) {
  Numbers all;
  for (const Slot slot : slots) all.push_back(at(slot, order));
  return line_.gather(std::move(all), w);
}

Node Lowering::coefficients(std::uint32_t first, std::uint32_t w) {
  std::vector<double> values;
  for (std::uint32_t lane = 0; lane < w; ++lane) {
    const Constant& c = p_.program.constants[p_.coefficients[first + lane]];
    if (c.kind != Kind::Number) return line_.given(Coefficients, first, w);
    values.push_back(c.value);
  }
  return line_.literal(values);
}

Node Lowering::over(Node x, double d, Node c) {
  const double high = 1 / d, low = std::fma(-high, d, 1.0) / d;
  const Node by_high = scaled(c, high);
  if (low == 0) return line_.product(x, by_high);
  return line_.sum({{x, scaled(c, low)}, {x, by_high}});
}

Node Lowering::dot(const std::vector<Term>& terms) {
  std::vector<Term> parts[2];
  for (std::size_t i = 0; i < terms.size(); ++i) parts[i % 2].push_back(terms[i]);
  if (parts[0].empty()) return none;
  const Node even = line_.sum(parts[0]);
  return parts[1].empty() ? even : line_.add(even, line_.sum(parts[1]));
}

Node Lowering::operand(std::uint32_t index, int order, std::uint32_t w) {
  const Block& block = p_.blocks[index];
  const bool is_past = order < stage_ + 2 - block.lag;
  const bool early = is_past && looks_ahead(stage_) && order == stage_ + 1 - block.lag;
  if (is_past)
    if (const auto found = operands_.find({index, order, early}); found != operands_.end()) return found->second;
  const bool of_coordinates = std::all_of(block.slots.begin(), block.slots.begin() + block.width, [&](Slot s) { return s < n_; });
  Node out;
  const int made = order - 2 + block.lag;
  if (block.weighted && of_coordinates && made >= 0 && !early && accelerations_.contains(made)) {
    Numbers all;
    for (const Slot s : slots_of(block)) all.push_back({accelerations_[made], s});
    out = over(line_.gather(all, w), made + 1.0);
  } else {
    Numbers all;
    for (const Slot s : slots_of(block)) {
      const auto found = early_.find({s, order});
      all.push_back(early && s < n_ ? Number{line_.literal(0, 1), 0} : early && found != early_.end() ? found->second : at(s, order));
    }
    out = line_.gather(all, w);
    if (block.weighted) out = scaled(out, order);
  }
  if (is_past) operands_[{index, order, early}] = out;
  return out;
}

template <class F, class G>
Node Lowering::convolution(F&& a, G&& b, int first, int k) {
  if (std::getenv("MAUP_ONE")) {
    std::vector<int> order;
    for (int j = first; j <= k; ++j) order.push_back(j);
    std::stable_sort(order.begin(), order.end(), [&](int x, int y) { return std::abs(2 * x - first - k) < std::abs(2 * y - first - k); });
    std::vector<Term> all;
    for (const int j : order) all.push_back({a(j), b(k - j)});
    return line_.sum(all);
  }
  std::vector<int> order;
  for (int j = first; j <= k; ++j) order.push_back(j);
  std::stable_sort(order.begin(), order.end(), [&](int x, int y) { return std::abs(2 * x - first - k) < std::abs(2 * y - first - k); });
  std::vector<Term> sums[2];
  const std::size_t ends = order.size() > 4 ? order.size() - 4 : 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == ends && ends > 0) {
      Node all = line_.sum(sums[0]);
      if (!sums[1].empty()) all = line_.add(all, line_.sum(sums[1]));
      sums[0] = {{all}}, sums[1].clear();
    }
    sums[(i - (ends > 0 && i >= ends ? ends : 0)) % 2].push_back({a(order[i]), b(k - order[i])});
  }
  const Node even = line_.sum(sums[0]);
  return sums[1].empty() ? even : line_.add(line_.sum(sums[1]), even);
}

void Lowering::keep(Slot out, std::uint32_t width, Node v) {
  for (std::uint32_t lane = 0; lane < width; ++lane) final_[{out + lane, current(out)}] = {v, lane};
}

// -------------------------------------------------------------------------------------------------------- dynamics

void Lowering::dynamics(const Pack& pack) {
  k_ = stage_ + 2 - pack.lag;
  if (k_ < 0) return;
  const std::uint32_t w = width_of(pack.width);
  Node out = none;
  switch (pack.kind) {
    case Pack::Sum: out = sum(pack, w); break;
    case Pack::Integral:
      if (k_ == 0) return functions(pack, w);
      return integral(pack, w);
    case Pack::Quotient: {
      const Node a = operand(pack.a, k_, w), b0 = operand(pack.b, 0, w);
      if (k_ == 0) { out = line_.quotient(a, b0); break; }
      const Node all = convolution([&](int j) { return operand(pack.b, j, w); }, [&](int j) { return operand(pack.y, j, w); }, 1, k_);
      out = line_.quotient(line_.sum({{a}, {all, none, true}}), b0);
      break;
    }
    case Pack::SquareRoot: {
      const Node u = operand(pack.a, k_, w);
      if (k_ == 0) { out = line_.one_of(Entry::Root, u); break; }
      const Node y0 = operand(pack.y, 0, w);
      out = line_.quotient(line_.sum({{u}, {self(pack.y, 1, w), none, true}}), line_.sum({{y0}, {y0}}));
      break;
    }
    case Pack::Scan: case Pack::ScanDown: case Pack::Strand: case Pack::Join: case Pack::JoinDown: case Pack::Scalar: throw llvm_backend::Declined("trial");
  }
  keep(pack.out, pack.width, out);
  if (stage_ < 0 || !is_corrected(pack.out)) line_.store(out, cell(k_, pack.out));
}

Node Lowering::sum(const Pack& pack, std::uint32_t w) {
  Node result = none;
  for (std::uint8_t shift = 0; shift < 3; ++shift) shifted(pack, shift, w, result);
  return products(pack, w, result == none ? line_.literal(0, w) : result);
}

void Lowering::shifted(const Pack& pack, std::uint8_t shift, std::uint32_t w, Node& result) {
  const double factor = shift == 0 ? 1 : shift == 1 ? k_ + 1.0 : (k_ + 1.0) * (k_ + 2.0);
  std::vector<Term> derivatives, columns;
  for (std::uint32_t c = pack.first_aligned; c < pack.last_aligned; ++c) {
    const Column& column = p_.columns[c];
    if (column.shift != shift || (column.source == p_.program.one && k_ + shift != 0)) continue;
    const Slots slots = sources_of(column, pack.width);
    const Node rate = rates(slots, shift, w), by = coefficients(column.coefficients, w);
    if (rate != none) derivatives.push_back({rate, by});
    else columns.push_back({gather(slots, k_ + shift, w), by});
  }
  if (const Node d = dot(derivatives); d != none) result = line_.add(d, result);
  if (columns.empty()) return;
  if (columns.size() <= 2) {
    for (Term& t : columns) t.b = scaled(t.b, factor);
    if (result != none) columns.insert(columns.begin(), {result});
    result = line_.sum(columns);
    return;
  }
  const Node whole = dot(columns);
  std::vector<Term> all;
  if (result != none) all.push_back({result});
  all.push_back({whole, number(factor, whole)});
  result = line_.sum(all);
}

Node Lowering::rates(const Slots& slots, std::uint8_t shift, std::uint32_t w) {
  if (shift == 0 || stage_ < 1) return none;
  Numbers all;
  for (const Slot slot : slots) {
    const auto found = slot < n_ || !pack_of_[slot] || current(slot) != k_ + shift ? rates_.end() : rates_.find({pack_of_[slot]->out, shift});
    if (found == rates_.end()) return none;
    all.push_back({found->second, slot - pack_of_[slot]->out});
  }
  return line_.gather(all, w);
}

Node Lowering::products(const Pack& pack, std::uint32_t w, Node result) {
  if (const std::uint32_t whole = merged_width(pack); whole > 0) {
    const packed::ProductTerm& first = p_.products[pack.first_product];
    const auto wide = [&](std::uint32_t block) { return [this, block, whole](int j) { return range(p_.blocks[block].slots[0], j, whole); }; };
    const Node all = convolution(wide(first.a), wide(first.b), 0, k_);
    std::vector<Term> terms{{result}};
    for (std::uint32_t t = 0; t * pack.width < whole; ++t) {
      Numbers part;
      for (std::uint32_t lane = 0; lane < pack.width; ++lane) part.push_back({all, t * pack.width + lane});
      terms.push_back({line_.gather(part, w), coefficients(p_.products[pack.first_product + t].coefficients, w)});
    }
    return line_.sum(terms);
  }
  std::vector<Term> terms{{result}};
  for (std::uint32_t i = pack.first_product; i < pack.last_product; ++i) {
    const packed::ProductTerm& term = p_.products[i];
    const Node value = term.a == term.b ? self(term.a, 0, w)
        : convolution([&](int j) { return operand(term.a, j, w); }, [&](int j) { return operand(term.b, j, w); }, 0, k_);
    terms.push_back({value, coefficients(term.coefficients, w)});
  }
  return line_.sum(terms);
}

std::uint32_t Lowering::merged_width(const Pack& pack) const {
  const std::uint32_t count = pack.last_product - pack.first_product;
  const std::size_t whole = static_cast<std::size_t>(count) * pack.width;
  if (count < 2 || whole > packed::lanes || !std::has_single_bit(whole)) return 0;
  const auto is_range = [](const Block& b) {
    for (std::uint32_t lane = 0; lane < b.width; ++lane)
      if (b.slots[lane] != b.slots[0] + lane) return false;
    return !b.weighted;
  };
  const auto follows = [&](std::uint32_t block, std::uint32_t first, std::uint32_t t) {
    const Block &x = p_.blocks[block], &y = p_.blocks[first];
    return x.lag == y.lag && x.slots[0] == y.slots[0] + t * pack.width && is_range(x);
  };
  const packed::ProductTerm& first = p_.products[pack.first_product];
  for (std::uint32_t t = 0; t < count; ++t) {
    const packed::ProductTerm& term = p_.products[pack.first_product + t];
    if (term.a == term.b || !follows(term.a, first.a, t) || !follows(term.b, first.b, t)) return 0;
  }
  return static_cast<std::uint32_t>(whole);
}

Node Lowering::range(Slot first, int order, std::uint32_t w) {
  const bool early = looks_ahead(stage_) && order == stage_ + 1 - p_.program.lags[first];
  Numbers all;
  for (Slot s = first; s < first + w; ++s) {
    const auto found = early_.find({s, order});
    all.push_back(early && s < n_ ? Number{line_.literal(0, 1), 0} : early && found != early_.end() ? found->second : at(s, order));
  }
  return line_.gather(all, w);
}

Node Lowering::self(std::uint32_t block, int first, std::uint32_t w) {
  std::vector<Term> terms;
  for (int j = (k_ - 1) / 2; j >= first && 2 * j < k_; --j) terms.push_back({operand(block, j, w), operand(block, k_ - j, w)});
  Node sum = none;
  if (!terms.empty()) sum = line_.sum(terms), sum = line_.sum({{sum}, {sum}});
  if (k_ % 2 == 0 && k_ / 2 >= first) {
    const Node middle = operand(block, k_ / 2, w);
    std::vector<Term> all;
    if (sum != none) all.push_back({sum});
    all.push_back({middle, middle});
    sum = line_.sum(all);
  }
  return sum == none ? line_.literal(0, w) : sum;
}

void Lowering::integral(const Pack& pack, std::uint32_t w) {
  const Node sum = convolution([&](int j) { return operand(pack.a, j, w); }, [&](int j) { return operand(pack.b, j, w); }, 1, k_);
  const Node c = coefficients(pack.coefficients, w);
  rates_[{pack.out, 1}] = line_.product(sum, c);
  rates_[{pack.out, 2}] = line_.product(sum, scaled(c, k_ - 1.0));
  const Node out = over(sum, k_, c);
  keep(pack.out, pack.width, out);
  if (!is_corrected(pack.out)) line_.store(out, cell(k_, pack.out));
}

void Lowering::functions(const Pack& pack, std::uint32_t w) {
  Node out;
  if (pack.first_function == pack.last_function) {
    Numbers all;
    for (std::uint32_t lane = 0; lane < pack.width; ++lane) all.push_back(seconds_.at(pack.out + lane));
    out = line_.gather(all, w);
  } else {
    if (pack.pairs == packed::no_block) throw llvm_backend::Declined("trial: functions");
    const std::uint32_t count = pack.last_function - pack.first_function, size = width_of(count);
    Slots slots(p_.blocks[pack.a].slots.begin(), p_.blocks[pack.a].slots.begin() + count);
    const Node sines = line_.one_of(Entry::Sines, gather(slots, current(slots[0]), size));
    const Node cosines = line_.one_of(Entry::Cosines, sines);
    if (pack.width == 2 * count) {
      Numbers all;
      for (std::uint32_t lane = 0; lane < w; ++lane)
        all.push_back(lane < count ? Number{sines, lane} : lane < 2 * count ? Number{cosines, lane - count} : Number{sines, 0});
      out = line_.gather(all, w);
    } else {
      for (std::uint32_t lane = 0; lane < count; ++lane) seconds_[pack.pairs + lane] = {cosines, lane};
      out = sines;
    }
  }
  keep(pack.out, pack.width, out);
  line_.store(out, cell(current(pack.out), pack.out));
}

// -------------------------------------------------------------------------------------------------------- tangents

Number Lowering::tangent_at(Part part, Slot slot, int d) {
  const Number zero{line_.literal(0, 1), 0};
  if (d < 0) return zero;
  if (slot < n_) return part == Leading && static_cast<int>(slot) == d ? Number{line_.literal(1, 1), 0} : zero;
  if (!pack_of_[slot]) return zero;
  const Tangent& t = tangents_[index_of(*pack_of_[slot])];
  const auto& map = part == Leading ? t.of : part == A ? t.a : t.b;
  const std::uint32_t lane = slot - pack_of_[slot]->out;
  if (const auto found = map.find(d); found != map.end()) return {found->second, lane};
  const auto found = map.find(-1);
  return found == map.end() || t.direction[lane] != d ? zero : Number{found->second, lane};
}

Node Lowering::tangents_of(Part part, const Slots& slots, const Directions& d, std::uint32_t w) {
  Numbers all;
  for (std::size_t lane = 0; lane < slots.size(); ++lane) all.push_back(tangent_at(part, slots[lane], d[lane]));
  return line_.gather(all, w);
}

std::vector<Lowering::Source> Lowering::sources(const Pack& pack) {
  const std::uint32_t w = width_of(pack.width);
  std::vector<Source> out;
  const auto of_block = [&](std::uint32_t block, auto&& factor) {
    if (p_.blocks[block].lag == pack.lag) out.push_back({slots_of(p_.blocks[block]), factor()});
  };
  if (pack.kind == Pack::Sum) {
    for (std::uint32_t c = pack.first_aligned; c < pack.last_aligned; ++c)
      if (const Column& column = p_.columns[c]; p_.program.lags[column.source] + column.shift == pack.lag)
        out.push_back({sources_of(column, pack.width), coefficients(column.coefficients, w)});
    for (std::uint32_t i = pack.first_product; i < pack.last_product; ++i) {
      const packed::ProductTerm& t = p_.products[i];
      of_block(t.a, [&] { return line_.product(coefficients(t.coefficients, w), at_zero(t.b, w)); });
      of_block(t.b, [&] { return line_.product(coefficients(t.coefficients, w), at_zero(t.a, w)); });
    }
  }
  if (pack.kind == Pack::Integral)
    of_block(pack.a, [&] { return line_.product(coefficients(pack.coefficients, w), at_zero(pack.b, w)); });
  if (pack.kind == Pack::Quotient) {
    of_block(pack.a, [&] { return line_.quotient(line_.literal(1, w), at_zero(pack.b, w)); });
    of_block(pack.b, [&] { return scaled(line_.quotient(at_zero(pack.y, w), at_zero(pack.b, w)), -1); });
  }
  if (pack.kind == Pack::SquareRoot) of_block(pack.a, [&] { return line_.quotient(line_.literal(0.5, w), at_zero(pack.y, w)); });
  return out;
}

void Lowering::tangent(const Pack& pack) {
  const std::uint32_t w = width_of(pack.width);
  Tangent& out = tangents_[index_of(pack)];
  const std::vector<Source> all = sources(pack);
  std::vector<std::set<int>> of_lane(pack.width);
  std::set<int> any;
  for (const Source& s : all)
    for (std::uint32_t lane = 0; lane < pack.width; ++lane)
      for (int d = 0; d < static_cast<int>(n_); ++d)
        if (!line_.is_literal(tangent_at(Leading, s.slots[lane], d).node) || static_cast<int>(s.slots[lane]) == d) of_lane[lane].insert(d), any.insert(d);
  const auto add = [&](int name, const Directions& d) {
    std::vector<Term> terms{{line_.literal(0, w)}};
    for (const Source& s : all) terms.push_back({tangents_of(Leading, s.slots, d, w), s.factor});
    out.of[name] = line_.sum(terms);
  };
  if (any.empty()) return;
  if (std::all_of(of_lane.begin(), of_lane.end(), [](const auto& s) { return s.size() <= 1; })) {
    for (const auto& s : of_lane) out.direction.push_back(s.empty() ? -1 : *s.begin());
    return add(-1, out.direction);
  }
  for (const int d : any) add(d, Directions(pack.width, d));
}

bool Lowering::can_look_ahead() const {
  return n_ <= 4 && std::all_of(p_.packs.begin(), p_.packs.end(), [&](const Pack& pack) {
    if (!is_moved(pack)) return true;
    for (std::uint32_t c = pack.first_aligned; pack.kind == Pack::Sum && c < pack.last_aligned; ++c)
      for (const Slot slot : sources_of(p_.columns[c], pack.width))
        if (passes(slot, p_.columns[c].shift, pack.lag - 1)) return false;
    return pack.kind == Pack::Sum || pack.kind == Pack::Integral;
  });
}

void Lowering::second_tangents(const Pack& pack) {
  const std::uint32_t w = width_of(pack.width);
  Tangent& t = tangents_[index_of(pack)];
  const auto add = [&](int name, const Directions& d) {
    std::vector<Term> a{{line_.literal(0, w)}}, b = a;
    const auto of = [&](Part part, const Slots& slots) { return tangents_of(part, slots, d, w); };
    const auto times = [&](std::uint32_t block, int order, Node c) { return line_.product(c, gather(slots_of(p_.blocks[block]), order, w)); };
    for (std::uint32_t c = pack.first_aligned; pack.kind == Pack::Sum && c < pack.last_aligned; ++c) {
      const Column& column = p_.columns[c];
      const Slots slots = sources_of(column, pack.width);
      const Node by = coefficients(column.coefficients, w);
      if (p_.program.lags[column.source] + column.shift == pack.lag) {
        a.push_back({of(A, slots), by}), b.push_back({of(B, slots), by});
        if (column.shift > 0) b.push_back({of(A, slots), scaled(by, column.shift)});
      } else if (passes(column.source, column.shift, pack.lag - 1)) {
        b.push_back({of(Leading, slots), by});
      }
    }
    for (std::uint32_t i = pack.first_product; pack.kind == Pack::Sum && i < pack.last_product; ++i) {
      const packed::ProductTerm& term = p_.products[i];
      const Node by = coefficients(term.coefficients, w);
      for (const auto& [x, y] : {std::pair{term.a, term.b}, std::pair{term.b, term.a}}) {
        const Slots slots = slots_of(p_.blocks[x]);
        const Node y0 = times(y, 0, by);
        if (p_.blocks[x].lag == pack.lag) {
          a.push_back({of(A, slots), y0}), a.push_back({of(Leading, slots), times(y, 1, by)}), b.push_back({of(B, slots), y0});
        } else if (p_.blocks[x].lag == pack.lag - 1) {
          b.push_back({of(Leading, slots), y0});
        }
      }
    }
    if (pack.kind == Pack::Integral) {
      const Slots u = slots_of(p_.blocks[pack.a]), x = slots_of(p_.blocks[pack.b]);
      const Node c = coefficients(pack.coefficients, w), w0 = times(pack.b, 0, c);
      if (p_.blocks[pack.a].lag == pack.lag) {
        const Node by_w1 = line_.product(of(Leading, u), times(pack.b, 1, c));
        a.push_back({of(A, u), w0}), a.push_back({by_w1});
        b.push_back({of(B, u), w0}), b.push_back({by_w1, none, true});
      } else if (p_.blocks[pack.a].lag == pack.lag - 1) {
        b.push_back({of(Leading, u), w0});
      }
      if (p_.blocks[pack.b].lag == pack.lag) b.push_back({of(Leading, x), times(pack.a, 1, c)});
    }
    if (const Node x = line_.sum(a); !line_.is_all(x, 0)) t.a[name] = x;
    if (const Node x = line_.sum(b); !line_.is_all(x, 0)) t.b[name] = x;
  };
  if (t.of.contains(-1)) return add(-1, t.direction);
  for (int d = 0; d < static_cast<int>(n_); ++d) add(d, Directions(pack.width, d));
}

// -------------------------------------------------------------------------------------------------------- solution

void Lowering::factor() {
  for (const Pack& pack : p_.packs)
    if (is_moved(pack) && (!follows_ || awaited_[index_of(pack)])) tangent(pack);
  std::vector<Node> columns;
  for (int d = 0; d < static_cast<int>(n_); ++d) {
    Numbers all;
    for (const Slot slot : p_.program.residual) all.push_back(passes(slot, 0, 2) ? tangent_at(Leading, slot, d) : Number{line_.literal(0, 1), 0});
    while (all.size() < wide_) all.push_back({line_.literal(0, 1), 0});
    columns.push_back(line_.gather(all, wide_));
  }
  for (const Node row : inverse(columns)) inverse_columns_.push_back(scaled(row, -1));
}

std::vector<Node> Lowering::inverse(std::vector<Node> rows) {
  const std::vector<Node> matrix = rows;
  const auto single = [&](Node row, std::uint32_t lane) { return line_.gather({{row, lane}}, 1); };
  const auto wide = [&](Node x) { return line_.spread({x, 0}, wide_); };
  const auto with = [&](Node row, const std::map<std::uint32_t, double>& changed) {
    Numbers all;
    for (std::uint32_t i = 0; i < wide_; ++i)
      all.push_back(changed.contains(i) ? Number{line_.literal(changed.at(i), 1), 0} : Number{row, i});
    return line_.gather(all, wide_);
  };
  const Node one = line_.literal(1, 1);
  std::vector<Node> diagonal;
  for (std::uint32_t i = 0; i < n_; ++i) diagonal.push_back(single(rows[i], i));
  std::uint32_t p = 0;
  for (; p + 1 < n_; p += 2) {
    const std::uint32_t o = p + 1;
    const Node a = single(rows[p], p), b = single(rows[p], o), c = single(rows[o], p), d = single(rows[o], o);
    const Node determinant = line_.sum({{a, d}, {b, c, true}});
    line_.checks.push_back({line_.quotient(a, diagonal[p]), 1e-10});
    line_.checks.push_back({line_.quotient(determinant, line_.product(a, diagonal[o])), 1e-10});
    line_.checks.push_back({line_.one_of(Entry::Magnitude, determinant), 1e-280});
    const Node inverse = wide(line_.quotient(one, determinant));
    const Node x = with(rows[p], {{p, 1}, {o, 0}}), y = with(rows[o], {{p, 0}, {o, 1}});
    const Node above = line_.sum({{wide(d), x}, {wide(b), y, true}}), below = line_.sum({{wide(a), y}, {wide(c), x, true}});
    for (std::uint32_t i = 0; i < n_; ++i) {
      if (i == p || i == o) continue;
      const Node f = line_.product(line_.spread({rows[i], p}, wide_), inverse), g = line_.product(line_.spread({rows[i], o}, wide_), inverse);
      rows[i] = line_.sum({{with(rows[i], {{p, 0}, {o, 0}})}, {f, above, true}, {g, below, true}});
    }
    rows[p] = line_.product(above, inverse), rows[o] = line_.product(below, inverse);
  }
  if (p < n_) {
    const Node pivot = single(rows[p], p);
    line_.checks.push_back({line_.quotient(pivot, diagonal[p]), 1e-10});
    const Node row = line_.product(with(rows[p], {{p, 1}}), wide(line_.quotient(one, pivot)));
    for (std::uint32_t i = 0; i < n_; ++i)
      if (i != p) rows[i] = line_.sum({{with(rows[i], {{p, 0}})}, {line_.spread({rows[i], p}, wide_), row, true}});
    rows[p] = row;
  }
  std::vector<Node> rest, out;
  for (std::uint32_t i = 0; i < n_; ++i) {
    std::vector<double> unit(wide_, 0.0);
    unit[i] = 1;
    std::vector<Term> terms{{line_.literal(unit)}};
    for (std::uint32_t j = 0; j < n_; ++j) terms.push_back({line_.spread({matrix[i], j}, wide_), rows[j], true});
    rest.push_back(line_.sum(terms));
  }
  for (std::uint32_t i = 0; i < n_; ++i) {
    std::vector<Term> terms;
    for (std::uint32_t j = 0; j < n_; ++j) terms.push_back({line_.spread({rows[i], j}, wide_), rest[j]});
    out.push_back(line_.add(rows[i], line_.sum(terms)));
  }
  return out;
}

void Lowering::solve() {
  std::vector<Term> before, now;
  for (std::uint32_t d = 0; d < n_; ++d) {
    now.push_back({line_.spread(at(p_.program.residual[d], stage_), wide_), inverse_columns_[d]});
    if (!looks_ahead(stage_)) continue;
    const Node slope = line_.sum({{ahead_a_[d]}, {ahead_b_[d], line_.literal(1.0 / stage_, wide_)}});
    before.push_back({line_.spread({accelerations_[stage_ - 1], d}, wide_), slope});
  }
  const Node found = line_.add(dot(before), dot(now));
  accelerations_[stage_] = found;
  check_ = check_ == none ? found : line_.add(check_, found);
}

void Lowering::correct() {
  const Node q = over(accelerations_[stage_], (stage_ + 1.0) * (stage_ + 2.0));
  coordinates_[stage_] = q;
  for (Slot i = 0; i < n_; ++i) final_[{i, stage_ + 2}] = {q, i};
  line_.store(q, cell(stage_ + 2, 0));
  for (const Pack& pack : p_.packs)
    if (is_corrected(pack.out)) correct(pack);
}

Node Lowering::acceleration(Node of, const Tangent& t, int d, std::uint32_t w) {
  if (d >= 0) return line_.spread({of, static_cast<std::uint32_t>(d)}, w);
  Numbers all;
  for (const int x : t.direction) all.push_back({of, static_cast<std::uint32_t>(std::max(0, x))});
  return line_.gather(all, w);
}

void Lowering::correct(const Pack& pack) {
  const int order = stage_ + 2 - pack.lag;
  if (order < 0) return;
  const std::uint32_t w = width_of(pack.width);
  const Tangent& t = tangents_[index_of(pack)];
  Node out = final_.at({pack.out, order}).node;
  const double k = stage_;
  if (looks_ahead(stage_)) {
    std::vector<Term> terms{{out}};
    std::set<int> names;
    for (const auto& [d, v] : t.a) names.insert(d);
    for (const auto& [d, v] : t.b) names.insert(d);
    for (const int d : names) {
      std::vector<Term> slopes;
      if (t.a.contains(d)) slopes.push_back({t.a.at(d)});
      if (t.b.contains(d)) slopes.push_back({t.b.at(d), line_.literal(1 / (k + 2 - pack.lag), w)});
      Node slope = line_.sum(slopes);
      if (pack.lag == 1) slope = scaled(slope, 1 / k);
      terms.push_back({acceleration(pack.lag == 0 ? coordinates_[stage_ - 1] : accelerations_[stage_ - 1], t, d, w), slope});
    }
    out = line_.sum(terms);
    for (std::uint32_t lane = 0; lane < pack.width; ++lane) early_[{pack.out + lane, order}] = {out, lane};
  } else {
    for (std::uint32_t lane = 0; lane < pack.width; ++lane) early_[{pack.out + lane, order}] = {out, lane};
  }
  const double factor = pack.lag == 2 ? 1 : pack.lag == 1 ? 1.0 / (k + 1) : 1.0 / ((k + 1) * (k + 2));
  const bool by_coordinates = pack.lag == 0 && looks_ahead(stage_);
  std::vector<Term> terms{{out}};
  for (const auto& [d, v] : t.of)
    terms.push_back({acceleration(by_coordinates ? coordinates_[stage_] : accelerations_[stage_], t, d, w), by_coordinates ? v : scaled(v, factor)});
  out = line_.sum(terms);
  for (std::uint32_t lane = 0; lane < pack.width; ++lane) final_[{pack.out + lane, order}] = {out, lane};
  line_.store(out, cell(order, pack.out));
}

}  // namespace maupertuis::grouped
