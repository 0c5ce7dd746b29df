#include "server/api/stops.h"

#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>

#include "server/api/names.h"

namespace axisgate::api {
namespace {

using server::Stage;
using stage::StageController;
using stage::StopReport;

// The reports of all devices that are stopped together. Each device fills its own place, on its own strand.
class Gathering {
 public:
  Gathering(const std::vector<Stage*>& devices, Answer<std::vector<DeviceStop>> answer)
      : missing_(devices.size()), answer_(std::move(answer)) {
    for (const Stage* device : devices) stops_.push_back({.device = device, .report = {}, .state = {}});
  }

  // Once for each device.
  void add(std::size_t index, StopReport report, const stage::State& state) {
    stops_[index].report = std::move(report);
    stops_[index].state = state;
    if (--missing_ == 0) answer_(std::move(stops_));
  }

 private:
  std::vector<DeviceStop> stops_;
  std::atomic<std::size_t> missing_;
  const Answer<std::vector<DeviceStop>> answer_;
};

// `start(controller, now, done)` stops one device.
template <class Start>
void stop_each(const std::vector<Stage*>& devices, Answer<std::vector<DeviceStop>> answer, Start start) {
  const auto gathering = std::make_shared<Gathering>(devices, std::move(answer));
  for (std::size_t index = 0; index < devices.size(); ++index) {
    devices[index]->post([gathering, index, start](StageController& controller, TimePoint now) {
      start(controller, now, [gathering, index, &controller](StopReport report) {
        gathering->add(index, std::move(report), controller.state());
      });
    });
  }
}

}  // namespace

Result<std::vector<Stage*>> Stops::find_stages(std::string_view device) const {
  if (device.empty()) return gateway_.stages();
  const Result<Stage*> found = find_stage(gateway_, device);
  if (!found) return tl::unexpected(found.error());
  return std::vector<Stage*>{*found};
}

void Stops::stop(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
                 Answer<std::vector<DeviceStop>> answer) const {
  const auto devices = find_stages(device);
  if (!devices) return answer(tl::unexpected(devices.error()));
  if (!axes) return answer(tl::unexpected(axes.error()));
  if (!axes->empty() && devices->size() > 1) {
    return answer(fail(Reason::invalid_request, "the axes to be stopped are given without their device",
                       "name one of " + stage_names(gateway_) + "; without axes all of them are stopped"));
  }
  stop_each(*devices, std::move(answer),
            [axes = *axes, context = admission_.context_of_stop(call)](StageController& controller, TimePoint now,
                                                                       StageController::OnStopped done) {
              controller.stop(axes, context, now, std::move(done));
            });
}

void Stops::emergency_stop(const Call& call, std::string_view device, Answer<std::vector<DeviceStop>> answer) const {
  const auto devices = find_stages(device);
  if (!devices) return answer(tl::unexpected(devices.error()));
  stop_each(*devices, std::move(answer),
            [context = admission_.context_of_stop(call)](StageController& controller, TimePoint now,
                                                         StageController::OnStopped done) {
              controller.emergency_stop(context, now, std::move(done));
            });
}

}  // namespace axisgate::api
