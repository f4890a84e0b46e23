#pragma once
#include "kernel/straight_line/evaluate.hpp"
#include "kernel/straight_line/straight_line.hpp"

#include <boost/align/aligned_allocator.hpp>
#include <span>
#include <vector>

namespace maupertuis::straight {

/// Numbers of an evaluation, aligned to 64 bytes.
using Cells = std::vector<double, boost::alignment::aligned_allocator<double, 64>>;

/// Runs a straight line where there is no machine code of it. Its nodes are sorted first: by level (a node is one level
/// above the highest of its operands, so that nodes of one level can be computed in any order), and within a level by
/// kind and number of terms. So one loop without branches runs all nodes that are alike. Nothing changes after
/// construction. Precondition: wide nodes are Unit, Wide and Lane alone, of up to 8 lanes.
class Evaluation {
 public:
  /// `seldom`: arrays whose numbers change seldom. What follows from them alone is computed by set() and not again.
  explicit Evaluation(const StraightLine& line, std::span<const std::uint32_t> seldom = {});

  /// What its cells hold at the beginning. Where angles or wide nodes are in the line, cells have to be aligned to 64
  /// bytes.
  const Cells& cells() const { return cells_; }
  /// After numbers of the seldom arrays changed; the other arrays are not read.
  void set(double* cells, double* const* arrays) const;
  /// Whether all went well; results of a guarded line are stored only then. The seldom arrays are not read.
  bool run(double* cells, double* const* arrays) const;

 private:
  friend class EvaluationLayout;

  struct Load {
    std::uint32_t array, index;
    Cell cell;
  };
  /// A node besides sums, sizes and sines: its operands by their cells.
  struct OtherNode {
    Node::What what;
    Kind function;
    Cell out, a, b, c;
  };
  struct Check {
    Cell pivot, size;
    double share;
  };

  void run_steps(double* cells, std::size_t first, std::size_t last) const;
  bool is_sound(const double* cells) const;

  std::vector<EvaluationStep> steps_;
  std::size_t changing_ = 0;  // the first step that does not follow from seldom arrays alone
  std::vector<SumRun> sums_;
  std::vector<WideRun> wides_;
  std::vector<SizeRun> sizes_;
  std::vector<AngleStep> angles_;
  std::vector<OtherNode> others_;
  std::vector<CellTerm> linear_, products_, triples_, wide_terms_, size_terms_;
  std::vector<Cell> scales_;
  std::vector<Load> given_, seldom_given_, stores_;
  std::vector<Check> checks_;
  std::vector<Cell> finite_;
  bool guarded_ = false;
  Cells cells_;
};

/// An evaluation with cells of its own, called as straight::Code is.
class Evaluator {
 public:
  explicit Evaluator(const StraightLine& line, std::span<const std::uint32_t> seldom = {})
      : evaluation_(line, seldom), cells_(evaluation_.cells()) {}

  template <class... Arrays>
  void set(Arrays... arrays) {
    double* const all[] = {const_cast<double*>(static_cast<const double*>(arrays))...};
    evaluation_.set(cells_.data(), all);
  }
  template <class... Arrays>
  bool operator()(Arrays... arrays) {
    double* const all[] = {const_cast<double*>(static_cast<const double*>(arrays))...};
    return evaluation_.run(cells_.data(), all);
  }

 private:
  Evaluation evaluation_;
  Cells cells_;
};

}  // namespace maupertuis::straight
