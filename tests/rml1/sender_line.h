// A SenderLine has everything that a sender needs besides its line, for tests without a controller.
#pragma once

#include "device/rml1/sending/abort.h"
#include "device/rml1/sending/sender.h"
#include "tests/unit/core/reported.h"

namespace axisgate::rml1 {

class SenderLine {
 public:
  // The profile and the line must outlive this object.
  SenderLine(const Profile& profile, const jobs::SendSettings& settings, FlowLink& line)
      : settings_(settings), line_(line), abort_(profile, settings_, line, reported) {}

  MillLine mill() { return {line_, abort_, reported}; }

  Reported reported;  // must stay empty

 private:
  const jobs::SendSettings settings_;
  FlowLink& line_;
  Abort abort_;
};

}  // namespace axisgate::rml1
