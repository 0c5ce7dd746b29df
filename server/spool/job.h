// A job that is kept on disk, and its record.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace axisgate::server::spool {

// A NewJob describes a job before its first byte.
struct NewJob {
  std::string name{};      // as job_name() accepts it
  std::string who{};       // caller, for people
  std::string identity{};  // identity whose bounds the job counts towards
  std::string facts{};     // see Job::facts
  std::chrono::sys_seconds created{};
};

struct Job {
  std::uint64_t id = 0;  // from 1, separately for each device; never assigned twice
  std::string name{};    // as job_name() returns it
  std::string who{}, identity{};
  std::int64_t bytes = 0;
  std::string sha256{};  // of the bytes, 64 hexadecimal digits
  std::chrono::sys_seconds created{};
  std::optional<std::chrono::sys_seconds> ended{};
  std::string facts{};  // UTF-8 text of the code that stores jobs here; the spool does not read it

  friend bool operator==(const Job&, const Job&) = default;
};

}  // namespace axisgate::server::spool
