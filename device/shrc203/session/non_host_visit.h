// Visits to non-host modes by P:R or MS:ON (manual 102) to 126)). Other callers get no replies during a visit, and the
// changed state is read again after it.
#pragma once

#include <string>

#include "device/core/tasks.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/session/settings_reader.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/registers.h"
#include "device/shrc203/state/state_store.h"
#include "device/shrc203/state/switch_audit.h"

namespace axisgate::shrc203 {

class NonHostVisit {
 public:
  NonHostVisit(Dialogue& dialogue, Line& line, Reader& reader, SettingsReader& settings, StateStore& store,
               Motions& motions, Registers& registers, NonHost& non_host, Tasks& tasks)
      : dialogue_(dialogue),
        line_(line),
        reader_(reader),
        settings_(settings),
        store_(store),
        motions_(motions),
        registers_(registers),
        non_host_(non_host),
        tasks_(tasks) {}

  // Begins a visit. Call before the transaction's first line. Lines of others are withdrawn, since they may not be sent
  // in a non-host mode.
  void leave_host(MotionId motion);
  // Read switches for the audit: those of the line's item before the first change, and those of all changed items
  // before the return.
  Task<Result<void>> read_switches_before(LiveMotionPtr live, SwitchAudit& audit, Command command);
  Task<void> read_switches_left(LiveMotionPtr live, SwitchAudit& audit);
  // Waits for the end of the program. Fails with outcome_unknown, device_error or stopped.
  Task<Result<void>> wait_for_program(LiveMotionPtr live);

  // Course of the transaction in the non-host mode.
  struct Course {
    bool sent_all = false, set_switches = false;
  };
  // Returns to HOST, whatever became of the transaction's lines, and gives the motion its outcome.
  Task<void> come_back(LiveMotionPtr live, Course course);

 private:
  Task<bool> wait_for_axes(LiveMotionPtr live);
  Task<bool> wait_for_host(LiveMotionPtr live);
  void end(LiveMotion& live, bool known, bool sent_all);

  Dialogue& dialogue_;
  Line& line_;
  Reader& reader_;
  SettingsReader& settings_;
  StateStore& store_;
  Motions& motions_;
  Registers& registers_;
  NonHost& non_host_;
  Tasks& tasks_;
};

// Takes one step back to HOST, depending on what ?:MODE reports: after a lost reply the controller may be in another
// mode than expected. Returns true if the controller is in HOST.
Task<bool> step_to_host(Dialogue& dialogue, StateStore& store, Lane lane, std::string caller, bool in_handshake);

}  // namespace axisgate::shrc203
