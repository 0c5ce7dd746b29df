// Queries of the journal.
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
  bool more = false;        // another page begins after the last entry
  std::int64_t newest = 0;  // number of the journal's newest entry, even if it does not match; 0: none
  bool own_only = false;    // without the entries of other callers: `others_seen_by` of the configuration
};

struct HistorySummary {
  server::journal::Summary summary;
  bool own_only = false;  // as in HistoryPage
};

struct JournalVerdict {
  server::journal::Verdict verdict;
  server::journal::Head head;
};

// Thread safe. Reads on one thread, and verifies on another, because the time to verify grows with the journal. Callers
// take turns on both. A caller whose role is lower than `others_seen_by` reads only the entries of their own identity
// (access/access.h), and entries without a caller. All members fail with unauthenticated, not_allowed, or
// journal_unavailable if no journal is kept or the disk refuses access.
class History {
 public:
  static constexpr int kPageMax = 1000;

  // The referenced objects must outlive this one.
  History(server::Gateway& gateway, const Admission& admission) : gateway_(gateway), admission_(admission) {}
  // Answers all waiting requests. The verifier ends first, because the erasure of a name on it also waits for the
  // reader.
  ~History() {
    verifier_.join();
    reader_.join();
  }
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  // Fails with invalid_request, and with not_allowed also if the filter selects another caller's entries, which this
  // caller may not read.
  void list(const Call& call, Result<server::journal::Filter> filter, int page_size, Answer<HistoryPage> answer) const;
  // Fails with invalid_request if the span ends before it begins.
  void summarize(const Call& call, Result<server::journal::Span> span, Answer<HistorySummary> answer) const;
  void verify(const Call& call, Result<std::optional<server::journal::Head>> noted,
              Answer<JournalVerdict> answer) const;
  // Erases a name as Journal::erase() does, and logs that without the name. Fails with not_found if no entry names this
  // caller.
  void erase(const Call& call, std::string who, Answer<server::journal::NamedPerson> answer) const;

 private:
  struct Reader {
    server::journal::Journal* journal;
    server::Caller caller;
    std::string identity;  // of the caller, for turns
    std::string only;      // identity to which the entries are limited, besides those without a caller; empty: no limit
  };

  Result<Reader> let_read(RequestKind kind, const Call& call) const;
  Result<void> check_who(const Reader& reader, const std::string& wanted) const;

  server::Gateway& gateway_;
  const Admission& admission_;
  // Separate threads, because reading waits for the disk.
  mutable FairWorker reader_, verifier_;
};

}  // namespace axisgate::api
