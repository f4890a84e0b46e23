// Moving pictures and pictures of every kind: what is written is what its name says, and what cannot be had is said.
#include "program.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>

using namespace cli_test;

namespace {

const char* const wheel =
    "system wheel \"Rolling wheel\"\nparam m = 1 kg, R = 20 cm\ncoord x : length\n"
    "body wheel mass m inertia m R^2/2 at (x, R) rotation angle -x/R\nstart x' = 30 cm/s\nrun 4 s\n"
    "draw disc wheel R, ground at (0, 0)\n";

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

bool has_program(const char* name) { return shell(std::string("command -v ") + name).code == 0; }

unsigned big_endian(const std::string& bytes, std::size_t at) {
  unsigned value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = 256 * value + static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// What ffprobe counts in a film: "width,height,frames".
std::string probed(const std::string& file) {
  return shell(
             "ffprobe -v error -count_frames -select_streams v:0 -show_entries stream=width,height,nb_read_frames -of "
             "csv=p=0 " +
             file)
      .out;
}

nlohmann::json document(const Outcome& outcome) { return nlohmann::json::parse(outcome.out); }

}  // namespace

TEST_CASE("the film of a model without a name has one") {
  const Folder folder;
  folder.write("model.lag", "coord x : length\npoint P mass 1 kg at (x, 0)\nstart x' = 1 m/s\nrun 1 s\n");
  CHECK(shell("cd '" + folder.path("") + "' && \"$MAUP\" animate model.lag").code == 0);
  CHECK(std::filesystem::exists(folder.path("animation.html")));
}

TEST_CASE("a film in MP4 and in GIF has the frames and the size that were asked for") {
  if (!has_program("ffmpeg")) {
    MESSAGE("ffmpeg is not installed");
    return;
  }
  const Folder folder;
  const std::string model = folder.write("wheel.lag", wheel), mp4 = folder.path("w.mp4"), gif = folder.path("w.gif");
  const Outcome film = maup({"animate", model, "-o", mp4, "--fps", "10", "--size", "320x200", "--to", "2s", "--json"});
  REQUIRE(film.code == 0);
  CHECK(document(film)["frames"] == 21);
  CHECK(read(mp4).substr(4, 4) == "ftyp");
  CHECK(contains(probed(mp4), "320,200,21"));
  const Outcome faster = maup({"animate", model, "-o", gif, "--fps", "5", "--size", "160x120", "--speed", "2"});
  REQUIRE(faster.code == 0);
  CHECK(read(gif).substr(0, 6) == "GIF89a");
  CHECK(contains(probed(gif), "160,120,11"));  // 4 s in 2 s, 5 a second, and the end
  CHECK(contains(read(gif), "NETSCAPE2.0"));   // which says that it begins anew
  REQUIRE(maup({"animate", model, "-o", gif, "--fps", "5", "--size", "160x120", "--once"}).code == 0);
  CHECK_FALSE(contains(read(gif), "NETSCAPE2.0"));
  CHECK(folder.names() == std::vector<std::string>{"w.gif", "w.mp4", "wheel.lag"});
  // The same command, the same film.
  const std::string before = read(mp4);
  REQUIRE(maup({"animate", model, "-o", mp4, "--fps", "10", "--size", "320x200", "--to", "2s"}).code == 0);
  CHECK(read(mp4) == before);
}

TEST_CASE("an animated picture shows six spokes that turn") {
  const Folder folder;
  const std::string model = folder.write("wheel.lag", wheel), svg = folder.path("w.svg");
  REQUIRE(maup({"animate", model, "-o", svg, "--fps", "8"}).code == 0);
  const std::string picture = read(svg);
  CHECK(contains(picture, "<svg xmlns"));
  CHECK(count(picture, "<animate attributeName=\"d\"") == 7);  // the rim and six spokes; the ground rests
  CHECK(count(picture.substr(picture.find("values=\"")), "M") >= 7 * 33);
  CHECK(shell("xmllint --noout " + svg).code == 0);
  CHECK(contains(picture, "repeatCount=\"indefinite\""));
}

TEST_CASE("a page needs nothing else") {
  const Folder folder;
  const std::string model = folder.write("wheel.lag", wheel), html = folder.path("w.html");
  REQUIRE(maup({"animate", model, "-o", html}).code == 0);
  const std::string page = read(html);
  CHECK(contains(page, "<!DOCTYPE html>"));
  CHECK(contains(page, "Rolling wheel"));
  CHECK(contains(page, "function animate(figure, scene)"));
  CHECK(contains(page, "default-src 'none'"));
  for (const char* outside : {"https://", "<script src", "<link rel=\"stylesheet\""})
    CHECK_FALSE(contains(page, outside));
}

TEST_CASE("one moment as SVG, PNG and PDF") {
  const Folder folder;
  const std::string model = folder.write("wheel.lag", wheel), svg = folder.path("m.svg"), png = folder.path("m.png"),
                    pdf = folder.path("m.pdf");
  REQUIRE(maup({"animate", model, "--still", "1s", "--size", "400x300", "-o", svg}).code == 0);
  CHECK(contains(read(svg), "t = 1.0"));
  CHECK_FALSE(contains(read(svg), "<animate"));
  for (const char* duration : {"2s", "3s", "700ms"}) {  // half a second is no whole number of thousandths of the others
    REQUIRE(maup({"animate", model, "--still", "0.5s", "--duration", duration, "-o", svg}).code == 0);
    CHECK((contains(read(svg), "t = 0.500 s") || contains(read(svg), "t = 500.0 ms")));
  }
  // As many digits as the moment has, however long the run is.
  for (const auto& [moment, caption] : {std::pair{"0.7s", "t = 0.700 s<"}, {"0.71234s", "t = 0.71234 s<"}}) {
    REQUIRE(maup({"animate", model, "--still", moment, "--duration", "4.27s", "-o", svg}).code == 0);
    CHECK(contains(read(svg), caption));
  }
  REQUIRE(maup({"animate", model, "--still", "1s", "--size", "400x300", "-o", png, "--dark"}).code == 0);
  CHECK(read(png).substr(1, 3) == "PNG");
  CHECK(big_endian(read(png), 16) == 800);  // two pixels each
  CHECK(big_endian(read(png), 20) == 600);
  REQUIRE(maup({"animate", model, "--still", "1s", "-o", pdf}).code == 0);
  CHECK(read(pdf).substr(0, 5) == "%PDF-");
}

TEST_CASE("a moment of a fast motion is that moment, not one between two frames") {
  const Folder folder;
  const std::string model =
                        folder.write("fast.lag",
                                     "system fast\nparam m = 1 kg, w = 6283 rad/s\ncoord x : length\npoint P mass m at "
                                     "(x, 0)\nV = 1/2 m w^2 x^2\nstart x = 1 m\nrun 10 s\n"),
                    svg = folder.path("m.svg");
  // From −1 to 1 in the middle of the picture: x = cos(6283 t).
  const auto place = [&](const std::string& time) {
    REQUIRE(maup({"animate", model, "--still", time, "--plain", "-o", svg}).code == 0);
    const std::string text = read(svg);
    const std::size_t at = text.find("cx=\"");
    REQUIRE(at != std::string::npos);
    return std::stod(text.substr(at + 4));
  };
  const double right = place("0s"), left = place("0.0005s"), middle = (left + right) / 2;
  CHECK(left < right - 300);
  CHECK((place("5.00025s") - middle) / (right - middle) == doctest::Approx(std::cos(6283 * 5.00025)).epsilon(1e-3));
  CHECK((place("9.9999s") - middle) / (right - middle) == doctest::Approx(std::cos(6283 * 9.9999)).epsilon(1e-3));
  const Outcome page = maup({"animate", model, "-o", folder.path("m.html")});
  CHECK(contains(page.err, "N0844"));
  CHECK_FALSE(contains(maup({"animate", model, "--duration", "1s", "-o", folder.path("m.html")}).err, "W08"));
}

TEST_CASE("plots as PNG and PDF: sizes, letters, and the same bytes again") {
  const Folder folder;
  const std::string model = folder.write("pendulum.lag", pendulum), png = folder.path("p.png"),
                    pdf = folder.path("p.pdf");
  REQUIRE(maup({"plot", model, "--y", "θ", "-o", png}).code == 0);
  CHECK(read(png).substr(1, 3) == "PNG");
  CHECK(big_endian(read(png), 16) == 1440);
  REQUIRE(maup({"plot", model, "--y", "θ", "-o", pdf}).code == 0);
  const std::string first = read(pdf);
  CHECK(first.substr(0, 5) == "%PDF-");
  if (has_program("pdftotext")) {
    const std::string text = shell("pdftotext " + pdf + " -").out;
    CHECK(contains(text, "θ"));
    CHECK(contains(text, "−0.5"));  // a minus sign, not a hyphen
  }
  if (has_program("pdffonts")) {  // every face is embedded, and only the letters that occur
    const std::string fonts = shell("pdffonts " + pdf + " | tail -n +3").out;
    CHECK(count(fonts, "\n") >= 1);
    CHECK(shell("pdffonts " + pdf + " | tail -n +3 | grep -vc ' yes yes '").out == "0\n");
  }
  REQUIRE(maup({"plot", model, "--y", "θ", "-o", pdf}).code == 0);
  CHECK(read(pdf) == first);
  REQUIRE(maup({"simulate", model, "--plot", png}).code == 0);
  REQUIRE(maup({"modes", model, "--sweep", "l = 0.5 .. 2 m steps 5", "--roots", pdf}).code == 0);
  CHECK(read(pdf).substr(0, 5) == "%PDF-");
}

TEST_CASE("what cannot be had is said, and nothing is written") {
  const Folder folder;
  const std::string
      model = folder.write("wheel.lag", wheel),
      bare = folder.write(
          "bare.lag", "system bare\ndimensionless\ncoord x : number\nT = 1/2 x'^2\nV = 1/2 x^2\nstart x = 1\nrun 1\n");
  const auto refused = [&](std::vector<std::string> options, const std::string& code, const std::string& words) {
    options.insert(options.begin(), {"animate", model});
    const Outcome outcome = maup(options);
    CAPTURE(outcome.err);
    CHECK(outcome.code == 2);
    CHECK(contains(outcome.err, code));
    CHECK(contains(outcome.err, words));
  };
  refused({"-o", folder.path("a.avi")}, "E0810", ".mp4, .gif");
  refused({"-o", folder.path("a.png")}, "E0810", "--still");
  refused({"-o", folder.path("a.svg"), "--size", "99999x20"}, "E0809", "--size");
  refused({"-o", folder.path("a.svg"), "--size", "0x0"}, "E0809", "--size");
  refused({"-o", folder.path("a.svg"), "--size", "400x300x200"}, "E0809", "--size");
  refused({"-o", folder.path("a.svg"), "--fps", "1e9"}, "E0809", "--fps");
  refused({"-o", folder.path("a.svg"), "--fps=-5"}, "E0809", "--fps");
  refused({"-o", folder.path("a.svg"), "--fps", "0"}, "E0809", "--fps");
  refused({"-o", folder.path("a.svg"), "--speed", "0"}, "E0809", "--speed");
  refused({"-o", folder.path("a.svg"), "--speed", "1e-9"}, "E0842", "frames");
  refused({"-o", folder.path("a.svg"), "--from", "9s"}, "E0809", "--from");
  refused({"-o", folder.path("a.svg"), "--from", "2s", "--to", "1s"}, "E0809", "--to");
  refused({"-o", folder.path("a.svg"), "--still", "9s"}, "E0809", "--duration` makes it longer");
  refused({"-o", folder.path("a.svg"), "--still=-1s"}, "E0809", "nothing is known before it");
  refused({"-o", folder.path("a.svg"), "--still", "soon"}, "E0809", "Write a number with a unit of time");
  refused({"-o", folder.path("a.svg"), "--view", "up"}, "E0809", "--view");
  refused({"-o", model}, "E08", "model");
  const Outcome nothing = maup({"animate", bare, "-o", folder.path("a.svg")});
  CHECK(nothing.code == 1);
  CHECK(contains(nothing.err, "E0843"));
  const Outcome missing = shell("PATH=/nowhere $MAUP animate " + model + " -o " + folder.path("a.mp4"));
  CHECK(missing.code == 2);
  CHECK(contains(missing.err, "E0841"));
  CHECK(contains(missing.err, "apt install ffmpeg"));
  CHECK(folder.names() == std::vector<std::string>{"bare.lag", "wheel.lag"});
}

TEST_CASE("an ffmpeg that fails is quoted, and leaves nothing behind") {
  const Folder folder;
  const std::string model = folder.write("wheel.lag", wheel),
                    program =
                        folder.write("ffmpeg", "#!/bin/sh\nhead -c 1000 >/dev/null\necho no such codec >&2\nexit 1\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const std::string where = program.substr(0, program.rfind('/'));
  const Outcome outcome = shell("PATH=" + where + ":$PATH $MAUP animate " + model + " -o " + folder.path("a.mp4"));
  CHECK(outcome.code == 3);
  CHECK(contains(outcome.err, "E0841"));
  CHECK(contains(outcome.err, "no such codec"));
  CHECK(folder.names() == std::vector<std::string>{"ffmpeg", "wheel.lag"});
}

TEST_CASE("Ctrl-C ends a film within a second, and leaves no part of it") {
  if (!has_program("ffmpeg")) return;
  const Folder folder;
  const std::string model = folder.write("wheel.lag", wheel);
  const Outcome outcome = shell("timeout --signal=INT 1.5 $MAUP animate " + model + " -o " + folder.path("a.mp4") +
                                " --size 1920x1080 --speed 0.01; echo code $?");
  CHECK(outcome.seconds < 8);
  CHECK(contains(outcome.err, "was not written"));
  CHECK((contains(outcome.out, "code 124") || contains(outcome.out, "code 130")));
  CHECK(folder.names() == std::vector<std::string>{"wheel.lag"});
}
