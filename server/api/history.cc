#include "server/api/history.h"

#include <boost/asio/post.hpp>
#include <utility>

namespace axisgate::api {
namespace {

using server::journal::Filter;
using server::journal::Head;
using server::journal::Journal;

Problem unavailable(Problem problem) {
  problem.reason = Reason::journal_unavailable;
  return problem;
}

Result<HistoryPage> page_of(const Journal& journal, const Filter& filter, std::size_t size) {
  auto entries = journal.read(filter, size + 1);
  if (!entries) return tl::unexpected(unavailable(entries.error()));
  HistoryPage page{*std::move(entries), 0};
  if (page.entries.size() <= size) return page;
  page.entries.pop_back();
  page.next_before = page.entries.back().number;
  return page;
}

Result<JournalVerdict> verdict_of(const Journal& journal, const std::optional<Head>& noted) {
  auto verdict = journal.verify(noted);
  if (!verdict) return tl::unexpected(unavailable(verdict.error()));
  auto head = journal.head();
  if (!head) return tl::unexpected(unavailable(head.error()));
  return JournalVerdict{*std::move(verdict), *std::move(head)};
}

}  // namespace

Result<const Journal*> History::journal_for(RequestKind kind, const Call& call) const {
  if (const auto caller = admission_.check_role(kind, call.credential); !caller) {
    return tl::unexpected(caller.error());
  }
  if (const Journal* journal = gateway_.journal()) return journal;
  return fail(Reason::journal_unavailable, "this daemon keeps no journal", "its log says why, where it started");
}

void History::list(const Call& call, Result<Filter> filter, int page_size, Answer<HistoryPage> answer) const {
  const auto journal = journal_for(RequestKind::list_history, call);
  if (!journal) return answer(tl::unexpected(journal.error()));
  if (!filter) return answer(tl::unexpected(filter.error()));
  if (page_size < 1 || page_size > kPageMax) {
    return answer(fail(Reason::invalid_request, "page_size is not within 1 to 1000", "leave it 0 for 100"));
  }
  boost::asio::post(reader_,
                    [journal = *journal, filter = *std::move(filter), size = static_cast<std::size_t>(page_size),
                     answer = std::move(answer)] { answer(page_of(*journal, filter, size)); });
}

void History::verify(const Call& call, Result<std::optional<Head>> noted, Answer<JournalVerdict> answer) const {
  const auto journal = journal_for(RequestKind::verify_journal, call);
  if (!journal) return answer(tl::unexpected(journal.error()));
  if (!noted) return answer(tl::unexpected(noted.error()));
  boost::asio::post(reader_, [journal = *journal, noted = *std::move(noted), answer = std::move(answer)] {
    answer(verdict_of(*journal, noted));
  });
}

}  // namespace axisgate::api
