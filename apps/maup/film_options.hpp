#pragma once
#include "json.hpp"
#include "output_files.hpp"
#include "run_options.hpp"

#include <maupertuis/drawing.hpp>
#include <maupertuis/motion_pictures.hpp>

#include <optional>
#include <string>
#include <vector>

/// What `maup animate` is asked for, and the frames of it.
namespace maupertuis::app {

struct AnimateOptions {
  ModelOptions model;
  RunOptions run;
  std::string output, size, from, to, still, view, trail = "fading";
  std::optional<double> fps, speed;
  bool once = false, dark = false, plain = false;
};

/// The options in numbers.
struct Film {
  FrameOptions picture;
  bool height_given = false;
  double fps = 30, speed = 1;
  std::vector<double> elapsed;  // of the frames, s from the start of the run
  double seconds() const { return static_cast<double>(elapsed.size() > 1 ? elapsed.size() - 1 : 1) / fps; }
};

std::string ending_of(const AnimateOptions& o);
/// Where nothing is said, a film is a page.
bool is_page(const AnimateOptions& o);
bool is_video(const AnimateOptions& o);
/// The name of the system; a model may have none.
std::string default_output(const AnimateOptions& o, const std::string& name);

Film read_options(const AnimateOptions& o, Diagnostics& diagnostics);
/// Files that cannot be written, tools that are not here: before anything is computed.
void check_files_and_tools(const AnimateOptions& o, Diagnostics& diagnostics);

/// A time of the motion as seconds since its first moment; `otherwise` where it is not given.
double time_of_option(const char* option, const std::string& text, const Drawing& drawing, double otherwise,
                      Diagnostics& diagnostics);
/// The speed at which a run takes a pleasant time to watch: its own, or a power of ten of it.
double pleasant_speed(double duration);
void choose_frames(const AnimateOptions& o, const Drawing& drawing, Film& film, Diagnostics& diagnostics);

ExitCode finish_interrupted(const AnimateOptions& o, Study& study, Console& console, Json& document);
void write_animation(const AnimateOptions& o, const std::string& bytes, Diagnostics& diagnostics);
void describe(const AnimateOptions& o, const Film& film, Json& document);
std::string written_sentence(const AnimateOptions& o, const Film& film, std::size_t bytes);

}  // namespace maupertuis::app
