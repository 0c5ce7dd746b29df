#include "server/api/looking/devices.h"

#include <algorithm>
#include <utility>

#include "device/link/clock.h"
#include "server/api/request/names.h"
#include "server/api/request/request_texts.h"
#include "server/api/stage/targets.h"

namespace axisgate::api {
namespace {

// A DeviceWatch streams the newest state, at most once per `min_interval`.
class DeviceWatch final : public Subscription<DeviceState> {
 public:
  DeviceWatch(server::Gateway& gateway, server::Stage& device, Duration min_interval, Streams::Place place)
      : Subscription(std::move(place)), gateway_(gateway), device_(device), min_interval_(min_interval) {}

 private:
  void begin() override {
    woken_by(device_.newest_state());
    wake();
  }

  Reading read() override {
    const auto newest = device_.newest_state().get();
    if (newest.version == taken_) return Nothing{};
    const TimePoint now = monotonic_now();
    if (now < earliest_) {
      wait(earliest_ - now);
      return Nothing{};
    }
    taken_ = newest.version;
    earliest_ = now + min_interval_;
    return DeviceState{&device_, newest.value};
  }

  void wait(Duration time) {
    if (std::exchange(waiting_, true)) return;
    gateway_.timeouts().after(time, [self = self<DeviceWatch>()] {
      {
        const std::lock_guard lock(self->mutex_);
        self->waiting_ = false;
      }
      self->wake();
    });
  }

  server::Gateway& gateway_;
  server::Stage& device_;
  const Duration min_interval_;
  std::optional<std::uint64_t> taken_;  // version that was delivered last
  TimePoint earliest_{};                // earliest time of the next state
  bool waiting_ = false;                // a timer for earliest_ is running
};

}  // namespace

Result<DeviceList> Devices::list(const Call& call) const {
  const auto caller = admission_.check_role(RequestKind::list_devices, call.credential);
  if (!caller) return tl::unexpected(caller.error());
  DeviceList all{.devices = {},
                 .request_memory = gateway_.requests().mark(),
                 .requests_kept = gateway_.journal() != nullptr && !gateway_.journal()->failure(),
                 .version = AXISGATE_VERSION,
                 .next_revision = gateway_.events().newest_revision() + 1,
                 .run = gateway_.run()};
  for (const auto& device : gateway_.devices()) {
    if (auto* mill = dynamic_cast<server::Mill*>(device.get())) {
      all.devices.emplace_back(MillState{mill, mill->newest().get().value});
    } else {
      auto& stage = dynamic_cast<server::Stage&>(*device);
      all.devices.emplace_back(DeviceState{&stage, stage.newest_state().get().value});
    }
  }
  return all;
}

void Devices::get(const Call& call, std::string_view device, std::optional<Duration> max_age,
                  Answer<DeviceNow> answer) const {
  const Result<server::Device*> found = find_device(gateway_, device);
  auto* mill = found ? dynamic_cast<server::Mill*>(*found) : nullptr;
  if (mill == nullptr) return get_stage(call, find_stage(gateway_, device), max_age, std::move(answer));
  const auto caller = admission_.check_role(RequestKind::get_device, call.credential);
  if (!caller) return answer(tl::unexpected(caller.error()));
  answer(MillState{mill, mill->newest().get().value});
}

void Devices::get_stage(const Call& call, Result<server::Stage*> stage, std::optional<Duration> max_age,
                        Answer<DeviceNow> answer) const {
  pipeline_.ask({RequestKind::get_device, call, std::move(stage)}, std::move(answer),
                [max_age](const Turn& turn, const Answer<DeviceNow>& respond) {
                  if (!max_age) return respond(StageNow{&turn.device, &turn.controller.state()});
                  turn.controller.refresh(*max_age, turn.context, turn.now,
                                          [respond, &asked = turn.device](const Result<stage::State>& state) {
                                            if (!state) return respond(tl::unexpected(state.error()));
                                            respond(StageNow{&asked, &*state});
                                          });
                });
}

Opened<DeviceState> Devices::watch(const Call& call, std::string_view device, Duration min_interval) const {
  const auto admitted = pipeline_.admit({RequestKind::watch_device, call, find_stage(gateway_, device)});
  if (!admitted) return tl::unexpected(admitted.error());
  Result<Streams::Place> place = streams_.take(RequestKind::watch_device, admitted->caller.who);
  if (!place) return tl::unexpected(place.error());
  return std::make_shared<DeviceWatch>(gateway_, *admitted->device, std::max(server::kWatchIntervalMin, min_interval),
                                       *std::move(place));
}

void Devices::clear_errors(const Call& call, std::string_view device, const Result<stage::AxisSet>& axes,
                           Answer<void> answer) const {
  pipeline_.run(
      {RequestKind::clear_errors, call, find_stage(gateway_, device), fault_of(axes)}, std::move(answer),
      [named = axes.value_or(stage::AxisSet())](const Turn& turn) {
        return controllable_axes(named, turn.controller.state());
      },
      [](const Turn&, stage::AxisSet) { return Result<void>(); },
      [](stage::AxisSet chosen) { return text_of("clear errors of", chosen); },
      [](const Turn& turn, stage::AxisSet chosen, const Answer<void>& respond) {
        turn.controller.clear_errors(chosen, turn.context, turn.now, respond);
      });
}

void Devices::withdraw_stop(const Call& call, std::string_view stop, Answer<void> answer) const {
  const Result<StopName> name = find_stop_name(gateway_, stop);
  pipeline_.once({RequestKind::withdraw_stop, call, device_of(name)}, std::move(answer),
                 [id = name ? name->id : 0](const Turn& turn, const Answer<void>& respond) {
                   turn.controller.withdraw_stop(id, turn.context, turn.now, respond);
                 });
}

}  // namespace axisgate::api
