#include "server/api/stage/stops.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include "device/core/escape.h"
#include "server/api/mill/mills.h"
#include "server/api/request/ending.h"
#include "server/api/request/names.h"
#include "server/api/stage/targets.h"
#include "server/log.h"

namespace axisgate::api {
namespace {

using server::Device;
using server::Mill;
using server::Stage;
using stage::StageController;
using stage::StopReport;

// A Gathering collects the reports of devices that are stopped together. Each device fills its own element, on its own
// strand.
class Gathering {
 public:
  Gathering(const std::vector<Device*>& devices, Answer<std::vector<DeviceStop>> answer)
      : missing_(devices.size()), answer_(std::move(answer)) {
    for (const Device* device : devices) stops_.push_back({.device = device, .report = {}});
  }

  // Called once for each device.
  void add(std::size_t index, StopReport report, const stage::State& state) {
    stops_[index].report = std::move(report);
    stops_[index].state = state;
    if (--missing_ == 0) answer_(std::move(stops_));
  }
  // Reports that the device's line is closed already, because the daemon ends; its `at_exit` was executed before.
  void add_too_late(std::size_t index) { add(index, {.axes = {}, .problem = daemon_ending()}, {}); }

 private:
  std::vector<DeviceStop> stops_;
  std::atomic<std::size_t> missing_;
  const Answer<std::vector<DeviceStop>> answer_;
};

// Returns the report of an aborted mill. `running` is the job that was aborted.
StopReport report_of_abort(const Mill& mill, const std::optional<jobs::RunningJob>& running, bool sent) {
  if (!sent) return {.axes = {}, .problem = not_sent_to(mill)};
  if (!running) return {};
  const double longest_s = std::chrono::duration<double>(running->run_on.longest).count();
  return {.axes = {},
          .problem = Problem{
              .reason = Reason::outcome_unknown,
              .message = fmt::format("the abort was sent to {}; whether it has stopped is not known", mill.name()),
              .hint = fmt::format("look at the machine; it may move for up to {:.1f} s: in an emergency use its own "
                                  "emergency stop",
                                  std::ceil(longest_s * 10) / 10)}};
}

void stop_mill(Mill& mill, const use::RequestContext& context, const std::shared_ptr<Gathering>& gathering,
               std::size_t index) {
  mill.post(
      [&mill, context, gathering, index](jobs::Machine& controller, TimePoint now) {
        const std::optional<jobs::RunningJob> running = controller.running(now);
        const bool sent = controller.abort(context, now);
        gathering->add(index, report_of_abort(mill, running, sent), {});
      },
      [gathering, index] { gathering->add_too_late(index); });
}

// Stops all devices. `start(controller, now, done)` stops one stage.
template <class Start>
void stop_each(const std::vector<Device*>& devices, const use::RequestContext& context,
               Answer<std::vector<DeviceStop>> answer, Start start) {
  const auto gathering = std::make_shared<Gathering>(devices, std::move(answer));
  for (std::size_t index = 0; index < devices.size(); ++index) {
    if (auto* mill = dynamic_cast<Mill*>(devices[index])) {
      stop_mill(*mill, context, gathering, index);
      continue;
    }
    auto& stage = dynamic_cast<Stage&>(*devices[index]);
    stage.post(
        [gathering, index, start](StageController& controller, TimePoint now) {
          start(controller, now, [gathering, index, &controller](StopReport report) {
            gathering->add(index, std::move(report), controller.state());
          });
        },
        [gathering, index] { gathering->add_too_late(index); });
  }
}

}  // namespace

Result<std::vector<Device*>> Stops::find_devices(std::string_view device, bool axes) const {
  if (device.empty() && axes) return std::vector<Device*>(gateway_.stages().begin(), gateway_.stages().end());
  std::vector<Device*> all;
  if (device.empty()) {
    for (const auto& one : gateway_.devices()) all.push_back(one.get());
    return all;
  }
  return find_device(gateway_, device).map([](Device* found) { return std::vector<Device*>{found}; });
}

void Stops::stop(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
                 Answer<std::vector<DeviceStop>> answer) const {
  const bool named = !axes || !axes->empty();
  const auto devices = find_devices(device, named);
  if (!devices) return answer(tl::unexpected(devices.error()));
  if (named && devices->size() != 1) {
    return answer(fail(Reason::invalid_request, "the axes to be stopped are given without their device",
                       "name one of " + device_names(gateway_) + "; without axes all of them are stopped"));
  }
  for (const Device* one : *devices) {
    if (one->whole().is_whole_device()) continue;  // whatever axes are named, a mill is aborted
    const auto good = axes ? check_axes(*axes, *one) : tl::unexpected(axes.error());
    if (!good) return answer(tl::unexpected(good.error()));
  }
  const use::RequestContext context = admission_.context_of_stop(call);
  stop_each(*devices, context, std::move(answer),
            [axes = axes.value_or(stage::AxisSet()), context](StageController& controller, TimePoint now,
                                                              StageController::OnStopped done) {
              controller.stop(axes, context, now, std::move(done));
            });
}

void Stops::emergency_stop(const Call& call, std::string_view device, Answer<std::vector<DeviceStop>> answer) const {
  const auto devices = find_devices(device, false);
  if (!devices) return answer(tl::unexpected(devices.error()));
  const use::RequestContext context = admission_.context_of_stop(call);
  stop_each(*devices, context, std::move(answer),
            [context](StageController& controller, TimePoint now, StageController::OnStopped done) {
              controller.emergency_stop(context, now, std::move(done));
            });
}

}  // namespace axisgate::api
