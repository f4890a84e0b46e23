#include "console.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

namespace maupertuis::app {

void Console::print_document(const nlohmann::ordered_json& document) {
  // `replace`: a name from a file that is not UTF-8 must not stop the document.
  data_ += document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void Console::show(const Diagnostics& diagnostics, const SourceText& source) const {
  if (!json_ && !diagnostics.empty()) say(render(diagnostics, source, {.color = colored_messages()}));
}

void Console::say(std::string_view text) const { std::fwrite(text.data(), 1, text.size(), stderr); }

std::string Console::flush() {
  errno = 0;
  const bool written = std::fwrite(data_.data(), 1, data_.size(), stdout) == data_.size() && std::fflush(stdout) == 0;
  data_.clear();
  if (written) return {};
  return errno == EPIPE ? "its reader has closed the pipe" : std::strerror(errno);
}

bool Console::interactive() const { return isatty(STDERR_FILENO) == 1; }

bool Console::colored_messages() const {
  if (color_ != Color::Auto) return color_ == Color::Always;
  const char* no_color = std::getenv("NO_COLOR");
  return interactive() && (!no_color || !*no_color);
}

}  // namespace maupertuis::app
