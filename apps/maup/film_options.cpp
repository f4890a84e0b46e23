#include "film_options.hpp"

#include "interrupt.hpp"
#include "outcome.hpp"
#include "quantity.hpp"
#include "video.hpp"

#include <fmt/format.h>

#include <maupertuis/picture.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis::app {
namespace {

constexpr double most_frames_of_svg = 1500, most_frames = 20'000, smallest_side = 16, largest_side = 4096,
                 most_fps = 120;

void wrong_option(Diagnostics& diagnostics, const std::string& what, const std::string& help) {
  diagnostics.error("E0809", {}, what, {}, help);
}

/// 640x360, or 640: the height then suits the drawing.
void read_size(const AnimateOptions& o, Film& film, Diagnostics& diagnostics) {
  if (o.size.empty()) return;
  unsigned width = 0, height = 0;
  char rest = 0;
  const int count = std::sscanf(o.size.c_str(), "%5u%*1[xX]%5u%c", &width, &height, &rest);
  const bool alone = o.size.find_first_not_of("0123456789") == std::string::npos;
  const auto good = [](unsigned side) { return side >= smallest_side && side <= largest_side; };
  if ((count != 2 && !(count == 1 && alone)) || !good(width) || (count == 2 && !good(height)))
    return wrong_option(
        diagnostics, fmt::format("--size {} is no size of a picture.", o.size),
        fmt::format("Write WIDTHxHEIGHT in pixels, such as 640x360, each from {} to {}; or the width alone.",
                    smallest_side, largest_side));
  film.picture.width = width;
  film.picture.height = height;
  film.height_given = count == 2;
}

void read_view(const AnimateOptions& o, Film& film, Diagnostics& diagnostics) {
  if (o.view.empty()) return;
  double azimuth = 0, elevation = 0;
  char rest = 0;
  if (std::sscanf(o.view.c_str(), "%lf,%lf%c", &azimuth, &elevation, &rest) != 2 || !std::isfinite(azimuth) ||
      !(std::abs(elevation) <= 90))
    return wrong_option(diagnostics, fmt::format("--view {} is no direction.", o.view),
                        "Write azimuth and elevation of the eye in degrees, such as -50,20.");
  constexpr double degree = 3.14159265358979323846 / 180;
  film.picture.camera.azimuth = azimuth * degree;
  film.picture.camera.elevation = elevation * degree;
}

}  // namespace

std::string ending_of(const AnimateOptions& o) {
  const std::size_t dot = o.output.rfind('.');
  return dot == std::string::npos ? "" : o.output.substr(dot);
}

bool is_page(const AnimateOptions& o) {
  const std::string ending = ending_of(o);
  return o.still.empty() && (o.output.empty() || ending == ".html" || ending == ".htm");
}

bool is_video(const AnimateOptions& o) {
  const std::string ending = ending_of(o);
  return o.still.empty() && (ending == ".mp4" || ending == ".gif");
}

std::string default_output(const AnimateOptions& o, const std::string& name) {
  return (name.empty() ? "animation" : name) + (o.still.empty() ? ".html" : ".svg");
}

Film read_options(const AnimateOptions& o, Diagnostics& diagnostics) {
  Film film;
  read_size(o, film, diagnostics);
  read_view(o, film, diagnostics);
  film.picture.theme = o.dark ? PlotTheme::Dark : PlotTheme::Light;
  film.picture.furniture = !o.plain;
  film.picture.trail = o.trail == "none"    ? TrailLength::None
                       : o.trail == "whole" ? TrailLength::Whole
                                            : TrailLength::Fading;
  film.fps = o.fps.value_or(ending_of(o) == ".mp4" ? 30 : ending_of(o) == ".gif" ? 20 : 12);
  if (!(film.fps > 0) || film.fps > most_fps)
    wrong_option(diagnostics, fmt::format("--fps {:g} is no rate of frames.", film.fps),
                 fmt::format("Write a number up to {:g}.", most_fps));
  if (o.speed && !(*o.speed > 0 && std::isfinite(*o.speed)))
    wrong_option(diagnostics, fmt::format("--speed {:g} is no speed.", *o.speed),
                 "Write how many seconds of motion a second of the film shows, such as 0.5.");
  return film;
}

double time_of_option(const char* option, const std::string& text, const Drawing& drawing, double otherwise,
                      Diagnostics& diagnostics) {
  if (text.empty()) return otherwise;
  const std::optional<Rational> t = parse_exact_time(text);
  const double first = drawing.times.front(), last = drawing.times.back();
  const double elapsed = t ? (last < first ? first - t->to_double() : t->to_double() - first) : NAN;
  const double duration = std::abs(last - first);
  if (elapsed >= -1e-9 * duration && elapsed <= duration * (1 + 1e-9)) return std::clamp(elapsed, 0.0, duration);
  if (!t)
    wrong_option(diagnostics, fmt::format("{} \"{}\" is no time.", option, text),
                 "Write a number with a unit of time, such as 3s, 250ms or \"2 min\".");
  else
    wrong_option(diagnostics, fmt::format("{} {} is no time of this run.", option, text),
                 fmt::format("It goes from {:.6g}{} to {:.6g}{}{}", first, drawing.dimensionless ? "" : " s", last,
                             drawing.dimensionless ? "" : " s",
                             elapsed > duration ? "; `--duration` makes it longer." : "; nothing is known before it."));
  return otherwise;
}

double pleasant_speed(double duration) {
  return duration >= 2 && duration <= 120 ? 1 : std::pow(10, std::round(std::log10(duration > 0 ? duration / 15 : 1)));
}

void choose_frames(const AnimateOptions& o, const Drawing& drawing, Film& film, Diagnostics& diagnostics) {
  const double duration = std::abs(drawing.times.back() - drawing.times.front());
  if (!film.height_given) film.picture.height = fitting_height(drawing, film.picture.width);
  const double from = time_of_option("--from", o.from, drawing, 0, diagnostics),
               to = time_of_option("--to", o.to, drawing, duration, diagnostics);
  if (!(from < to) && duration > 0 && !diagnostics.has_errors())
    wrong_option(diagnostics, "--from is not before --to.", "Give the earlier time to --from.");
  film.speed = o.speed.value_or(pleasant_speed(to - from));
  film.picture.trail_time = 3 * film.speed;
  const double count = std::floor((to - from) / film.speed * film.fps * (1 + 1e-12)) + 1;
  const double most = ending_of(o) == ".svg" ? most_frames_of_svg : most_frames;
  if (count > most) {
    const std::string counted =
        count < 1e9 ? fmt::format("{:.0f}", count) : fmt::format("some 10^{:.0f}", std::log10(count));
    diagnostics.error(
        "E0842", {}, fmt::format("{} would have {} frames.", o.output, counted),
        fmt::format("More than {:.0f} are not made of this kind.", most),
        "Show less of the motion (--from, --to), show it faster (--speed), or with fewer frames a second (--fps).");
    return;
  }
  for (double i = 0; i < count; ++i) film.elapsed.push_back(std::min(to, from + i * film.speed / film.fps));
}

void check_files_and_tools(const AnimateOptions& o, Diagnostics& diagnostics) {
  check_output_files({{"-o", o.output, o.still.empty() ? FileKind::Animation : FileKind::Picture}}, o.model.path,
                     diagnostics);
  if (!is_video(o)) return;
  if (find_ffmpeg().empty())
    diagnostics.error("E0841", {}, fmt::format("{} needs ffmpeg, which is in no folder of PATH.", o.output), {},
                      "On Debian, `apt install ffmpeg` brings it. An .html or .svg needs nothing.");
  else if (const std::string problem = picture_problem(); !problem.empty())
    diagnostics.error("E0840", {}, fmt::format("{} cannot be made: {}.", o.output, problem), {},
                      "Take .html or .svg, which need nothing else.");
}

// -------------------------------------------------------------------------------------------- what was made, said

ExitCode finish_interrupted(const AnimateOptions& o, Study& study, Console& console, Json& document) {
  if (!console.json()) console.say(fmt::format("Interrupted: {} was not written.\n", o.output));
  finish(console, study, document);
  return ExitCode::Interrupted;
}

void write_animation(const AnimateOptions& o, const std::string& bytes, Diagnostics& diagnostics) {
  if (diagnostics.has_errors()) return;
  o.still.empty() ? write_result(o.output, bytes, diagnostics) : write_picture(o.output, bytes, diagnostics);
}

void describe(const AnimateOptions& o, const Film& film, Json& document) {
  document["frames"] = film.elapsed.size();
  if (o.still.empty()) document["fps"] = film.fps, document["speed"] = film.speed, document["seconds"] = film.seconds();
}

std::string written_sentence(const AnimateOptions& o, const Film& film, std::size_t bytes) {
  if (!o.still.empty()) return fmt::format("Wrote {}.\n", o.output);
  const std::size_t kilobytes = (bytes + 999) / 1000;
  if (film.elapsed.empty()) return fmt::format("Wrote {} ({} kB). Open it in any browser.\n", o.output, kilobytes);
  return fmt::format("Wrote {} ({} frames, {:.3g} s, {} kB).\n", o.output, film.elapsed.size(), film.seconds(),
                     kilobytes);
}

}  // namespace maupertuis::app
