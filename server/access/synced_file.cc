#include "server/access/synced_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace axisgate::server {
namespace {

tl::unexpected<Problem> failed(const std::string& path) {
  return fail(Reason::internal, fmt::format("cannot write {}: {}", path, std::strerror(errno)),
              "let the daemon's user write there");
}

bool write_synced(const std::string& path, const std::string& text) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0) return false;
  const bool written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const bool synced = written && ::fsync(file) == 0;
  return ::close(file) == 0 && synced;
}

bool sync_directory(const std::string& path) {
  const int directory = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory < 0) return false;
  const bool synced = ::fsync(directory) == 0;
  return ::close(directory) == 0 && synced;
}

}  // namespace

Result<void> replace_synced(const std::string& path, const std::string& text) {
  const std::string directory = std::filesystem::path(path).parent_path().string(), fresh = path + ".new";
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (!write_synced(fresh, text)) return failed(fresh);
  if (::rename(fresh.c_str(), path.c_str()) != 0) return failed(path);
  if (!sync_directory(directory)) return failed(directory);
  return {};
}

}  // namespace axisgate::server
