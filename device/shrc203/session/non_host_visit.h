// Out of HOST by P:R or MS:ON and back (manual 102) to 126)): while a transaction is in a non-host mode, nobody else is
// answered. Afterwards what it has changed is read again.
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

  // Before the first line of that transaction: what others have requested is not sent in a non-host mode.
  void leave_host(MotionId motion);
  // What the item of the line says before any of it is set, and all items before they are left: for the audit.
  Task<Result<void>> read_switches_before(LiveMotionPtr live, SwitchAudit& audit, Command command);
  Task<void> read_switches_left(LiveMotionPtr live, SwitchAudit& audit);
  // outcome_unknown, device_error, stopped.
  Task<Result<void>> wait_for_program(LiveMotionPtr live);

  // How the transaction has gone out there.
  struct Course {
    bool sent_all = false, set_switches = false;
  };
  // Whatever became of its lines; the motion has its outcome then.
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

// One step back to HOST, by what ?:MODE reports. An answer that was lost may have left the controller in another mode
// than expected. True when it is in HOST.
Task<bool> step_to_host(Dialogue& dialogue, StateStore& store, Lane lane, std::string caller, bool in_handshake);

}  // namespace axisgate::shrc203
