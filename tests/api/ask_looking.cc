#include <string>

#include "tests/api/ask.h"
#include "tests/api/ask_parts.h"

namespace axisgate::api {

Reason ask_readers(World& world, RequestKind kind, const Call& call) {
  const DoorReport door{"", [](const server::Stage&, const stage::State&) { return std::string("state\n"); }};
  switch (kind) {
    case RequestKind::record:
      return reason_of(world.api->diagnostics.record(call, kDevice, false, false));
    case RequestKind::get_support_report:
      return reason_of(world.api->diagnostics.report(call, door));
    default:
      return reason_of(world.api->events.watch(call, {.from = 0}));
  }
}

Reason ask_tokens(World& world, RequestKind kind, const Call& call) {
  const Tokens& tokens = world.api->tokens;
  switch (kind) {
    case RequestKind::get_caller:
      return reason_of(tokens.caller(call));
    case RequestKind::create_token:
      return reason_of(tokens.create(call, NewToken{.name = "made"}));
    case RequestKind::list_tokens:
      return reason_of(tokens.list(call));
    default:
      return reason_of(tokens.revoke(call, "made"));
  }
}

Reason ask_history(World& world, RequestKind kind, const Call& call) {
  const History& history = world.api->history;
  if (kind == RequestKind::list_history) {
    Asking<HistoryPage> page;
    history.list(call, server::journal::Filter(), 10, page.answer());
    return page.reason();
  }
  if (kind == RequestKind::summarize_history) {
    Asking<HistorySummary> summary;
    history.summarize(call, server::journal::Span(), summary.answer());
    return summary.reason();
  }
  if (kind == RequestKind::erase_person) {
    Asking<server::journal::NamedPerson> person;
    history.erase(call, kAnna, person.answer());
    return person.reason();
  }
  Asking<JournalVerdict> verdict;
  history.verify(call, std::nullopt, verdict.answer());
  return verdict.reason();
}

}  // namespace axisgate::api
