// How much the jobs and the uploads under way take up, and how much they may.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "device/core/problem.h"

namespace axisgate::server::spool {

inline constexpr std::int64_t kMebibyte = 1 << 20;

struct Bounds {
  std::int64_t bytes = 256 * kMebibyte;              // of all jobs
  std::int64_t bytes_of_one = 64 * kMebibyte;        // of one job
  std::int64_t bytes_of_identity = 128 * kMebibyte;  // of all jobs of one identity
  std::size_t jobs = 200;
  std::size_t jobs_of_identity = 100;
  std::chrono::days kept{30};  // after the end of a job
};

class Place;

// Thread safe. Outlives its places.
class Room {
 public:
  explicit Room(const Bounds& bounds) : bounds_(bounds) {}

  // For a job without bytes yet. queue_full, where there are as many as may be, or as one identity may have.
  Result<std::unique_ptr<Place>> take(std::string identity);
  // Whether a job of the greatest size may not fit: beside all jobs, or beside those of the identity.
  bool is_short();
  bool is_short_for(const std::string& identity);
  // For a job that is there already, also beyond the bounds.
  std::unique_ptr<Place> hold(std::string identity, std::int64_t bytes);

 private:
  friend class Place;
  struct Taken {
    std::size_t jobs = 0;
    std::int64_t bytes = 0;
  };

  Result<void> check(const Place& place, std::int64_t more) const;  // under mutex_
  // Likewise; both may be negative.
  void add(const std::string& identity, int jobs, std::int64_t bytes);

  const Bounds bounds_;
  std::mutex mutex_;
  Taken all_;
  std::map<std::string, Taken> by_identity_;  // who has none is not in it
};

// What one job takes up, for as long as this lives. Used by one thread at a time.
class Place {
 public:
  ~Place();
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  // out_of_range beyond what one job may have; queue_full beyond what all of an identity, or all, may. Then it is as
  // large as before.
  Result<void> grow(std::int64_t bytes);

 private:
  friend class Room;
  Place(Room& room, std::string identity, std::int64_t bytes);

  Room& room_;
  const std::string identity_;
  std::int64_t bytes_;
};

}  // namespace axisgate::server::spool
