#include "server/api/history.h"

#include <boost/asio/post.hpp>
#include <utility>

#include "device/stage/axes.h"

namespace axisgate::api {
namespace {

using server::journal::Filter;
using server::journal::Head;
using server::journal::Journal;
using server::journal::Span;
using server::journal::Summary;

Problem unavailable(Problem problem) {
  problem.reason = Reason::journal_unavailable;
  return problem;
}

Result<void> check(const Filter& filter, int page_size) {
  if (page_size < 1 || page_size > History::kPageMax) {
    return fail(Reason::invalid_request, "page_size is not within 1 to 1000", "leave it 0 for 100");
  }
  if (filter.axis < 0 || filter.axis > stage::kAxisCount) {
    return fail(Reason::invalid_request, "axis is not within 1 to 3", "leave it 0 for all");
  }
  return {};
}

// The newest entry is read first: what is appended meanwhile is after it.
Result<HistoryPage> page_of(const Journal& journal, const Filter& filter, std::size_t size) {
  const auto head = journal.head();
  if (!head) return tl::unexpected(unavailable(head.error()));
  auto entries = journal.read(filter, size + 1);
  if (!entries) return tl::unexpected(unavailable(entries.error()));
  HistoryPage page{*std::move(entries), false, head->number};
  page.more = page.entries.size() > size;
  if (page.more) page.entries.pop_back();
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
  if (const auto good = check(*filter, page_size); !good) return answer(tl::unexpected(good.error()));
  boost::asio::post(reader_,
                    [journal = *journal, filter = *std::move(filter), size = static_cast<std::size_t>(page_size),
                     answer = std::move(answer)] { answer(page_of(*journal, filter, size)); });
}

void History::summarize(const Call& call, Result<Span> span, Answer<Summary> answer) const {
  const auto journal = journal_for(RequestKind::summarize_history, call);
  if (!journal) return answer(tl::unexpected(journal.error()));
  if (!span) return answer(tl::unexpected(span.error()));
  if (span->to < span->from) {
    return answer(fail(Reason::invalid_request, "end_time is before start_time", "exchange them"));
  }
  boost::asio::post(reader_, [journal = *journal, span = *std::move(span), answer = std::move(answer)] {
    answer(journal->summarize(span).map_error(unavailable));
  });
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
