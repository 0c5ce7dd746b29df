#include "device/rml1/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/locale/encoding_utf.hpp>
#include <cmath>

namespace axisgate::rml1 {
namespace {

constexpr double kWidth = 1000, kViewsHeight = 800, kMargin = 40, kHeading = 60, kLine = 18, kSwatch = 14;
constexpr std::array<const char*, 3> kTitles = {"top: X, Y", "front: X, Z", "side: Y, Z"};

double part(const Point& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

// All that is shown, in steps.
Bounds extent(const Check& check, const Profile& profile, std::optional<Stock> stock, bool origin_known) {
  Bounds shown = check.summary().bounds;
  shown.take({0, 0, 0});
  if (stock) shown.take({profile.steps(stock->x), profile.steps(stock->y), -profile.steps(stock->z)});
  if (origin_known) {
    shown.take(check.machine().box().lowest);
    shown.take(check.machine().box().highest);
  }
  // Nothing has a size of nothing.
  const double least = profile.steps(1);
  for (Reach* reach : {&shown.x, &shown.y, &shown.z}) reach->take(reach->lowest + std::max(least, reach->size()));
  return shown;
}

class Layout {
 public:
  Layout(const Bounds& shown, const Profile& profile) : shown_(shown), profile_(profile) {
    const double across = shown.x.size() + shown.y.size(), down = shown.y.size() + shown.z.size();
    scale_ = std::min((kWidth - 3 * kMargin) / across, kViewsHeight / down);
    const double right = 2 * kMargin + shown.x.size() * scale_;
    const double lower = kHeading + shown.y.size() * scale_ + 2 * kMargin;
    place(0, 0, 1, kMargin, kHeading);
    place(1, 0, 2, kMargin, lower);
    place(2, 1, 2, right, lower);
    picture_.width = kWidth;
    picture_.height = lower + shown.z.size() * scale_ + kMargin;
  }

  Picture picture(const Strokes& strokes) {
    picture_.strokes = &strokes;
    return picture_;
  }

  void add_box(Picture::Rectangle::Kind kind, const Point& lowest, const Point& highest) {
    for (const Picture::View& view : picture_.views) {
      const double left = view.x + part(lowest, view.across) * scale_;
      const double top = view.y - part(highest, view.up) * scale_;
      picture_.rectangles.push_back({kind, left, top, (part(highest, view.across) - part(lowest, view.across)) * scale_,
                                     (part(highest, view.up) - part(lowest, view.up)) * scale_});
    }
  }

  const std::vector<Picture::Rectangle>& rectangles() const { return picture_.rectangles; }

  void add_heading(const std::string& title) { picture_.labels.push_back({kMargin, kMargin * 0.6, title, true}); }

  void add_legend(const std::vector<std::string>& lines, double deepest_mm) {
    double y = picture_.height;
    for (const std::string& line : lines) picture_.labels.push_back({kMargin, y += kLine, line});
    y += kLine;
    const int shades = deepest_mm > 0 ? kShades : 1;
    for (int shade = 0; shade < shades; ++shade) {
      const double x = kMargin + shade * 100.0;
      picture_.rectangles.push_back({Picture::Rectangle::Kind::swatch, x, y, kSwatch, kSwatch, shade});
      picture_.labels.push_back(
          {x + kSwatch + 4, y + kSwatch - 2,
           shade == 0 ? "travel" : fmt::format("to {:.2f} mm", deepest_mm * shade / (kShades - 1))});
    }
    picture_.height = y + kMargin;
  }

 private:
  void place(std::size_t index, int across, int up, double left, double top) {
    const auto reach = [this](int axis) { return axis == 0 ? shown_.x : axis == 1 ? shown_.y : shown_.z; };
    picture_.views[index] = {across, up, left - reach(across).lowest * scale_, top + reach(up).highest * scale_,
                             scale_};
    picture_.labels.push_back({left, top - 6, kTitles[index]});
  }

  Bounds shown_;
  const Profile& profile_;
  double scale_ = 1;
  Picture picture_;
};

std::vector<std::string> legend(const Check& check, const Profile& profile, const Strokes& strokes,
                                const std::vector<Picture::Rectangle>& drawn) {
  const Summary& job = check.summary();
  const Reach& feeds = strokes.feeds();
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{} commands; {:.0f} mm driven, of them {:.0f} mm cutting; {}, by assumed accelerations",
                              job.commands, job.distance_mm, job.cutting_mm, time_text(job)));
  if (feeds.any)
    lines.push_back(fmt::format("cuts at {} mm/s, {} rpm", to_string(feeds), job.rpm.any ? to_string(job.rpm) : "0"));
  const auto shows = [&drawn](Picture::Rectangle::Kind kind) {
    return std::any_of(drawn.begin(), drawn.end(), [kind](const auto& one) { return one.kind == kind; });
  };
  lines.push_back(fmt::format("steps of {} mm{}{}; cross: work origin, Z0", profile.step_mm,
                              shows(Picture::Rectangle::Kind::work_area) ? "; dashed: work area" : "",
                              shows(Picture::Rectangle::Kind::stock) ? "; filled: stock" : ""));
  return lines;
}

}  // namespace

const std::array<const char*, kShades> kShadeColours = {"#9aa5b1", "#fdcc8a", "#fdae61", "#fc8d59", "#ef6548",
                                                        "#d7301f", "#a50f15", "#7a0177", "#3f007d"};

void Strokes::moved(const Move& move) {
  if (move.from.z * move.to.z < 0) {
    const Point surface = move.from + (move.to - move.from) * (move.from.z / (move.from.z - move.to.z));
    add(move.from, surface, move.from.z < 0);
    add(surface, move.to, move.to.z < 0);
  } else {
    add(move.from, move.to, move.cuts());
  }
  lowest_ = std::min({lowest_, move.from.z, move.to.z});
  if (move.cuts() && !move.lifts()) feeds_.take(move.speed);
}

void Strokes::add(const Point& from, const Point& to, bool cuts) {
  const auto single = [](const Point& p) {
    return std::array<float, 3>{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  };
  all_.push_back({single(from), single(to), cuts});
}

int Strokes::shade(const Stroke& stroke) const {
  if (!stroke.cuts) return 0;
  const double deepest = std::min(stroke.from[2], stroke.to[2]);
  if (lowest_ >= 0) return 1;  // nothing is below the surface
  return std::clamp(static_cast<int>(std::ceil(deepest / lowest_ * (kShades - 1))), 1, kShades - 1);
}

Picture make_picture(const std::string& title, const Check& check, const Profile& profile, std::optional<Stock> stock,
                     bool origin_known, const Strokes& strokes) {
  Layout layout(extent(check, profile, stock, origin_known), profile);
  // A file's name may be of any bytes; what is no UTF-8 is left out.
  layout.add_heading(boost::locale::conv::utf_to_utf<char>(title) + " on the " + profile.name);
  if (origin_known) {
    const Box& box = check.machine().box();
    layout.add_box(Picture::Rectangle::Kind::work_area, box.lowest, box.highest);
  }
  if (stock) {
    layout.add_box(Picture::Rectangle::Kind::stock, {0, 0, -profile.steps(stock->z)},
                   {profile.steps(stock->x), profile.steps(stock->y), 0});
  }
  layout.add_legend(legend(check, profile, strokes, layout.rectangles()), -strokes.lowest() * profile.step_mm);
  return layout.picture(strokes);
}

}  // namespace axisgate::rml1
