#include "server/access/writers.h"

#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <utility>

namespace axisgate::server {
namespace {

tl::unexpected<Problem> refuse(const std::string& who, std::string command) {
  return fail(Reason::invalid_request, fmt::format("{}, who could change what the daemon does", who),
              std::move(command));
}

std::string close_to_others(const std::string& path) { return fmt::format("chmod go-w {}", path); }

Result<void> check_everybody(const std::string& path, const struct stat& status) {
  if ((status.st_mode & S_IWOTH) == 0) return {};
  return refuse("may be written by everybody on this machine", close_to_others(path));
}

Result<void> check_group(const std::string& path, const struct stat& status) {
  // Debian gives each user a group of their own, and lets this group write the user's files (umask 002). So the
  // daemon's own group counts as its user. Other members of the group are its administrator's decision.
  if ((status.st_mode & S_IWGRP) == 0 || status.st_gid == ::getegid()) return {};
  return refuse(fmt::format("may be written by the members of the group {}", status.st_gid), close_to_others(path));
}

Result<void> check_owner(const std::string& path, const struct stat& status) {
  const uid_t own = ::geteuid();
  if (status.st_uid == 0 || status.st_uid == own) return {};
  return refuse(fmt::format("belongs to the user {} (the daemon runs as {})", status.st_uid, own),
                fmt::format("chown {} {}", own, path));
}

bool mounted_read_only(const std::string& path) {
  struct statvfs system {};
  return ::statvfs(path.c_str(), &system) == 0 && (system.f_flag & ST_RDONLY) != 0;
}

}  // namespace

Result<void> check_writers(const std::string& path, const struct stat& status) {
  for (const auto check : {check_everybody, check_group, check_owner}) {
    if (Result<void> checked = check(path, status); !checked) return checked;
  }
  return {};
}

Result<void> check_writers(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return mounted_read_only(path) ? check_everybody(path, status) : check_writers(path, status);
}

}  // namespace axisgate::server
