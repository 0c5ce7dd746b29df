// Where the guideline is silent or has several interpretations: README.md gives the place of each.
#pragma once

#include <cstddef>

#include "device/core/named_options.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1::simulator {

class Options : public NamedOptions {
 public:
  Options();
};

std::span<const OptionName> option_names();

// How the mill holds back what is sent to it.
enum class Flow { none, xon, rts };

struct MillSetup {
  Profile profile;
  Options options;
  std::size_t buffer_bytes = 1024;  // 16 to 1048576
  Flow flow = Flow::none;
  double slower_percent = 0;  // 0 to 1000: each motion takes so much longer than by the profile
};

}  // namespace axisgate::rml1::simulator
