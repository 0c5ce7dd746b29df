#include "tests/simulation/daemon.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <future>
#include <stdexcept>
#include <utility>

#include "server/access/access.h"
#include "server/devices/after_crash.h"
#include "server/journal/answers.h"

namespace axisgate::simulation {
namespace {

using server::journal::Entry;
using server::journal::EntryKind;
using server::journal::Journal;
using server::journal::MemoryBounds;
using server::journal::RequestChange;
using server::journal::RequestMemory;
using stage::MotionId;

constexpr const char* kBoot = "one boot for all runs";
constexpr const char* kMemoryDisk = "/dev/shm";
// Only these two files of the last run are kept: SQLite rebuilds the index of the WAL.
constexpr const char* kJournalFiles[] = {"", "-wal"};
constexpr const char* kKept = ".kept";

std::string made_folder() {
  const auto parent = std::filesystem::is_directory(kMemoryDisk) ? kMemoryDisk : std::filesystem::temp_directory_path();
  std::string name = parent / "axisgate-daemon-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
  return name;
}

Entry entry_of(EntryKind kind, TimePoint now) {
  return {.kind = kind, .time = server::to_wall(now), .boot_time = now, .device = kDevice, .body = "{}"};
}

}  // namespace

StateFolder::StateFolder() : path_(made_folder()) {}

StateFolder::~StateFolder() { std::filesystem::remove_all(path_); }

void StateFolder::keep_journal() const {
  for (const char* file : kJournalFiles) {
    std::filesystem::copy_file(journal() + file, journal() + file + kKept,
                               std::filesystem::copy_options::overwrite_existing);
  }
}

void StateFolder::put_journal_back() const {
  for (const char* file : kJournalFiles) std::filesystem::rename(journal() + file + kKept, journal() + file);
}

Daemon::Daemon(const StateFolder& folder, const MemoryBounds& bounds, std::uint32_t generation)
    : folder_(folder),
      tokens_(generation),
      journal_(Journal::open(folder.journal(), kBoot).value()),
      requests_(bounds, journal_->epoch(), Duration::zero(), journal_->take_requests()),
      record_(server::MotionRecord::open(folder.motions(), kBoot).value()),
      stops_(server::StopRecord::open(folder.stops()).value()),
      entries_(kDevice, journal_.get(), requests_) {}

void Daemon::prepare(stage::StageController& controller, TimePoint now) {
  stage::Inheritance left = stops_->before();
  left.unfinished = record_->unfinished();
  controller.inherit(left, now);
  controller.number_motions_after(std::max(journal_->last_motion(kDevice).value(), record_->last_motion()));
  server::EventBus nobody_watches([](std::function<void()>) {});
  server::settle_what_was_left(journal_.get(), requests_, nobody_watches,
                               [this](std::string_view) { return record_->started_before(); });
  journal_->append({entry_of(EntryKind::daemon_started, {})});
}

void Daemon::on_event(const stage::Event& event, TimePoint now) {
  record_->on_event(event);
  stops_->on_event(event);
  entries_.on_event(event, now);
}

void Daemon::let_disk_hang() {
  (void)journal_->head();  // waits until everything is written
  folder_.keep_journal();
  disk_hangs_ = true;
}

Mutation::Mutation(Daemon& daemon, RequestChange begun)
    : daemon_(daemon), begun_(std::move(begun)), key_{begun_.request.identity, begun_.request.id} {}

Result<void> Mutation::intend(TimePoint now) {
  if (daemon_.disk_hangs()) return fail(Reason::journal_unavailable, "the journal's disk does not answer");
  std::promise<Result<void>> written;
  daemon_.journal().commit({entry_of(EntryKind::request_made, now), begun_},
                           [&written](Result<void> result) { written.set_value(std::move(result)); });
  return written.get_future().get();
}

void Mutation::acted(std::optional<std::string> answer) {
  if (answer) write(EntryKind::request_ended, daemon_.requests().ended(key_, *std::move(answer)));
  daemon_.requests().acted(key_);
}

bool Mutation::failed(const Problem& problem) {
  if (server::journal::is_refusal(problem.reason) || begun_.request.moves) {
    if (auto change = daemon_.requests().refused(key_, problem)) {
      write(EntryKind::request_refused, std::move(change));
      return true;
    }
    daemon_.requests().acted(key_);
  } else {
    acted(server::journal::answer_of(problem));
  }
  return false;
}

void Mutation::write(EntryKind kind, std::optional<RequestChange> change) {
  daemon_.journal().append({entry_of(kind, {}), std::move(change).value_or(RequestChange{})});
}

}  // namespace axisgate::simulation
