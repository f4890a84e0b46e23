#include "lsp/frames.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>

namespace maupertuis::app::lsp {
namespace {

constexpr std::size_t largest_header = 8192;
constexpr std::size_t largest_body = 64u << 20;
constexpr std::string_view length_name = "content-length:";

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// The number behind Content-Length; npos where there is none that can be believed.
std::size_t content_length(const std::string& header) {
  const std::string small = lower(header);
  std::size_t at = small.rfind(length_name, 0) == 0 ? 0 : small.find("\n" + std::string(length_name));
  if (at == std::string::npos) return at;
  at = small.find(':', at) + 1;
  while (at < small.size() && (small[at] == ' ' || small[at] == '\t')) ++at;
  std::size_t length = 0, digits = 0;
  for (; at < small.size() && std::isdigit(static_cast<unsigned char>(small[at])); ++at, ++digits)
    length = std::min<std::size_t>(length * 10 + static_cast<std::size_t>(small[at] - '0'), std::size_t{1} << 40);
  const bool ends = at == small.size() || small[at] == '\r' || small[at] == '\n' || small[at] == ' ';
  return digits > 0 && ends ? length : std::string::npos;
}

}  // namespace

/// More bytes; false at the end of the stream, when a signal asks to stop, and when the conversation has ended.
bool FrameReader::fill() {
  constexpr int half_a_second = 500;  // ms
  pollfd waiting{descriptor_, POLLIN, 0};
  for (int found = 0; found <= 0;) {
    found = poll(&waiting, 1, half_a_second);
    if (stop_ || ended_ || (found < 0 && errno != EINTR)) return false;
  }
  char bytes[65536];
  ssize_t got = -1;
  do got = read(descriptor_, bytes, sizeof bytes);
  while (got < 0 && errno == EINTR && !stop_);
  if (got <= 0 || stop_) return false;
  buffer_.append(bytes, static_cast<std::size_t>(got));
  return true;
}

Frame FrameReader::malformed(std::string why) {
  skip_to_header();
  return {Frame::Kind::Malformed, std::move(why)};
}

/// To the next line that begins a header, or to the end of what was read.
void FrameReader::skip_to_header() {
  const std::size_t header = lower(buffer_).find(length_name, 1);
  buffer_.erase(0, header == std::string::npos ? buffer_.size() : header);
}

Frame FrameReader::next() {
  while (skip_ > 0) {
    const std::size_t now = std::min(skip_, buffer_.size());
    buffer_.erase(0, now);
    skip_ -= now;
    if (skip_ > 0 && !fill()) return {};
  }
  std::size_t end = std::string::npos, gap = 0;
  while (end == std::string::npos) {
    const std::size_t strict = buffer_.find("\r\n\r\n"), loose = buffer_.find("\n\n");
    end = std::min(strict, loose);
    gap = end == strict ? 4 : 2;
    if (end != std::string::npos) break;
    if (buffer_.size() > largest_header) return malformed("a header without an end");
    if (!fill()) {
      const bool nothing = buffer_.find_first_not_of("\r\n \t") == std::string::npos;
      buffer_.clear();
      return nothing || stop_ ? Frame{} : Frame{Frame::Kind::Malformed, "the stream ends within a header"};
    }
  }
  const std::size_t length = content_length(buffer_.substr(0, end));
  if (length == std::string::npos) return malformed("a header without Content-Length");
  buffer_.erase(0, end + gap);
  if (length > largest_body) {
    skip_ = length;
    return {Frame::Kind::Malformed, "a message of more than 64 MiB"};
  }
  while (buffer_.size() < length)
    if (!fill())
      return stop_ ? Frame{} : (buffer_.clear(), Frame{Frame::Kind::Malformed, "the stream ends within a message"});
  Frame frame{Frame::Kind::Message, buffer_.substr(0, length)};
  buffer_.erase(0, length);
  return frame;
}

void FrameWriter::write(std::string_view json) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string frame = "Content-Length: " + std::to_string(json.size()) + "\r\n\r\n";
  frame += json;
  for (std::size_t at = 0; at < frame.size() && !failed_;) {
    const ssize_t sent = ::write(descriptor_, frame.data() + at, frame.size() - at);
    if (sent > 0) at += static_cast<std::size_t>(sent);
    if (sent < 0 && errno != EINTR) failed_ = true;
  }
}

}  // namespace maupertuis::app::lsp
