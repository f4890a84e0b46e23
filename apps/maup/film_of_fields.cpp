#include "film_of_fields.hpp"

#include "field_views.hpp"
#include "fields_text.hpp"
#include "interrupt.hpp"
#include "outcome.hpp"
#include "quantity.hpp"
#include "video.hpp"

#include <fmt/format.h>

#include <maupertuis/picture.hpp>
#include <maupertuis/report.hpp>

#include <algorithm>
#include <cmath>

namespace maupertuis::app {
namespace {

/// Frame by frame.
std::string video_of(const AnimateOptions& o, const Film& film, const std::vector<std::string>& frames,
                     Diagnostics& diagnostics) {
  const PictureSize size = size_of_picture(frames.front());
  Video::Options options;
  options.format = ending_of(o) == ".gif" ? Video::Format::Gif : Video::Format::Mp4;
  options.width = 2 * static_cast<int>(std::lround(size.width / 2));
  options.height = 2 * static_cast<int>(std::lround(size.height / 2));
  options.fps = film.fps, options.loop = !o.once;
  Video video(find_ffmpeg(), options);
  for (const std::string& frame : frames)
    if (interrupt_flag().load() || !video.add(pixels_of(frame, options.width, options.height))) break;
  if (interrupt_flag().load()) return {};
  const Video::Film made = video.finish();
  if (!made.problem.empty())
    diagnostics.error("E0841", {}, fmt::format("ffmpeg did not make {}.", o.output),
                      fmt::format("It says: {}.", made.problem), "An .html or .svg needs no ffmpeg.");
  return made.bytes;
}

/// The rows of a run that are nearest to the times of the frames.
std::vector<std::size_t> rows_of_frames(const FieldRunResult& run, const Film& film) {
  std::vector<std::size_t> out;
  std::size_t row = 0;
  const std::vector<double>& times = run.trajectory.times;
  for (const double t : film.elapsed) {
    while (row + 1 < times.size() && std::abs(times[row + 1] - t) <= std::abs(times[row] - t)) ++row;
    out.push_back(row);
  }
  return out;
}

void check_field_options(const AnimateOptions& o, const Film& film, Diagnostics& diagnostics) {
  refuse_options_of_motions(o.run,
                            {{"--view", !o.view.empty()},
                             {"--trail", o.trail != "fading"},
                             {"--plain", o.plain},
                             {"--at", !o.run.at.empty()}},
                            diagnostics);
  if (film.height_given)
    diagnostics.error("E0809", {}, fmt::format("--size {} gives a height.", o.size),
                      "The height of a picture of fields follows from its width.", "Give the width alone.");
}

/// The times of the frames; without a word, the whole run in ten seconds.
void choose_field_frames(AnimateOptions& o, const FieldRunResult& run, Film& film, Diagnostics& diagnostics) {
  Drawing times;
  times.times = run.trajectory.times;
  film.height_given = true;
  constexpr double pleasant_seconds = 10;
  if (!o.speed) o.speed = run.end / pleasant_seconds;
  if (o.still.empty())
    choose_frames(o, times, film, diagnostics);
  else
    film.elapsed = {time_of_option("--still", o.still, times, 0, diagnostics)};
}

FieldPictureOptions field_picture(const AnimateOptions& o, const Film& film, Study& study) {
  FieldPictureOptions like;
  like.theme = film.picture.theme;
  const bool plane = study.model()->fields->system.space.size() == 2;
  like.width = !o.size.empty() ? std::max(film.picture.width, 240.0) : plane ? 480 : 720;
  return field_pictures_of(study, *study.field_equations(), {}, like).front();
}

/// One picture a frame; fewer where they are interrupted.
std::vector<std::string> field_frames(const FieldEquations& equations, const FieldRunResult& run,
                                      FieldPictureOptions like, const Film& film, bool page) {
  if (page) like.title.clear();  // the page has it
  std::vector<std::string> frames;
  for (const std::size_t row : rows_of_frames(run, film)) {
    if (interrupt_flag().load()) break;
    frames.push_back(field_frame_svg(equations, run, like, row));
  }
  return frames;
}

std::string film_of_fields(const AnimateOptions& o, const Film& film, const std::vector<std::string>& frames,
                           const std::string& title, Diagnostics& diagnostics) {
  if (!o.still.empty()) return frames.front();
  if (is_video(o)) return video_of(o, film, frames, diagnostics);
  return is_page(o) ? turned_pictures_html(frames, film.seconds(), title)
                    : turned_pictures_svg(frames, film.seconds(), !o.once);
}

}  // namespace

ExitCode animate_fields(AnimateOptions o, Study& study, Console& console) {
  Json document = json_document("animate");
  Diagnostics& diagnostics = study.diagnostics();
  const SimulationOptions settings = simulation_options(o.run, diagnostics, study.tree());
  Film film = read_options(o, diagnostics);
  check_field_options(o, film, diagnostics);
  check_files_and_tools(o, diagnostics);
  if (study.wrong()) return finish_usage(console, study, "animate");
  const FieldEquations* equations = study.field_equations();
  if (!equations) return finish(console, study, document);
  if (o.output.empty()) o.output = default_output(o, study.model()->system.name);
  std::vector<double> asked;
  if (const auto t = o.still.empty() ? std::nullopt : parse_exact_time(o.still)) asked.push_back(t->to_double());
  const auto run = run_model(study, settings, FieldMotionOptions{true, true, asked}, console);
  if (!run || !has_pictures(*run, study.diagnostics())) return finish(console, study, document);

  choose_field_frames(o, *run, film, diagnostics);
  if (study.wrong()) return finish_usage(console, study, "animate");
  const FieldPictureOptions like = field_picture(o, film, study);
  const std::vector<std::string> frames = field_frames(*equations, *run, like, film, is_page(o));
  const std::string bytes =
      interrupt_flag().load() ? std::string{} : film_of_fields(o, film, frames, like.title, diagnostics);
  if (interrupt_flag().load()) return finish_interrupted(o, study, console, document);
  write_animation(o, bytes, diagnostics);
  document["file"] = o.output;
  describe(o, film, document);
  const bool written = !study.wrong();
  if (written && !console.json()) console.say(written_sentence(o, film, bytes.size()));
  finish(console, study, document);
  return written ? ExitCode::Fine : ExitCode::RunFailed;
}

}  // namespace maupertuis::app
