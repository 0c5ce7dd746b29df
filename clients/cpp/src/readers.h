// Series of events and of states.
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "axisgate/events.h"
#include "clients/cpp/src/feed.h"

namespace axisgate::client {

class EventReader {
 public:
  // `cursor` has the device and the first event to read.
  EventReader(std::shared_ptr<DeviceSession> session, v1::WatchRequest cursor);

  std::optional<std::variant<Event, Gap>> next();
  void close() { feed_.close(); }

 private:
  // Moves the cursor to the end of the gap that the failure reports.
  bool skip(const Failure& failure);

  const std::shared_ptr<DeviceSession> session_;
  v1::WatchRequest cursor_;
  std::optional<Gap> gap_;
  Feed<v1::WatchResponse> feed_;
};

class StateReader {
 public:
  StateReader(std::shared_ptr<DeviceSession> session, milliseconds interval);

  std::optional<Status> next();
  void close() { feed_.close(); }

 private:
  Feed<v1::WatchDeviceResponse> feed_;
};

}  // namespace axisgate::client
