#include "field_views.hpp"
#include "film_of_fields.hpp"
#include "film_options.hpp"
#include "interrupt.hpp"
#include "outcome.hpp"
#include "video.hpp"

#include <fmt/format.h>

#include <maupertuis/picture.hpp>

#include <algorithm>
#include <cmath>

/// The drawing of a model in motion, as a film, a page, a moving picture, or one moment of it.
namespace maupertuis::app {
namespace {

std::string caption(const Drawing& drawing, double elapsed, double step, const FrameOptions& picture) {
  if (!picture.furniture || drawing.times.size() < 2) return {};
  const double first = drawing.times.front(), t = drawing.times.back() < first ? first - elapsed : first + elapsed;
  // In thousandths, millionths … of a second where the whole run is short.
  static constexpr const char* units[] = {"s", "ms", "μs", "ns", "ps", "fs"};
  const double longest = std::max(std::abs(first), std::abs(drawing.times.back()));
  std::size_t unit = 0;
  double factor = 1;
  for (; !drawing.dimensionless && longest > 0 && longest * factor < 1 && unit + 1 < std::size(units); ++unit)
    factor *= 1000;
  const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step > 0 ? step * factor : 1) - 1e-9)), 0, 9);
  return fmt::format("t = {:.{}f}{}{}", t * factor, digits, drawing.dimensionless ? "" : " ",
                     drawing.dimensionless ? "" : units[unit]);
}

std::string still_svg(const Drawing& drawing, Film& film) {
  if (!film.height_given) film.picture.height = fitting_height(drawing, film.picture.width);
  const double duration = std::abs(drawing.times.back() - drawing.times.front()), elapsed = film.elapsed.front();
  film.picture.trail_time = 3 * pleasant_speed(duration);
  // A thousandth of the run in a power of ten, or as fine as the moment was asked for.
  double step = duration > 0 ? std::pow(10, std::floor(std::log10(duration / 1000))) : 1;
  while (step > 1e-9 * duration && std::abs(std::remainder(elapsed, step)) > 1e-6 * step) step /= 10;
  film.picture.caption = caption(drawing, elapsed, step, film.picture);
  return frame_svg(drawing, elapsed, film.picture);
}

/// Draws and encodes frame by frame; empty where it was interrupted or failed, and the diagnostics say why.
std::string video_of(const AnimateOptions& o, const Drawing& drawing, Film& film, const Console& console,
                     Diagnostics& diagnostics) {
  Video::Options options;
  options.format = ending_of(o) == ".gif" ? Video::Format::Gif : Video::Format::Mp4;
  options.width = 2 * static_cast<int>(std::lround(film.picture.width / 2));
  options.height = 2 * static_cast<int>(std::lround(film.picture.height / 2));
  options.fps = film.fps;
  options.loop = !o.once;
  film.picture.width = options.width;
  film.picture.height = options.height;
  Video video(find_ffmpeg(), options);
  const std::size_t hundredth = std::max<std::size_t>(1, film.elapsed.size() / 100);
  for (std::size_t i = 0; i < film.elapsed.size(); ++i) {
    if (interrupt_flag().load()) return {};
    film.picture.caption = caption(drawing, film.elapsed[i], film.speed / film.fps / 2, film.picture);
    if (!video.add(pixels_of(frame_svg(drawing, film.elapsed[i], film.picture), options.width, options.height))) break;
    if (console.progress() && i % hundredth == 0)
      console.progress()->measure(fmt::format("{} of {} frames", i + 1, film.elapsed.size()));
  }
  if (interrupt_flag().load()) return {};  // the film in the making goes with `video`
  const Video::Film made = video.finish();
  if (!made.problem.empty())
    diagnostics.error("E0841", {}, fmt::format("ffmpeg did not make {}.", o.output),
                      fmt::format("It says: {}.", made.problem), "An .html or .svg needs no ffmpeg.");
  return made.bytes;
}

std::optional<Drawing> drawing_of(Study& study, SimulationOptions run, Console& console,
                                  std::optional<SimulationResult>& result) {
  if (study.wrong() || !study.model() || !study.equations()) return {};
  run.rows_of_steps = run.rows_at.empty();
  run.errors = ErrorEstimates::None;
  result = run_model(study, run, console);
  if (!result) return {};
  const std::size_t frames = 12'000 + 2 * run.rows_at.size();
  std::optional<Drawing> drawing = evaluate_drawing(*study.model(), result->trajectory, frames, study.equations(),
                                                    impulses_of(*result, study.model()->system));
  if (!drawing && !result->undetermined.empty())
    study.diagnostics().error("E0631", {}, "where anything is that this model draws depends on functions that are free",
                              "The Lagrangian leaves them open, so that it has no place of its own.",
                              "`gauge EXPR = EXPR` makes a choice.");
  else if (!drawing)
    study.diagnostics().error("E0843", {}, "The model has nothing to draw.",
                              "A drawing shows points, bodies, springs and what `draw` names; this model has none.",
                              "Mark a point, `point P at (x, y)`, or plot the coordinates: maup plot.");
  return drawing;
}

/// A motion that swings faster than the drawing's frames follow is run once more, with rows at the moments that are
/// shown. What swings between two frames of a film cannot be seen in it: said, unless it goes so slowly that its frames
/// follow the motion.
void hit_moments(const Film& film, Study& study, SimulationOptions run, Console& console,
                 std::optional<SimulationResult>& result, std::optional<Drawing>& drawing) {
  if (!drawing->moments_only) return;
  if (film.elapsed.empty()) return note_moments_only(study.diagnostics());  // a page
  const Diagnostics said = study.diagnostics();
  const double first = drawing->times.front(), way = drawing->times.back() < first ? -1 : 1;
  for (const double elapsed : film.elapsed) run.rows_at.push_back(first + way * elapsed);
  if (auto again = drawing_of(study, run, console, result)) {
    again->moments_only = true;
    again->low = drawing->low, again->high = drawing->high, again->radius = drawing->radius;  // of the whole motion
    drawing = std::move(again);
    study.diagnostics() = said;  // the second run has nothing to add
  }
  const bool followed = result && frames_follow(*study.model(), result->trajectory, film.elapsed);
  if (film.elapsed.size() != 1 && !followed) note_moments_only(study.diagnostics());
}

std::string film_of_motion(const AnimateOptions& o, const Drawing& drawing, Film& film, const MechanicalSystem& system,
                           Console& console, Diagnostics& diagnostics) {
  if (!o.still.empty()) return still_svg(drawing, film);
  if (is_page(o)) return animation_html(drawing, system.title.empty() ? system.name : system.title);
  if (is_video(o)) return video_of(o, drawing, film, console, diagnostics);
  film.picture.trail_pieces = 4;
  return animated_svg(drawing, {film.elapsed, film.seconds(), !o.once}, film.picture);
}

ExitCode animate(AnimateOptions o, Console& console) {
  Study study = open_study(o.model);
  if (declares_fields(study.tree())) return animate_fields(std::move(o), study, console);
  Json document = json_document("animate");
  const bool readable_model = !study.wrong();
  const SimulationOptions settings = simulation_options(o.run, study.diagnostics(), study.tree());
  Diagnostics& diagnostics = study.diagnostics();
  Film film = read_options(o, diagnostics);
  if (!o.view.empty() && is_page(o))
    diagnostics.error("E0809", {}, "--view is not for pages.", {}, "On a page the reader turns the drawing.");
  check_files_and_tools(o, diagnostics);
  if (readable_model && study.wrong()) return finish_usage(console, study, "animate");
  put_in_run(o.run, study);
  std::optional<SimulationResult> result;
  std::optional<Drawing> drawing = drawing_of(study, settings, console, result);
  if (!drawing) return finish(console, study, document);
  if (o.output.empty()) o.output = default_output(o, study.model()->system.name);

  const bool page = is_page(o);
  if (!o.still.empty())
    film.elapsed = {time_of_option("--still", o.still, *drawing, 0, diagnostics)};
  else if (!page)
    choose_frames(o, *drawing, film, diagnostics);
  if (study.wrong()) return finish_usage(console, study, "animate");
  hit_moments(film, study, settings, console, result, drawing);
  if (!drawing) return finish(console, study, document);
  const std::string bytes = film_of_motion(o, *drawing, film, study.model()->system, console, diagnostics);
  if (interrupt_flag().load()) return finish_interrupted(o, study, console, document);
  write_animation(o, bytes, diagnostics);
  document["file"] = o.output;
  if (!page) {
    describe(o, film, document);
    document["width"] = film.picture.width, document["height"] = film.picture.height;
  }
  const bool written = !study.wrong();
  if (written && !console.json()) console.say(written_sentence(o, film, bytes.size()));
  if (!result->ok() && !console.json()) console.say(fmt::format("The run ended early: {}\n", result->reason));
  finish(console, study, document);
  return written ? exit_code(result->ending) : ExitCode::RunFailed;
}

}  // namespace

void add_animate(CommandLine& line) {
  const auto options = std::make_shared<AnimateOptions>();
  Command& command =
      line.add("animate", "The drawing in motion: MP4, GIF, a page, an animated SVG; or one moment of it",
               "  maup animate pendulum.lag -o pendulum.mp4\n"
               "  maup animate top.lag -o top.gif --size 480x360 --to 4s --speed 0.5\n"
               "  maup animate pendulum.lag --still 2s -o figure.pdf\n",
               [options](Console& console) { return animate(*options, console); });
  add_model_options(command, options->model);
  add_span_options(command, options->run);
  add_method_options(command, options->run);
  command
      .add_option("-o,--output", options->output, "What to write (default: SYSTEM.html); the ending names the format")
      ->type_name("FILE.mp4|gif|html|svg");
  command.add_option("--still", options->still, "One moment instead, as .svg, .png or .pdf")->type_name("TIME");
  command.add_option("--size", options->size, "In pixels (default: 720 wide, as high as suits the drawing)")
      ->type_name("WIDTHxHEIGHT");
  command.add_option("--fps", options->fps, "Frames a second (default: 30 in MP4, 20 in GIF, 12 in SVG)")
      ->type_name("NUMBER");
  command
      .add_option("--speed", options->speed, "Seconds of motion that a second shows (default: 1, or a power of ten)")
      ->type_name("NUMBER");
  command.add_option("--from", options->from, "From this time of the motion on")->type_name("TIME");
  command.add_option("--to", options->to, "Up to this time")->type_name("TIME");
  command.add_flag("--once", options->once, "Plays once; GIF and SVG begin anew otherwise");
  command.add_flag_callback(
      "--loop", [options] { options->once = false; }, "Begins anew at the end (the default of GIF and SVG)");
  command.add_option("--trail", options->trail, "What points leave behind")
      ->one_of({"fading", "whole", "none"})
      ->type_name("fading|whole|none");
  command
      .add_option("--view", options->view, "From where a drawing in space is seen, in degrees (default: -51.6,18.3)")
      ->type_name("AZIMUTH,ELEVATION");
  command.add_flag("--dark", options->dark, "Light on dark");
  command.add_flag("--plain", options->plain, "Without scale, axes, direction of gravity and time");
}

}  // namespace maupertuis::app
