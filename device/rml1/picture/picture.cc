#include "device/rml1/picture/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/locale/encoding_utf.hpp>
#include <cmath>

#include "device/rml1/picture/layout.h"

namespace axisgate::rml1 {
namespace {

constexpr double kLine = 18, kSwatch = 14;
constexpr double kCharacter = 7;  // width of a figure in text of this size
constexpr double kPad = 0.04;     // margin, as a fraction of the extent
constexpr std::size_t kReports = 8;
constexpr double kAssumedToolMm = 2;  // diameter for reliefs, the same as in the check of passes

jobs::Point wide(const std::array<float, 3>& p) { return {p[0], p[1], p[2]}; }

jobs::Bounds stock_bounds(const jobs::Stock& stock, const Profile& profile) {
  jobs::Bounds bounds;
  bounds.take({0, 0, -profile.steps(stock.z)});
  bounds.take({profile.steps(stock.x), profile.steps(stock.y), 0});
  return bounds;
}

// Returns the bounds of the cuts; with `commanded`, also of cuts that clipping leaves out.
jobs::Bounds cut_bounds(const Strokes& strokes, bool commanded) {
  jobs::Bounds bounds;
  for (const Strokes::Stroke& stroke : strokes.all()) {
    const bool left_out = stroke.kind == Strokes::Kind::left_out && (stroke.from[2] < 0 || stroke.to[2] < 0);
    if (stroke.kind != Strokes::Kind::cut && !(commanded && left_out)) continue;
    bounds.take(wide(stroke.from));
    bounds.take(wide(stroke.to));
  }
  return bounds;
}

// Adds the travel. Its height counts only below the top, and only as far above Z0 as the cuts lie below it: people look
// at the cut, and a lift may be many times as high.
void take_travel(jobs::Bounds& bounds, const Strokes& strokes, double top, bool plane) {
  const double highest = bounds.z.any ? std::max(0.0, -bounds.z.lowest) : top;
  for (const Strokes::Stroke& stroke : strokes.all()) {
    if (stroke.kind != Strokes::Kind::travel) continue;
    for (const jobs::Point& p : {wide(stroke.from), wide(stroke.to)}) {
      if (plane) bounds.x.take(p.x), bounds.y.take(p.y);
      if (p.z < std::floor(top)) bounds.z.take(std::min(p.z, highest));
    }
  }
}

void pad(jobs::Reach& reach, double least) {
  if (!reach.any) reach.take(0);
  const double middle = (reach.lowest + reach.highest) / 2;
  const double half = std::max(least, reach.size() * (1 + 2 * kPad)) / 2;
  reach.take(middle - half);
  reach.take(middle + half);
}

Extents extents(const Box& box, const Profile& profile, std::optional<jobs::Stock> stock, bool origin_known,
                const Strokes& strokes, double radius) {
  Extents all;
  all.shown = cut_bounds(strokes, true);
  if (all.shown.x.any) {
    all.shown.take({all.shown.x.lowest - radius, all.shown.y.lowest - radius, all.shown.z.lowest});
    all.shown.take({all.shown.x.highest + radius, all.shown.y.highest + radius, all.shown.z.lowest});
  }
  take_travel(all.shown, strokes, box.highest.z, !all.shown.x.any);
  all.shown.take({0, 0, 0});  // a person clamps the workpiece by the work origin
  if (stock) {
    all.stock = stock_bounds(*stock, profile);
    for (const jobs::Point& p : {jobs::Point{all.stock->x.lowest, all.stock->y.lowest, all.stock->z.lowest},
                                 jobs::Point{all.stock->x.highest, all.stock->y.highest, 0}}) {
      all.shown.take(p);
    }
  }
  if (origin_known) {
    all.area.emplace();
    all.area->take(box.lowest);
    all.area->take(box.highest);
  }
  pad(all.shown.x, profile.steps(1));
  pad(all.shown.y, profile.steps(1));
  pad(all.shown.z, profile.steps(0.1));
  return all;
}

std::string size_text(std::string_view axis, const jobs::Reach& reach, double step_mm) {
  return fmt::format("{} {:.2f} to {:.2f} mm ({:.2f} mm)", axis, reach.lowest * step_mm, reach.highest * step_mm,
                     reach.size() * step_mm);
}

// Returns a text such as "812 mm driven, 600 mm cutting".
std::string lengths_text(const Strokes& strokes, Strokes::Done done, double step_mm) {
  double driven = 0, cutting = 0;
  for (const Strokes::Stroke& stroke : strokes.all()) {
    if (stroke.done != done || stroke.kind == Strokes::Kind::left_out) continue;
    driven += stroke.length() * step_mm;
    if (stroke.kind == Strokes::Kind::cut) cutting += stroke.length() * step_mm;
  }
  return fmt::format("{:.0f} mm driven, {:.0f} mm cutting", driven, cutting);
}

bool any_executed(const Strokes& strokes) { return strokes.executed().most != jobs::Place(); }

void add_remains(std::vector<std::string>& lines, const Strokes& strokes, double step_mm) {
  const auto add = [&](std::string_view what, const jobs::Place& end, Strokes::Done done) {
    lines.push_back(fmt::format("{} up to line {}, column {}: {}", what, end.line, end.column,
                                lengths_text(strokes, done, step_mm)));
  };
  const auto& [least, most] = strokes.executed();
  add("done", least, Strokes::Done::yes);
  if (least != most) add("perhaps done", most, Strokes::Done::perhaps);
  lines.push_back("remains: " + lengths_text(strokes, Strokes::Done::no, step_mm));
}

using Parts = std::vector<const Check*>;

// Returns a text such as "part 2: ", or an empty text for a job without parts.
std::string part_text(const Parts& parts, std::size_t index) {
  return parts.size() == 1 ? "" : fmt::format("part {}: ", index + 1);
}

// Describes one part.
std::string work_text(const Check& check) {
  const Summary& job = check.summary();
  return fmt::format("{} commands; {:.0f} mm driven, of them {:.0f} mm cutting; takes {}", job.commands,
                     job.distance_mm, job.cutting_mm, time_text(job));
}

std::string speed_text(const Parts& parts, const Strokes& strokes) {
  jobs::Reach rpm;
  std::optional<double> not_reached;
  for (const Check* part : parts) {
    const jobs::Reach& one = part->summary().rpm;
    if (one.any) rpm.take(one.lowest), rpm.take(one.highest);
    if (part->speed_not_reached()) not_reached = std::max(not_reached.value_or(0), *part->speed_not_reached());
  }
  return fmt::format("cuts at {} mm/s, {} rpm{}", to_string(strokes.feeds()), rpm.any ? to_string(rpm) : "0",
                     not_reached ? fmt::format("; the job sets up to {:g} mm/s", *not_reached) : "");
}

// Returns a text about the width of the drawn cuts.
std::string width_text(const Picture& picture, double step_mm) {
  if (picture.diameters.empty()) return "";
  std::vector<std::string> widths;
  for (const double one : picture.diameters) widths.push_back(fmt::format("{:g}", one * step_mm));
  return fmt::format("{} as a flat tool of {} mm leaves {}", picture.relief ? "; shaded" : "; cuts",
                     fmt::join(widths, ", "), picture.relief ? "it" : "them");
}

std::vector<std::string> facts(const Parts& parts, const Profile& profile, const Picture& picture, bool stock,
                               bool area) {
  const Strokes& strokes = *picture.strokes;
  const jobs::Bounds cuts = cut_bounds(strokes, false);
  std::vector<std::string> lines;
  for (std::size_t index = 0; index < parts.size(); ++index) {
    lines.push_back(part_text(parts, index) + work_text(*parts[index]));
  }
  lines.push_back("time: " + time_reason(parts.front()->summary(), profile));
  if (any_executed(strokes)) add_remains(lines, strokes, profile.step_mm);
  if (cuts.x.any) {
    lines.push_back(fmt::format("cuts {}, {}{}, {:.2f} mm deep", size_text("X", cuts.x, profile.step_mm),
                                size_text("Y", cuts.y, profile.step_mm),
                                picture.diameters.empty() ? "" : " at the middle of the tool",
                                std::max(0.0, -cuts.z.lowest) * profile.step_mm));
  }
  if (strokes.feeds().any) lines.push_back(speed_text(parts, strokes));
  lines.push_back(fmt::format("steps of {} mm; cross: work origin, Z0{}{}{}", profile.step_mm,
                              area ? "; dashed: work area" : "", stock ? "; filled: stock" : "",
                              width_text(picture, profile.step_mm)));
  return lines;
}

// Breaks the text at blanks into lines that fit into the picture.
std::vector<std::string> wrapped(std::string text, double width) {
  const auto characters = static_cast<std::size_t>((width - 2 * kMargin) / kCharacter);
  std::vector<std::string> lines;
  while (text.size() > characters) {
    const std::size_t blank = text.rfind(' ', characters);
    const std::size_t end = blank == std::string::npos || blank < 4 ? characters : blank;
    lines.push_back(text.substr(0, end));
    text = "    " + text.substr(text.find_first_not_of(' ', end));
  }
  lines.push_back(text);
  return lines;
}

std::vector<std::string> reports(const Parts& parts, double width) {
  std::vector<std::string> lines;
  std::uint64_t more = 0;
  for (std::size_t index = 0; index < parts.size(); ++index) {
    const Diagnostics& diagnostics = parts[index]->diagnostics();
    for (const Diagnostic& one : diagnostics.in_order()) {
      if (lines.size() >= kReports) {
        ++more;
        continue;
      }
      const std::string text =
          fmt::format("{}{}, line {}: {}", part_text(parts, index), name(one.severity), one.place.line, one.text);
      for (std::string& line : wrapped(text, width)) lines.push_back(std::move(line));
    }
    more += diagnostics.omitted_count();
  }
  if (more > 0) lines.push_back(fmt::format("and {} more", more));
  return lines;
}

// Returns diameters in steps. A relief without a tool uses the assumed one; other pictures use hairlines. So does a
// picture of what remains, because passes of the tool's width would hide each other.
std::vector<double> diameters_of(const Parts& parts, const Profile& profile, const Strokes& strokes, bool relief) {
  if (any_executed(strokes)) return {};
  std::vector<double> all;
  for (const Check* part : parts) {
    if (!part->tool_mm() && !relief) return {};
    all.push_back(profile.steps(part->tool_mm().value_or(kAssumedToolMm)));
  }
  return all;
}

class Legend {
 public:
  explicit Legend(Picture& picture) : picture_(picture), y_(picture.height) {}

  void add_line(const std::string& line) { picture_.labels.push_back({kMargin, y_ += kLine, line}); }

  void add_swatches(const std::vector<Shades::Entry>& entries) {
    std::size_t longest = 0;
    for (const Shades::Entry& entry : entries) longest = std::max(longest, entry.text.size());
    const double width = 2 * kSwatch + kCharacter * static_cast<double>(longest);
    const auto in_line = static_cast<std::size_t>((picture_.width - 2 * kMargin) / width);
    for (std::size_t index = 0; index < entries.size(); ++index) {
      if (index % in_line == 0) y_ += kLine + 4;
      const double x = kMargin + static_cast<double>(index % in_line) * width;
      picture_.rectangles.push_back(
          {Picture::Rectangle::Kind::swatch, x, y_ - kSwatch + 2, kSwatch, kSwatch, entries[index].shade});
      picture_.labels.push_back({x + kSwatch + 5, y_, entries[index].text});
    }
    y_ += 4;
  }

  double bottom() const { return y_ + kLine; }

 private:
  Picture& picture_;
  double y_;
};

}  // namespace

bool is_in_relief(const Picture& picture, const Picture::View& view, const Strokes::Stroke& stroke) {
  return picture.relief && view.from_above() && stroke.kind == Strokes::Kind::cut;
}

double drawn_width(const Picture& picture, const Picture::View& view, std::size_t part) {
  return view.from_above() && !picture.diameters.empty() ? std::max(1.0, picture.diameters[part] * view.scale) : 0;
}

Picture make_picture(const std::string& title, const std::vector<const Check*>& parts, const Profile& profile,
                     std::optional<jobs::Stock> stock, bool origin_known, const Strokes& strokes) {
  const Shades shades(strokes, profile.step_mm);
  const bool relief = shades.are_ranges() && !any_executed(strokes);
  const std::vector<double> diameters = diameters_of(parts, profile, strokes, relief);
  const double widest = diameters.empty() ? 0 : *std::ranges::max_element(diameters);
  Picture picture = lay_out(extents(parts.front()->machine().box(), profile, stock, origin_known, strokes, widest / 2),
                            profile.step_mm);
  picture.strokes = &strokes;
  picture.shades = shades;
  picture.relief = relief;
  picture.diameters = diameters;
  // The name of a file may contain any bytes; bytes that are not UTF-8 are left out.
  picture.labels.push_back({kMargin, kMargin * 0.7,
                            fmt::format("{}{} on the {}", boost::locale::conv::utf_to_utf<char>(title),
                                        any_executed(strokes) ? ": what remains" : "", profile.name),
                            true});
  Legend legend(picture);
  legend.add_swatches(picture.shades->legend());
  for (const std::string& line : facts(parts, profile, picture, stock.has_value(), origin_known)) {
    for (const std::string& piece : wrapped(line, picture.width)) legend.add_line(piece);
  }
  for (const std::string& line : reports(parts, picture.width)) legend.add_line(line);
  picture.height = legend.bottom();
  return picture;
}

}  // namespace axisgate::rml1
