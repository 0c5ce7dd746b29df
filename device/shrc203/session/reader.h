// Readings: questions of the gateway's own, and their answers noted in the StateStore.
#pragma once

#include <string>

#include "device/core/problem.h"
#include "device/core/tasks.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/front_panel.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/registers.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

// What each of them refuses: the problem of its exchange; device_refused where the answer does not report it.
class Reader {
 public:
  Reader(Dialogue& dialogue, Line& line, FrontPanel& panel, StateStore& store, Registers& registers, Motions& motions,
         const Tasks& tasks)
      : dialogue_(dialogue),
        line_(line),
        panel_(panel),
        store_(store),
        registers_(registers),
        motions_(motions),
        tasks_(tasks) {}

  // Also line_fault.
  Task<Result<void>> read_positions(Lane lane, std::string caller, bool in_handshake = false);
  // A caller's own question was answered so. What is not plausible is left to the next reading.
  void note_positions(const Reply& reply);
  Task<Result<void>> read_registers(std::string caller);
  Task<Result<void>> read_speeds(std::string caller);
  Task<Result<void>> read_origin_speeds(std::string caller);
  // After S: (manual 55)). Twice, since everything hangs on it.
  Task<Result<void>> read_scales(std::string caller);
  // The front panel and an emergency stop switch motors, too.
  Task<Result<void>> read_excitation(std::string caller, Lane lane = Lane::motion);
  // False while the answer of a controller with one axis could be a completion, so that the question would keep
  // motions out.
  bool may_poll_excitation() const;
  Task<Result<void>> read_outputs(std::string caller);
  Task<Result<void>> read_trigger(std::string caller);
  // The speeds of those axes, read where they are not known. Also line_fault.
  Task<Result<void>> learn_speeds(AxisSet axes, std::string caller);

 private:
  bool implausible(const Reply& reply) const;
  bool apply_positions(const Reply& reply);
  AxisSet moving_silently() const;

  Dialogue& dialogue_;
  Line& line_;
  FrontPanel& panel_;
  StateStore& store_;
  Registers& registers_;
  Motions& motions_;
  const Tasks& tasks_;
};

}  // namespace axisgate::shrc203
