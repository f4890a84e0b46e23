#include <maupertuis/dirac.hpp>
#include <maupertuis/print.hpp>
#include <maupertuis/transform.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace maupertuis {
namespace {

std::string plural(std::size_t number, const char* one, const char* many) {
  return fmt::format("{} {}", number, number == 1 ? one : many);
}

/// "Secondary constraints"
std::string title(int generation) {
  static constexpr std::array words{"Primary", "Secondary", "Tertiary", "Quaternary"};
  return generation < static_cast<int>(words.size())
             ? fmt::format("{} constraints", words[static_cast<std::size_t>(generation)])
             : fmt::format("Constraints of generation {}", generation + 1);
}

class DiracLines {
 public:
  DiracLines(const DiracAnalysis& found, const Hamiltonian& h) : found_(found), h_(h) {}

  std::vector<DerivationStep> write(const DegenerateAnalysis* of_lagrange) {
    for (const PhaseConstraint& c : found_.constraints)
      if (c.generation > 0) formula(title(c.generation), "dφ/dt = 0 of those before", layouts::number("0"), c.value);
    for (const BranchChoice& b : found_.branches)
      sentence("Branches", fmt::format("{} = 0 has several branches: this is {} = 0{}.", to_plain(b.product, h_.order),
                                       to_plain(b.kept, h_.order), b.at_start ? ", where the start is" : ""));
    if (found_.outcome != ConstraintChain::Outcome::Closed) {
      sentence("Classes", found_.outcome == ConstraintChain::Outcome::Contradiction
                              ? "The last constraint cannot be fulfilled: there is no motion."
                          : found_.outcome == ConstraintChain::Outcome::Varies
                              ? "What vanishes near the start does not vanish elsewhere: the classes are not the same "
                                "everywhere."
                              : "No state near the start was found that fulfils the last constraint.");
      return std::move(lines_);
    }
    classes();
    if (of_lagrange && of_lagrange->closed()) counts(*of_lagrange);
    generators();
    return std::move(lines_);
  }

 private:
  void formula(const std::string& section, const std::string& rule, Layout left, Expr right) {
    lines_.push_back({section, rule, std::move(left), right, {}, {}});
  }
  void sentence(const std::string& section, std::string text) {
    lines_.push_back({section, {}, {}, {}, std::move(text), {}});
  }

  void classes() {
    const std::string section = "Classes";
    sentence(section, fmt::format("{} of the first class, {} of the second: phase space has 2·{} − 2·{} − {} = {} "
                                  "physical dimensions, {}.",
                                  plural(found_.first_class, "constraint", "constraints"), found_.second_class,
                                  h_.momenta.size(), found_.first_class, found_.second_class, found_.physical_dimension,
                                  freedoms()));
    if (found_.second_class > 0)
      for (const Expr& f : found_.first_class_functions)
        formula(section, "of the first class", layouts::number("0"), f);
    if (found_.primary_first_class > 0)
      sentence(section, fmt::format("{} of the total Hamiltonian H + u φ stay{} free.",
                                    plural(found_.primary_first_class, "multiplier", "multipliers"),
                                    found_.primary_first_class == 1 ? "s" : ""));
  }

  std::string freedoms() const {
    const std::size_t d = found_.physical_dimension;
    return d % 2 == 0 ? plural(d / 2, "freedom", "freedoms") : fmt::format("{}/2 freedoms", d);
  }

  /// δq = {q, G}, coordinate by coordinate: ε' + ε x.
  void generators() {
    for (std::size_t g = 0; g < found_.generators.size(); ++g) {
      const GaugeGenerator& generator = found_.generators[g];
      const std::string section =
          found_.generators.size() == 1 ? "Gauge transformation" : fmt::format("Gauge transformation {}", g + 1);
      formula(section, "generator", layouts::name("G"), with_epsilon(generator.parts));
      for (std::size_t i = 0; i < generator.changes.size(); ++i) {
        const Expr change = with_epsilon(generator.changes[i]);
        if (!change.is_zero())
          formula(section, "δq = {q, G}", layouts::name("δ" + h_.system->coordinates[i].name), change);
      }
      sentence(section, "With any function ε(t) it turns motions into motions: proved by Noether's identity.");
    }
  }

  Expr with_epsilon(const ExprVector& parts) const {
    Context& context = *h_.system->context;
    ExprVector terms;
    for (std::size_t k = 0; k < parts.size(); ++k)  // a function of t alone, as an input is
      terms.push_back(context.symbol("ε", Role::Input, static_cast<int>(k)) * parts[k]);
    return context.sum(terms);
  }

  /// Whether the constraints, with p = ∂L/∂q' in them, hold on Lagrange's side too.
  bool on_one_branch(const DegenerateAnalysis& lagrange) const {
    const ExprVector momenta = MotionTerms(*h_.system)(h_.momentum_values);
    ExprMap values;
    for (std::size_t i = 0; i < momenta.size(); ++i) values.emplace(h_.momenta[i], expand_time_derivatives(momenta[i]));
    return std::all_of(found_.constraints.begin(), found_.constraints.end(), [&](const PhaseConstraint& c) {
      return lagrange.chain.where->vanishes(substitute(c.value, values)) != Verdict::Nonzero;
    });
  }

  void counts(const DegenerateAnalysis& lagrange) {
    const std::string section = "Classes";
    const std::string who =
        h_.system->gauges.empty() ? "Lagrange's equations" : "Lagrange's equations without the gauge";
    if (lagrange.motions == found_.physical_dimension) {
      sentence(section, fmt::format("{} count alike: {} out a motion.", who,
                                    plural(lagrange.motions, "number singles", "numbers single")));
      return;
    }
    if (!on_one_branch(lagrange)) {
      sentence(section,
               "Lagrange's equations were looked at on another branch of the constraints: the two counts are "
               "not those of one set of motions.");
      return;
    }
    sentence(section,
             fmt::format("{} count otherwise: {} out a motion, not {}. Some constraint of "
                         "the first class moves no motion: Dirac's conjecture, that all of them do, fails here.",
                         who, plural(lagrange.motions, "number singles", "numbers single"), found_.physical_dimension));
  }

  const DiracAnalysis& found_;
  const Hamiltonian& h_;
  std::vector<DerivationStep> lines_;
};

}  // namespace

std::vector<DerivationStep> dirac_lines(const DiracAnalysis& analysis, const Hamiltonian& hamiltonian,
                                        const DegenerateAnalysis* of_lagrange) {
  return DiracLines(analysis, hamiltonian).write(of_lagrange);
}

}  // namespace maupertuis
