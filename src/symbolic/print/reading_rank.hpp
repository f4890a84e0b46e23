#pragma once
#include <maupertuis/transform.hpp>

#include <unordered_map>
#include <vector>

/// Where a factor stands in a product and a term in a sum.
namespace maupertuis::print {

/// Sort keys are compared lexicographically; smaller stands first.
using Rank = std::vector<std::uint32_t>;

class ReadingRanks {
 public:
  explicit ReadingRanks(const ReadingOrder& order);

  /// number, parameter sums, parameters, time and inputs, coordinates, momenta, functions, velocities, accelerations.
  Rank factor(Expr factor) const;
  /// Accelerations (the own one first, if asked), velocities (squares, products, single ones), then what has none of them.
  Rank term(Expr term, bool own_first) const;
  /// Inside sin( ) and cos( ): coordinates before everything, in declared order.
  Rank angle_term(Expr term) const;

 private:
  std::uint32_t symbol_rank(Expr symbol) const;
  std::uint32_t declared_rank(Expr symbol) const;
  std::uint32_t rate_rank(Expr symbol, bool own_first) const;
  Rank rank_of_rest(Expr term) const;

  std::unordered_map<NodeId, std::uint32_t> parameters_;
  std::unordered_map<std::string, std::uint32_t> coordinates_;   // by name, so that primes do not matter
  std::string own_;
};

}  // namespace maupertuis::print
