#include "device/rml1/picture/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace axisgate::rml1 {
namespace {

constexpr double kWidth = 1000, kNarrowest = 640;  // pixels, width of the page
constexpr double kTop = 76, kBetween = 56;
constexpr double kHighest = 760, kDeepest = 260;  // greatest height of a view of X and Y, and of a view of Z
constexpr double kInset = 180;
constexpr double kTick = 4, kTicksApart = 50;
constexpr double kFlat = 60, kStretched = 110;  // a view of Z that is lower than kFlat is stretched up to kStretched

const jobs::Reach& reach(const jobs::Bounds& bounds, int axis) {
  return axis == 0 ? bounds.x : axis == 1 ? bounds.y : bounds.z;
}

// Returns the largest of 1, 2 and 5 times a power of ten that is at most `most`.
double round_below(double most) {
  const double power = std::pow(10, std::floor(std::log10(most)));
  return most >= 5 * power ? 5 * power : most >= 2 * power ? 2 * power : power;
}

double round_above(double least) {
  const double below = round_below(least);
  if (below >= least) return below;
  return round_below(below * 2.5);
}

int stretch_of(double height) {
  if (height >= kFlat) return 1;
  return static_cast<int>(std::clamp(round_below(std::max(1.0, kStretched / height)), 1.0, 1000.0));
}

class Layout {
 public:
  Layout(const Extents& extents, double step_mm) : extents_(extents), step_mm_(step_mm) {
    const double x = extents.shown.x.size(), y = extents.shown.y.size(), z = extents.shown.z.size();
    // The view from above has the views of Z below and beside it, and the work area in the corner between them.
    const double free = kWidth - 3 * kMargin, beside = extents.area ? kInset : kStretched;
    scale_ = std::min({(free - beside) / x, free / (x + z), kHighest / y, kDeepest / z});
    stretch_ = stretch_of(z * scale_);
    const double deep = z * scale_ * stretch_;
    const double right = 2 * kMargin + x * scale_, lower = kTop + y * scale_ + kBetween;
    picture_.width = std::max(kNarrowest, right + std::max(deep, beside) + kMargin);
    const std::string stretched = stretch_ == 1 ? "" : fmt::format(" (Z {} times as high)", stretch_);
    add_view(0, "top: X, Y", {0, 1}, kMargin, kTop);
    add_view(1, "front: X, Z" + stretched, {0, 2}, kMargin, lower);
    add_view(2, stretch_ == 1 ? "side: Z, Y" : fmt::format("side: Z x {}, Y", stretch_), {2, 1}, right, kTop);
    if (extents.area) add_inset(right, lower);
    add_scale_bar();
    picture_.height = lower + std::max(deep, extents.area ? kInset : 0) + kMargin / 2;
  }

  Picture picture() { return std::move(picture_); }

 private:
  struct Axes {
    int across, up;
  };

  void add_view(std::size_t index, const std::string& title, Axes axes, double left, double top) {
    const jobs::Reach& across = reach(extents_.shown, axes.across);
    const jobs::Reach& up = reach(extents_.shown, axes.up);
    Picture::View& view = picture_.views[index];
    view.across = axes.across, view.up = axes.up, view.scale = scale_;
    view.stretch = view.from_above() ? 1 : stretch_;
    view.frame = {Picture::Rectangle::Kind::frame, left, top, across.size() * view.scale_across(),
                  up.size() * view.scale_up()};
    view.x = left - across.lowest * view.scale_across();
    view.y = top + up.highest * view.scale_up();
    if (extents_.area) view.boxes.push_back(box(view, Picture::Rectangle::Kind::work_area, *extents_.area));
    if (extents_.stock) view.boxes.push_back(box(view, Picture::Rectangle::Kind::stock, *extents_.stock));
    picture_.labels.push_back({left, top - 8, title});
    add_ticks(view, across, up);
  }

  static Picture::Rectangle box(const Picture::View& view, Picture::Rectangle::Kind kind, const jobs::Bounds& bounds) {
    const jobs::Reach& across = reach(bounds, view.across);
    const jobs::Reach& up = reach(bounds, view.up);
    return {kind, view.x + across.lowest * view.scale_across(), view.y - up.highest * view.scale_up(),
            across.size() * view.scale_across(), up.size() * view.scale_up()};
  }

  // Adds ticks in mm along the lower and the left side.
  void add_ticks(const Picture::View& view, const jobs::Reach& across, const jobs::Reach& up) {
    const Picture::Rectangle& frame = view.frame;
    const double bottom = frame.y + frame.height;
    each_tick(across, view.scale_across(), [&](double steps, const std::string& text) {
      const double x = view.x + steps * view.scale_across();
      picture_.lines.push_back({x, bottom, x, bottom + kTick});
      picture_.labels.push_back({x, bottom + kTick + 12, text, false, Picture::Anchor::middle});
    });
    each_tick(up, view.scale_up(), [&](double steps, const std::string& text) {
      const double y = view.y - steps * view.scale_up();
      picture_.lines.push_back({frame.x - kTick, y, frame.x, y});
      picture_.labels.push_back({frame.x - kTick - 3, y + 4, text, false, Picture::Anchor::end});
    });
  }

  template <class Tick>
  void each_tick(const jobs::Reach& shown, double scale, Tick tick) const {
    const double apart = round_above(std::min(kTicksApart, shown.size() * scale / 4) / scale * step_mm_);
    const double first = std::ceil(shown.lowest * step_mm_ / apart - 1e-9);
    const double last = std::floor(shown.highest * step_mm_ / apart + 1e-9);
    for (double number = first; number <= last; ++number) {
      tick(number * apart / step_mm_, fmt::format("{:g}", number == 0 ? 0 : number * apart));
    }
  }

  void add_scale_bar() {
    const double mm = round_below(120 / scale_ * step_mm_);
    const double right = picture_.width - kMargin, left = right - mm / step_mm_ * scale_, y = kMargin * 0.6;
    picture_.lines.push_back({left, y, right, y});
    for (const double x : {left, right}) picture_.lines.push_back({x, y - kTick, x, y + kTick});
    picture_.labels.push_back({left - 8, y + 4, fmt::format("{:g} mm", mm), false, Picture::Anchor::end});
  }

  // Adds an overview of the work area, with the frame of the view from above.
  void add_inset(double left, double top) {
    const jobs::Bounds& area = *extents_.area;
    jobs::Bounds all = area;
    all.take({extents_.shown.x.lowest, extents_.shown.y.lowest, 0});
    all.take({extents_.shown.x.highest, extents_.shown.y.highest, 0});
    Picture::View inset;
    inset.across = 0, inset.up = 1;
    inset.scale = kInset / std::max(all.x.size(), all.y.size());
    inset.x = left - all.x.lowest * inset.scale;
    inset.y = top + all.y.highest * inset.scale;
    picture_.rectangles.push_back(box(inset, Picture::Rectangle::Kind::work_area, area));
    if (extents_.stock) picture_.rectangles.push_back(box(inset, Picture::Rectangle::Kind::stock, *extents_.stock));
    picture_.rectangles.push_back(box(inset, Picture::Rectangle::Kind::frame, extents_.shown));
    picture_.labels.push_back(
        {left, top - 8, fmt::format("work area: {:g} x {:g} mm", area.x.size() * step_mm_, area.y.size() * step_mm_)});
  }

  const Extents& extents_;
  double step_mm_;
  double scale_ = 1;
  int stretch_ = 1;
  Picture picture_;
};

}  // namespace

Picture lay_out(const Extents& extents, double step_mm) { return Layout(extents, step_mm).picture(); }

}  // namespace axisgate::rml1
