// Random choices of one seed of a mill on a bad line: the job, its sending, the mill, the faults, and people's acts.
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

// Fault of one byte of the job. The gateway cannot detect a changed byte.
enum class ByteFault { none, lost, doubled, flipped };

// Event before the start that makes a confirmation void.
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
  std::string body;  // body of the job
  jobs::MachineSettings settings;
  simulator::MillSetup mill;
  LineToMill::Setup line;
  ByteFault byte = ByteFault::none;
  std::size_t byte_at = 0;  // index among the job's bytes that arrive
  int bit = 0;              // the bit that is flipped
  bool loses_xon = false;   // loses the first XON
  bool sticks_forever = false;
  bool keeps_converter = false;  // the converter's bytes arrive after the line broke
  BeforeStart before_start = BeforeStart::nothing;
  std::vector<Act> acts;  // in order of time
};

// Draws a plan for the mill with this profile. The same seed gives the same plan.
LineFaultPlan line_fault_plan(std::uint64_t seed, const Profile& profile);

// Returns the plan as text for people.
std::string text_of(const LineFaultPlan& plan);

}  // namespace axisgate::rml1
