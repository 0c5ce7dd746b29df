#include "server/spool/room.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace axisgate::server::spool {
namespace {

constexpr std::string_view kMakeRoom =
    "wait until jobs have ended, or take some out of the queue: `CancelJob`; an administrator clears the "
    "jobs of one caller: `CancelJobs`";

std::string size_text(std::int64_t bytes) {
  return bytes % kMebibyte == 0 ? fmt::format("{} MiB", bytes / kMebibyte) : fmt::format("{} bytes", bytes);
}

}  // namespace

void Room::Taken::add(const Taken& more) {
  jobs += more.jobs;
  waiting += more.waiting;
  bytes += more.bytes;
}

void Room::Taken::take_off(const Taken& less) {
  jobs -= less.jobs;
  waiting -= less.waiting;
  bytes -= less.bytes;
}

Room::Taken Room::of(const std::string& identity) const {
  const auto found = by_identity_.find(identity);
  return found == by_identity_.end() ? Taken() : found->second;
}

Result<void> Room::check_count(const std::string& identity) const {
  const auto full = [](std::string message) {
    return fail(Reason::queue_full, std::move(message), std::string(kMakeRoom));
  };
  if (all_.jobs >= bounds_.jobs) return full(fmt::format("all {} places of the queue are taken", bounds_.jobs));
  const std::size_t own = of(identity).waiting;
  if (own >= bounds_.jobs_of_identity) {
    return full(fmt::format("{} jobs of {} are in the queue, the most for one caller", own, identity));
  }
  if (own == 0 || all_.waiting + bounds_.jobs_reserved < bounds_.jobs) return {};
  return full(
      fmt::format("{} of the {} places of the queue are taken, {} of them by jobs of {}; the last {} are for "
                  "callers without a job in it",
                  all_.waiting, bounds_.jobs, own, identity, bounds_.jobs_reserved));
}

Result<std::unique_ptr<Place>> Room::take(std::string identity) {
  const std::lock_guard lock(mutex_);
  if (const Result<void> checked = check_count(identity); !checked) return tl::unexpected(checked.error());
  return std::unique_ptr<Place>(new Place(*this, std::move(identity), {.jobs = 1, .waiting = 1}));
}

bool Room::is_short() {
  const std::lock_guard lock(mutex_);
  return all_.jobs >= bounds_.jobs || all_.bytes + bounds_.bytes_of_one > bounds_.bytes;
}

bool Room::is_short_for(const std::string& identity) {
  const std::lock_guard lock(mutex_);
  const Taken own = of(identity);
  return own.jobs >= bounds_.jobs_of_identity ||
         (own.jobs > 0 && own.bytes + bounds_.bytes_of_one > bounds_.bytes_of_identity);
}

std::unique_ptr<Place> Room::hold(std::string identity, std::int64_t bytes, bool has_ended) {
  const std::lock_guard lock(mutex_);
  const Taken taken{.jobs = 1, .waiting = has_ended ? 0u : 1u, .bytes = bytes};
  return std::unique_ptr<Place>(new Place(*this, std::move(identity), taken));
}

Result<void> Room::check(const Place& place, std::int64_t more) const {
  if (place.taken_.bytes + more > bounds_.bytes_of_one) {
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

void Room::add(const std::string& identity, const Taken& more) {
  all_.add(more);
  by_identity_[identity].add(more);
}

void Room::take_off(const std::string& identity, const Taken& less) {
  all_.take_off(less);
  Taken& own = by_identity_.at(identity);
  own.take_off(less);
  if (own.jobs == 0) by_identity_.erase(identity);
}

Place::Place(Room& room, std::string identity, const Room::Taken& taken)
    : room_(room), identity_(std::move(identity)), taken_(taken) {
  room_.add(identity_, taken_);
}

Place::~Place() {
  const std::lock_guard lock(room_.mutex_);
  room_.take_off(identity_, taken_);
}

Result<void> Place::grow(std::int64_t bytes) {
  const std::lock_guard lock(room_.mutex_);
  if (Result<void> checked = room_.check(*this, bytes); !checked) return checked;
  taken_.bytes += bytes;
  room_.add(identity_, {.bytes = bytes});
  return {};
}

void Place::end() {
  const std::lock_guard lock(room_.mutex_);
  room_.take_off(identity_, {.waiting = std::exchange(taken_.waiting, 0)});
}

}  // namespace axisgate::server::spool
