// What the journal keeps of a device's events.
#pragma once

#include <string>

#include "device/stage/event.h"
#include "server/journal/journal.h"

namespace axisgate::server::journal {

// On the device's strand. Never waits.
class DeviceEntries {
 public:
  // `journal` outlives it.
  DeviceEntries(std::string device, Journal& journal) : device_(std::move(device)), journal_(journal) {}

  void on_event(const stage::Event& event, TimePoint now);

 private:
  const std::string device_;
  Journal& journal_;
};

}  // namespace axisgate::server::journal
