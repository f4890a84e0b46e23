#pragma once
#include <atomic>
#include <cstddef>
#include <mutex>
#include <string>
#include <string_view>

/// The stream of the protocol: a header with Content-Length, an empty line, a JSON text.
namespace maupertuis::app::lsp {

struct Frame {
  enum class Kind { Message, Malformed, End } kind = Kind::End;
  std::string text;  // of a message its JSON; of what is malformed why
};

/// Reads frames from a file descriptor. What is no frame is told and passed over up to the next header.
class FrameReader {
 public:
  /// `stop`: looked at when a signal comes; `ended`: twice a second.
  FrameReader(int descriptor, const std::atomic<bool>& stop, const std::atomic<bool>& ended)
      : descriptor_(descriptor), stop_(stop), ended_(ended) {}

  Frame next();

 private:
  bool fill();
  Frame malformed(std::string why);
  void skip_to_header();

  int descriptor_;
  const std::atomic<bool>&stop_, &ended_;
  std::string buffer_;
  std::size_t skip_ = 0;  // bytes of a body that is too large
};

/// Writes frames, each whole, from any thread. After a failure nothing more is written.
class FrameWriter {
 public:
  explicit FrameWriter(int descriptor) : descriptor_(descriptor) {}

  void write(std::string_view json);
  const std::atomic<bool>& failed() const { return failed_; }

 private:
  int descriptor_;
  std::mutex mutex_;
  std::atomic<bool> failed_{false};
};

}  // namespace maupertuis::app::lsp
