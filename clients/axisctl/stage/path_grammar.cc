#include "clients/axisctl/stage/path_grammar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/parse.h"

namespace axisgate::axisctl {
namespace {

using Places = std::vector<v1::AxisDistance>;

constexpr std::string_view kAround = "around", kThrough = "through", kTo = "to", kRise = "rise";

// Options of one segment besides its course.
struct Manner {
  std::string speed;
  std::optional<std::int64_t> rest_ms, inputs;
};

std::int64_t parse_rest(std::string_view text) {
  constexpr std::int64_t most_ms = 255'000;
  if (text.ends_with('s')) {
    if (const auto rest = parse_steps(text.substr(0, text.size() - 1), 3, most_ms)) return *rest;
  }
  throw usage(fmt::format("\"{}\" is not a waiting time", text), "0s to 255s, as rest=0.5s");
}

std::int64_t parse_inputs(std::string_view text) {
  constexpr std::int64_t all_on = 63;
  if (const auto inputs = parse_steps(text, 0, all_on)) return *inputs;
  throw usage(fmt::format("\"{}\" is not a state of the inputs", text),
              "0 to 63: add 1 for IN1, 2 for IN2, 4 for IN3, 8 for IN4, 16 for IN5 and 32 for IN6, as inputs=5");
}

bool take_manner(std::string_view word, Manner& manner) {
  const std::size_t equals = word.find('=');
  if (equals == std::string_view::npos) return false;
  const std::string_view name = word.substr(0, equals), value = word.substr(equals + 1);
  if (name == "speed") {
    manner.speed = value;
  } else if (name == "rest") {
    manner.rest_ms = parse_rest(value);
  } else if (name == "inputs") {
    manner.inputs = parse_inputs(value);
  } else {
    return false;
  }
  return true;
}

// A Course reads the words of a segment's course, from the first to the last.
class Course {
 public:
  Course(const v1::Device& device, std::vector<std::string> words) : device_(device), words_(std::move(words)) {}

  bool next_is(std::string_view word) const { return at_ < words_.size() && words_[at_] == word; }

  bool take(std::string_view word) {
    if (!next_is(word)) return false;
    ++at_;
    return true;
  }

  // Takes the next word; empty after the last word.
  std::string take() { return at_ < words_.size() ? words_[at_++] : std::string(); }

  Places take_places() {
    Places places;
    while (at_ < words_.size() && words_[at_].find('=') != std::string::npos) {
      places.push_back(parse_place(device_, words_[at_++]));
    }
    return places;
  }

  void expect_end(std::string_view hint) const {
    if (at_ < words_.size()) throw usage(fmt::format("\"{}\" is not expected here", words_[at_]), std::string(hint));
  }

 private:
  const v1::Device& device_;
  const std::vector<std::string> words_;
  std::size_t at_ = 0;
};

v1::ArcAroundCenter::Rotation parse_rotation(std::string_view word) {
  if (word == "cw") return v1::ArcAroundCenter::ROTATION_CLOCKWISE;
  if (word == "ccw") return v1::ArcAroundCenter::ROTATION_COUNTERCLOCKWISE;
  throw usage(word.empty() ? "the arc has no direction" : fmt::format("\"{}\" is not the direction of an arc", word),
              "write cw or ccw after its center, e.g. around 1=0 2=1mm ccw 90deg");
}

void fill_extent(std::string_view word, v1::ArcAroundCenter& around) {
  const std::size_t unit = std::min(word.find("turn"), word.size());
  if (word.substr(unit) == "turn" || word.substr(unit) == "turns") {
    constexpr std::int64_t most = 1000;
    if (const auto turns = parse_steps(word.substr(0, unit), 0, most)) {
      around.set_turns(static_cast<int>(*turns));
      return;
    }
  } else if (const Result<Quantity> angle = parse_quantity(word, Unit::pulses); angle && angle->unit == Unit::degrees) {
    around.set_degrees(to_string(angle->value));
    return;
  }
  throw usage(word.empty() ? "the arc has no angle" : fmt::format("\"{}\" is not the angle of an arc", word),
              "write degrees or whole turns after cw or ccw, e.g. 90deg, 1turn or 2turns");
}

const Places& of_two_axes(const Places& places, std::string_view what) {
  if (places.size() == 2) return places;
  throw usage(fmt::format("{} of an arc has two coordinates, not {}", what, places.size()),
              "name both axes of the circle, e.g. 1=0 2=1mm; a third axis rises, e.g. rise 3=0.1mm");
}

void fill_rise(Course& course, v1::Arc& arc) {
  constexpr std::string_view example = "e.g. around 1=0 2=1mm cw 2turns rise 3=0.1mm";
  if (course.take(kRise)) {
    const Places places = course.take_places();
    if (places.size() != 1) throw usage("a rise has one axis", std::string(example));
    *arc.mutable_rise() = places.front();
  }
  course.expect_end(arc.has_around() ? example : "e.g. through 1=1mm 2=1mm to 1=2mm 2=0 rise 3=0.1mm");
}

// Fills in an arc around a center, and returns the axes of the circle in `plane`.
void fill_around(Course& course, v1::Arc& arc, Places& plane) {
  v1::ArcAroundCenter& around = *arc.mutable_around();
  plane = of_two_axes(course.take_places(), "the center");
  around.mutable_center()->Add(plane.begin(), plane.end());
  around.set_rotation(parse_rotation(course.take()));
  fill_extent(course.take(), around);
}

void fill_through(Course& course, v1::Arc& arc, Places& plane) {
  v1::ArcThroughPoint& through = *arc.mutable_through();
  plane = of_two_axes(course.take_places(), "the point");
  through.mutable_point()->Add(plane.begin(), plane.end());
  if (!course.take(kTo)) throw usage("the arc has no end point", "e.g. through 1=1mm 2=1mm to 1=2mm 2=0");
  const Places end = of_two_axes(course.take_places(), "the end");
  through.mutable_end()->Add(end.begin(), end.end());
}

void fill_straight(Course& course, v1::Segment& segment, Places& places) {
  places = course.take_places();
  if (places.empty()) {
    const std::string word = course.take();
    throw usage(word.empty() ? "no axis is named" : fmt::format("\"{}\" does not begin a segment", word),
                "write AXIS=AMOUNT, e.g. 1=+5mm, or an arc, e.g. around 1=0 2=1mm ccw 90deg");
  }
  course.expect_end("a straight line is AXIS=AMOUNT for each axis, e.g. 1=+5mm 2=1mm");
  if (places.size() == 1) {
    *segment.mutable_single() = places.front();
  } else {
    segment.mutable_line()->mutable_distances()->Add(places.begin(), places.end());
  }
}

// Returns the axis with the lowest number. The path's speed is that axis's speed (manual 2.4), so a bare number is in
// its unit.
const v1::Axis& lowest_axis(const v1::Device& device, const Places& places) {
  const auto lowest =
      std::min_element(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.axis() < b.axis(); });
  return find_axis(device, lowest->axis());
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line.substr(0, line.find('#')));
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

}  // namespace

v1::Segment parse_segment(const v1::Device& device, const PathOptions& options, const std::vector<std::string>& words) {
  Manner manner{options.speed, {}, {}};
  std::vector<std::string> others;
  for (const std::string& word : words) {
    if (!take_manner(word, manner)) others.push_back(word);
  }
  Course course(device, std::move(others));
  v1::Segment segment;
  Places places;
  if (course.take(kAround)) {
    fill_around(course, *segment.mutable_arc(), places);
    fill_rise(course, *segment.mutable_arc());
  } else if (course.take(kThrough)) {
    fill_through(course, *segment.mutable_arc(), places);
    fill_rise(course, *segment.mutable_arc());
  } else {
    fill_straight(course, segment, places);
  }
  segment.set_relative(!options.absolute);
  if (options.acceleration_ms != 0) *segment.mutable_acceleration_time() = from_milliseconds(options.acceleration_ms);
  if (!manner.speed.empty()) *segment.mutable_speed() = parse_speed_for(lowest_axis(device, places), manner.speed);
  if (manner.rest_ms) *segment.mutable_rest_time() = from_milliseconds(*manner.rest_ms);
  if (manner.inputs) *segment.mutable_inputs() = to_pins(static_cast<int>(*manner.inputs));
  return segment;
}

std::vector<v1::Segment> parse_path(const v1::Device& device, const PathOptions& options, std::istream& input,
                                    const std::string& file_name) {
  std::vector<v1::Segment> segments;
  std::string line;
  for (int number = 1; std::getline(input, line); ++number) {
    try {
      const std::vector<std::string> words = words_of(line);
      if (!words.empty()) segments.push_back(parse_segment(device, options, words));
    } catch (Failure& failure) {
      failure.message = fmt::format("{}:{}: {}", file_name, number, failure.message);
      throw;
    }
  }
  if (input.bad()) throw usage(fmt::format("{}: reading has failed", file_name), "is it a file?");
  if (segments.empty())
    throw usage(fmt::format("{}: it has no segment", file_name), "write one per line, e.g. 1=1mm 2=1mm");
  return segments;
}

}  // namespace axisgate::axisctl
