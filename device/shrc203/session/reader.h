// Readings: the gateway's own questions, whose replies are noted in the StateStore.
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

// A Reader sends questions. Each reading fails with the problem of its exchange, or with device_refused if the reply
// has no data.
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

  // Also fails with line_fault.
  Task<Result<void>> read_positions(Lane lane, std::string caller, bool in_handshake = false);
  // Notes the reply to a caller's own question. An implausible reply is ignored; the next reading decides.
  void note_positions(const Reply& reply);
  Task<Result<void>> read_registers(std::string caller);
  Task<Result<void>> read_speeds(std::string caller);
  Task<Result<void>> read_origin_speeds(std::string caller);
  // Reads the resolutions after S: (manual 55)), twice, since everything depends on them.
  Task<Result<void>> read_scales(std::string caller);
  // Reads which motors are on. The front panel and an emergency stop switch motors, too.
  Task<Result<void>> read_excitation(std::string caller, Lane lane = Lane::motion);
  // Returns false while the reply of a controller with one axis could be a completion, so that the question would keep
  // motions out.
  bool may_poll_excitation() const;
  Task<Result<void>> read_outputs(std::string caller);
  Task<Result<void>> read_trigger(std::string caller);
  // Reads the speeds of the axes if any of them is unknown. Also fails with line_fault.
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
