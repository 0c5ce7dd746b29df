#include "server/metrics/page_request.h"

#include <algorithm>

namespace axisgate::server {
namespace {

constexpr std::size_t kNowhere = std::string_view::npos;

// Information about the connection in the fields of a head.
struct Fields {
  bool close = false;
  bool keep_alive = false;
  bool body = false;
};

// Removes the line end as well. A person at a terminal sends it without a carriage return.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& character : result) {
    if (character >= 'A' && character <= 'Z') character = static_cast<char>(character - 'A' + 'a');
  }
  return result;
}

bool is_method(std::string_view text) {
  return !text.empty() &&
         std::ranges::all_of(text, [](char character) { return character >= 'A' && character <= 'Z'; });
}

bool read_field(std::string_view line, Fields& fields) {
  const std::size_t colon = line.find(':');
  if (colon == 0 || colon == kNowhere) return false;
  const std::string name = lower(line.substr(0, colon));
  const std::string value = lower(line.substr(colon + 1));
  if (name == "connection") {
    fields.close |= value.find("close") != kNowhere;
    fields.keep_alive |= value.find("keep-alive") != kNowhere;
  }
  // A length of 0 announces no body.
  fields.body |= name == "transfer-encoding" || (name == "content-length" && value.find_first_not_of(" 0") != kNowhere);
  return true;
}

}  // namespace

std::optional<std::size_t> head_size(std::string_view received) {
  for (std::size_t end = received.find('\n'); end != kNowhere; end = received.find('\n', end + 1)) {
    const std::string_view rest = received.substr(end + 1);
    if (rest.starts_with('\n')) return end + 2;
    if (rest.starts_with("\r\n")) return end + 3;
  }
  return std::nullopt;
}

std::optional<PageRequest> parse_request(std::string_view head) {
  const std::string_view line = take_line(head);
  const std::size_t first = line.find(' ');
  const std::size_t last = line.rfind(' ');
  if (first == last) return std::nullopt;
  const std::string_view method = line.substr(0, first);
  const std::string_view target = line.substr(first + 1, last - first - 1);
  const std::string_view version = line.substr(last + 1);
  const bool version_1_1 = version == "HTTP/1.1";
  if (!is_method(method) || target.empty() || target.find(' ') != kNowhere) return std::nullopt;
  if (!version_1_1 && version != "HTTP/1.0") return std::nullopt;
  Fields fields;
  for (std::string_view field = take_line(head); !field.empty(); field = take_line(head)) {
    if (!read_field(field, fields)) return std::nullopt;
  }
  // Bodies are not read, and would look like the next request.
  const bool keep_alive = !fields.close && !fields.body && (version_1_1 || fields.keep_alive);
  return PageRequest{std::string(method), std::string(target.substr(0, target.find('?'))), keep_alive};
}

}  // namespace axisgate::server
