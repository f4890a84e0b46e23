#include "picture/library.hpp"

#include <maupertuis/picture.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <memory>

namespace maupertuis {
namespace {

using namespace picture;

struct Unref {
  void operator()(Handle* h) const { library().g_object_unref(h); }
};
struct Destroy {
  void operator()(Surface* s) const { library().cairo_surface_destroy(s); }
  void operator()(Drawer* d) const { library().cairo_destroy(d); }
};
using OwnHandle = std::unique_ptr<Handle, Unref>;
using OwnSurface = std::unique_ptr<Surface, Destroy>;
using OwnDrawer = std::unique_ptr<Drawer, Destroy>;

constexpr double points_per_px = 0.75;  // of PDF, 72 an inch
const char* const not_read = "the picture could not be read back";

OwnHandle read(const std::string& svg) {
  return OwnHandle(
      library().rsvg_handle_new_from_data(reinterpret_cast<const unsigned char*>(svg.data()), svg.size(), nullptr));
}

PictureSize size_of(Handle* handle) {
  PictureSize size;
  if (!library().rsvg_handle_get_intrinsic_size_in_pixels(handle, &size.width, &size.height)) return {};
  return size;
}

int append(void* closure, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), length);
  return 0;
}

bool draw(Handle* handle, Surface* surface, double width, double height) {
  const Library& l = library();
  if (l.cairo_surface_status(surface) != 0) return false;
  const OwnDrawer drawer(l.cairo_create(surface));
  const Rectangle whole{0, 0, width, height};
  return l.rsvg_handle_render_document(handle, drawer.get(), &whole, nullptr) != 0 &&
         l.cairo_surface_status(surface) == 0;
}

}  // namespace

std::string picture_problem() {
  const std::string& problem = library().problem;
  return problem.empty() ? problem : problem + "; on Debian, `apt install librsvg2-2` brings it";
}

PictureSize size_of_picture(const std::string& svg) {
  if (!library().problem.empty()) return {};
  const OwnHandle handle = read(svg);
  return handle ? size_of(handle.get()) : PictureSize{};
}

PictureBytes png_of(const std::string& svg, double scale) {
  if (std::string problem = picture_problem(); !problem.empty()) return {{}, std::move(problem)};
  const OwnHandle handle = read(svg);
  const PictureSize size = handle ? size_of(handle.get()) : PictureSize{};
  const double width = std::ceil(scale * size.width), height = std::ceil(scale * size.height);
  if (!(width >= 1 && height >= 1)) return {{}, not_read};
  if (width * height > most_pixels)
    return {{}, fmt::format("{:.0f} × {:.0f} pixels are more than a picture may have", width, height)};
  const Library& l = library();
  const OwnSurface surface(l.cairo_image_surface_create(argb32, static_cast<int>(width), static_cast<int>(height)));
  PictureBytes result;
  if (!draw(handle.get(), surface.get(), width, height) ||
      l.cairo_surface_write_to_png_stream(surface.get(), append, &result.bytes) != 0)
    return {{}, "the picture could not be drawn"};
  return result;
}

PictureBytes pdf_of(const std::string& svg) {
  if (std::string problem = picture_problem(); !problem.empty()) return {{}, std::move(problem)};
  const OwnHandle handle = read(svg);
  const PictureSize size = handle ? size_of(handle.get()) : PictureSize{};
  const double width = points_per_px * size.width, height = points_per_px * size.height;
  if (!(width > 0 && height > 0)) return {{}, not_read};
  const Library& l = library();
  PictureBytes result;
  const OwnSurface surface(l.cairo_pdf_surface_create_for_stream(append, &result.bytes, width, height));
  l.cairo_pdf_surface_set_metadata(surface.get(), create_date, "");  // the day would make each file another
  const bool drawn = draw(handle.get(), surface.get(), width, height);
  l.cairo_surface_finish(surface.get());
  if (!drawn || l.cairo_surface_status(surface.get()) != 0) return {{}, "the picture could not be drawn"};
  return result;
}

std::vector<std::uint8_t> pixels_of(const std::string& svg, int width, int height) {
  if (!library().problem.empty() || width < 1 || height < 1) return {};
  const OwnHandle handle = read(svg);
  if (!handle) return {};
  const Library& l = library();
  const OwnSurface surface(l.cairo_image_surface_create(rgb24, width, height));
  if (!draw(handle.get(), surface.get(), width, height)) return {};
  l.cairo_surface_flush(surface.get());
  const unsigned char* data = l.cairo_image_surface_get_data(surface.get());
  const auto stride = static_cast<std::size_t>(l.cairo_image_surface_get_stride(surface.get())),
             row = 4 * static_cast<std::size_t>(width);
  std::vector<std::uint8_t> pixels(row * static_cast<std::size_t>(height));
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
    std::memcpy(&pixels[y * row], data + y * stride, row);
  return pixels;
}

}  // namespace maupertuis
