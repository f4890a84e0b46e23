#pragma once
#include <maupertuis/transform.hpp>

#include <unordered_map>
#include <vector>

namespace maupertuis {

/// The place of each name of a ReadingOrder.
struct ReadingPlaces {
  std::vector<Expr> listed_parameters, listed_coordinates;  // that these are the places of
  std::unordered_map<NodeId, std::uint32_t> parameters;
  std::unordered_map<std::string, std::uint32_t> coordinates;  // by name, so that primes do not matter
};

/// Cost: once for an order and its copies, then a comparison of the lists.
std::shared_ptr<const ReadingPlaces> places_of(const ReadingOrder& order);

}  // namespace maupertuis

/// Where a factor stands in a product and a term in a sum.
namespace maupertuis::print {

/// Sort keys are compared lexicographically; smaller stands first.
using Rank = std::vector<std::uint32_t>;

class ReadingRanks {
 public:
  explicit ReadingRanks(const ReadingOrder& order);

  /// number, parameter sums, parameters, time and inputs, coordinates, momenta, functions, velocities, accelerations.
  Rank factor(Expr factor) const;
  /// Accelerations (the own one first, if asked), velocities (squares, products, single ones), then what has none of
  /// them.
  Rank term(Expr term, bool own_first) const;
  /// Inside sin( ) and cos( ): coordinates before everything, in declared order.
  Rank angle_term(Expr term) const;

 private:
  std::uint32_t symbol_rank(Expr symbol) const;
  std::uint32_t declared_rank(Expr symbol) const;
  std::uint32_t rate_rank(Expr symbol, bool own_first) const;
  Rank rank_of_rest(Expr term) const;

  std::shared_ptr<const ReadingPlaces> places_;
  std::string own_;
};

}  // namespace maupertuis::print
