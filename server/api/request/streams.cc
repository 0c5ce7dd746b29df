#include "server/api/request/streams.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "server/api/request/ending.h"

namespace axisgate::api {
void OpenStream::on_cut_off(std::function<void()> then) {
  {
    const std::lock_guard lock(mutex_);
    if (!cut_) {
      then_ = std::move(then);
      return;
    }
  }
  then();
}

std::optional<StreamCut> OpenStream::cut_off() const {
  const std::lock_guard lock(mutex_);
  return cut_ ? std::optional(*cut_) : std::nullopt;
}

void OpenStream::cut_off(StreamCut cut) {
  std::function<void()> then;
  {
    const std::lock_guard lock(mutex_);
    if (cut_) return;
    cut_ = std::make_unique<const StreamCut>(std::move(cut));
    then = std::exchange(then_, nullptr);
  }
  if (then) then();
}

// Called under the lock.
std::optional<Problem> Streams::full(Quota quota, const std::string& who) const {
  const Counts& all = open_->all;
  const auto refused = [](std::string message) {
    return Problem{.reason = Reason::queue_full,
                   .message = std::move(message),
                   .hint = "close streams that nobody reads, and ask again in 1 s"};
  };
  if (quota == Quota::path) {
    const auto own = open_->paths_by_caller.find(who);
    if (own != open_->paths_by_caller.end() && own->second >= limits_.paths_of_one) {
      return refused(fmt::format("{} has {} paths open, and one caller may have no more", who, own->second));
    }
    if (all.paths >= limits_.paths) return refused(fmt::format("{} paths are open, and no more are served", all.paths));
  }
  if (all.streams >= limits_.streams) {
    return refused(fmt::format("{} streams are open, and no more are served", all.streams));
  }
  if (quota != Quota::motion_stream && all.streams - all.outcomes >= limits_.streams - limits_.outcomes_kept) {
    return refused(fmt::format("{} streams are open, and the last {} are for those that follow one motion",
                               all.streams - all.outcomes, limits_.outcomes_kept));
  }
  return std::nullopt;
}

void Streams::count(Open& open, Quota quota, const std::string& who, int one) {
  open.all.streams += one;
  if (quota == Quota::motion_stream) open.all.outcomes += one;
  if (quota != Quota::path) return;
  open.all.paths += one;
  const auto own = open.paths_by_caller.try_emplace(who).first;
  own->second += one;
  if (own->second == 0) open.paths_by_caller.erase(own);
}

Result<Streams::Place> Streams::take(RequestKind kind, const std::string& who) {
  const Quota quota = rule_of(kind).quota;
  const std::lock_guard lock(open_->mutex);
  if (open_->ended) return tl::unexpected(daemon_ending());
  if (auto problem = full(quota, who)) return tl::unexpected(*std::move(problem));
  count(*open_, quota, who, 1);
  const Entry entry = open_->by_caller.emplace(who, std::weak_ptr<OpenStream>());
  const auto give_back = [open = open_, quota, entry](OpenStream* stream) {
    {
      const std::lock_guard its_lock(open->mutex);
      count(*open, quota, entry->first, -1);
      open->by_caller.erase(entry);
    }
    delete stream;
  };
  const Place place(new OpenStream, give_back);
  entry->second = place;
  return place;
}

void Streams::cut_off(const std::string& who, const Problem& why) {
  std::vector<Place> theirs;
  {
    const std::lock_guard lock(open_->mutex);
    const auto [begin, end] = open_->by_caller.equal_range(who);
    theirs = places(begin, end);
  }
  for (const Place& place : theirs) place->cut_off({why});
}

void Streams::end_all() {
  std::vector<Place> all;
  {
    const std::lock_guard lock(open_->mutex);
    open_->ended = true;
    all = places(open_->by_caller.begin(), open_->by_caller.end());
  }
  for (const Place& place : all) place->cut_off({daemon_ending(), true});
}

std::optional<Problem> Streams::ending() const {
  const std::lock_guard lock(open_->mutex);
  return open_->ended ? std::optional(daemon_ending()) : std::nullopt;
}

std::vector<Streams::Place> Streams::places(Entry begin, Entry end) {
  std::vector<Place> places;
  for (auto one = begin; one != end; ++one) {
    if (Place place = one->second.lock()) places.push_back(std::move(place));
  }
  return places;
}

}  // namespace axisgate::api
