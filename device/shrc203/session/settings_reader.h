// Settings that are read after a connect, and again after memory switches may have changed them: axes, resolutions,
// speeds, excitation, outputs, trigger, positions.
#pragma once

#include <cstdint>

#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class SettingsReader {
 public:
  SettingsReader(Dialogue& dialogue, Reader& reader, StateStore& store)
      : dialogue_(dialogue), reader_(reader), store_(store) {}

  // Returns false if not everything was reported, or another connection has begun (StateStore::connection()).
  Task<bool> read(std::uint64_t connection);

 private:
  struct Answers;
  Task<bool> ask(Answers& answers, std::uint64_t connection);
  bool take(const Answers& answers);
  bool take_of_axes(const Answers& answers, AxisSet controllable);

  Dialogue& dialogue_;
  Reader& reader_;
  StateStore& store_;
};

}  // namespace axisgate::shrc203
