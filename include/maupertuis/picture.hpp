#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace maupertuis {

/// Why this machine makes no PNG, PDF and video, as a sentence with what to install; empty where it does. They are made
/// by librsvg and cairo, which are opened at first use: a program without them makes SVG alone.
std::string picture_problem();

/// What became of a picture: bytes, or the sentence for the user.
struct PictureBytes {
  std::string bytes;
  std::string problem;
};

/// A picture in SVG as PNG, `scale` pixels for each px of the SVG. Text is set in the faces that the machine has.
/// Refused beyond `most_pixels`.
PictureBytes png_of(const std::string& svg, double scale = 2);

/// The same as one page of PDF, as large as the picture (96 px an inch); text stays text, the letters that occur are
/// embedded. The same picture gives the same bytes.
PictureBytes pdf_of(const std::string& svg);

/// The size of a picture in px: 0 × 0 where the text is no SVG.
struct PictureSize {
  double width = 0, height = 0;
};
PictureSize size_of_picture(const std::string& svg);

/// The colours of a picture, row by row, four bytes a pixel: blue, green, red, and one without meaning.
/// Empty where picture_problem() says why, or the text is no SVG.
std::vector<std::uint8_t> pixels_of(const std::string& svg, int width, int height);

inline constexpr double most_pixels = 64e6;  // 256 MB

}  // namespace maupertuis
