// What has happened, by the journal.
#pragma once

#include <boost/asio/thread_pool.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/api/admission.h"
#include "server/api/call.h"
#include "server/gateway.h"
#include "server/journal/journal.h"

namespace axisgate::api {

struct HistoryPage {
  std::vector<server::journal::StoredEntry> entries;
  bool more = false;        // the next page begins after the last of them
  std::int64_t newest = 0;  // the number of the journal's newest entry, wanted or not; 0: none
};

struct JournalVerdict {
  server::journal::Verdict verdict;
  server::journal::Head head;
};

// Thread safe. Each answers with unauthenticated, not_allowed, or journal_unavailable: none is kept, or the disk
// refuses.
class History {
 public:
  static constexpr int kPageMax = 1000;

  // Both outlive this.
  History(server::Gateway& gateway, const Admission& admission) : gateway_(gateway), admission_(admission) {}
  ~History() { reader_.join(); }
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  // invalid_request.
  void list(const Call& call, Result<server::journal::Filter> filter, int page_size, Answer<HistoryPage> answer) const;
  // invalid_request: the span ends before it begins.
  void summarize(const Call& call, Result<server::journal::Span> span, Answer<server::journal::Summary> answer) const;
  void verify(const Call& call, Result<std::optional<server::journal::Head>> noted,
              Answer<JournalVerdict> answer) const;

 private:
  Result<const server::journal::Journal*> journal_for(RequestKind kind, const Call& call) const;

  server::Gateway& gateway_;
  const Admission& admission_;
  // Reading waits for the disk.
  mutable boost::asio::thread_pool reader_{1};
};

}  // namespace axisgate::api
