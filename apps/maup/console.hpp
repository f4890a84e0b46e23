#pragma once
#include "progress_line.hpp"

#include <maupertuis/diagnostic.hpp>

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>

namespace maupertuis::app {

/// Where a command puts what it has to say: data on standard output, messages on standard error. Characters that a
/// terminal would act on instead of showing them, as names of models and files can hold, are spelled out
/// (look_alikes.hpp).
class Console {
 public:
  enum class Color { Auto, Always, Never };

  void use_color(Color color) { color_ = color; }
  void use_json(bool json) { json_ = json; }
  bool json() const { return json_; }

  /// Collects data; it is written at once by flush(), so that a full disk or a closed pipe is noticed and said.
  void print(std::string_view text);
  /// The same for the text of a file, byte by byte where standard output is no terminal.
  void print_file(std::string_view text);
  void print_document(const nlohmann::ordered_json& document);
  /// Renders to standard error (nothing under --json, whose document holds the diagnostics).
  void show(const Diagnostics& diagnostics, const SourceTexts& texts) const;
  void say(std::string_view text) const;
  /// To standard error as it is: escape sequences of our own.
  void draw(std::string_view text) const;

  /// From here on a line of the terminal tells what is done, where standard error is one and nothing asks for JSON.
  void begin_progress(std::string command);
  void end_progress() { progress_.reset(); }
  /// The line; null where there is none.
  ProgressLine* progress() const { return progress_.get(); }
  /// The part of the work that begins.
  void at(std::string part) const {
    if (progress_) progress_->tell(std::move(part));
  }

  /// Whether something was printed that flush() will write.
  bool has_data() const { return !data_.empty(); }
  /// What an interrupted command leaves, where that is not what it printed: "run.svg shows the motion up to t = 3 s."
  void leaves(std::string sentence) { left_ = std::move(sentence); }
  const std::string& left() const { return left_; }
  /// Writes what was printed; the reason when it could not be written, else empty.
  std::string flush();

  bool colored_messages() const;
  /// Standard error is a terminal, so that progress may be drawn on it.
  bool interactive() const;

 private:
  Color color_ = Color::Auto;
  bool json_ = false;
  std::string data_, left_;
  std::unique_ptr<ProgressLine> progress_;
};

}  // namespace maupertuis::app
