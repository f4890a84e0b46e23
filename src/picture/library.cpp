#include "picture/library.hpp"

#include <fmt/format.h>

#ifndef __EMSCRIPTEN__
#include <dlfcn.h>
#endif

namespace maupertuis::picture {
namespace {

constexpr const char* file = "librsvg-2.so.2";

#ifdef __EMSCRIPTEN__
Library open() {
  Library l;
  l.problem = fmt::format("a WebAssembly module cannot open {}", file);
  return l;
}
#else
template <class Function>
void look_up(void* opened, const char* name, Function& function, std::string& problem) {
  function = reinterpret_cast<Function>(dlsym(opened, name));  // of its dependencies too: cairo, GObject
  if (!function && problem.empty()) problem = fmt::format("{} of this machine is too old: it has no {}", file, name);
}

Library open() {
  Library l;
  void* opened = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (!opened) {
    l.problem = fmt::format("{} is not here", file);
    return l;
  }
#define MAUP_LOOK_UP(name) look_up(opened, #name, l.name, l.problem)
  MAUP_LOOK_UP(rsvg_handle_new_from_data);
  MAUP_LOOK_UP(rsvg_handle_get_intrinsic_size_in_pixels);
  MAUP_LOOK_UP(rsvg_handle_render_document);
  MAUP_LOOK_UP(g_object_unref);
  MAUP_LOOK_UP(cairo_image_surface_create);
  MAUP_LOOK_UP(cairo_image_surface_get_data);
  MAUP_LOOK_UP(cairo_image_surface_get_stride);
  MAUP_LOOK_UP(cairo_surface_write_to_png_stream);
  MAUP_LOOK_UP(cairo_pdf_surface_create_for_stream);
  MAUP_LOOK_UP(cairo_pdf_surface_set_metadata);
  MAUP_LOOK_UP(cairo_create);
  MAUP_LOOK_UP(cairo_destroy);
  MAUP_LOOK_UP(cairo_surface_flush);
  MAUP_LOOK_UP(cairo_surface_finish);
  MAUP_LOOK_UP(cairo_surface_destroy);
  MAUP_LOOK_UP(cairo_surface_status);
#undef MAUP_LOOK_UP
  return l;
}
#endif

}  // namespace

const Library& library() {
  static const Library opened = open();
  return opened;
}

}  // namespace maupertuis::picture
