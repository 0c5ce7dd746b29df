#include "server/access/state_directory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "server/access/synced_file.h"
#include "server/access/writers.h"

namespace axisgate::server {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOtherDirectory = "give this one a directory of its own with STATE_DIRECTORY";

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// Returns " (process 123)"; empty if the lock file names no process.
std::string holder_in(const std::string& lock) {
  const Result<std::string> text = read_state_file(lock);
  const std::string process = text ? text->substr(0, text->find('\n')) : "";
  return process.empty() ? "" : fmt::format(" (process {})", process);
}

// Writes the process id for people only, so a full disk does not matter.
void name_holder(const std::string& lock) {
  const Result<Descriptor> file = open_state_file(lock, O_WRONLY | O_TRUNC);
  if (file && file->valid()) ::dprintf(file->get(), "%d\n", ::getpid());
}

tl::unexpected<Problem> refuse(const std::string& what, const Problem& why) {
  return fail(Reason::internal, fmt::format("{} {}", what, why.message), why.hint);
}

// Checks the folders above a directory, because a user who may rename one of them decides which directory is at the
// path. In a sticky folder, such as /tmp, users may rename only their own files.
Result<void> check_folders_above(const fs::path& directory, const std::string& link) {
  for (fs::path folder = directory.parent_path();; folder = folder.parent_path()) {
    struct stat status {};
    if (::stat(folder.c_str(), &status) == 0) {
      if ((status.st_mode & S_ISVTX) != 0) status.st_mode &= ~static_cast<mode_t>(S_IWOTH | S_IWGRP);
      if (const Result<void> checked = check_writers(folder, status); !checked) {
        return refuse(fmt::format("the state directory {} is a link to {}, and the folder {}", link, directory.string(),
                                  folder.string()),
                      checked.error());
      }
    }
    if (folder == folder.root_path()) return {};
  }
}

// Resolves links once, so that nobody can change them while the daemon runs, and because SQLite follows none. Returns a
// path unchanged if it does not exist or has no link.
Result<std::string> without_links(const std::string& path) {
  std::error_code error;
  if (fs::symlink_status(path, error).type() == fs::file_type::symlink && !fs::exists(path, error)) {
    return fail(Reason::internal,
                fmt::format("the state directory {} is a link to {}, which does not exist", path,
                            fs::read_symlink(path, error).string()),
                "make that directory or mount its disk, or set STATE_DIRECTORY to another path");
  }
  const fs::path real = fs::canonical(path, error);
  const fs::path named = (fs::absolute(path) / "").lexically_normal().parent_path();  // with or without a last slash
  if (error || real == named) return path;
  if (const Result<void> checked = check_folders_above(real, path); !checked) return tl::unexpected(checked.error());
  return real.string();
}

}  // namespace

std::string default_state_directory() {
  if (const std::string given = variable("STATE_DIRECTORY"); !given.empty()) return given.substr(0, given.find(':'));
  if (::geteuid() == 0) return "/var/lib/axisgate";
  if (const std::string state = variable("XDG_STATE_HOME"); !state.empty()) return state + "/axisgate";
  return variable("HOME") + "/.local/state/axisgate";
}

Result<StateDirectory> StateDirectory::hold(const std::string& path) {
  make_state_directory(path);
  const Result<std::string> resolved = without_links(path);
  if (!resolved) return tl::unexpected(resolved.error());
  StateDirectory directory(*resolved);
  struct stat status {};
  if (::stat(directory.path_.c_str(), &status) != 0) return directory;
  if (!S_ISDIR(status.st_mode)) {
    return fail(Reason::internal, fmt::format("the state directory {} is not a directory", directory.path_),
                "move it away, or set STATE_DIRECTORY to another path");
  }
  if (const Result<void> checked = check_writers(directory.path_, status); !checked) {
    return refuse(fmt::format("the state directory {}", directory.path_), checked.error());
  }
  if (const Result<void> locked = directory.lock(); !locked) return tl::unexpected(locked.error());
  return directory;
}

Result<void> StateDirectory::lock() {
  const std::string path = file("lock");
  // Opened for reading, so that it can also be locked on a disk that can no longer be written.
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
