// A job that is kept on disk, and what is known of it.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace axisgate::server::spool {

// What is known before the first byte.
struct NewJob {
  std::string name{};      // as job_name() takes it
  std::string who{};       // the caller, as people read it
  std::string identity{};  // whose jobs share the bounds of one identity
  std::string facts{};     // as in Job
  std::chrono::sys_seconds created{};
};

struct Job {
  std::uint64_t id = 0;  // from 1, of one device; never given twice
  std::string name{};    // as job_name() has cleaned it
  std::string who{}, identity{};
  std::int64_t bytes = 0;
  std::string sha256{};  // of the bytes, 64 hexadecimal digits
  std::chrono::sys_seconds created{};
  std::optional<std::chrono::sys_seconds> ended{};
  std::string facts{};  // text of the code that keeps jobs here, UTF-8; the spool does not look into it

  friend bool operator==(const Job&, const Job&) = default;
};

}  // namespace axisgate::server::spool
