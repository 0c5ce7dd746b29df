// Journal, and the thread that writes it.
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
#include "server/limits.h"

namespace axisgate::server::journal {

// Thread safe. Entries that are appended while others are written are committed together.
class Journal {
 public:
  // Maximum number of entries that wait for the disk. Further entries are left out, and the journal says how many.
  static constexpr std::size_t kWaitingMax = 10'000;

  // Opens the file like Store::open(). A damaged file is moved aside with an error in the log that names it, and a new
  // file begins. `boot` names this boot of the machine; empty if unknown.
  static Result<std::unique_ptr<Journal>> open(const std::string& path, std::string_view boot = {},
                                               const StoreBounds& bounds = {});
  // Returns a journal whose file could not be opened and stays closed for as long as the daemon runs: opening it later
  // would give the numbers of motions and revisions a second time. It fails with `why` like a journal on a disk that
  // refuses, and keeps nothing.
  static std::unique_ptr<Journal> unopened(const std::string& path, const Problem& why);
  // Writes the waiting records if the disk accepts them.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // Appends a record without waiting for the disk. If the disk refuses, writing is tried again each second.
  void append(Record record);
  // Appends a refused request that has no other entry. A refusal within RefusalBudget gets its own entry; further ones
  // are counted.
  void append_refusal(Entry refusal);
  // Appends a record that must be on the disk before its request is carried out. `done` is called once, from the
  // journal's thread or from within this call. Fails with journal_unavailable if the disk refuses; the record is not
  // written later either. If the disk hangs, the answer comes late.
  using OnCommitted = std::function<void(Result<void>)>;
  void commit(Record record, OnCommitted done);
  // Replaces the name of a caller with erased_name(), and adds an entry by `by` about it. Returns nullopt if no entry
  // names this caller. Fails with journal_unavailable if the disk refuses, or if the name is erased but stays in the
  // file's log because another program is reading the file. Call it from a thread that may wait, before
  // answer_nobody(); no other reader should be active.
  Result<std::optional<NamedPerson>> erase(const std::string& name, const std::string& by);
  // No callback runs after this returns. Call it before destroying what the callbacks use.
  void answer_nobody();
  // Keeps a fact of the event bus: see EventBus::Keep. Never waits. The fact is written with the next commit, or after
  // kFactsWait. If the disk refuses, the newest facts wait.
  void keep(FactPointer fact, std::uint64_t oldest);
  // Returns why nothing can be written now; nullopt while the disk accepts records.
  std::optional<Problem> failure() const;

  // Duration of the last commit. While a commit takes longer than kCommitHangs: its duration up to now.
  Duration last_commit() const;

  bool is_open() const { return store_.has_value(); }

  // State of the file when it was opened; empty if it could not be opened.
  const std::string& epoch() const { return epoch_; }
  Duration boot_offset() const { return boot_offset_; }
  RequestsOnFile take_requests() { return std::exchange(requests_, {}); }
  FactsBefore take_facts() { return std::exchange(facts_, {}); }
  bool after_unclean_end() const { return after_unclean_end_; }  // true if the previous run ended uncleanly

  // Each call uses its own connection and may be called from threads that may wait. It finds everything that was
  // appended before, unless the disk refuses or is slow.
  Result<std::vector<StoredEntry>> read(const Filter& filter, std::size_t limit) const;
  // Motions of the previous run; call before the new run begins.
  Result<std::vector<StoredEntry>> unfinished_motions() const;
  Result<std::uint64_t> last_motion(std::string_view device) const;
  Result<Verdict> verify(const std::optional<Head>& noted) const;
  Result<Head> head() const;
  Result<Summary> summarize(const Span& span) const;

 private:
  struct Waiting {
    Record record;
    OnCommitted done;  // empty if nobody waits
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
  // Tries until the batch is written. Returns false if the daemon ends before.
  bool write(Batch batch);
  void drop_old();
  Result<void> empty_log(const Batch& written);
  void answer(const OnCommitted& done, const Result<void>& written);
  void note_failure(Batch& batch, const Problem& problem);
  std::optional<Problem> unavailable() const;  // under mutex_

  const std::string path_;
  // nullopt if the file could not be opened; used by the thread, as are the next three members.
  std::optional<Store> store_;
  StoreBounds bounds_;
  TimePoint next_drop_{};
  bool log_has_names_ = false;  // the file's log contains erased names
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
  std::mutex answering_;  // locked during callbacks
  bool silent_ = false;   // under answering_
  std::thread thread_;
};

}  // namespace axisgate::server::journal
