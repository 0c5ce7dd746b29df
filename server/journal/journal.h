// The thread that writes the journal.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "server/journal/refusal_budget.h"
#include "server/journal/store.h"
#include "server/journal/summary.h"

namespace axisgate::server::journal {

// Thread safe. Entries that are appended while others are written are committed together.
class Journal {
 public:
  // A disk that takes longer for one commit hangs: commit() refuses then, until it has come back.
  static constexpr Duration kHangs = std::chrono::seconds(2);
  // Beyond so many that wait for the disk, entries are left out, and the journal says how many.
  static constexpr std::size_t kWaitingMax = 10'000;
  // So long facts wait for an entry, so that a path's many facts do not sync the disk for each of them.
  static constexpr Duration kFactsWait = std::chrono::milliseconds(100);

  // As Store::open(). A damaged file is moved aside, with a warning that names it, and a new one begins. `boot` names
  // this boot of the machine; empty: not known.
  static Result<std::unique_ptr<Journal>> open(const std::string& path, std::string_view boot = {},
                                               const StoreBounds& bounds = {});
  // A journal whose file could not be opened, for as long as the daemon runs: a later opening would give the numbers of
  // its motions and revisions a second time. It fails as on a disk that refuses, with `why`, and keeps nothing.
  static std::unique_ptr<Journal> unopened(const std::string& path, const Problem& why);
  // Writes what waits, if the disk takes it.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // Never waits for the disk. Where the disk refuses, it is tried again each second.
  void append(Record record);
  // A refused request of which nothing else is in the journal: within RefusalBudget it has an entry, beyond it is
  // counted.
  void append_refusal(Entry refusal);
  // The same as append(), for what must be on the disk before it is done: `done` is called once, from the journal's
  // thread or from within this call. journal_unavailable, where the disk refuses it, so that it is not written later
  // either. From a disk that hangs the answer comes late.
  using OnCommitted = std::function<void(Result<void>)>;
  void commit(Record record, OnCommitted done);
  // Erases the name of a caller: it becomes erased_name(), and an entry by `by` says so. Nothing: no entry names this
  // caller. journal_unavailable: the disk refuses it; or the name is erased, but stays in the file's log while another
  // program reads the file. For threads that may wait, before answer_nobody(); nothing else should read meanwhile.
  Result<std::optional<NamedPerson>> erase(const std::string& name, const std::string& by);
  // From now on nobody is answered any more. Before that goes which they would call.
  void answer_nobody();
  // A fact of the event bus: EventBus::Keep. Never waits; written with the next commit, or after kFactsWait. Where the
  // disk refuses, the newest wait.
  void keep(FactPointer fact, std::uint64_t oldest);
  // Why nothing is written now; nothing while the disk takes what comes.
  std::optional<Problem> failure() const;

  // How long the last commit took; while one takes longer than kHangs, how long it has taken.
  Duration last_commit() const;

  bool is_open() const { return store_.has_value(); }

  // As the file had it when it was opened; empty if it was not.
  const std::string& epoch() const { return epoch_; }
  Duration boot_offset() const { return boot_offset_; }
  RequestsOnFile take_requests() { return std::exchange(requests_, {}); }
  FactsBefore take_facts() { return std::exchange(facts_, {}); }
  bool after_unclean_end() const { return after_unclean_end_; }  // of the run before

  // Each with a connection of its own, for threads that may wait. What was appended before is found, unless the disk
  // refuses it or is slow.
  Result<std::vector<StoredEntry>> read(const Filter& filter, std::size_t limit) const;
  Result<std::vector<StoredEntry>> unfinished_motions() const;  // of the run before: before it is begun
  Result<std::uint64_t> last_motion(std::string_view device) const;
  Result<Verdict> verify(const std::optional<Head>& noted) const;
  Result<Head> head() const;
  Result<Summary> summarize(const Span& span) const;

 private:
  struct Waiting {
    Record record;
    OnCommitted done;  // empty: nobody waits
  };
  struct Batch {
    std::vector<Waiting> records;
    FactChange facts;
    bool empty() const { return records.empty() && facts.added.empty(); }
  };

  Journal(std::string path, std::optional<Store> store);

  static Result<std::unique_ptr<Journal>> start(std::string path, Store store, std::string_view boot,
                                                const StoreBounds& bounds);
  // Waits until what was appended is written. Fails with journal_unavailable if the file could not be opened.
  Result<void> catch_up() const;
  Result<Store> reader() const;
  void run();
  Batch wait_for_records();
  void wait_or_sum_up_refusals(std::unique_lock<std::mutex>& lock);
  void put(Record record);  // under mutex_
  // Until it is written; false where the daemon ends before.
  bool write(Batch batch);
  void drop_old();
  Result<void> empty_log(const Batch& written);
  void answer(const OnCommitted& done, const Result<void>& written);
  void note_failure(Batch& batch, const Problem& problem);
  std::optional<Problem> unavailable() const;  // under mutex_

  const std::string path_;
  std::optional<Store> store_;  // nullopt if the file could not be opened; of the thread, as are the next three
  StoreBounds bounds_;
  TimePoint next_drop_{};
  bool log_has_names_ = false;  // that were erased
  std::string epoch_;
  Duration boot_offset_{};
  RequestsOnFile requests_;
  FactsBefore facts_;
  bool after_unclean_end_ = false;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::vector<Waiting> waiting_;
  FactChange facts_waiting_;
  RefusalBudget refusals_;
  std::optional<TimePoint> writing_since_;
  Duration last_commit_{};
  std::uint64_t left_out_ = 0;
  std::optional<Problem> failure_;
  bool ending_ = false;
  std::mutex answering_;  // held while somebody is answered
  bool silent_ = false;   // under answering_
  std::thread thread_;
};

}  // namespace axisgate::server::journal
