#include <maupertuis/locus.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

namespace maupertuis {

std::vector<double> values_without_points(const Locus& locus) {
  std::set<double> seen;
  for (const LocusBranch& b : locus.branches)
    for (const LocusPoint& x : b.points) seen.insert(x.parameter);
  std::vector<double> out;
  std::copy_if(locus.values.begin(), locus.values.end(), std::back_inserter(out),
               [&](double value) { return seen.count(value) == 0; });
  return out;
}

std::string to_csv(const MechanicalSystem& system, const Locus& locus) {
  const auto unit = [&](const Dimension& d) {
    const std::string word = system.dimensionless ? "1" : to_string(d);
    return word == "1" ? std::string() : " [" + word + "]";
  };
  const Parameter& p = system.parameters[locus.parameter];
  std::string out = p.name + unit(p.dimension) + ",branch,verdict";
  for (const Coordinate& c : system.coordinates) out += fmt::format(",{}{}", c.name, unit(c.dimension));
  for (const Coordinate& c : system.coordinates)
    out += fmt::format(",{}'{}", c.name, unit(c.dimension / system.independent_dimension));
  std::size_t eigenvalues = 0;
  for (const LocusBranch& b : locus.branches)
    for (const LocusPoint& x : b.points) eigenvalues = std::max(eigenvalues, x.eigenvalues.size());
  for (std::size_t i = 1; i <= eigenvalues; ++i) out += fmt::format(",re{0},im{0}", i);
  out += "\r\n";
  for (std::size_t b = 0; b < locus.branches.size(); ++b)
    for (const LocusPoint& x : locus.branches[b].points) {
      out += fmt::format("{:.17g},{},{}", x.parameter, b + 1, stability_word(x.stability.verdict));
      for (const auto* list : {&x.equilibrium.point.q, &x.equilibrium.point.v})
        for (const double value : *list) out += fmt::format(",{:.17g}", value);
      for (std::size_t i = 0; i < eigenvalues; ++i)
        out += i < x.eigenvalues.size()
                   ? fmt::format(",{:.17g},{:.17g}", x.eigenvalues[i].real(), x.eigenvalues[i].imag())
                   : ",nan,nan";
      out += "\r\n";
    }
  return out;
}

}  // namespace maupertuis
