#include "fields/outlook.hpp"

#include <fmt/format.h>

#include <string>

namespace maupertuis {
namespace {

std::string in_words(double seconds) {
  return seconds < 120     ? fmt::format("{:.0f} s", seconds)
         : seconds < 7200  ? fmt::format("{:.0f} min", seconds / 60)
         : seconds < 172e3 ? fmt::format("{:.0f} h", seconds / 3600)
                           : fmt::format("{:.0f} days", seconds / 86400);
}

}  // namespace

void Outlook::after_steps(std::size_t done, double share) {
  constexpr double minute = 60, soon = 5, begun = 1;
  if (told_ || !options_.announce || !(share > 0)) return;
  const double passed = std::chrono::duration<double>(Clock::now() - begin_).count();
  if (passed < (done < 3 ? soon : begun)) return;
  told_ = true;
  if (const double seconds = passed / share; seconds >= minute)
    options_.announce(
        fmt::format("This run takes some {}, {:.0f} steps.", in_words(seconds), static_cast<double>(done) / share));
}

}  // namespace maupertuis
