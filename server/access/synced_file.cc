#include "server/access/synced_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "server/access/writers.h"

namespace axisgate::server {
namespace {

constexpr mode_t kMode = 0600;

tl::unexpected<Problem> failed(std::string_view what, const std::string& path, int error, std::string hint) {
  return fail(Reason::internal, fmt::format("cannot {} {}: {}", what, path, std::generic_category().message(error)),
              std::move(hint));
}

std::string_view kind_of(mode_t mode) {
  if (S_ISLNK(mode)) return "a symbolic link";
  if (S_ISDIR(mode)) return "a directory";
  return S_ISFIFO(mode) ? "a FIFO" : "a device or a socket";
}

tl::unexpected<Problem> no_regular_file(const std::string& path, mode_t mode) {
  return fail(Reason::internal, fmt::format("{} is {}, not a regular file", path, kind_of(mode)),
              "move it away: the daemon makes this file itself");
}

// Explains an error of open(), which has one error for several kinds of files, and several errors for one kind.
Result<Descriptor> explain_failed_open(const std::string& path, int error) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) == 0) {
    if (!S_ISREG(status.st_mode)) return no_regular_file(path, status.st_mode);
  } else if (errno == ENOENT) {
    return Descriptor();
  }
  return failed("open", path, error, "let the daemon's user read and write it");
}

bool write_synced(const std::string& path, const std::string& text) {
  // Replaces a file that an earlier run, or another program, left there. Such a file is never written to.
  ::unlink(path.c_str());
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kMode));
  if (!file.valid()) return false;
  if (!write_all(file.get(), text) || ::fsync(file.get()) != 0) return false;
  return ::close(file.release()) == 0;
}

}  // namespace

void make_state_directory(const std::string& path) {
  std::filesystem::path directory = path;
  if (!directory.has_filename()) directory = directory.parent_path();  // "state/"
  std::error_code ignored;
  std::filesystem::create_directories(directory.parent_path(), ignored);
  ::mkdir(directory.c_str(), 0700);
}

Result<Descriptor> open_state_file(const std::string& path, int flags) {
  // O_NONBLOCK: otherwise, opening a FIFO would wait for a process at its other end.
  Descriptor file(::open(path.c_str(), flags | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, kMode));
  if (!file.valid()) return explain_failed_open(path, errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return failed("look at", path, errno, "check the disk");
  if (!S_ISREG(status.st_mode)) return no_regular_file(path, status.st_mode);
  if (const Result<void> checked = check_writers(path, status); !checked) {
    return fail(Reason::internal, fmt::format("{} {}", path, checked.error().message), checked.error().hint);
  }
  return file;
}

Result<void> read_pieces(int file, const std::string& path, const std::function<void(std::string_view)>& take) {
  std::array<char, 1 << 15> piece{};
  while (true) {
    const ssize_t count = ::read(file, piece.data(), piece.size());
    if (count == 0) return {};
    if (count > 0) {
      take({piece.data(), static_cast<std::size_t>(count)});
    } else if (errno != EINTR) {
      return failed("read", path, errno, "check the disk: the file is left as it is");
    }
  }
}

Result<std::string> read_state_file(const std::string& path) {
  const Result<Descriptor> file = open_state_file(path, O_RDONLY);
  if (!file) return tl::unexpected(file.error());
  std::string text;
  if (!file->valid()) return text;
  const Result<void> whole = read_pieces(file->get(), path, [&text](std::string_view piece) { text += piece; });
  if (!whole) return tl::unexpected(whole.error());
  return text;
}

bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0 && errno != EINTR) return false;
    bytes.remove_prefix(count < 0 ? 0 : static_cast<std::size_t>(count));
  }
  return true;
}

tl::unexpected<Problem> cannot_write(const std::string& path) {
  const int error = errno;
  const bool full = error == ENOSPC || error == EDQUOT;
  return failed("write", path, error, full ? "free space on its disk" : "let the daemon's user write there");
}

Result<void> sync_directory(const std::string& path) {
  const Descriptor directory(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!directory.valid() || ::fsync(directory.get()) != 0) return cannot_write(path);
  return {};
}

Result<void> replace_synced(const std::string& path, const std::string& text) {
  const std::string directory = std::filesystem::path(path).parent_path().string(), fresh = path + ".new";
  make_state_directory(directory);
  if (!write_synced(fresh, text)) return cannot_write(fresh);
  if (::rename(fresh.c_str(), path.c_str()) != 0) return cannot_write(path);
  return sync_directory(directory);
}

}  // namespace axisgate::server
