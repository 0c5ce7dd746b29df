#include "server/api/looking/history.h"

#include <fmt/format.h>

#include <future>
#include <memory>
#include <utility>

#include "device/core/escape.h"
#include "server/access/access.h"
#include "server/api/request/audit.h"

namespace axisgate::api {
namespace {

using server::journal::Filter;
using server::journal::Head;
using server::journal::Journal;
using server::journal::NamedPerson;
using server::journal::Span;

Problem unavailable(Problem problem) {
  problem.reason = Reason::journal_unavailable;
  return problem;
}

Result<void> check_page_size(int page_size) {
  if (page_size < 1 || page_size > History::kPageMax) {
    return fail(Reason::invalid_request, "page_size is not within 1 to 1000", "leave it 0 for 100");
  }
  return {};
}

// Reads the newest entry first, so that entries appended meanwhile come after it.
Result<HistoryPage> page_of(const Journal& journal, const Filter& filter, std::size_t size) {
  const auto head = journal.head();
  if (!head) return tl::unexpected(unavailable(head.error()));
  auto entries = journal.read(filter, size + 1);
  if (!entries) return tl::unexpected(unavailable(entries.error()));
  HistoryPage page{*std::move(entries), false, head->number, !filter.identity.empty()};
  page.more = page.entries.size() > size;
  if (page.more) page.entries.pop_back();
  return page;
}

Result<HistorySummary> summary_of(const Journal& journal, const Span& span) {
  auto summary = journal.summarize(span);
  if (!summary) return tl::unexpected(unavailable(summary.error()));
  return HistorySummary{*std::move(summary), !span.identity.empty()};
}

Result<JournalVerdict> verdict_of(const Journal& journal, const std::optional<Head>& noted) {
  auto verdict = journal.verify(noted);
  if (!verdict) return tl::unexpected(unavailable(verdict.error()));
  auto head = journal.head();
  if (!head) return tl::unexpected(unavailable(head.error()));
  return JournalVerdict{*std::move(verdict), *std::move(head)};
}

Result<NamedPerson> erased_in(Journal& journal, const std::string& who, const std::string& by) {
  const auto person = journal.erase(who, by);
  if (!person) return tl::unexpected(unavailable(person.error()));
  if (!*person) {
    return fail(Reason::not_found, fmt::format("the journal has no caller \"{}\"", escaped(who)),
                "give the whole name as `ListHistory` shows it, e.g. \"unix anna\"");
  }
  audit(RequestKind::erase_person, by, fmt::format("erased the name of caller {} from the journal", (*person)->number));
  return **person;
}

}  // namespace

Result<History::Reader> History::let_read(RequestKind kind, const Call& call) const {
  const auto caller = admission_.check_role(kind, call.credential);
  if (!caller) return tl::unexpected(caller.error());
  Journal* const journal = gateway_.journal();
  if (journal == nullptr) {
    return fail(Reason::journal_unavailable, "this daemon keeps no journal",
                "its configuration says so: `kept` in [journal]");
  }
  const bool sees_others = caller->role >= gateway_.config().journal.others_seen_by;
  const std::string identity = server::identity_of(caller->who);
  return Reader{journal, *caller, identity, sees_others ? "" : identity};
}

Result<void> History::check_who(const Reader& reader, const std::string& wanted) const {
  if (reader.only.empty() || wanted.empty() || server::identity_of(wanted) == reader.only) return {};
  return fail(Reason::not_allowed,
              fmt::format("reading what other callers did needs the role {}, and {} is {}",
                          name(gateway_.config().journal.others_seen_by), reader.caller.who, name(reader.caller.role)),
              "read your own entries; `others_seen_by` in [journal] of the configuration names the role");
}

void History::list(const Call& call, Result<Filter> filter, int page_size, Answer<HistoryPage> answer) const {
  const auto reader = let_read(RequestKind::list_history, call);
  if (!reader) return answer(tl::unexpected(reader.error()));
  if (!filter) return answer(tl::unexpected(filter.error()));
  if (const auto good = check_page_size(page_size); !good) return answer(tl::unexpected(good.error()));
  if (const auto own = check_who(*reader, filter->who); !own) return answer(tl::unexpected(own.error()));
  filter->identity = reader->only;
  reader_.post(reader->identity,
               [&journal = *reader->journal, filter = *std::move(filter), size = static_cast<std::size_t>(page_size),
                answer = std::move(answer)] { answer(page_of(journal, filter, size)); });
}

void History::summarize(const Call& call, Result<Span> span, Answer<HistorySummary> answer) const {
  const auto reader = let_read(RequestKind::summarize_history, call);
  if (!reader) return answer(tl::unexpected(reader.error()));
  if (!span) return answer(tl::unexpected(span.error()));
  if (span->to < span->from) {
    return answer(fail(Reason::invalid_request, "end_time is before start_time", "exchange them"));
  }
  span->identity = reader->only;
  reader_.post(reader->identity, [&journal = *reader->journal, span = *std::move(span), answer = std::move(answer)] {
    answer(summary_of(journal, span));
  });
}

void History::verify(const Call& call, Result<std::optional<Head>> noted, Answer<JournalVerdict> answer) const {
  const auto reader = let_read(RequestKind::verify_journal, call);
  if (!reader) return answer(tl::unexpected(reader.error()));
  if (!noted) return answer(tl::unexpected(noted.error()));
  verifier_.post(reader->identity, [&journal = *reader->journal, noted = *std::move(noted),
                                    answer = std::move(answer)] { answer(verdict_of(journal, noted)); });
}

// Occupies both threads, because a concurrent reader would prevent the database's log (`-wal`) from being emptied.
void History::erase(const Call& call, std::string who, Answer<NamedPerson> answer) const {
  const auto reader = let_read(RequestKind::erase_person, call);
  if (!reader) return answer(tl::unexpected(reader.error()));
  verifier_.post(reader->identity, [this, reader = *reader, who = std::move(who), answer = std::move(answer)] {
    const auto erased = std::make_shared<std::promise<void>>();
    reader_.post(reader.identity, [&, erased] {
      answer(erased_in(*reader.journal, who, reader.caller.who));
      erased->set_value();
    });
    erased->get_future().wait();
  });
}

}  // namespace axisgate::api
