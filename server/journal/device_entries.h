// What the journal keeps of a device's events.
#pragma once

#include <optional>
#include <string>

#include "device/stage/event.h"
#include "server/journal/exchanged_lines.h"
#include "server/journal/journal.h"
#include "server/journal/request_memory.h"

namespace axisgate::server::journal {

// On the device's strand. Never waits.
class DeviceEntries {
 public:
  // Both outlive it. `journal` may be null: nothing is kept then, and requests are remembered in memory only.
  DeviceEntries(std::string device, Journal* journal, RequestMemory& requests)
      : device_(std::move(device)), journal_(journal), requests_(requests) {}

  void on_event(const stage::Event& event, TimePoint now);

 private:
  // What becomes of the request that the motion is of.
  std::optional<RequestChange> change_of(const stage::Event& event);

  const std::string device_;
  Journal* const journal_;
  RequestMemory& requests_;
  ExchangedLines lines_;
};

}  // namespace axisgate::server::journal
