#include "server/config/limits.h"

namespace axisgate::server {
namespace {

void read_count(ConfigTable& table, std::string_view key, int minimum, int maximum, int& into) {
  if (const auto value = table.integer(key, minimum, maximum)) into = static_cast<int>(*value);
}

}  // namespace

void read_identity_limits(const toml::table& source, std::string_view file, std::vector<ConfigError>& errors,
                          LimitsConfig& limits) {
  ConfigTable table(source, "limits", file, errors);
  read_count(table, "connections", 1, 4096, limits.connections);
  read_count(table, "streams", 1, 4096, limits.streams);
  read_count(table, "calls", 1, 65'536, limits.calls);
  // Any segment of a path and any command line is far shorter than the lower bound.
  read_count(table, "message_bytes", 4096, 64 << 20, limits.message_bytes);
  table.refuse_unknown();
}

}  // namespace axisgate::server
