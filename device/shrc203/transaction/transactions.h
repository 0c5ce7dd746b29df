// Runs a caller's own lines as one transaction: checked by the command table, without another caller's motion between
// them.
#pragma once

#include <vector>

#include "device/core/tasks.h"
#include "device/shrc203/session/ending.h"
#include "device/shrc203/session/stops.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/rights.h"
#include "device/shrc203/transaction/transaction_end.h"
#include "device/shrc203/transaction/transaction_lines.h"
#include "device/shrc203/transaction/transaction_start.h"
#include "device/use/permission.h"

namespace axisgate::shrc203 {

class Transactions {
 public:
  using OnExecute = StageController::OnExecute;

  Transactions(TransactionStart& start, TransactionLines& lines, TransactionEnd& end, Stops& stops,
               const StateStore& store, Motions& motions, Rights& rights, const NonHost& non_host, const Ending& ending,
               Tasks& tasks)
      : start_(start),
        lines_(lines),
        end_(end),
        stops_(stops),
        store_(store),
        motions_(motions),
        rights_(rights),
        non_host_(non_host),
        ending_(ending),
        tasks_(tasks) {}

  // Carries out StageController::execute(). A stop does not become a transaction.
  void execute(ExecuteRequest request, OnExecute event);

 private:
  Result<void> check(const ExecuteRequest& request, const std::vector<Command>& commands);
  Task<void> run(Transaction transaction);
  void stop(const Command& command, const ExecuteRequest& request, OnExecute event);

  TransactionStart& start_;
  TransactionLines& lines_;
  TransactionEnd& end_;
  Stops& stops_;
  const StateStore& store_;
  Motions& motions_;
  Rights& rights_;
  const NonHost& non_host_;
  const Ending& ending_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
