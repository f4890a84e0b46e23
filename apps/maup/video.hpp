#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace maupertuis::app {

/// Where ffmpeg is, of the folders of PATH; empty: nowhere.
std::string find_ffmpeg();

/// A film in the making: ffmpeg, which is given one frame after the other. Nothing is on the disk until the film is
/// written by whoever asked for it; a film that is given up leaves nothing.
class Video {
 public:
  enum class Format { Mp4, Gif };
  struct Options {
    Format format = Format::Mp4;
    int width = 0, height = 0;  // even
    double fps = 30;
    bool loop = true;  // Gif: without end
  };
  Video(const std::string& ffmpeg, const Options& options);
  ~Video();
  Video(const Video&) = delete;
  Video& operator=(const Video&) = delete;

  /// One frame, four bytes a pixel: blue, green, red, nothing. False where ffmpeg takes no more: see `finish`.
  bool add(const std::vector<std::uint8_t>& pixels);

  struct Film {
    std::string bytes;
    std::string problem;  // what ffmpeg says where it made none; empty: it made one
  };
  Film finish();

 private:
  struct Process;
  std::unique_ptr<Process> process_;
};

}  // namespace maupertuis::app
