// The caller of a request.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "device/core/time.h"

namespace axisgate::use {

// The caller of a request and its time limit. `not_after` limits when a motion may start and how long a question may
// wait; it never stops a motion that has started.
struct RequestContext {
  std::string who;
  std::string request_id{};
  TimePoint not_after{};
  std::uint64_t lease = 0;               // fencing token of the lease; 0: none
  std::uint64_t device_epoch = 0;        // stage::State::device_epoch that the caller expects; 0: any
  std::uint64_t frame_epoch = 0;         // stage::State::frame_epoch that the caller expects; 0: any
  std::string role{};                    // role of the configuration, such as "operator"; selects the travel envelope
  std::optional<TimePoint> answer_by{};  // for a stop: time by which its report is made, with whatever is known
  std::string identity{};                // identity with which `who` takes turns; empty: `who`
  std::string session{};                 // Use::session

  const std::string& takes_turns_as() const { return identity.empty() ? who : identity; }
};

}  // namespace axisgate::use
