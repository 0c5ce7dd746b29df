#include "server/rpc/device_watch.h"

#include "device/link/clock.h"
#include "server/rpc/news.h"

namespace axisgate::rpc {

DeviceWatch* DeviceWatch::start(server::Gateway& gateway, server::Device& device, Duration min_interval,
                                StreamLimit::Place place) {
  std::shared_ptr<DeviceWatch> watch(new DeviceWatch(gateway, device, min_interval, std::move(place)));
  watch->open();
  // The subscription ends in closed(), before the watch does.
  watch->subscription_ = device.newest_state().subscribe([raw = watch.get()] { raw->pump(); });
  watch->pump();
  return watch.get();
}

DeviceWatch::Next DeviceWatch::next() {
  const server::Newest<stage::State>::Snapshot newest = device_.newest_state().get();
  if (newest.version == sent_) return Wait{};
  const TimePoint now = monotonic_now();
  if (now < earliest_) {
    if (!timer_set_) {
      timer_set_ = true;
      gateway_.after(earliest_ - now, [watch = self<DeviceWatch>()] {
        {
          const std::lock_guard lock(watch->mutex_);
          watch->timer_set_ = false;
        }
        watch->pump();
      });
    }
    return Wait{};
  }
  sent_ = newest.version;
  earliest_ = now + min_interval_;
  api::WatchDeviceResponse response;
  *response.mutable_device() = to_proto(device_, *newest.value);
  return response;
}

}  // namespace axisgate::rpc
