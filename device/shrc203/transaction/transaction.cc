#include "device/shrc203/transaction/transaction.h"

#include <fmt/format.h>

#include <utility>

namespace axisgate::shrc203 {

void Transaction::tell_end(std::optional<Problem> problem) const {
  ExecuteEvent event;
  event.kind = ExecuteEvent::Kind::ended;
  event.problem = std::move(problem);
  tell(event);
}

Problem nothing_saved(const Command& question) {
  return {.reason = Reason::not_found,
          .message = fmt::format("nothing is saved under number {}", question.arguments.first("n").value_or("")),
          .hint = "save a position there first; a restart of the controller deletes saved positions (PIT:)",
          .sent = question.line,
          .wire_reply = "NG"};
}

}  // namespace axisgate::shrc203
