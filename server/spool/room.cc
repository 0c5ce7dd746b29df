#include "server/spool/room.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace axisgate::server::spool {
namespace {

constexpr std::string_view kMakeRoom = "remove jobs that are not needed any more";

std::string size_text(std::int64_t bytes) {
  return bytes % kMebibyte == 0 ? fmt::format("{} MiB", bytes / kMebibyte) : fmt::format("{} bytes", bytes);
}

}  // namespace

Result<std::unique_ptr<Place>> Room::take(std::string identity) {
  const std::lock_guard lock(mutex_);
  if (all_.jobs >= bounds_.jobs) {
    return fail(Reason::queue_full, fmt::format("{} jobs are kept already, as many as may be", bounds_.jobs),
                std::string(kMakeRoom));
  }
  if (const auto own = by_identity_.find(identity);
      own != by_identity_.end() && own->second.jobs >= bounds_.jobs_of_identity) {
    return fail(
        Reason::queue_full,
        fmt::format("{} jobs of {} are kept already, as many as may be of one caller", own->second.jobs, identity),
        std::string(kMakeRoom));
  }
  return std::unique_ptr<Place>(new Place(*this, std::move(identity), 0));
}

bool Room::is_short() {
  const std::lock_guard lock(mutex_);
  return all_.jobs >= bounds_.jobs || all_.bytes + bounds_.bytes_of_one > bounds_.bytes;
}

bool Room::is_short_for(const std::string& identity) {
  const std::lock_guard lock(mutex_);
  const auto own = by_identity_.find(identity);
  return own != by_identity_.end() && (own->second.jobs >= bounds_.jobs_of_identity ||
                                       own->second.bytes + bounds_.bytes_of_one > bounds_.bytes_of_identity);
}

std::unique_ptr<Place> Room::hold(std::string identity, std::int64_t bytes) {
  const std::lock_guard lock(mutex_);
  return std::unique_ptr<Place>(new Place(*this, std::move(identity), bytes));
}

Result<void> Room::check(const Place& place, std::int64_t more) const {
  if (place.bytes_ + more > bounds_.bytes_of_one) {
    return fail(Reason::out_of_range,
                fmt::format("the job is larger than {}, the most for one job", size_text(bounds_.bytes_of_one)),
                "divide it into several jobs");
  }
  if (by_identity_.at(place.identity_).bytes + more > bounds_.bytes_of_identity) {
    return fail(Reason::queue_full,
                fmt::format("with it the jobs of {} are larger than {}, the most for one caller", place.identity_,
                            size_text(bounds_.bytes_of_identity)),
                std::string(kMakeRoom));
  }
  if (all_.bytes + more > bounds_.bytes) {
    return fail(Reason::queue_full,
                fmt::format("with it all jobs are larger than {}, the most together", size_text(bounds_.bytes)),
                std::string(kMakeRoom));
  }
  return {};
}

void Room::add(const std::string& identity, int jobs, std::int64_t bytes) {
  Taken& own = by_identity_[identity];
  for (Taken* const taken : {&all_, &own}) {
    taken->jobs += static_cast<std::size_t>(jobs);
    taken->bytes += bytes;
  }
  if (own.jobs == 0) by_identity_.erase(identity);
}

Place::Place(Room& room, std::string identity, std::int64_t bytes)
    : room_(room), identity_(std::move(identity)), bytes_(bytes) {
  room_.add(identity_, 1, bytes_);
}

Place::~Place() {
  const std::lock_guard lock(room_.mutex_);
  room_.add(identity_, -1, -bytes_);
}

Result<void> Place::grow(std::int64_t bytes) {
  const std::lock_guard lock(room_.mutex_);
  if (Result<void> checked = room_.check(*this, bytes); !checked) return checked;
  bytes_ += bytes;
  room_.add(identity_, 0, bytes);
  return {};
}

}  // namespace axisgate::server::spool
