#include "server/access/state_directory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "server/access/synced_file.h"
#include "server/access/writers.h"

namespace axisgate::server {
namespace {

constexpr const char* kOtherDirectory = "give this one a directory of its own with STATE_DIRECTORY";

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// " (process 123)"; empty, where the lock does not say.
std::string holder_in(const std::string& lock) {
  const Result<std::string> text = read_state_file(lock);
  const std::string process = text ? text->substr(0, text->find('\n')) : "";
  return process.empty() ? "" : fmt::format(" (process {})", process);
}

// For people only, so a full disk does not matter.
void name_holder(const std::string& lock) {
  const Result<Descriptor> file = open_state_file(lock, O_WRONLY | O_TRUNC);
  if (file && file->valid()) ::dprintf(file->get(), "%d\n", ::getpid());
}

}  // namespace

std::string default_state_directory() {
  if (const std::string given = variable("STATE_DIRECTORY"); !given.empty()) return given.substr(0, given.find(':'));
  if (::geteuid() == 0) return "/var/lib/axisgate";
  if (const std::string state = variable("XDG_STATE_HOME"); !state.empty()) return state + "/axisgate";
  return variable("HOME") + "/.local/state/axisgate";
}

Result<StateDirectory> StateDirectory::hold(std::string path) {
  StateDirectory directory(std::move(path));
  make_state_directory(directory.path_);
  struct stat status {};
  if (::stat(directory.path_.c_str(), &status) != 0) return directory;
  if (!S_ISDIR(status.st_mode)) {
    return fail(Reason::internal, fmt::format("the state directory {} is not a directory", directory.path_),
                "move it away, or set STATE_DIRECTORY to another path");
  }
  if (const Result<void> checked = check_writers(directory.path_, status); !checked) {
    return fail(Reason::internal, fmt::format("the state directory {} {}", directory.path_, checked.error().message),
                checked.error().hint);
  }
  if (const Result<void> locked = directory.lock(); !locked) return tl::unexpected(locked.error());
  return directory;
}

Result<void> StateDirectory::lock() {
  const std::string path = file("lock");
  // For reading, so that it can also be locked where nothing can be written any more.
  Result<Descriptor> opened = open_state_file(path, O_RDONLY | O_CREAT);
  if (!opened) return tl::unexpected(opened.error());
  if (!opened->valid()) return {};
  if (::flock(opened->get(), LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    if (error != EWOULDBLOCK) {
      return fail(Reason::internal, fmt::format("cannot lock {}: {}", path, std::generic_category().message(error)),
                  kOtherDirectory);
    }
    return fail(Reason::internal,
                fmt::format("the state directory {} is held by another axisgated{}", path_, holder_in(path)),
                fmt::format("end the other one, or {}", kOtherDirectory));
  }
  name_holder(path);
  lock_ = *std::move(opened);
  return {};
}

}  // namespace axisgate::server
