#include "clients/axisctl/mill/job_file.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/upload_steps.h"

namespace axisgate::axisctl {
namespace {

Failure cannot_read(const std::string& name) {
  return usage(fmt::format("{} cannot be read: {}", name, std::strerror(errno)), "name the file of a job");
}

void check_size(const std::string& name, std::int64_t bytes, std::int64_t most) {
  if (most == 0 || bytes <= most) return;
  throw usage(fmt::format("{} has {} bytes, and jobs of this mill have at most {}", name, bytes, most),
              "divide it into several jobs; `megabytes_each` in the configuration of the daemon is the limit");
}

}  // namespace

void check_job_file(const std::string& name) {
  if (name == "-") return;
  struct stat found {};
  if (::stat(name.c_str(), &found) != 0) throw cannot_read(name);
  if (!S_ISREG(found.st_mode))
    throw usage(name + " is no regular file", "name the file of a job, or - for the standard input");
}

std::int64_t read_job_file(const std::string& name, std::int64_t most,
                           const std::function<void(std::string_view)>& take) {
  check_job_file(name);
  const auto close = [](std::FILE* file) { return file == stdin ? 0 : std::fclose(file); };
  errno = 0;
  const std::unique_ptr<std::FILE, decltype(close)> file(name == "-" ? stdin : std::fopen(name.c_str(), "rb"), close);
  if (!file) throw cannot_read(name);
  struct stat before {};
  ::fstat(::fileno(file.get()), &before);
  const bool regular = S_ISREG(before.st_mode);
  if (regular) check_size(name, before.st_size, most);
  const Failure changed = usage(name + " was written to while it was read", "send it when it is complete");
  std::vector<char> piece(kUploadPiece);
  std::int64_t bytes = 0;
  while (const std::size_t count = std::fread(piece.data(), 1, piece.size(), file.get())) {
    bytes += static_cast<std::int64_t>(count);
    if (regular && bytes > before.st_size) throw changed;
    check_size(name, bytes, most);
    take({piece.data(), count});
  }
  if (std::ferror(file.get()) != 0) throw cannot_read(name);
  struct stat after {};
  ::fstat(::fileno(file.get()), &after);
  const bool same = after.st_size == before.st_size && after.st_mtim.tv_sec == before.st_mtim.tv_sec &&
                    after.st_mtim.tv_nsec == before.st_mtim.tv_nsec;
  if (regular && !same) throw changed;
  return bytes;
}

}  // namespace axisgate::axisctl
