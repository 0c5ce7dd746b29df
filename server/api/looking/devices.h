// Configured devices and their states.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "device/core/problem.h"
#include "device/stage/state.h"
#include "server/api/mill/mills.h"
#include "server/api/request/admission.h"
#include "server/api/request/call.h"
#include "server/api/request/pipeline.h"
#include "server/api/request/subscription.h"
#include "server/gateway.h"
#include "server/limits.h"

namespace axisgate::api {

// Both pointers are never null. The device is valid as long as the gateway.
struct DeviceState {
  const server::Stage* device = nullptr;
  std::shared_ptr<const stage::State> state;
};

struct DeviceList {
  std::vector<std::variant<DeviceState, MillState>> devices;  // in the order of the configuration
  std::string request_memory{};                               // RequestMemory::mark()
  bool requests_kept = false;                                 // requests are remembered over a restart, too
  std::string version{};                                      // of the daemon
  std::uint64_t next_revision = 0;                            // of the first event after this answer
  std::string run{};                                          // of the daemon
};

// A StageNow is not a copy: it is valid only during the call that passes it.
struct StageNow {
  const server::Stage* device = nullptr;
  const stage::State* state = nullptr;
};

using DeviceNow = std::variant<StageNow, MillState>;

// Thread safe.
class Devices {
 public:
  // The referenced objects must outlive this one.
  Devices(server::Gateway& gateway, const Admission& admission, const Pipeline& pipeline, Streams& streams)
      : gateway_(gateway), admission_(admission), pipeline_(pipeline), streams_(streams) {}

  // Answers from memory. A caller who wants to stop a device gets its name here.
  Result<DeviceList> list(const Call& call) const;

  // Answers with the state; with `max_age`, reads an older state again from the device. Fails with link_down if the
  // device must be read and is not up. A mill is never read, because it never answers.
  void get(const Call& call, std::string_view device, std::optional<Duration> max_age, Answer<DeviceNow> answer) const;

  // Streams the newest state at every change, at most once per `min_interval`, which is at least
  // server::kWatchIntervalMin.
  Opened<DeviceState> watch(const Call& call, std::string_view device, Duration min_interval) const;

  // Clears the errors of the axes; empty: all. Fails with unknown_axis or link_down, and as the device refuses it.
  void clear_errors(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
                    Answer<void> answer) const;

  // Abandons an open stop. For administrators. Fails with not_found if it is not open.
  void withdraw_stop(const Call& call, std::string_view stop, Answer<void> answer) const;

 private:
  void get_stage(const Call& call, Result<server::Stage*> stage, std::optional<Duration> max_age,
                 Answer<DeviceNow> answer) const;

  server::Gateway& gateway_;
  const Admission& admission_;
  const Pipeline& pipeline_;
  Streams& streams_;
};

}  // namespace axisgate::api
