// Parser of requests to the metrics page: the part of HTTP/1 that a read-only page needs.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate::server {

struct PageRequest {
  std::string method;
  std::string path;         // without the question mark and the text after it
  bool keep_alive = false;  // another request may follow on the connection
};

// Returns the size of the first head in `received`, including its empty line. nullopt until it is complete.
std::optional<std::size_t> head_size(std::string_view received);

// Returns nullopt if the head is not HTTP/1.
std::optional<PageRequest> parse_request(std::string_view head);

}  // namespace axisgate::server
