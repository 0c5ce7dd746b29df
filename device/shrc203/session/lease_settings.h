// Lasting settings made under a lease: speeds (manual 89) D: to 92), 94) B:), outputs (96) O:) and the trigger (97) to
// 101) T:). The values before are read first, so that they can be restored when the lease has ended.
#pragma once

#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/pending_restores.h"
#include "device/shrc203/state/state_store.h"
#include "device/use/permission.h"

namespace axisgate::shrc203 {

class LeaseSettings {
 public:
  LeaseSettings(Reader& reader, const StateStore& store, PendingRestores& pending, Permission& permission)
      : reader_(reader), store_(store), pending_(pending), permission_(permission) {}

  // Reads unknown values of the settings that the lines will change. Not the speeds of D:; Reader::learn_speeds() reads
  // these. Fails with line_fault.
  Task<Result<void>> learn(const std::vector<Command>& commands, std::string caller);
  // Notes the settings to restore. Call before the line is sent.
  void remember(const RequestContext& context, const Command& command);

 private:
  Reader& reader_;
  const StateStore& store_;
  PendingRestores& pending_;
  Permission& permission_;
};

// Notes the settings of a line after its reply. If the reply was lost, the settings are unknown.
void note_setting(StateStore& store, const Command& command, const ExchangeResult& result);

}  // namespace axisgate::shrc203
