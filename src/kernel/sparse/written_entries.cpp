#include "kernel/sparse/written_entries.hpp"

#include <utility>

namespace maupertuis::sparse {

using straight::Builder;
using straight::Term;
using straight::Value;

EntryWriter::EntryWriter(const LiftedSystem& system, EntrySources sources)
    : system_(system),
      sources_(std::move(sources)),
      number_(system.entries.size(), 0.0),
      edges_(system.entries.size()) {
  for (const std::uint32_t e : system.minus_one) number_[e] -= 1;
  for (const std::uint32_t e : system.plus_one) number_[e] += 1;
  for (std::uint32_t i = 0; i < system.edges.size(); ++i) edges_[system.entry_of_edge[i]].push_back(i);
}

Value EntryWriter::operator()(Builder& to, std::uint32_t entry) const {
  std::vector<Term> terms{{number_[entry]}};
  for (const std::uint32_t edge : edges_[entry]) terms.push_back(term(to, edge));
  return to.sum(std::move(terms));
}

Term EntryWriter::term(Builder& to, std::uint32_t i) const {
  const Edge& edge = system_.edges[i];
  const auto x = [&] { return sources_.value(to, edge.x); };
  const auto y = [&] { return sources_.value(to, edge.y); };
  const auto constant = [&] { return sources_.constant(to, edge.index); };
  switch (edge.rule) {
    case Rule::One:
      return {1};
    case Rule::Coefficient:
      return {1, constant()};
    case Rule::Scaled:
      return {1, constant(), x()};
    case Rule::Value:
      return {1, x()};
    case Rule::Negative:
      return {-1, x()};
    case Rule::Double:
      return {2, x()};
    case Rule::Reciprocal:
      return {1, to.reciprocal(x())};
    case Rule::HalfReciprocal:
      return {0.5, to.reciprocal(x())};
    case Rule::Ratio:
      return {-1, y(), to.reciprocal(x())};
    case Rule::PowerSlope:
      return {1, constant(), y(), to.reciprocal(x())};
    case Rule::Choice:
      return {1, sources_.choice(to, i)};
  }
  return {0};
}

}  // namespace maupertuis::sparse
