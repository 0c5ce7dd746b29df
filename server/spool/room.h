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
  std::size_t jobs_of_identity = 50;
  std::size_t jobs_reserved = 50;  // the last places, for those who have no job that waits
  std::chrono::days kept{30};      // after the end of a job
};

class Place;

// Thread safe. Outlives its places.
class Room {
 public:
  explicit Room(const Bounds& bounds) : bounds_(bounds) {}

  // For a job without bytes yet. queue_full, where there are as many as may be, or as one identity may have; also where
  // only places of Bounds::jobs_reserved are left and a job of the identity waits.
  Result<std::unique_ptr<Place>> take(std::string identity);
  // Whether a job of the greatest size may not fit: beside all jobs, or beside those of the identity.
  bool is_short();
  bool is_short_for(const std::string& identity);
  // For a job that is there already, also beyond the bounds.
  std::unique_ptr<Place> hold(std::string identity, std::int64_t bytes, bool has_ended);

 private:
  friend class Place;
  struct Taken {
    std::size_t jobs = 0;
    std::size_t waiting = 0;  // of them: uploads, and jobs that have not ended
    std::int64_t bytes = 0;

    void add(const Taken& more);
    void take_off(const Taken& less);
  };

  // Under mutex_, as those below.
  Result<void> check_count(const std::string& identity) const;
  Result<void> check(const Place& place, std::int64_t more) const;
  Taken of(const std::string& identity) const;
  void add(const std::string& identity, const Taken& more);
  void take_off(const std::string& identity, const Taken& less);

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
  // The job has ended: it waits no longer. Again: nothing.
  void end();

 private:
  friend class Room;
  Place(Room& room, std::string identity, const Room::Taken& taken);

  Room& room_;
  const std::string identity_;
  Room::Taken taken_;  // of this one job
};

}  // namespace axisgate::server::spool
