#include "kernel/packed/columns.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace maupertuis::packed {
namespace {

/// Whether 8 lanes can be read at once. Lanes beyond the sums are multiplied by 0, so that they must hold numbers: they
/// do if they belong to the same pack.
bool is_range(const Sums& sums, std::size_t t) {
  const Slot first = sums[0][t].a;
  for (std::size_t lane = 0; lane < sums.size(); ++lane)
    if (sums[lane][t].a != first + lane) return false;
  return sums.size() == lanes || first % lanes == 0;
}

bool is_reversed(const Sums& sums, std::size_t t) {
  for (std::size_t lane = 0; lane < sums.size(); ++lane)
    if (sums[lane][t].a + lane != sums[0][t].a) return false;
  return sums.size() == lanes;
}

Sums by_shift_and_slot(Sums sums) {
  for (auto& terms : sums)
    std::stable_sort(terms.begin(), terms.end(),
                     [](const Term& x, const Term& y) { return std::tuple(x.shift, x.a) < std::tuple(y.shift, y.a); });
  return sums;
}

/// Whether the sums have as many terms, alike in shift and lag place by place.
bool are_alike(const Program& program, const Sums& sums) {
  const auto alike = [&](const Term& x, const Term& y) {
    return x.shift == y.shift && program.tangent_lags[x.a] == program.tangent_lags[y.a];
  };
  return std::all_of(sums.begin(), sums.end(), [&](const auto& terms) {
    return std::equal(terms.begin(), terms.end(), sums[0].begin(), sums[0].end(), alike);
  });
}

std::vector<ReadColumn> columns_by_operand(const Sums& sums, ConstantId zero) {
  std::map<std::pair<std::uint32_t, Slot>, std::vector<ConstantId>> by_operand;
  for (std::size_t lane = 0; lane < sums.size(); ++lane)
    for (const Term& term : sums[lane]) {
      auto& column = by_operand[{term.shift, term.a}];
      column.resize(lanes, zero);
      column[lane] = term.coefficient;
    }
  std::vector<ReadColumn> found;
  for (const auto& [key, coefficients] : by_operand)
    found.push_back({{.kind = Column::Broadcast, .shift = static_cast<std::uint8_t>(key.first), .source = key.second},
                     coefficients});
  return found;
}

bool is_single(const Sums& sums, std::size_t t) {
  return std::all_of(sums.begin(), sums.end(), [&](const auto& terms) { return terms[t].a == sums[0][t].a; });
}

/// Whole vectors that most lanes take their operand from, one after the other; what is left, by operand.
std::vector<ReadColumn> columns_with_holes(const Program& program, Sums sums, ConstantId zero) {
  constexpr std::size_t least_lanes = 3;
  using Key = std::tuple<std::uint32_t, Slot>;  // shift, first slot
  std::vector<ReadColumn> found;
  for (;;) {
    std::map<Key, std::size_t> lanes_of;
    for (std::size_t lane = 0; lane < sums.size(); ++lane)
      for (const Term& term : sums[lane]) {
        const Slot first = term.a / lanes * lanes;
        if (term.a == first + lane && program.lags[first] == program.lags[term.a] &&
            program.tangent_lags[first] == program.tangent_lags[term.a])
          ++lanes_of[{term.shift, first}];
      }
    const auto best = std::max_element(lanes_of.begin(), lanes_of.end(),
                                       [](const auto& x, const auto& y) { return x.second < y.second; });
    if (best == lanes_of.end() || best->second < least_lanes) break;
    const std::uint32_t shift = std::get<0>(best->first);
    const Slot first = std::get<1>(best->first);
    ReadColumn read{{.kind = Column::Contiguous, .shift = static_cast<std::uint8_t>(shift), .source = first},
                    std::vector<ConstantId>(lanes, zero)};
    for (Slot lane = 0; lane < lanes; ++lane) read.column.sources[lane] = first + lane;
    for (std::size_t lane = 0; lane < sums.size(); ++lane) {
      const auto term = std::find_if(sums[lane].begin(), sums[lane].end(),
                                     [&](const Term& x) { return x.shift == shift && x.a == first + lane; });
      if (term == sums[lane].end()) continue;
      read.coefficients[lane] = term->coefficient;
      sums[lane].erase(term);
    }
    found.push_back(std::move(read));
  }
  for (ReadColumn& read : columns_by_operand(sums, zero)) found.push_back(std::move(read));
  return found;
}

/// Of sums that are alike.
std::vector<ReadColumn> columns_by_place(const Sums& sums) {
  std::vector<ReadColumn> found;
  for (std::size_t t = 0; t < sums[0].size(); ++t) {
    ReadColumn read{{.kind = is_single(sums, t)     ? Column::Broadcast
                             : is_range(sums, t)    ? Column::Contiguous
                             : is_reversed(sums, t) ? Column::Reversed
                                                    : Column::Gather,
                     .shift = static_cast<std::uint8_t>(sums[0][t].shift),
                     .source = sums[0][t].a},
                    {}};
    read.column.sources.fill(sums[0][t].a);
    for (std::size_t lane = 0; lane < sums.size(); ++lane) {
      read.column.sources[lane] = sums[lane][t].a;
      read.coefficients.push_back(sums[lane][t].coefficient);
    }
    found.push_back(std::move(read));
  }
  return found;
}

/// Shift and lag: terms of one kind stand in one column.
using TermKind = std::pair<std::uint32_t, int>;
TermKind kind_of(const Program& program, const Term& term) { return {term.shift, program.lags[term.a]}; }

/// The `place`-th term of its kind in each sum, if there is one.
ReadColumn aligned_column(const Program& program, const Sums& sums, TermKind kind, std::size_t place, ConstantId zero) {
  ReadColumn read{{.kind = Column::Gather, .shift = static_cast<std::uint8_t>(kind.first)}, {}};
  std::vector<Slot> sources;
  for (const auto& terms : sums) {
    std::size_t seen = 0;
    const auto term = std::find_if(terms.begin(), terms.end(),
                                   [&](const Term& x) { return kind_of(program, x) == kind && seen++ == place; });
    sources.push_back(term == terms.end() ? no_slot : term->a);
    read.coefficients.push_back(term == terms.end() ? zero : term->coefficient);
  }
  const Slot any = *std::find_if(sources.rbegin(), sources.rend(), [](Slot slot) { return slot != no_slot; });
  read.column.source = any;
  read.column.sources.fill(any);
  for (std::size_t lane = 0; lane < sources.size(); ++lane)
    if (sources[lane] != no_slot) read.column.sources[lane] = sources[lane];
  return read;
}

}  // namespace

std::vector<ReadColumn> columns_of(const Program& program, const Sums& unordered, ConstantId zero, bool holes) {
  const Sums sums = by_shift_and_slot(unordered);
  const auto loads = [](const std::vector<ReadColumn>& columns) {
    std::size_t count = 0;
    for (const ReadColumn& read : columns) count += read.column.kind == Column::Gather ? 5 : 1;
    return count;
  };
  std::vector<ReadColumn> best = columns_by_operand(sums, zero);
  const auto try_one = [&](std::vector<ReadColumn> other) {
    if (loads(other) < loads(best)) best = std::move(other);
  };
  if (are_alike(program, sums)) try_one(columns_by_place(sums));
  if (holes) try_one(columns_with_holes(program, sums, zero));
  return best;
}

std::vector<ReadColumn> aligned_columns_of(const Program& program, const Sums& unordered, ConstantId zero) {
  Sums sums(unordered.size());
  ReadColumn of_one{{.kind = Column::Broadcast, .source = program.one}, std::vector<ConstantId>(lanes, zero)};
  bool has_one = false;
  std::map<TermKind, std::size_t> longest;
  for (std::size_t lane = 0; lane < sums.size(); ++lane) {
    for (const Term& term : unordered[lane]) {
      if (term.a == program.one)
        has_one = true, of_one.coefficients[lane] = term.coefficient;
      else
        sums[lane].push_back(term);
    }
    std::stable_sort(sums[lane].begin(), sums[lane].end(), [&](const Term& x, const Term& y) {
      return std::pair(kind_of(program, x), x.a) < std::pair(kind_of(program, y), y.a);
    });
    std::map<TermKind, std::size_t> count;
    for (const Term& term : sums[lane]) {
      std::size_t& most = longest[kind_of(program, term)];
      most = std::max(most, ++count[kind_of(program, term)]);
    }
  }
  std::vector<ReadColumn> found;
  for (const auto& [kind, count] : longest)
    for (std::size_t place = 0; place < count; ++place)
      found.push_back(aligned_column(program, sums, kind, place, zero));
  if (has_one) found.push_back(std::move(of_one));
  return found;
}

}  // namespace maupertuis::packed
