// Requests to the metrics page: as much of HTTP/1 as a page needs that only answers.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate::server {

struct PageRequest {
  std::string method;
  std::string path;         // without what follows a question mark
  bool keep_alive = false;  // another request may follow on the connection
};

// The size of the first head in `received`, with its empty line; nothing until it is complete.
std::optional<std::size_t> head_size(std::string_view received);

// Nothing if the head is not HTTP/1.
std::optional<PageRequest> parse_request(std::string_view head);

}  // namespace axisgate::server
