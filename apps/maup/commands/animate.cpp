#include "field_views.hpp"
#include "fields_text.hpp"
#include "interrupt.hpp"
#include "outcome.hpp"
#include "output_files.hpp"
#include "quantity.hpp"
#include "run_options.hpp"
#include "video.hpp"

#include <fmt/format.h>

#include <maupertuis/drawing.hpp>
#include <maupertuis/motion_pictures.hpp>
#include <maupertuis/picture.hpp>
#include <maupertuis/report.hpp>

#include <algorithm>
#include <cmath>

/// The drawing of a model in motion, as a film, a page, a moving picture, or one moment of it.
namespace maupertuis::app {
namespace {

constexpr double most_frames_of_svg = 1500, most_frames = 20'000, smallest_side = 16, largest_side = 4096,
                 most_fps = 120;

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

std::string ending_of(const AnimateOptions& o) {
  const std::size_t dot = o.output.rfind('.');
  return dot == std::string::npos ? "" : o.output.substr(dot);
}

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

/// The name of the system; a model may have none.
std::string default_output(const AnimateOptions& o, const std::string& name) {
  return (name.empty() ? "animation" : name) + (o.still.empty() ? ".html" : ".svg");
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
  if (!o.view.empty() && ending_of(o) == ".html")
    wrong_option(diagnostics, "--view is not for pages.", "On a page the reader turns the drawing.");
  return film;
}

/// A time of the motion as seconds since its first moment; `otherwise` where it is not given.
double moment(const char* option, const std::string& text, const Drawing& drawing, double otherwise,
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

/// The speed at which a run takes a pleasant time to watch: its own, or a power of ten of it.
double pleasant_speed(double duration) {
  return duration >= 2 && duration <= 120 ? 1 : std::pow(10, std::round(std::log10(duration > 0 ? duration / 15 : 1)));
}

void choose_frames(const AnimateOptions& o, const Drawing& drawing, Film& film, Diagnostics& diagnostics) {
  const double duration = std::abs(drawing.times.back() - drawing.times.front());
  if (!film.height_given) film.picture.height = fitting_height(drawing, film.picture.width);
  const double from = moment("--from", o.from, drawing, 0, diagnostics),
               to = moment("--to", o.to, drawing, duration, diagnostics);
  if (!(from < to) && duration > 0 && !diagnostics.has_errors())
    wrong_option(diagnostics, "--from is not before --to.", "Give the earlier time to --from.");
  film.speed = o.speed.value_or(pleasant_speed(to - from));
  film.picture.trail_time = 3 * film.speed;
  const double count = std::floor((to - from) / film.speed * film.fps * (1 + 1e-12)) + 1;
  const double most = ending_of(o) == ".svg" ? most_frames_of_svg : most_frames;
  if (count > most) {
    diagnostics.error(
        "E0842", {}, fmt::format("{} would have {:.0f} frames.", o.output, count),
        fmt::format("More than {:.0f} are not made of this kind.", most),
        "Show less of the motion (--from, --to), show it faster (--speed), or with fewer frames a second (--fps).");
    return;
  }
  for (double i = 0; i < count; ++i) film.elapsed.push_back(std::min(to, from + i * film.speed / film.fps));
}

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
  const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step > 0 ? step * factor : 1))), 0, 9);
  return fmt::format("t = {:.{}f}{}{}", t * factor, digits, drawing.dimensionless ? "" : " ",
                     drawing.dimensionless ? "" : units[unit]);
}

std::string still_svg(const Drawing& drawing, Film& film) {
  if (!film.height_given) film.picture.height = fitting_height(drawing, film.picture.width);
  const double duration = std::abs(drawing.times.back() - drawing.times.front()), elapsed = film.elapsed.front();
  film.picture.trail_time = 3 * pleasant_speed(duration);
  double step = duration / 1000;  // or as fine as the moment was asked for
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

/// Before anything is computed.
void check_tools(const AnimateOptions& o, Diagnostics& diagnostics) {
  const std::string ending = ending_of(o);
  if (!o.still.empty() || (ending != ".mp4" && ending != ".gif")) return;
  if (find_ffmpeg().empty())
    diagnostics.error("E0841", {}, fmt::format("{} needs ffmpeg, which is in no folder of PATH.", o.output), {},
                      "On Debian, `apt install ffmpeg` brings it. An .html or .svg needs nothing.");
  else if (const std::string problem = picture_problem(); !problem.empty())
    diagnostics.error("E0840", {}, fmt::format("{} cannot be made: {}.", o.output, problem), {},
                      "Take .html or .svg, which need nothing else.");
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

/// A field in motion: u(x), or the plane in colours.
ExitCode animate_fields(AnimateOptions o, Study& study, Console& console) {
  Json document = json_document("animate");
  Diagnostics& diagnostics = study.diagnostics();
  refuse_options_of_motions(o.run,
                            {{"--view", !o.view.empty()},
                             {"--trail", o.trail != "fading"},
                             {"--plain", o.plain},
                             {"--at", !o.run.at.empty()}},
                            diagnostics);
  const SimulationOptions settings = simulation_options(o.run, diagnostics, study.tree());
  Film film = read_options(o, diagnostics);
  if (film.height_given)
    diagnostics.error("E0809", {}, fmt::format("--size {} gives a height.", o.size),
                      "The height of a picture of fields follows from its width.", "Give the width alone.");
  check_output_files({{"-o", o.output, o.still.empty() ? FileKind::Animation : FileKind::Picture}}, o.model.path,
                     diagnostics);
  check_tools(o, diagnostics);
  if (study.wrong()) return finish_usage(console, study, "animate");
  const FieldEquations* equations = study.field_equations();
  if (!equations) return finish(console, study, document);
  if (o.output.empty()) o.output = default_output(o, study.model()->system.name);
  std::vector<double> asked;
  if (const auto t = o.still.empty() ? std::nullopt : parse_exact_time(o.still)) asked.push_back(t->to_double());
  const auto run = run_model(study, settings, FieldMotionOptions{true, true, asked}, console);
  if (!run || !has_pictures(*run, study.diagnostics())) return finish(console, study, document);

  Drawing times;  // of the run
  times.times = run->trajectory.times;
  film.height_given = true;
  constexpr double pleasant_seconds = 10;
  if (!o.speed) o.speed = run->end / pleasant_seconds;
  if (o.still.empty())
    choose_frames(o, times, film, diagnostics);
  else
    film.elapsed = {moment("--still", o.still, times, 0, diagnostics)};
  if (study.wrong()) return finish_usage(console, study, "animate");
  FieldPictureOptions like;
  like.theme = film.picture.theme;
  const bool plane = study.model()->fields->system.space.size() == 2;
  like.width = !o.size.empty() ? std::max(film.picture.width, 240.0) : plane ? 480 : 720;
  like = field_pictures_of(study, *equations, {}, like).front();
  const std::string title = like.title;
  if (const std::string e = ending_of(o); e == ".html" || e == ".htm") like.title.clear();  // the page has it
  std::vector<std::string> frames;
  for (const std::size_t row : rows_of_frames(*run, film)) {
    if (interrupt_flag().load()) break;
    frames.push_back(field_frame_svg(*equations, *run, like, row));
  }
  std::string bytes;
  const std::string ending = ending_of(o);
  if (interrupt_flag().load()) {
    if (!console.json()) console.say(fmt::format("Interrupted: {} was not written.\n", o.output));
    finish(console, study, document);
    return ExitCode::Interrupted;
  }
  if (!o.still.empty())
    write_picture(o.output, frames.front(), diagnostics);
  else {
    bytes = ending == ".mp4" || ending == ".gif"    ? video_of(o, film, frames, diagnostics)
            : ending == ".html" || ending == ".htm" ? turned_pictures_html(frames, film.seconds(), title)
                                                    : turned_pictures_svg(frames, film.seconds(), !o.once);
    if (!study.wrong()) write_result(o.output, bytes, diagnostics);
  }
  document["file"] = o.output;
  document["frames"] = frames.size();
  if (o.still.empty()) document["fps"] = film.fps, document["speed"] = film.speed, document["seconds"] = film.seconds();
  const bool written = !study.wrong();
  if (written && !console.json())
    console.say(o.still.empty() ? fmt::format("Wrote {} ({} frames, {:.3g} s, {} kB).\n", o.output, frames.size(),
                                              film.seconds(), (bytes.size() + 999) / 1000)
                                : fmt::format("Wrote {}.\n", o.output));
  finish(console, study, document);
  return written ? ExitCode::Fine : ExitCode::RunFailed;
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

ExitCode animate(AnimateOptions o, Console& console) {
  Study study = open_study(o.model);
  if (declares_fields(study.tree())) return animate_fields(std::move(o), study, console);
  Json document = json_document("animate");
  const bool readable_model = !study.wrong();
  const SimulationOptions settings = simulation_options(o.run, study.diagnostics(), study.tree());
  Diagnostics& diagnostics = study.diagnostics();
  read_options(o, diagnostics);  // for what is wrong with them, before anything is computed
  check_output_files({{"-o", o.output, o.still.empty() ? FileKind::Animation : FileKind::Picture}}, o.model.path,
                     diagnostics);
  check_tools(o, diagnostics);
  if (readable_model && study.wrong()) return finish_usage(console, study, "animate");
  put_in_run(o.run, study);
  std::optional<SimulationResult> result;
  std::optional<Drawing> drawing = drawing_of(study, settings, console, result);
  if (!drawing) return finish(console, study, document);
  if (o.output.empty()) o.output = default_output(o, study.model()->system.name);

  Film film = read_options(o, diagnostics);
  std::string bytes;
  const bool page = o.still.empty() && (ending_of(o) == ".html" || ending_of(o) == ".htm");
  const std::string ending = ending_of(o), title = study.model()->system.title.empty() ? study.model()->system.name
                                                                                       : study.model()->system.title;
  if (!o.still.empty())
    film.elapsed = {moment("--still", o.still, *drawing, 0, diagnostics)};
  else if (!page)
    choose_frames(o, *drawing, film, diagnostics);
  if (study.wrong()) return finish_usage(console, study, "animate");
  hit_moments(film, study, settings, console, result, drawing);
  if (!drawing) return finish(console, study, document);
  if (!o.still.empty())
    bytes = still_svg(*drawing, film);
  else {
    if (page)
      bytes = animation_html(*drawing, title);
    else if (ending == ".mp4" || ending == ".gif")
      bytes = video_of(o, *drawing, film, console, diagnostics);
    else {
      film.picture.trail_pieces = 4;
      bytes = animated_svg(*drawing, {film.elapsed, film.seconds(), !o.once}, film.picture);
    }
  }
  if (interrupt_flag().load()) {
    if (!console.json()) console.say(fmt::format("Interrupted: {} was not written.\n", o.output));
    finish(console, study, document);
    return ExitCode::Interrupted;
  }
  if (!study.wrong())
    o.still.empty() ? write_result(o.output, bytes, diagnostics) : write_picture(o.output, bytes, diagnostics);
  document["file"] = o.output;
  if (!page) {
    document["frames"] = film.elapsed.size();
    document["width"] = film.picture.width;
    document["height"] = film.picture.height;
  }
  if (o.still.empty() && !page)
    document["fps"] = film.fps, document["speed"] = film.speed, document["seconds"] = film.seconds();
  const bool written = !study.wrong();
  if (written && !console.json())
    console.say(page ? fmt::format("Wrote {} ({} kB). Open it in any browser.\n", o.output, (bytes.size() + 999) / 1000)
                : o.still.empty() ? fmt::format("Wrote {} ({} frames, {:.3g} s, {} kB).\n", o.output,
                                                film.elapsed.size(), film.seconds(), (bytes.size() + 999) / 1000)
                                  : fmt::format("Wrote {}.\n", o.output));
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
