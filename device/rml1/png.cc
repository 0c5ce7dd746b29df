#include <cairo.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "device/rml1/picture.h"
#include "device/rml1/relief.h"

namespace axisgate::rml1 {
namespace {

constexpr double kPixels = 2;  // a pixel of the picture's
constexpr std::size_t kMany = 20'000;
constexpr int kAtOnce = 64;  // one long path is slow to draw, and many short ones, too

void set_colour(cairo_t* cairo, const char* colour, double opacity = 1) {
  unsigned value = 0;
  (void)std::from_chars(colour + 1, colour + 7, value, 16);
  cairo_set_source_rgba(cairo, (value >> 16) / 255.0, (value >> 8 & 255) / 255.0, (value & 255) / 255.0, opacity);
}

void draw_rectangle(cairo_t* cairo, const Picture::Rectangle& one) {
  static constexpr double kDashes[] = {6, 4};
  cairo_rectangle(cairo, one.x, one.y, one.width, one.height);
  switch (one.kind) {
    case Picture::Rectangle::Kind::work_area:
      set_colour(cairo, "#555555");
      cairo_set_line_width(cairo, 1);
      cairo_set_dash(cairo, kDashes, 2, 0);
      cairo_stroke(cairo);
      cairo_set_dash(cairo, nullptr, 0, 0);
      return;
    case Picture::Rectangle::Kind::stock:
      set_colour(cairo, "#e8d8b8", 0.5);
      cairo_fill(cairo);
      return;
    case Picture::Rectangle::Kind::swatch:
      set_colour(cairo, kShadeColours[static_cast<std::size_t>(one.shade)]);
      cairo_fill(cairo);
      return;
    case Picture::Rectangle::Kind::frame:
      set_colour(cairo, "#8c98a4");
      cairo_set_line_width(cairo, 1);
      cairo_stroke(cairo);
  }
}

using Shaded = std::array<std::vector<const Strokes::Stroke*>, kShades>;

// Returns the strokes of one part that one view shows.
Shaded by_shade(const Picture& picture, const Picture::View& view, std::size_t part) {
  Shaded shaded;
  for (const Strokes::Stroke& stroke : picture.strokes->all()) {
    if (stroke.part != part || is_in_relief(picture, view, stroke)) continue;
    shaded[static_cast<std::size_t>(picture.shades->of(stroke))].push_back(&stroke);
  }
  return shaded;
}

double line_width(std::size_t shade, double tool) {
  if (shade == kTravel) return 0.6;
  if (shade != kLeftOut && tool > 0) return tool;
  return shade == kPerhapsDone ? 2 : 1;
}

// `tool`: its width in pixels; 0: it is not drawn.
void draw_strokes(cairo_t* cairo, const Shaded& shaded, bool many, const Picture::View& view, double tool) {
  const auto across = static_cast<std::size_t>(view.across), up = static_cast<std::size_t>(view.up);
  const auto point = [&](const std::array<float, 3>& p, auto to) {
    to(cairo, view.x + p[across] * view.scale_across(), view.y - p[up] * view.scale_up());
  };
  cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
  // What is a pixel apart looks the same without smooth edges, and is drawn in a fraction of the time.
  cairo_set_antialias(cairo, many ? CAIRO_ANTIALIAS_NONE : CAIRO_ANTIALIAS_DEFAULT);
  for (std::size_t shade = 0; shade < shaded.size(); ++shade) {
    static constexpr double kDots[] = {2, 2};
    set_colour(cairo, kShadeColours[shade]);
    cairo_set_line_width(cairo, line_width(shade, tool));
    cairo_set_dash(cairo, kDots, shade == kLeftOut ? 2 : 0, 0);
    int waiting = 0;
    for (const Strokes::Stroke* stroke : shaded[shade]) {
      point(stroke->from, cairo_move_to);
      point(stroke->to, cairo_line_to);
      if (++waiting % kAtOnce == 0) cairo_stroke(cairo);
    }
    cairo_stroke(cairo);
  }
  cairo_set_dash(cairo, nullptr, 0, 0);
  cairo_set_line_cap(cairo, CAIRO_LINE_CAP_BUTT);
  cairo_set_antialias(cairo, CAIRO_ANTIALIAS_DEFAULT);
}

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

Surface surface_of(const Relief& relief) {
  Surface surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, static_cast<int>(relief.width()),
                                             static_cast<int>(relief.height())),
                  cairo_surface_destroy);
  cairo_surface_flush(surface.get());
  unsigned char* const bytes = cairo_image_surface_get_data(surface.get());
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface.get()));
  for (std::size_t row = 0; bytes != nullptr && row < relief.height(); ++row) {
    std::memcpy(bytes + row * stride, relief.pixels().data() + row * relief.width(),
                relief.width() * sizeof(std::uint32_t));
  }
  cairo_surface_mark_dirty(surface.get());
  return surface;
}

void draw_relief(cairo_t* cairo, const Picture& picture, const Picture::View& view) {
  const Relief relief(*picture.strokes, *picture.shades, picture.diameters, view);
  const Surface surface = surface_of(relief);
  cairo_save(cairo);
  cairo_translate(cairo, view.frame.x, view.frame.y);
  cairo_scale(cairo, view.frame.width / static_cast<double>(relief.width()),
              view.frame.height / static_cast<double>(relief.height()));
  cairo_set_source_surface(cairo, surface.get(), 0, 0);
  cairo_paint(cairo);
  cairo_restore(cairo);
}

void draw_holes(cairo_t* cairo, const Picture& picture, const Picture::View& view) {
  constexpr double kTurn = 6.2832;
  const auto& strokes = picture.strokes->all();
  for (std::size_t index = 0; index < strokes.size(); ++index) {
    if (!picture.strokes->is_hole(index)) continue;
    set_colour(cairo, kShadeColours[static_cast<std::size_t>(picture.shades->of(strokes[index]))]);
    cairo_arc(cairo, view.x + strokes[index].to[0] * view.scale, view.y - strokes[index].to[1] * view.scale, 2.5, 0,
              kTurn);
    cairo_fill(cairo);
  }
}

void draw_view(cairo_t* cairo, const Picture& picture, const Picture::View& view) {
  cairo_save(cairo);
  cairo_rectangle(cairo, view.frame.x, view.frame.y, view.frame.width, view.frame.height);
  cairo_clip(cairo);
  for (const Picture::Rectangle& one : view.boxes) draw_rectangle(cairo, one);
  if (picture.relief && view.from_above()) draw_relief(cairo, picture, view);
  for (std::size_t part = 0; part < picture.strokes->parts(); ++part) {
    draw_strokes(cairo, by_shade(picture, view, part), picture.strokes->all().size() > kMany, view,
                 drawn_width(picture, view, part));
  }
  if (view.from_above() && !picture.relief) draw_holes(cairo, picture, view);
  set_colour(cairo, "#0060c0");
  cairo_set_line_width(cairo, 1.5);
  cairo_move_to(cairo, view.x - 6, view.y);
  cairo_rel_line_to(cairo, 12, 0);
  cairo_move_to(cairo, view.x, view.y - 6);
  cairo_rel_line_to(cairo, 0, 12);
  cairo_stroke(cairo);
  cairo_restore(cairo);
  draw_rectangle(cairo, view.frame);
}

void draw_label(cairo_t* cairo, const Picture::Label& label) {
  cairo_set_font_size(cairo, label.heading ? 18 : 12);
  cairo_text_extents_t text;
  cairo_text_extents(cairo, label.text.c_str(), &text);
  const double part = label.anchor == Picture::Anchor::start ? 0 : label.anchor == Picture::Anchor::middle ? 0.5 : 1;
  cairo_move_to(cairo, label.x - part * text.x_advance, label.y);
  cairo_show_text(cairo, label.text.c_str());
}

}  // namespace

std::string png_of(const Relief& relief) {
  std::string bytes;
  const auto append = [](void* to, const unsigned char* data, unsigned size) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), size);
    return CAIRO_STATUS_SUCCESS;
  };
  cairo_surface_write_to_png_stream(surface_of(relief).get(), append, &bytes);
  return bytes;
}

bool write_png(const Picture& picture, const std::string& file) {
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(picture.width * kPixels),
                                 static_cast<int>(picture.height * kPixels)),
      cairo_surface_destroy);
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> cairo(cairo_create(surface.get()), cairo_destroy);
  cairo_scale(cairo.get(), kPixels, kPixels);
  set_colour(cairo.get(), "#ffffff");
  cairo_paint(cairo.get());
  for (const Picture::Rectangle& one : picture.rectangles) draw_rectangle(cairo.get(), one);
  for (const Picture::View& view : picture.views) draw_view(cairo.get(), picture, view);
  set_colour(cairo.get(), "#555555");
  cairo_set_line_width(cairo.get(), 1);
  for (const Picture::Line& line : picture.lines) {
    cairo_move_to(cairo.get(), line.from_x, line.from_y);
    cairo_line_to(cairo.get(), line.to_x, line.to_y);
  }
  cairo_stroke(cairo.get());
  set_colour(cairo.get(), "#222222");
  for (const Picture::Label& label : picture.labels) draw_label(cairo.get(), label);
  return cairo_status(cairo.get()) == CAIRO_STATUS_SUCCESS &&
         cairo_surface_write_to_png(surface.get(), file.c_str()) == CAIRO_STATUS_SUCCESS;
}

}  // namespace axisgate::rml1
