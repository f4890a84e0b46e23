#include "kernel/straight_line/evaluator.hpp"

#include "machine_code/processor.hpp"
#include "kernel/series/elementary.hpp"

#include <maupertuis/require.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace maupertuis::straight {
namespace {

constexpr Cell cell_of_one = 0;

Evaluate best_evaluate() {
  if (vector_instructions() >= VectorInstructions::Avx512 && avx512_evaluate()) return avx512_evaluate();
  if (vector_instructions() >= VectorInstructions::Avx2 && avx2_evaluate()) return avx2_evaluate();
  return baseline_evaluate();
}

/// Terms of a sum by the number of their operands; a literal is a term of the number 1.
struct Shape {
  std::uint32_t linear = 0, products = 0, triples = 0;
};

double value(Node::What what, Kind function, double a, double b, double c) {
  if (what == Node::Chosen) return a != 0 ? b : c;
  if (what == Node::Root) return std::sqrt(a);
  if (what == Node::Call) return series::operation<double>(function, std::array{a, b});
  throw std::logic_error("a straight line holds a node that is not evaluated; please report");
}

}  // namespace

/// Numbers the cells of a line and writes its nodes level by level.
class EvaluationLayout {
 public:
  EvaluationLayout(const StraightLine& line, std::span<const std::uint32_t> seldom, Evaluation& out)
      : line_(line),
        out_(out),
        cell_(line.nodes.size(), 0),
        level_(line.nodes.size(), 0),
        changes_(line.nodes.size(), false),
        is_seldom_(line.arrays, false) {
    for (const std::uint32_t array : seldom) is_seldom_[array] = true;
  }

  void run() {
    out_.cells_.assign(1, 1.0);
    find_levels();
    for (Value v = 0; v < line_.nodes.size(); ++v) place_given(v);
    std::vector<Value> order;
    for (Value v = 0; v < line_.nodes.size(); ++v)
      if (is_made(v)) order.push_back(v);
    std::stable_sort(order.begin(), order.end(), [this](Value v, Value w) { return key(v) < key(w); });
    for (auto first = order.begin(); first != order.end();) {
      const auto last = std::find_if(first, order.end(), [&](Value v) { return key(v) != key(*first); });
      write({&*first, static_cast<std::size_t>(last - first)});
      if (!changes_[*first]) out_.changing_ = out_.steps_.size();
      first = last;
    }
    for (const Store& store : line_.stores) out_.stores_.push_back({store.array, store.index, cell(store.value)});
    for (const PivotCheck& check : line_.checks)
      out_.checks_.push_back({cell(check.pivot), cell(check.size), check.share});
    for (const Value v : line_.finite) out_.finite_.push_back(cell(v));
    out_.guarded_ = line_.guarded;
  }

 private:
  const Node& node(Value v) const { return line_.nodes[v]; }
  /// By a step of the evaluation.
  bool is_made(Value v) const {
    const Node::What what = node(v).what;
    return what != Node::Literal && what != Node::Given && what != Node::Unit && what != Node::Lane &&
           what != Node::Sine && what != Node::Cosine;
  }

  void find_levels() {
    for (Value v = 0; v < line_.nodes.size(); ++v) {
      const Node& n = node(v);
      if (n.what == Node::Given) changes_[v] = !is_seldom_[n.array];
      for_operands(line_, n, [&](Value w) {
        changes_[v] = changes_[v] || changes_[w];
        level_[v] = std::max(level_[v], level_[w] + (is_made(v) ? 1 : 0));
      });
    }
  }

  Cell take(std::size_t count, std::size_t alignment = 1) {
    const std::size_t first = (out_.cells_.size() + alignment - 1) / alignment * alignment;
    out_.cells_.resize(first + count, 0.0);
    return static_cast<Cell>(first);
  }

  void place_given(Value v) {
    const Node& n = node(v);
    if (n.what == Node::Literal) out_.cells_[cell_[v] = take(1)] = n.literal;
    if (n.what == Node::Unit) out_.cells_[(cell_[v] = take(8, 8)) + n.index] = 1;
    if (n.what != Node::Given) return;
    MAUP_REQUIRE(!n.wide);
    cell_[v] = take(1);
    (is_seldom_[n.array] ? out_.seldom_given_ : out_.given_).push_back({n.array, n.index, cell_[v]});
  }

  /// Sines and lanes stand among the numbers of another node.
  Cell cell(Value v) const {
    if (v == none) return cell_of_one;
    const Node& n = node(v);
    if (n.what == Node::Lane || n.what == Node::Sine) return cell_[n.a] + n.index;
    return n.what == Node::Cosine ? cell_[n.a] + 8 + n.index : cell_[v];
  }

  Shape shape(Value v) const {
    Shape out;
    if (node(v).what != Node::Sum) return {node(v).last - node(v).first, 0, 0};
    for (std::uint32_t t = node(v).first; t < node(v).last; ++t)
      ++list(line_.terms[t], out.linear, out.products, out.triples);
    return out;
  }

  template <class T>
  static T& list(const Term& term, T& linear, T& products, T& triples) {
    return term.c != none ? triples : term.b != none ? products : linear;
  }

  /// Nodes of one key stand together.
  std::tuple<bool, std::uint32_t, int, std::uint32_t, std::uint32_t, std::uint32_t, bool> key(Value v) const {
    const Node& n = node(v);
    const Shape s = shape(v);
    return {changes_[v],
            level_[v],
            n.what,
            s.linear,
            s.products,
            s.triples,
            n.what == Node::Sum && (n.a != none || n.b != none)};
  }

  void write(std::span<const Value> run) {
    switch (node(run[0]).what) {
      case Node::Sum:
        return write_sums(run);
      case Node::Wide:
        return write_wides(run);
      case Node::Angles:
        return write_angles(run);
      case Node::Magnitudes:
      case Node::Larger:
        return write_sizes(run);
      case Node::Chosen:
      case Node::Root:
      case Node::Call:
        return write_others(run);
      case Node::Literal:
      case Node::Given:
      case Node::Sine:
      case Node::Cosine:
      case Node::Unit:
      case Node::Lane:
      case Node::Gather:
        break;
    }
    throw std::logic_error("a straight line holds a node that is not evaluated; please report");
  }

  template <class Items>
  void step(EvaluationStep::Kind kind, const Items& items) {
    out_.steps_.push_back({kind, static_cast<std::uint32_t>(items.size() - 1)});
  }
  template <class Items>
  static std::uint32_t size(const Items& items) {
    return static_cast<std::uint32_t>(items.size());
  }

  CellTerm term(std::uint32_t t) const {
    const Term& term = line_.terms[t];
    return {term.factor, cell(term.a), cell(term.b), cell(term.c)};
  }

  void write_sums(std::span<const Value> run) {
    const Shape s = shape(run[0]);
    const bool scales = node(run[0]).a != none || node(run[0]).b != none;
    out_.sums_.push_back({s.linear, s.products, s.triples, size(run), take(run.size()), size(out_.linear_),
                          size(out_.products_), size(out_.triples_), scales ? size(out_.scales_) : no_scale});
    step(EvaluationStep::Sums, out_.sums_);
    for (std::uint32_t i = 0; i < run.size(); ++i) {
      const Node& n = node(run[i]);
      cell_[run[i]] = out_.sums_.back().out + i;
      for (std::uint32_t t = n.first; t < n.last; ++t)
        list(line_.terms[t], out_.linear_, out_.products_, out_.triples_).push_back(term(t));
      if (scales) out_.scales_.insert(out_.scales_.end(), {cell(n.a), cell(n.b)});
    }
  }

  void write_wides(std::span<const Value> run) {
    out_.wides_.push_back({shape(run[0]).linear, size(run), take(8 * run.size(), 8), size(out_.wide_terms_)});
    step(EvaluationStep::Wides, out_.wides_);
    for (std::uint32_t i = 0; i < run.size(); ++i) {
      cell_[run[i]] = out_.wides_.back().out + 8 * i;
      for (std::uint32_t t = node(run[i]).first; t < node(run[i]).last; ++t) {
        const Term& wide = line_.terms[t];
        out_.wide_terms_.push_back({wide.factor, cell(wide.a), cell(wide.c), cell_of_one});
      }
    }
  }

  void write_sizes(std::span<const Value> run) {
    const bool compares = node(run[0]).what == Node::Larger;
    out_.sizes_.push_back({shape(run[0]).linear, size(run), take(run.size()), size(out_.size_terms_)});
    step(compares ? EvaluationStep::Larger : EvaluationStep::Magnitudes, out_.sizes_);
    for (std::uint32_t i = 0; i < run.size(); ++i) {
      const Node& n = node(run[i]);
      cell_[run[i]] = out_.sizes_.back().out + i;
      if (compares) out_.size_terms_.push_back({1, cell(n.a), cell(n.b), cell_of_one});
      for (std::uint32_t t = n.first; t < n.last; ++t) out_.size_terms_.push_back(term(t));
    }
  }

  void write_angles(std::span<const Value> run) {
    for (const Value v : run) {
      AngleStep angles{{}, cell_[v] = take(16, 8)};
      angles.angle.fill(cell_of_one);
      for (std::uint32_t i = node(v).first; i < node(v).last; ++i)
        angles.angle[i - node(v).first] = cell(line_.operands[i]);
      out_.angles_.push_back(angles);
      step(EvaluationStep::Angles, out_.angles_);
    }
  }

  void write_others(std::span<const Value> run) {
    for (const Value v : run) {
      const Node& n = node(v);
      cell_[v] = take(1);
      out_.others_.push_back({n.what, n.function, cell_[v], cell(n.a), cell(n.b), cell(n.c)});
      step(EvaluationStep::Other, out_.others_);
    }
  }

  const StraightLine& line_;
  Evaluation& out_;
  std::vector<Cell> cell_;            // [nodes]
  std::vector<std::uint32_t> level_;  // [nodes] how many others it waits for, one after the other
  std::vector<bool> changes_;         // [nodes] whether it follows from more than the seldom arrays
  std::vector<bool> is_seldom_;       // [arrays]
};

Evaluation::Evaluation(const StraightLine& line, std::span<const std::uint32_t> seldom) {
  EvaluationLayout(line, seldom, *this).run();
  if (seldom_given_.empty()) run_steps(cells_.data(), 0, changing_);
}

void Evaluation::run_steps(double* cells, std::size_t first, std::size_t last) const {
  static const Evaluate evaluate = best_evaluate();
  struct Context {
    const Evaluation& evaluation;
    double* cells;
  } context{*this, cells};
  const auto other = [](void* of, std::uint32_t index) {
    const auto& [evaluation, all] = *static_cast<Context*>(of);
    const OtherNode& node = evaluation.others_[index];
    all[node.out] = value(node.what, node.function, all[node.a], all[node.b], all[node.c]);
  };
  evaluate({sums_.data(), wides_.data(), sizes_.data(), angles_.data(), linear_.data(), products_.data(),
            triples_.data(), wide_terms_.data(), size_terms_.data(), scales_.data(), cells, &context, other},
           steps_.data() + first, steps_.data() + last);
}

void Evaluation::set(double* cells, double* const* arrays) const {
  for (const Load& load : seldom_given_) cells[load.cell] = arrays[load.array][load.index];
  run_steps(cells, 0, changing_);
}

bool Evaluation::run(double* cells, double* const* arrays) const {
  for (const Load& load : given_) cells[load.cell] = arrays[load.array][load.index];
  run_steps(cells, changing_, steps_.size());
  const bool sound = is_sound(cells);
  if (sound || !guarded_)
    for (const Load& store : stores_) arrays[store.array][store.index] = cells[store.cell];
  return sound;
}

bool Evaluation::is_sound(const double* cells) const {
  double rest = 0;
  bool sound = true;
  for (const Check& check : checks_) {
    const double margin = cells[check.pivot] - check.share * cells[check.size];
    sound &= margin > 0;
    rest += 0 * margin;
  }
  for (const Cell cell : finite_) rest += 0 * cells[cell];
  return sound && rest == 0;
}

}  // namespace maupertuis::straight
