#pragma once
#include <string>

/// The functions of librsvg and cairo that pictures need. They are declared here and looked up at run time, so that
/// neither their headers are needed to build nor they themselves to start; their binary interface has been stable since
/// librsvg 2.52 and cairo 1.16.
namespace maupertuis::picture {

struct Handle;   // RsvgHandle
struct Surface;  // cairo_surface_t
struct Drawer;   // cairo_t
struct Error;    // GError
struct Rectangle {
  double x, y, width, height;
};                                                                                  // RsvgRectangle
using Writer = int (*)(void* closure, const unsigned char* data, unsigned length);  // cairo_write_func_t, 0: success

inline constexpr int argb32 = 0, rgb24 = 1;  // cairo_format_t
inline constexpr int create_date = 5;        // cairo_pdf_metadata_t

struct Library {
  Handle* (*rsvg_handle_new_from_data)(const unsigned char*, unsigned long, Error**) = nullptr;
  int (*rsvg_handle_get_intrinsic_size_in_pixels)(Handle*, double*, double*) = nullptr;
  int (*rsvg_handle_render_document)(Handle*, Drawer*, const Rectangle*, Error**) = nullptr;
  void (*g_object_unref)(void*) = nullptr;
  Surface* (*cairo_image_surface_create)(int, int, int) = nullptr;
  unsigned char* (*cairo_image_surface_get_data)(Surface*) = nullptr;
  int (*cairo_image_surface_get_stride)(Surface*) = nullptr;
  int (*cairo_surface_write_to_png_stream)(Surface*, Writer, void*) = nullptr;
  Surface* (*cairo_pdf_surface_create_for_stream)(Writer, void*, double, double) = nullptr;
  void (*cairo_pdf_surface_set_metadata)(Surface*, int, const char*) = nullptr;
  Drawer* (*cairo_create)(Surface*) = nullptr;
  void (*cairo_destroy)(Drawer*) = nullptr;
  void (*cairo_surface_flush)(Surface*) = nullptr;
  void (*cairo_surface_finish)(Surface*) = nullptr;
  void (*cairo_surface_destroy)(Surface*) = nullptr;
  int (*cairo_surface_status)(Surface*) = nullptr;
  std::string problem;  // empty: all are there
};

/// Opened once; never closed, since GLib cannot be.
const Library& library();

}  // namespace maupertuis::picture
