#include "server/devices/saved_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <utility>

#include "server/access/synced_file.h"

namespace axisgate::server {
namespace {

constexpr std::string_view kHeader = "# axisgate positions 1: device name kind number coordinates saved serial who\n";
constexpr std::string_view kPlace = "place", kCoordinates = "coordinates";

bool is_word_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

template <class Number>
std::optional<Number> number_in(std::string_view text) {
  Number number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// Returns a text such as "1:100,2:-200".
std::string to_text(const std::map<int, std::int64_t>& coordinates) {
  std::string text;
  for (const auto& [axis, pulses] : coordinates) text += fmt::format("{}{}:{}", text.empty() ? "" : ",", axis, pulses);
  return text;
}

std::optional<std::map<int, std::int64_t>> coordinates_in(const std::string& text) {
  std::map<int, std::int64_t> coordinates;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t colon = std::min(part.find(':'), part.size());
    const auto axis = number_in<int>(std::string_view(part).substr(0, colon));
    const auto pulses = number_in<std::int64_t>(std::string_view(part).substr(std::min(colon + 1, part.size())));
    if (!axis || !pulses || *axis < 1 || *axis > stage::kAxesMax) return std::nullopt;
    if (!coordinates.emplace(*axis, *pulses).second) return std::nullopt;
  }
  return coordinates.empty() ? std::nullopt : std::optional(std::move(coordinates));
}

std::string to_line(const SavedPosition& position) {
  return fmt::format("{} {} {} {} {} {} {} {}\n", position.device, position.name,
                     position.place ? kPlace : kCoordinates, position.number, to_text(position.coordinates),
                     position.saved.time_since_epoch().count(), position.serial_number, position.who);
}

std::optional<SavedPosition> from_line(const std::string& line) {
  std::istringstream fields(line);
  SavedPosition position;
  std::string kind, coordinates;
  std::int64_t saved = 0;
  fields >> position.device >> position.name >> kind >> position.number >> coordinates >> saved >>
      position.serial_number;
  std::getline(fields >> std::ws, position.who);
  const auto places = coordinates_in(coordinates);
  const bool good = fields && places && is_position_name(position.name) && (kind == kPlace || kind == kCoordinates) &&
                    position.number >= 1 && position.number <= SavedPositions::kNumbers;
  if (!good) return std::nullopt;
  position.place = kind == kPlace;
  position.coordinates = *places;
  position.saved = std::chrono::sys_seconds(std::chrono::seconds(saved));
  return position;
}

bool same(const SavedPosition& a, const SavedPosition& b) {
  return a.place == b.place && a.number == b.number && a.coordinates == b.coordinates && a.saved == b.saved;
}

}  // namespace

Frame frame_of(const stage::State& state) {
  Frame frame{state.device_epoch, state.frame_epoch, {}, {}};
  for (const int number : state.controllable().list()) {
    const stage::AxisState& axis = state.axis(number);
    frame.homings[static_cast<std::size_t>(number - 1)] = axis.homings;
    if (axis.scale) frame.per_pulse[static_cast<std::size_t>(number - 1)] = axis.scale->per_pulse;
  }
  return frame;
}

bool is_position_name(std::string_view name) {
  return !name.empty() && name.size() <= SavedPositions::kNameMax && std::ranges::all_of(name, is_word_character);
}

Result<std::unique_ptr<SavedPositions>> SavedPositions::open(std::string path) {
  std::unique_ptr<SavedPositions> positions(new SavedPositions(std::move(path)));
  if (const Result<void> read = positions->read(); !read) return tl::unexpected(read.error());
  return positions;
}

Result<void> SavedPositions::read() {
  const Result<std::string> text = read_state_file(path_);
  if (!text) return tl::unexpected(text.error());
  std::istringstream file(*text);
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    std::optional<SavedPosition> position = from_line(line);
    if (!position || !is_free(position->device, position->place, position->number) ||
        !positions_.emplace(std::pair(position->device, position->name), *position).second) {
      return fail(Reason::internal,
                  fmt::format("{}:{}: {}", path_, number,
                              position ? "its name or its number is used above already" : "is no saved position"),
                  "correct or remove the line: the controller keeps the position, and the gateway only its name");
    }
  }
  return {};
}

Result<void> SavedPositions::write(const Positions& positions) const {
  std::string text(kHeader);
  for (const auto& [key, position] : positions) text += to_line(position);
  return replace_synced(path_, text);
}

std::optional<SavedPosition> SavedPositions::find(const std::string& device, const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = positions_.find({device, name});
  return found == positions_.end() ? std::nullopt : std::optional(found->second);
}

std::vector<SavedPosition> SavedPositions::list(const std::string& device) const {
  const std::lock_guard lock(mutex_);
  std::vector<SavedPosition> all;
  for (const auto& [key, position] : positions_) {
    if (position.device == device) all.push_back(position);
  }
  return all;
}

bool SavedPositions::is_free(const std::string& device, bool place, int number) const {
  const auto has = [&](const auto& one) { return one.device == device && one.place == place && one.number == number; };
  return std::ranges::none_of(taken_, has) &&
         std::ranges::none_of(positions_, [&](const auto& entry) { return has(entry.second); });
}

Result<SavedPositions::Number> SavedPositions::take_number(const std::string& device, const std::string& name,
                                                           bool place, bool only_new) {
  if (!is_position_name(name)) {
    return fail(Reason::invalid_request, "that is not a name for a position",
                fmt::format("use 1 to {} letters, digits, '-' and '_'", kNameMax));
  }
  const std::lock_guard lock(mutex_);
  const auto found = positions_.find({device, name});
  const bool being_saved =
      std::ranges::any_of(taken_, [&](const Taken& one) { return one.device == device && one.name == name; });
  if (only_new && (found != positions_.end() || being_saved)) {
    return fail(Reason::invalid_request, fmt::format("there is a position named \"{}\" already", name),
                "choose another name, or forget it first");
  }
  Taken taken{device, name, place, 0};
  if (found != positions_.end() && found->second.place == place) taken.number = found->second.number;
  for (int number = 1; taken.number == 0 && number <= kNumbers; ++number) {
    if (is_free(device, place, number)) taken.number = number;
  }
  if (taken.number == 0) {
    return fail(
        Reason::queue_full,
        fmt::format("all {} {} that the controller keeps have names", kNumbers, place ? "places" : "coordinates"),
        "delete one: `ListPositions` lists them, `DeletePosition`");
  }
  taken_.push_back(taken);
  return Number(new int(taken.number), [this, taken](const int* number) {
    give_back(taken);
    delete number;
  });
}

void SavedPositions::give_back(const Taken& taken) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find_if(taken_, [&](const Taken& one) {
    return one.device == taken.device && one.name == taken.name && one.place == taken.place &&
           one.number == taken.number;
  });
  if (found != taken_.end()) taken_.erase(found);
}

Result<void> SavedPositions::keep(SavedPosition position) {
  const std::lock_guard writing(writing_);
  Positions fresh = [this] {
    const std::lock_guard lock(mutex_);
    return positions_;
  }();
  const auto key = std::pair(position.device, position.name);
  fresh.insert_or_assign(key, position);
  if (auto written = write(fresh); !written) return written;
  const std::lock_guard lock(mutex_);
  positions_.insert_or_assign(key, std::move(position));
  return {};
}

Result<void> SavedPositions::forget(const std::string& device, const std::string& name) {
  const std::lock_guard writing(writing_);
  Positions fresh = [this] {
    const std::lock_guard lock(mutex_);
    return positions_;
  }();
  if (fresh.erase({device, name}) == 0) return {};
  if (auto written = write(fresh); !written) return written;
  const std::lock_guard lock(mutex_);
  positions_.erase({device, name});
  return {};
}

void SavedPositions::held_in(const SavedPosition& position, const std::optional<Frame>& frame) {
  const std::lock_guard lock(mutex_);
  const auto found = positions_.find({position.device, position.name});
  if (found != positions_.end() && same(found->second, position)) found->second.frame = frame;
}

}  // namespace axisgate::server
