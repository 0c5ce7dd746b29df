#include "server/access/generation.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

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

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

std::string default_state_directory() {
  if (const std::string given = variable("STATE_DIRECTORY"); !given.empty()) return given.substr(0, given.find(':'));
  if (::geteuid() == 0) return "/var/lib/axisgate";
  if (const std::string state = variable("XDG_STATE_HOME"); !state.empty()) return state + "/axisgate";
  return variable("HOME") + "/.local/state/axisgate";
}

Result<std::uint32_t> next_generation(const std::string& state_directory, std::uint32_t seconds_since_1970) {
  std::error_code error;
  std::filesystem::create_directories(state_directory, error);
  const std::string path = state_directory + "/generation", fresh = path + ".new";
  std::uint32_t last = 0;
  std::ifstream(path) >> last;
  const std::uint32_t next = std::max(last + 1, seconds_since_1970);
  if (!write_synced(fresh, fmt::format("{}\n", next))) return failed(fresh);
  if (::rename(fresh.c_str(), path.c_str()) != 0) return failed(path);
  if (!sync_directory(state_directory)) return failed(state_directory);
  return next;
}

}  // namespace axisgate::server
