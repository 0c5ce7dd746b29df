// Which devices there are, and how they are.
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

namespace axisgate::api {

// Both are never null; the device is valid as long as the gateway.
struct DeviceState {
  const server::Stage* device = nullptr;
  std::shared_ptr<const stage::State> state;
};

struct DeviceList {
  std::vector<std::variant<DeviceState, MillState>> devices;  // in the order of the configuration
  std::string request_memory{};                               // RequestMemory::mark()
  bool requests_kept = false;                                 // also over a restart
};

// Not copied: valid during the call that hands it over.
struct StateNow {
  const server::Stage* device = nullptr;
  const stage::State* state = nullptr;
};

// Thread safe.
class Devices {
 public:
  static constexpr Duration kIntervalMin = std::chrono::milliseconds(10);

  // All outlive this.
  Devices(server::Gateway& gateway, const Admission& admission, const Pipeline& pipeline, Streams& streams)
      : gateway_(gateway), admission_(admission), pipeline_(pipeline), streams_(streams) {}

  // From memory. A stop needs it, for the device's name.
  Result<DeviceList> list(const Call& call) const;

  // With `max_age` read again from the device where it is older: link_down while that is not up.
  void get(const Call& call, std::string_view device, std::optional<Duration> max_age, Answer<StateNow> answer) const;

  // The newest state at every change, no more often than every `min_interval`, which is kIntervalMin at least.
  Opened<DeviceState> watch(const Call& call, std::string_view device, Duration min_interval) const;

  // Of no axes named, all. unknown_axis, link_down, and as the device refuses it.
  void clear_errors(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
                    Answer<void> answer) const;

  // Abandons an open stop. For administrators. Fails with not_found if it is not open.
  void withdraw_stop(const Call& call, std::string_view stop, Answer<void> answer) const;

 private:
  server::Gateway& gateway_;
  const Admission& admission_;
  const Pipeline& pipeline_;
  Streams& streams_;
};

}  // namespace axisgate::api
