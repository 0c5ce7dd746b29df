// Space that jobs and uploads in progress take up, and its bounds.
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
  std::size_t jobs_reserved = 50;  // last places, for identities without a waiting job
  std::chrono::days kept{30};      // time after the end of a job
};

class Place;

// Thread safe. Must outlive its places.
class Room {
 public:
  explicit Room(const Bounds& bounds) : bounds_(bounds) {}

  // Takes a place for a job without bytes yet. Fails with queue_full if the number of all jobs, or of the identity's
  // jobs, is at its bound; also if only places of Bounds::jobs_reserved are left and a job of the identity waits.
  Result<std::unique_ptr<Place>> take(std::string identity);
  // Reports whether a job of the greatest size may not fit: into the bounds of all jobs, or into those of the identity.
  bool is_short();
  bool is_short_for(const std::string& identity);
  // Takes a place for an existing job, even beyond the bounds.
  std::unique_ptr<Place> hold(std::string identity, std::int64_t bytes, bool has_ended);

 private:
  friend class Place;
  struct Taken {
    std::size_t jobs = 0;
    std::size_t waiting = 0;  // uploads, and jobs that have not ended
    std::int64_t bytes = 0;

    void add(const Taken& more);
    void take_off(const Taken& less);
  };

  // Called under mutex_, like the functions below.
  Result<void> check_count(const std::string& identity) const;
  Result<void> check(const Place& place, std::int64_t more) const;
  Taken of(const std::string& identity) const;
  void add(const std::string& identity, const Taken& more);
  void take_off(const std::string& identity, const Taken& less);

  const Bounds bounds_;
  std::mutex mutex_;
  Taken all_;
  std::map<std::string, Taken> by_identity_;  // without identities that have no job
};

// A Place is the space of one job, taken up as long as the Place exists. Used by one thread at a time.
class Place {
 public:
  ~Place();
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  // Adds bytes. Fails with out_of_range beyond the bound of one job, and with queue_full beyond the bound of the
  // identity or of all jobs; the size is then unchanged.
  Result<void> grow(std::int64_t bytes);
  // Notes that the job has ended and no longer waits. Further calls have no effect.
  void end();

 private:
  friend class Room;
  Place(Room& room, std::string identity, const Room::Taken& taken);

  Room& room_;
  const std::string identity_;
  Room::Taken taken_;  // of this one job
};

}  // namespace axisgate::server::spool
