#include "clients/axisctl/mill/job_places.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <optional>
#include <system_error>
#include <tuple>

#include "clients/axisctl/failure.h"

namespace axisgate::axisctl {
namespace {

std::optional<std::uint64_t> count_from_one(std::string_view text) {
  std::int64_t value = 0;  // same type as in the request
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value <= 0) return std::nullopt;
  return static_cast<std::uint64_t>(value);
}

std::optional<jobs::Place> place_in(std::string_view text) {
  const std::size_t colon = text.find(':');
  const auto line = count_from_one(text.substr(0, colon));
  const auto column = colon == std::string_view::npos ? 1 : count_from_one(text.substr(colon + 1));
  if (!line || !column) return std::nullopt;
  return jobs::Place{.line = *line, .column = *column};
}

}  // namespace

jobs::Place job_place(const std::string& text) {
  if (const auto place = place_in(text)) return *place;
  throw usage(fmt::format("\"{}\" is not valid for --from", text),
              "name a line, e.g. 12, or a line and a column, e.g. 1:340");
}

jobs::PlaceRange job_range(const std::string& text) {
  const std::string_view all = text;
  const std::size_t hyphen = all.find('-');
  const auto least = place_in(all.substr(0, hyphen));
  const auto most = hyphen == std::string_view::npos ? least : place_in(all.substr(hyphen + 1));
  const auto order = [](const jobs::Place& place) { return std::tie(place.line, place.column); };
  if (least && most && order(*least) <= order(*most)) return {*least, *most};
  throw usage(fmt::format("\"{}\" is not valid for --from", text),
              "name a line, e.g. 12, a line and a column, e.g. 1:340, or two of them in their order, e.g. 8:1-13:1");
}

std::string place_text(const v1::JobPlace& place) {
  return fmt::format("line {}, column {}", place.line(), place.column());
}

std::string line_text(const v1::JobPlace& place) {
  return place.column() > 1 ? place_text(place) : fmt::format("line {}", place.line());
}

}  // namespace axisgate::axisctl
