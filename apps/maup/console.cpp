#include "console.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <maupertuis/look_alikes.hpp>
#include <nlohmann/json.hpp>

namespace maupertuis::app {

void Console::print(std::string_view text) { data_ += visible(text); }

void Console::print_file(std::string_view text) {
  if (isatty(STDOUT_FILENO) == 1)
    print(text);
  else
    data_ += text;
}

void Console::print_document(const nlohmann::ordered_json& document) {
  // `replace`: a name from a file that is not UTF-8 must not stop the document.
  // Characters that turn the direction of writing become escapes of JSON's own form.
  data_ += visible(document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) + "\n";
}

void Console::show(const Diagnostics& diagnostics, const SourceTexts& texts) const {
  if (!json_ && !diagnostics.empty()) draw(render(diagnostics, texts, {.color = colored_messages()}));
}

void Console::say(std::string_view text) const { draw(visible(text)); }

void Console::draw(std::string_view text) const {
  if (progress_) progress_->wipe();
  std::fwrite(text.data(), 1, text.size(), stderr);
}

void Console::begin_progress(std::string command) {
  constexpr std::chrono::milliseconds patience(1000);
  if (json_ || !interactive()) return;
  progress_ = std::make_unique<ProgressLine>(
      std::move(command), patience, [](std::string_view text) { std::fwrite(text.data(), 1, text.size(), stderr); });
}

std::string Console::flush() {
  errno = 0;
  const bool written = std::fwrite(data_.data(), 1, data_.size(), stdout) == data_.size() && std::fflush(stdout) == 0;
  data_.clear();
  if (written) return {};
  return errno == EPIPE ? "its reader has closed the pipe" : std::strerror(errno);
}

// A dumb terminal shows escape sequences instead of carrying them out.
bool Console::interactive() const {
  const char* const terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && (!terminal || std::strcmp(terminal, "dumb") != 0);
}

bool Console::colored_messages() const {
  if (color_ != Color::Auto) return color_ == Color::Always;
  const char* no_color = std::getenv("NO_COLOR");
  return interactive() && (!no_color || !*no_color);
}

}  // namespace maupertuis::app
