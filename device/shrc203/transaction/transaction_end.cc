#include "device/shrc203/transaction/transaction_end.h"

#include <algorithm>

#include "device/core/guard.h"
#include "device/shrc203/planning/transaction_lines.h"

namespace axisgate::shrc203 {
namespace {

// Reports whether the lines set only speeds, which leaves motors and positions unchanged (manual 89) D: to 92) DR:, 94)
// B:).
bool sets_speeds_only(const Transaction& transaction) {
  return std::ranges::all_of(transaction.commands, [](const Command& command) {
    return command.row->effect == Effect::setting && command.row->sets_speeds != SetsSpeeds::no;
  });
}

}  // namespace

Task<void> TransactionEnd::end(Transaction& transaction, bool sent_all) {
  if (non_host_.away()) {
    co_await come_back(transaction, sent_all);
  } else if (transaction.changed.contains(Transaction::Changed::everything)) {
    line_.disconnect("it was reset, and is read again", tasks_.now());
    motions_.end(*transaction.live, MotionState::succeeded, {});
    if (sent_all) transaction.tell_end({});
  } else {
    co_await finish(transaction, sent_all);
  }
  transaction.live->on_completion = {};
}

Task<void> TransactionEnd::come_back(Transaction& transaction, bool sent_all) {
  co_await non_host_visit_.read_switches_left(transaction.live, transaction.audit);
  co_await non_host_visit_.come_back(
      transaction.live,
      {.sent_all = sent_all, .set_switches = transaction.changed.contains(Transaction::Changed::memory_switches)});
  if (const auto changed = transaction.audit.result(transaction.who())) store_.emit(*changed);
  if (sent_all) transaction.tell_end({});
}

Task<void> TransactionEnd::finish(Transaction& transaction, bool sent_all) {
  const LiveMotionPtr live = transaction.live;
  const bool wait = sent_all && completes(transaction.commands);
  if (sent_all && !wait) {
    transaction.tell_end({});
    live->on_completion = {};
  }
  if (guarded(Guard::registers_unknown_after_transaction)) registers_.forget();
  if (transaction.started == Transaction::Started::no) {
    co_await read_all(transaction, sent_all);
  } else {
    const bool in_doubt = transaction.started == Transaction::Started::in_doubt;
    co_await watch_.run(live, in_doubt ? Start::in_doubt : Start::accepted);
    if (!store_.speeds_known(store_.controllable())) co_await reader_.read_speeds(transaction.who());
  }
  if (!wait) co_return;
  transaction.tell_end(live->motion.state == MotionState::succeeded ? std::nullopt : live->motion.problem);
}

// The resolution changes after S: (manual 55)).
Task<Result<void>> TransactionEnd::read_what_is_set(Transaction& transaction) {
  const LiveMotionPtr live = transaction.live;
  if (transaction.changed.contains(Transaction::Changed::scale) && !live->life.line_lost()) {
    const auto read = co_await reader_.read_scales(transaction.who());
    if (!read && !live->life.line_lost()) {
      line_.disconnect("its scale was changed, and could not be read", tasks_.now());
    }
  }
  if (store_.origin_speeds_known(store_.controllable())) co_return Result<void>();
  auto read = co_await reader_.read_origin_speeds(transaction.who());
  co_return read;
}

Task<void> TransactionEnd::read_all(Transaction& transaction, bool sent_all) {
  auto read = co_await read_what_is_set(transaction);
  if (read && !store_.speeds_known(store_.controllable())) read = co_await reader_.read_speeds(transaction.who());
  if (!sets_speeds_only(transaction)) {
    if (read) read = co_await reader_.read_excitation(transaction.who());
    if (read) read = co_await reader_.read_positions(Lane::motion, transaction.who());
  }
  motions_.end(*transaction.live, sent_all && read ? MotionState::succeeded : MotionState::failed, {});
}

}  // namespace axisgate::shrc203
