// The end of a transaction that had its turn: watches the motion that was started, reads again what may have changed,
// and brings the controller back to HOST.
#pragma once

#include "device/core/tasks.h"
#include "device/shot/line/line.h"
#include "device/shrc203/motion/watch.h"
#include "device/shrc203/session/non_host_visit.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/registers.h"
#include "device/shrc203/transaction/transaction.h"

namespace axisgate::shrc203 {

class TransactionEnd {
 public:
  TransactionEnd(Line& line, Reader& reader, Watch& watch, NonHostVisit& non_host_visit, const NonHost& non_host,
                 Registers& registers, StateStore& store, Motions& motions, const Tasks& tasks)
      : line_(line),
        reader_(reader),
        watch_(watch),
        non_host_visit_(non_host_visit),
        non_host_(non_host),
        registers_(registers),
        store_(store),
        motions_(motions),
        tasks_(tasks) {}

  // Ends the transaction. If `sent_all` is false, the caller has already received the end.
  Task<void> end(Transaction& transaction, bool sent_all);

 private:
  Task<void> come_back(Transaction& transaction, bool sent_all);
  Task<void> finish(Transaction& transaction, bool sent_all);
  Task<Result<void>> read_what_is_set(Transaction& transaction);
  Task<void> read_all(Transaction& transaction, bool sent_all);

  Line& line_;
  Reader& reader_;
  Watch& watch_;
  NonHostVisit& non_host_visit_;
  const NonHost& non_host_;
  Registers& registers_;
  StateStore& store_;
  Motions& motions_;
  const Tasks& tasks_;
};

}  // namespace axisgate::shrc203
