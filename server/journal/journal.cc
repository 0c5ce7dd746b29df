#include "server/journal/journal.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <filesystem>
#include <utility>

#include "device/link/clock.h"
#include "server/explain.h"

namespace axisgate::server::journal {
namespace {

constexpr auto kRetry = std::chrono::seconds(1);
constexpr auto kCatchingUp = std::chrono::seconds(1);  // a disk that hangs keeps no reader longer

Entry left_out(std::uint64_t count) {
  return {.kind = EntryKind::entries_left_out,
          .time = std::chrono::system_clock::now(),
          .boot_time = monotonic_now(),
          .body = fmt::format(R"({{"count":{}}})", count)};
}

// SQLite's own files beside it are worth nothing without it.
Result<void> move_aside(const std::string& path) {
  const auto stamp = std::chrono::system_clock::now().time_since_epoch() / std::chrono::seconds(1);
  const std::string kept = fmt::format("{}.damaged-{}", path, stamp);
  std::error_code error;
  for (const char* suffix : {"", "-wal", "-shm"}) {
    std::filesystem::rename(path + suffix, kept + suffix, error);
    if (error && *suffix == '\0') {
      return fail(Reason::internal,
                  fmt::format("journal {}: damaged, and it cannot be moved aside: {}", path, error.message()));
    }
  }
  spdlog::error("journal {}: it is damaged, and was moved to {}; a new one begins", path, kept);
  return {};
}

}  // namespace

Result<std::unique_ptr<Journal>> Journal::open(const std::string& path) {
  auto store = Store::open(path);
  if (!store && store.error().damaged) {
    if (auto moved = move_aside(path); !moved) return tl::unexpected(moved.error());
    store = Store::open(path);
  }
  if (!store) return tl::unexpected(store.error().problem);
  return std::unique_ptr<Journal>(new Journal(path, *std::move(store)));
}

Journal::Journal(std::string path, Store store) : path_(std::move(path)), store_(std::move(store)) {
  thread_ = std::thread([this] { run(); });
}

Journal::~Journal() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Journal::append(Entry entry) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= kWaitingMax) {
      ++left_out_;
      return;
    }
    waiting_.push_back(std::move(entry));
  }
  changed_.notify_all();
}

std::optional<Problem> Journal::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

void Journal::run() {
  while (true) {
    const std::vector<Entry> entries = wait_for_entries();
    if (entries.empty() || !write(entries)) return;
  }
}

// Nothing: the daemon ends, and all is written.
std::vector<Entry> Journal::wait_for_entries() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
  auto entries = std::exchange(waiting_, {});
  writing_ = !entries.empty();
  if (const auto count = std::exchange(left_out_, 0); count > 0) entries.push_back(left_out(count));
  return entries;
}

bool Journal::write(const std::vector<Entry>& entries) {
  while (true) {
    const Result<void> written = store_.append(entries);
    std::unique_lock lock(mutex_);
    if (written) {
      if (failure_) spdlog::info("journal {}: it is written again", path_);
      failure_.reset();
      writing_ = false;
      changed_.notify_all();
      return true;
    }
    if (!failure_) spdlog::error("{}", explain(written.error()));
    failure_ = written.error();
    changed_.notify_all();
    if (changed_.wait_for(lock, kRetry, [this] { return ending_; })) return false;
  }
}

Result<Store> Journal::reader() const {
  {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kCatchingUp, [this] { return failure_ || (waiting_.empty() && !writing_); });
  }
  return Store::open_to_read(path_);
}

Result<std::vector<StoredEntry>> Journal::read(const Filter& filter, std::size_t limit) const {
  return reader().and_then([&](Store store) { return store.read(filter, limit); });
}

Result<std::uint64_t> Journal::last_motion(std::string_view device) const {
  return reader().and_then([&](Store store) { return store.last_motion(device); });
}

Result<Verdict> Journal::verify(const std::optional<Head>& noted) const {
  return reader().and_then([&](Store store) { return store.verify(noted); });
}

Result<Head> Journal::head() const {
  return reader().and_then([](Store store) { return store.head(); });
}

}  // namespace axisgate::server::journal
