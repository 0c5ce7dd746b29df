// What has happened, by the journal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/api/request/admission.h"
#include "server/api/request/call.h"
#include "server/api/request/fair_worker.h"
#include "server/gateway.h"
#include "server/journal/journal.h"

namespace axisgate::api {

struct HistoryPage {
  std::vector<server::journal::StoredEntry> entries;
  bool more = false;        // the next page begins after the last of them
  std::int64_t newest = 0;  // the number of the journal's newest entry, wanted or not; 0: none
  bool own_only = false;    // without the entries of other callers: `others_seen_by` of the configuration
};

struct HistorySummary {
  server::journal::Summary summary;
  bool own_only = false;  // likewise
};

struct JournalVerdict {
  server::journal::Verdict verdict;
  server::journal::Head head;
};

// Thread safe. Reading takes place on a thread of its own, and verifying, which takes as long as the journal is large,
// on another; on both, callers take turns. A caller whose role is lower than `others_seen_by` reads the entries of
// their own identity (access/access.h), and those of nobody. Each answers with unauthenticated, not_allowed, or
// journal_unavailable: none is kept, or the disk refuses.
class History {
 public:
  static constexpr int kPageMax = 1000;

  // Both outlive this.
  History(server::Gateway& gateway, const Admission& admission) : gateway_(gateway), admission_(admission) {}
  // What waits is answered. The verifier ends first, because a name that is erased there also waits for the reader.
  ~History() {
    verifier_.join();
    reader_.join();
  }
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  // invalid_request; not_allowed also where the filter is for another caller's entries, which this one may not read.
  void list(const Call& call, Result<server::journal::Filter> filter, int page_size, Answer<HistoryPage> answer) const;
  // invalid_request: the span ends before it begins.
  void summarize(const Call& call, Result<server::journal::Span> span, Answer<HistorySummary> answer) const;
  void verify(const Call& call, Result<std::optional<server::journal::Head>> noted,
              Answer<JournalVerdict> answer) const;
  // As Journal::erase(); also in the log, without the name. not_found: no entry names this caller.
  void erase(const Call& call, std::string who, Answer<server::journal::NamedPerson> answer) const;

 private:
  struct Reader {
    server::journal::Journal* journal;
    server::Caller caller;
    std::string identity;  // of the caller, whose turn it is
    std::string only;      // the identity whose entries alone this caller reads, beside nobody's; empty: all
  };

  Result<Reader> let_read(RequestKind kind, const Call& call) const;
  Result<void> check_who(const Reader& reader, const std::string& wanted) const;

  server::Gateway& gateway_;
  const Admission& admission_;
  // Reading waits for the disk.
  mutable FairWorker reader_, verifier_;
};

}  // namespace axisgate::api
