#pragma once
#include "kernel/sparse/lifted_system.hpp"
#include "kernel/straight_line/builder.hpp"

#include <functional>
#include <vector>

/// The entries of a lifted system as nodes of a straight line.
namespace maupertuis::sparse {

/// Where a line finds what entries are made of.
struct EntrySources {
  using Source = std::function<straight::Value(straight::Builder& to, std::uint32_t index)>;
  Source value;     // [slots] at order 0
  Source constant;  // [constants] of the program
  Source choice;    // [edges] of Rule::Choice: 1 or 0
};

class EntryWriter {
 public:
  EntryWriter(const LiftedSystem& system, EntrySources sources);
  straight::Value operator()(straight::Builder& to, std::uint32_t entry) const;

 private:
  straight::Term term(straight::Builder& to, std::uint32_t edge) const;

  const LiftedSystem& system_;
  EntrySources sources_;
  std::vector<double> number_;                     // [entries] what enters as −1 or 1
  std::vector<std::vector<std::uint32_t>> edges_;  // [entries]
};

}  // namespace maupertuis::sparse
