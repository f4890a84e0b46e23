#pragma once
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

/// Random smooth models as text: coupled kinetic energies, polynomial and periodic potentials, numbers that double does
/// not hold.
namespace maupertuis::property {

class RandomModel {
 public:
  explicit RandomModel(std::uint64_t seed) : random_(seed) {}

  /// `unknowns` coordinates, bounded motions, a run of `duration`.
  std::string text(int unknowns, double duration) {
    static const char* const names[] = {"a", "b", "c", "d", "e1", "f"};
    std::string coordinates, kinetic, potential, start;
    for (int i = 0; i < unknowns; ++i) {
      const std::string x = names[i];
      coordinates += (i ? ", " : "") + x;
      kinetic += (i ? " + " : "") + fmt::format("1/2 {} {}'^2", number(0.7, 2.5), x);
      potential += (i ? " + " : "") + well(x);
      start += (i ? ", " : "") + fmt::format("{} = {}, {}' = {}", x, number(-1.4, 1.4), x, number(-1, 1));
      if (i == 0) continue;
      const std::string y = names[i - 1];
      kinetic += fmt::format(" + {} {} {}' {}'", number(0.05, 0.3),
                             one_of({"cos(" + y + " - " + x + ")", "cos(" + x + ")", "(1/3)"}), y, x);
      potential += " + " + one_of({fmt::format("1/2 {} ({} - {})^2", number(0.1, 2), y, x),
                                   fmt::format("{} {}^2 {}^2", number(0.05, 0.5), y, x),
                                   fmt::format("{} cos({} - 2 {})", number(0.1, 1.5), y, x)});
    }
    const std::string friction = coin(0.25) ? fmt::format("D = 1/2 {} a'^2\n", number(0.05, 0.5)) : "";
    return "system random\ndimensionless\ncoord " + coordinates + " : number\nT = " + kinetic + "\nV = " + potential +
           "\n" + friction + "start " + start + fmt::format("\nrun {}\n", duration);
  }

 private:
  double uniform(double low, double high) { return low + (high - low) * std::generate_canonical<double, 53>(random_); }
  bool coin(double probability) { return uniform(0, 1) < probability; }
  std::string one_of(const std::vector<std::string>& choices) { return choices[random_() % choices.size()]; }
  /// Three decimals.
  std::string number(double low, double high) { return fmt::format("({:.3f})", uniform(low, high)); }
  std::string well(const std::string& x) {
    return one_of({fmt::format("1/2 {} {}^2", number(0.4, 6), x),
                   fmt::format("1/2 {} {}^2 + {} {}^4", number(-1, 3), x, number(0.1, 1), x),
                   fmt::format("{} (1 - cos {})", number(1, 9), x), fmt::format("{} sqrt(1 + {}^2)", number(0.5, 4), x),
                   fmt::format("{} (exp(0.4 {}) + exp(-0.4 {}))", number(0.5, 3), x, x)});
  }

  std::mt19937_64 random_;
};

}  // namespace maupertuis::property
