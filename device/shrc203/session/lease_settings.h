// What a lease's holder sets for good, speeds (manual 89) D: to 92), 94) B:), outputs (96) O:) and the trigger (97) to
// 101) T:): known before, so that it can be restored when the lease has ended.
#pragma once

#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/pending_restores.h"
#include "device/shrc203/state/state_store.h"
#include "device/stage/permission.h"

namespace axisgate::shrc203 {

class LeaseSettings {
 public:
  LeaseSettings(Reader& reader, const StateStore& store, PendingRestores& pending, Permission& permission)
      : reader_(reader), store_(store), pending_(pending), permission_(permission) {}

  // What the lines set has to be known before. Not the speeds of D:, which Reader::learn_speeds() is for. line_fault.
  Task<Result<void>> learn(const std::vector<Command>& commands, std::string caller);
  // Before the line goes out.
  void remember(const RequestContext& context, const Command& command);

 private:
  Reader& reader_;
  const StateStore& store_;
  PendingRestores& pending_;
  Permission& permission_;
};

// After its answer: what the line has set is known; where the answer was lost it may have been taken.
void note_setting(StateStore& store, const Command& command, const ExchangeResult& result);

}  // namespace axisgate::shrc203
