// Journal entries for the events of a device.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/stage/event.h"
#include "device/stage/motion.h"
#include "server/journal/exchanged_lines.h"
#include "server/journal/journal.h"
#include "server/journal/request_memory.h"

namespace axisgate::server::journal {

// Returns the results in the details of an entry; none if it has none.
std::vector<stage::AxisResult> results_in(std::string_view details);

// Runs on the device's strand and never waits.
class DeviceEntries {
 public:
  // The references must outlive this object. If `journal` is null, no entries are written, and requests are remembered
  // in memory only.
  DeviceEntries(std::string device, Journal* journal, RequestMemory& requests)
      : device_(std::move(device)), journal_(journal), requests_(requests) {}

  void on_event(const stage::Event& event, TimePoint now);

 private:
  // Returns the new state of the request that started the motion; nullopt if it is unchanged.
  std::optional<RequestChange> change_of(const stage::Event& event);

  const std::string device_;
  Journal* const journal_;
  RequestMemory& requests_;
  ExchangedLines lines_;
};

}  // namespace axisgate::server::journal
