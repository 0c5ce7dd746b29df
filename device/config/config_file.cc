#include "device/config/config_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace axisgate {
namespace {

constexpr std::size_t kBytesMax = 1 << 20;

}  // namespace

tl::expected<std::string, std::string> read_config_file(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) return tl::unexpected(fmt::format("cannot be opened: {}", std::strerror(errno)));
  std::string text(kBytesMax + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad() || (file.fail() && !file.eof())) {
    return tl::unexpected(fmt::format("cannot be read: {}", std::strerror(errno)));
  }
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kBytesMax) return tl::unexpected(std::string("is larger than 1 MB: not a configuration"));
  return text;
}

}  // namespace axisgate
