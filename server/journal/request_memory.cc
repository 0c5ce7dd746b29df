#include "server/journal/request_memory.h"

#include <fmt/format.h>

#include <charconv>

namespace axisgate::server::journal {

RequestMemory::RequestMemory(MemoryBounds bounds, std::string epoch, Duration boot_offset, RequestsOnFile before)
    : bounds_(bounds),
      epoch_(std::move(epoch)),
      boot_offset_(boot_offset),
      last_(before.forgotten),
      forgotten_(before.forgotten) {
  for (RememberedRequest& request : before.requests) {
    const Key key{request.identity, request.id};
    last_ = std::max(last_, request.number);
    by_number_[request.number] = key;
    requests_[key] = {std::move(request), true, {}};
  }
}

Result<std::optional<RequestChange>> RequestMemory::begin(RememberedRequest request, std::string_view mark,
                                                          TimePoint now, OnKnown known) {
  std::optional<Known> answer;
  {
    const std::lock_guard lock(mutex_);
    const Duration lived = now.time_since_epoch() + boot_offset_;
    const std::int64_t forgotten = forget_old(lived);
    const Key key{request.identity, request.id};
    const auto found = requests_.find(key);
    if (found == requests_.end()) {
      if (const auto good = check_mark(mark); !good) return tl::unexpected(good.error());
      request.number = ++last_;
      request.lived = lived;
      by_number_[request.number] = key;
      requests_[key] = {request, false, {}};
      return RequestChange{std::move(request), false, forgotten};
    }
    if (found->second.request.digest != request.digest) {
      return fail(Reason::request_id_reused, fmt::format("the request_id {} was used for another request", request.id),
                  "give each request an id of its own");
    }
    if (!found->second.acted) {
      found->second.waiting.push_back(std::move(known));
      return std::nullopt;
    }
    answer = known_of(found->second.request);
  }
  known(*std::move(answer));
  return std::nullopt;
}

Result<void> RequestMemory::check_mark(std::string_view mark) const {
  if (mark.empty()) return {};
  const std::size_t dash = mark.rfind('-');
  std::int64_t number = -1;
  if (dash != std::string_view::npos) std::from_chars(mark.data() + dash + 1, mark.data() + mark.size(), number);
  if (mark.substr(0, dash) == epoch_ && number >= forgotten_) return {};
  return fail(Reason::request_memory_lost,
              "whether this request has come before is not known: the memory of request ids was lost in between",
              "look at the stage and at its history (`ListHistory`), then request it with a new id");
}

// Forgets old requests that have ended, oldest first, up to the first that must be kept. Returns the number up to which
// all requests are forgotten; 0 if nothing was forgotten.
std::int64_t RequestMemory::forget_old(Duration lived) {
  const std::int64_t before = forgotten_;
  while (!by_number_.empty()) {
    const auto oldest = requests_.find(by_number_.begin()->second);
    const RememberedRequest& request = oldest->second.request;
    const bool old = lived - request.lived > bounds_.kept || requests_.size() > bounds_.most;
    if (!old || request.open || !oldest->second.acted) break;
    forgotten_ = request.number;
    requests_.erase(oldest);
    by_number_.erase(by_number_.begin());
  }
  return forgotten_ == before ? 0 : forgotten_;
}

RequestMemory::Remembered* RequestMemory::find_open(const Key& key) {
  const auto found = requests_.find(key);
  return found == requests_.end() || !found->second.request.open ? nullptr : &found->second;
}

void RequestMemory::acted(const Key& key) {
  std::vector<OnKnown> waiting;
  Known answer;
  {
    const std::lock_guard lock(mutex_);
    const auto found = requests_.find(key);
    if (found == requests_.end()) return;
    found->second.acted = true;
    waiting = std::exchange(found->second.waiting, {});
    answer = known_of(found->second.request);
  }
  for (const OnKnown& known : waiting) known(answer);
}

std::optional<RequestChange> RequestMemory::made(const Key& key, std::uint64_t motion, std::string answer) {
  const std::lock_guard lock(mutex_);
  Remembered* const found = find_open(key);
  if (found == nullptr || !found->request.moves || found->request.motion != 0) return std::nullopt;
  found->request.motion = motion;
  found->request.answer = std::move(answer);
  return RequestChange{found->request, false, 0};
}

std::optional<RequestChange> RequestMemory::motion_ended(const Key& key, std::uint64_t motion, std::string answer) {
  const std::lock_guard lock(mutex_);
  Remembered* const found = find_open(key);
  if (found == nullptr || found->request.motion != motion) return std::nullopt;
  return ended(*found, std::move(answer));
}

std::optional<RequestChange> RequestMemory::ended(const Key& key, std::string answer) {
  const std::lock_guard lock(mutex_);
  Remembered* const found = find_open(key);
  return found == nullptr ? std::nullopt : std::optional(ended(*found, std::move(answer)));
}

RequestChange RequestMemory::ended(Remembered& remembered, std::string answer) {
  remembered.request.open = false;
  remembered.request.answer = std::move(answer);
  return {remembered.request, false, 0};
}

std::optional<RequestChange> RequestMemory::refused(const Key& key, const Problem& why) {
  std::vector<OnKnown> waiting;
  RequestChange change;
  {
    const std::lock_guard lock(mutex_);
    const Remembered* const found = find_open(key);
    if (found == nullptr) return std::nullopt;
    change = {found->request, true, 0};
    waiting = found->waiting;
    by_number_.erase(found->request.number);
    requests_.erase(key);
  }
  for (const OnKnown& known : waiting) known(tl::unexpected(why));
  return change;
}

std::string RequestMemory::mark() const {
  const std::lock_guard lock(mutex_);
  return fmt::format("{}-{}", epoch_, last_);
}

std::vector<RememberedRequest> RequestMemory::open() const {
  const std::lock_guard lock(mutex_);
  std::vector<RememberedRequest> all;
  for (const auto& [key, one] : requests_) {
    if (one.request.open) all.push_back(one.request);
  }
  return all;
}

}  // namespace axisgate::server::journal
