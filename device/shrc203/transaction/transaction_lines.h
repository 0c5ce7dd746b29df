// Sends a transaction's lines one after the other, reports each reply, and notes the changes.
#pragma once

#include <cstddef>
#include <vector>

#include "device/core/tasks.h"
#include "device/shot/line/line.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/explainer.h"
#include "device/shrc203/session/lease_settings.h"
#include "device/shrc203/session/non_host_visit.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/session/session.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/pending_restores.h"
#include "device/shrc203/transaction/transaction.h"

namespace axisgate::shrc203 {

class TransactionLines {
 public:
  TransactionLines(Dialogue& dialogue, Explainer& explainer, Reader& reader, LeaseSettings& settings,
                   NonHostVisit& non_host_visit, Session& session, NonHost& non_host, PendingRestores& pending,
                   StateStore& store, Motions& motions, const Tasks& tasks)
      : dialogue_(dialogue),
        explainer_(explainer),
        reader_(reader),
        settings_(settings),
        non_host_visit_(non_host_visit),
        session_(session),
        non_host_(non_host),
        pending_(pending),
        store_(store),
        motions_(motions),
        tasks_(tasks) {}

  // Sends all lines. False: a line was not accepted, or a stop came, and the caller has received the reason.
  Task<bool> send_all(Transaction& transaction);

 private:
  Task<bool> send(Transaction& transaction, std::size_t index);
  Task<Result<void>> leave_host(Transaction& transaction, Command command);
  Task<ExchangeResult> exchange(Transaction& transaction, Command command);
  ExchangeRequest request_for(const Transaction& transaction, const Command& command) const;
  void note(Transaction& transaction, const Command& command, const ExchangeResult& result);
  void note_start(Transaction& transaction, const ExchangeResult& result);
  void note_speeds(const Command& command, const ExchangeResult& result);
  void note_mode(Transaction& transaction, Mode mode);
  void note_completions(const std::vector<int>& axes);
  Task<bool> was_answered(Transaction& transaction, Command question, bool refused);
  Task<bool> was_accepted(Transaction& transaction, Command command, bool accepted);

  Dialogue& dialogue_;
  Explainer& explainer_;
  Reader& reader_;
  LeaseSettings& settings_;
  NonHostVisit& non_host_visit_;
  Session& session_;
  NonHost& non_host_;
  PendingRestores& pending_;
  StateStore& store_;
  Motions& motions_;
  const Tasks& tasks_;
};

}  // namespace axisgate::shrc203
