#include "disks/many_disks.hpp"
#include "disks/values.hpp"

#include <numbers>

/// Compiled for each instruction set, by the lanes that its registers hold.
namespace maupertuis {
namespace {

using disk_rules::Lanes;

class OnLanes final : public ManyDisks::Values {
 public:
  explicit OnLanes(const DiskPlan& plan) : plan_(plan), values_(plan) {}

  std::size_t passes() const override { return count; }

  void evaluate(const SlotCoefficients& coefficients, const ManyDisks::Radii& radii, std::size_t pass,
                std::span<const ResidualTerms::Term> terms, ManyDisks::Tails* tails) override {
    Lanes on_lanes;
    for (std::size_t l = 0; l < width; ++l) on_lanes[l] = radii[pass + count * l];
    values_.begin(coefficients);
    if (!plan_.derived.empty())  // the larger disk
      values_.evaluate(on_lanes * std::numbers::sqrt2, plan_.derived, false);
    values_.evaluate(on_lanes, plan_.needed, false);
    for (std::size_t t = 0; t < terms.size(); ++t) {
      const Lanes of_term = tails_of(terms[t]);
      for (std::size_t l = 0; l < width; ++l) tails[t][pass + count * l] = of_term[l];
    }
  }

 private:
  static constexpr std::size_t width = disk_rules::lanes, count = Disks::many / width;
  Lanes tails_of(const ResidualTerms::Term& term) const {
    return term.b == no_slot ? values_.shifted_tail(term.a, term.shift) : values_.tail_of_product(term.a, term.b);
  }

  const DiskPlan& plan_;
  DiskValues<Lanes> values_;
};

}  // namespace
}  // namespace maupertuis
