#pragma once
#include "kernel/straight_line/evaluate.hpp"
#include "kernel/straight_line/straight_line.hpp"

#include <boost/align/aligned_allocator.hpp>
#include <span>
#include <vector>

namespace maupertuis::straight {

/// Runs a straight line number by number, where there is no machine code of it: nodes that do not wait for each other and have as many
/// terms stand together, so that the loop over them has no branches of its own. Nothing is allocated after construction.
/// Precondition: wide nodes are Unit, Wide and Lane alone, of up to 8 lanes.
class Evaluator {
 public:
  /// `seldom`: arrays whose numbers change seldom. What follows from them alone is computed by set() and not again.
  explicit Evaluator(const StraightLine& line, std::span<const std::uint32_t> seldom = {});

  /// After numbers of the seldom arrays changed; the other arrays are not read.
  template <class... Arrays>
  void set(Arrays... arrays) {
    double* const all[] = {const_cast<double*>(static_cast<const double*>(arrays))...};
    fetch(seldom_given_, all);
    run(0, changing_);
  }
  /// As straight::Code: whether all went well; results of a guarded line are stored only then. The seldom arrays are not read.
  template <class... Arrays>
  bool operator()(Arrays... arrays) {
    double* const all[] = {const_cast<double*>(static_cast<const double*>(arrays))...};
    return evaluate(all);
  }

 private:
  friend class Layout;

  struct Load {
    std::uint32_t array, index;
    Cell cell;
  };
  /// A node besides sums and sines: its operands by their cells.
  struct OtherNode {
    Node::What what;
    Kind function;
    Cell out, a, b, c;
    std::uint32_t first = 0, last = 0;  // Magnitudes: terms
  };
  struct Check {
    Cell pivot, size;
    double share;
  };

  void fetch(const std::vector<Load>& given, double* const* arrays) {
    for (const Load& load : given) cells_[load.cell] = arrays[load.array][load.index];
  }
  void run(std::size_t first, std::size_t last);
  bool evaluate(double* const* arrays);
  bool is_sound() const;
  static void other(void* self, std::uint32_t index);
  double value(const OtherNode& node) const;

  std::vector<EvaluationStep> steps_;
  std::size_t changing_ = 0;                 // the first step that does not follow from seldom arrays alone
  std::vector<SumRun> sums_;
  std::vector<WideRun> wides_;
  std::vector<AngleStep> angles_;
  std::vector<OtherNode> others_;
  std::vector<CellTerm> linear_, products_, triples_, wide_terms_, magnitudes_;
  std::vector<Cell> scales_;
  std::vector<Load> given_, seldom_given_, stores_;
  std::vector<Check> checks_;
  std::vector<Cell> finite_;
  bool guarded_ = false;
  std::vector<double, boost::alignment::aligned_allocator<double, 64>> cells_;
};

}  // namespace maupertuis::straight
