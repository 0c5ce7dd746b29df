// What one seed of a mill on a bad line draws: the job, how it is sent, the mill, the faults, and what people do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "device/core/time.h"
#include "device/rml1/machine/profile.h"
#include "device/rml1/mill/mill_controller.h"
#include "device/rml1/simulator/options.h"
#include "tests/rml1/abort_bench.h"

namespace axisgate::rml1 {

// A changed byte cannot be seen from here. It is one of the job's.
enum class ByteFault { none, lost, doubled, flipped };

// What makes a confirmation void.
enum class BeforeStart { nothing, line_breaks, abort, abort_and_at_once };

struct Act {
  enum class Kind {
    pause,
    resume,
    abort,
    stick,
    release,
    unplug,
    plug_in
  };  // stick: CTS is low, whatever the mill does
  Kind kind = Kind::abort;
  Duration at{};  // since the start of the job
};
std::string_view name(Act::Kind kind);

struct LineFaultPlan {
  std::string body;  // of the job
  MillSettings settings;
  simulator::MillSetup mill;
  LineToMill::Setup line;
  ByteFault byte = ByteFault::none;
  std::size_t byte_at = 0;  // of the job's bytes that arrive
  int bit = 0;              // which is flipped
  bool loses_xon = false;   // the first
  bool sticks_forever = false;
  bool keeps_converter = false;  // its bytes arrive after the line broke
  BeforeStart before_start = BeforeStart::nothing;
  std::vector<Act> acts;  // in their order
};

// `profile`: of the mill. The same for the same seed.
LineFaultPlan line_fault_plan(std::uint64_t seed, const Profile& profile);

// For people.
std::string text_of(const LineFaultPlan& plan);

}  // namespace axisgate::rml1
