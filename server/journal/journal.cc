#include "server/journal/journal.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <future>
#include <iterator>
#include <memory>
#include <utility>

#include "device/core/explain.h"
#include "device/link/clock.h"
#include "server/limits.h"
#include "server/log.h"

namespace axisgate::server::journal {
namespace {

Entry own_entry(EntryKind kind, std::string body) {
  return {
      .kind = kind, .time = std::chrono::system_clock::now(), .boot_time = monotonic_now(), .body = std::move(body)};
}

Entry left_out(std::uint64_t count) {
  return own_entry(EntryKind::entries_left_out, fmt::format(R"({{"count":{}}})", count));
}

Entry journal_failed() { return own_entry(EntryKind::journal_failed, "{}"); }

// Moves SQLite's own files along, which are useless without the database.
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
  log::error("journal {}: it is damaged, and was moved to {}; a new one begins", path, kept);
  return {};
}

}  // namespace

Result<std::unique_ptr<Journal>> Journal::open(const std::string& path, std::string_view boot,
                                               const StoreBounds& bounds) {
  auto store = Store::open(path);
  if (!store && store.error().damaged) {
    if (auto moved = move_aside(path); !moved) return tl::unexpected(moved.error());
    store = Store::open(path);
  }
  if (!store) return tl::unexpected(store.error().problem);
  return start(path, *std::move(store), boot, bounds);
}

Result<std::unique_ptr<Journal>> Journal::start(std::string path, Store store, std::string_view boot,
                                                const StoreBounds& bounds) {
  auto epoch = store.epoch();
  if (!epoch) return tl::unexpected(epoch.error());
  const auto offset = store.boot_offset(boot, monotonic_now());
  if (!offset) return tl::unexpected(offset.error());
  auto requests = store.requests();
  if (!requests) return tl::unexpected(requests.error());
  const auto unclean = store.ended_uncleanly();
  if (!unclean) return tl::unexpected(unclean.error());
  auto facts = store.begin_facts(*unclean);
  if (!facts) return tl::unexpected(facts.error());
  std::unique_ptr<Journal> journal(new Journal(std::move(path), std::move(store)));
  journal->epoch_ = *std::move(epoch);
  journal->boot_offset_ = *offset;
  journal->bounds_ = bounds;
  journal->requests_ = *std::move(requests);
  journal->facts_ = *std::move(facts);
  journal->after_unclean_end_ = *unclean;
  journal->thread_ = std::thread([&self = *journal] { self.run(); });
  return journal;
}

std::unique_ptr<Journal> Journal::unopened(const std::string& path, const Problem& why) {
  std::unique_ptr<Journal> journal(new Journal(path, std::nullopt));
  const std::string_view first_step = why.hint.empty() ? "look at the file and its disk" : std::string_view(why.hint);
  journal->failure_ = Problem{.reason = Reason::journal_unavailable,
                              .message = fmt::format("the journal could not be opened: {}", why.message),
                              .hint = fmt::format("{}; then restart the daemon", first_step)};
  return journal;
}

Journal::Journal(std::string path, std::optional<Store> store) : path_(std::move(path)), store_(std::move(store)) {}

Journal::~Journal() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Journal::append(Record record) {
  if (!store_) return;
  {
    const std::lock_guard lock(mutex_);
    put(std::move(record));
  }
  changed_.notify_all();
}

void Journal::append_refusal(Entry refusal) {
  if (!store_) return;
  {
    const std::lock_guard lock(mutex_);
    for (Entry& entry : refusals_.add(std::move(refusal), monotonic_now())) put({std::move(entry)});
  }
  changed_.notify_all();
}

void Journal::put(Record record) {
  if (waiting_.size() >= kWaitingMax) {
    ++left_out_;
  } else {
    waiting_.push_back({std::move(record), {}});
  }
}

void Journal::commit(Record record, OnCommitted done) {
  std::optional<Problem> refusal;
  {
    const std::lock_guard lock(mutex_);
    refusal = unavailable();
    if (!refusal) waiting_.push_back({std::move(record), std::move(done)});
  }
  if (refusal) return done(tl::unexpected(*refusal));
  changed_.notify_all();
}

void Journal::keep(FactPointer fact, std::uint64_t oldest) {
  if (!store_) return;
  {
    const std::lock_guard lock(mutex_);
    FactChange& waiting = facts_waiting_;
    waiting.added.push_back(std::move(fact));
    waiting.oldest = oldest;
    while (waiting.added.front()->revision < oldest) waiting.added.pop_front();
  }
  changed_.notify_all();
}

std::optional<Problem> Journal::unavailable() const {
  const bool hangs = writing_since_ && monotonic_now() - *writing_since_ > kCommitHangs;
  if (!failure_ && !hangs && waiting_.size() < kWaitingMax) return std::nullopt;
  return Problem{.reason = Reason::journal_unavailable,
                 .message = failure_ ? failure_->message : fmt::format("the disk of {} does not answer", path_),
                 .hint = fmt::format("nothing was sent; stops work; {}",
                                     store_ ? "look at the disk, the daemon recovers by itself" : failure_->hint)};
}

void Journal::answer_nobody() {
  const std::lock_guard lock(answering_);
  silent_ = true;
}

void Journal::answer(const OnCommitted& done, const Result<void>& written) {
  if (!done) return;
  const std::lock_guard lock(answering_);
  if (!silent_) done(written);
}

std::optional<Problem> Journal::failure() const {
  const std::lock_guard lock(mutex_);
  return unavailable();
}

Duration Journal::last_commit() const {
  const std::lock_guard lock(mutex_);
  const Duration now = writing_since_ ? monotonic_now() - *writing_since_ : Duration::zero();
  return now > kCommitHangs ? now : last_commit_;
}

void Journal::run() {
  while (true) {
    Batch batch = wait_for_records();
    if (batch.empty() || !write(std::move(batch))) return;
    drop_old();
  }
}

// Returns an empty batch if the daemon is ending and everything is written.
Journal::Batch Journal::wait_for_records() {
  std::unique_lock lock(mutex_);
  while (!ending_ && waiting_.empty() && facts_waiting_.added.empty()) wait_or_sum_up_refusals(lock);
  changed_.wait_for(lock, kFactsWait, [this] { return ending_ || !waiting_.empty(); });
  if (ending_) {
    for (Entry& entry : refusals_.rest()) put({std::move(entry)});
  }
  Batch batch{std::exchange(waiting_, {}), std::exchange(facts_waiting_, {})};
  if (const auto count = std::exchange(left_out_, 0); count > 0) batch.records.push_back({{left_out(count)}, {}});
  if (!batch.empty()) writing_since_ = monotonic_now();
  return batch;
}

void Journal::wait_or_sum_up_refusals(std::unique_lock<std::mutex>& lock) {
  if (const auto due = refusals_.next_due()) {
    changed_.wait_for(lock, std::max(*due - monotonic_now(), Duration::zero()));
  } else {
    changed_.wait(lock);
  }
  for (Entry& entry : refusals_.due(monotonic_now())) put({std::move(entry)});
}

// Drops one segment at a time, so that no caller waits long for it. A failure here also occurs in write(), which
// reports it.
void Journal::drop_old() {
  const TimePoint now = monotonic_now();
  if (now < next_drop_) return;
  const Result<bool> dropped = store_->drop_old(bounds_, own_entry(EntryKind::entries_dropped, ""));
  if (!dropped.value_or(false)) next_drop_ = now + kJournalDropPause;
}

bool Journal::write(Batch batch) {
  while (true) {
    std::vector<Record> records;
    for (const Waiting& one : batch.records) records.push_back(one.record);
    const Result<void> written = store_->append(records, batch.facts);
    if (!written) note_failure(batch, written.error());
    std::unique_lock lock(mutex_);
    if (written) {
      if (failure_) log::info("journal {}: it is written again", path_);
      failure_.reset();
      last_commit_ = monotonic_now() - *std::exchange(writing_since_, {});
      lock.unlock();
      const Result<void> emptied = empty_log(batch);
      for (const Waiting& one : batch.records)
        answer(one.done, one.record.erased_person == 0 ? Result<void>() : emptied);
      changed_.notify_all();
      return true;
    }
    writing_since_.reset();
    changed_.notify_all();
    if (changed_.wait_for(lock, kJournalRetry, [this] { return ending_; })) return false;
    writing_since_ = monotonic_now();
  }
}

// Refuses the records that a caller waits for; they are not tried again.
void Journal::note_failure(Batch& batch, const Problem& problem) {
  std::optional<Problem> refusal;
  std::vector<Waiting> refused;
  const auto take_from = [&refused](std::vector<Waiting>& waiting) {
    const auto awaited = std::ranges::stable_partition(waiting, [](const Waiting& one) { return one.done == nullptr; });
    refused.insert(refused.end(), std::move_iterator(awaited.begin()), std::move_iterator(awaited.end()));
    waiting.erase(awaited.begin(), awaited.end());
  };
  {
    const std::lock_guard lock(mutex_);
    if (!failure_) {
      log::error("{}", explain(problem));
      batch.records.push_back({{journal_failed()}, {}});
    }
    failure_ = problem;
    refusal = unavailable();
    take_from(batch.records);
    take_from(waiting_);  // records that came while this batch was tried
  }
  for (const Waiting& one : refused) answer(one.done, tl::unexpected(*refusal));
}

// Tries again after the next commit if somebody is reading.
Result<void> Journal::empty_log(const Batch& written) {
  const auto erases = [](const Waiting& one) { return one.record.erased_person != 0; };
  log_has_names_ = log_has_names_ || std::ranges::any_of(written.records, erases);
  if (!log_has_names_) return {};
  const Result<void> emptied = store_->empty_log();
  log_has_names_ = !emptied;
  if (emptied) return {};
  return fail(Reason::journal_unavailable,
              fmt::format("the name is erased, but it stays in {}-wal: {}", path_, emptied.error().message),
              "end what reads the file; the daemon empties it with one of its next entries");
}

Result<std::optional<NamedPerson>> Journal::erase(const std::string& name, const std::string& by) {
  auto person = reader().and_then([&](Store store) { return store.find_person(name); });
  if (!person || !*person) return person;
  Entry entry = own_entry(EntryKind::person_erased, fmt::format(R"({{"person":{}}})", (*person)->number));
  entry.who = by;
  const auto written = std::make_shared<std::promise<Result<void>>>();
  commit({std::move(entry), {}, (*person)->number}, [written](Result<void> result) { written->set_value(result); });
  auto answer = written->get_future();
  if (answer.wait_for(kJournalErasing) != std::future_status::ready) {
    return fail(Reason::journal_unavailable, fmt::format("the disk of {} does not answer", path_),
                "the name is erased when it does, unless the daemon ends before");
  }
  if (const Result<void> done = answer.get(); !done) return tl::unexpected(done.error());
  return person;
}

Result<void> Journal::catch_up() const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, kJournalCatchUp, [this] { return failure_ || (waiting_.empty() && !writing_since_); });
  if (!store_) return tl::unexpected(*failure_);
  return {};
}

Result<Store> Journal::reader() const {
  return catch_up().and_then([this] { return Store::open_to_read(path_); });
}

Result<std::vector<StoredEntry>> Journal::read(const Filter& filter, std::size_t limit) const {
  return reader().and_then([&](Store store) { return store.read(filter, limit); });
}

Result<std::vector<StoredEntry>> Journal::unfinished_motions() const {
  return reader().and_then([](Store store) { return store.unfinished_motions(); });
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

Result<Summary> Journal::summarize(const Span& span) const {
  if (const auto there = catch_up(); !there) return tl::unexpected(there.error());
  auto database = Database::open(path_, Database::Access::read);
  if (!database) return tl::unexpected(database.error().problem);
  return journal::summarize(*database, span);
}

}  // namespace axisgate::server::journal
