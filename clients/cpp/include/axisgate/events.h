// Events of a device, and its states, as series that continue after a broken connection.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "axisgate/state.h"

namespace axisgate {

namespace client {
class EventReader;
class StateReader;
}  // namespace client

// An Event is one fact about a device or the daemon.
struct Event {
  std::uint64_t revision = 0;                  // ascending over all devices and over restarts
  std::chrono::system_clock::time_point time;  // by the daemon's clock
  std::string device;                          // empty: an event of the daemon itself
  std::string kind;                            // "motion", "stop_requested"; empty for a fact of a newer daemon
  std::string json;                            // the whole event, with the field names of the API
  std::string run;                             // run of the daemon
};

// A Gap means that events were missed, because they are no longer kept.
struct Gap {
  std::uint64_t resume_revision = 0;  // of the event with which the series continues
};

// Events is a series of events, each once and in order, also over broken connections and restarts of the daemon. One
// thread reads at a time; close() may be called from any thread.
class AXISGATE_PUBLIC Events {
 public:
  explicit Events(std::unique_ptr<client::EventReader> reader);
  ~Events();
  Events(Events&&) noexcept;
  Events& operator=(Events&&) = delete;

  // Waits for the next event. Returns nullopt after close(). Throws Error if the daemon refuses to continue.
  std::optional<std::variant<Event, Gap>> next();
  void close();

 private:
  std::unique_ptr<client::EventReader> reader_;
};

// States is a series of the newest states of a device: one at once, and one after every change. A slow reader skips
// states. The series continues after a broken connection. One thread reads at a time; close() may be called from any
// thread.
class AXISGATE_PUBLIC States {
 public:
  explicit States(std::unique_ptr<client::StateReader> reader);
  ~States();
  States(States&&) noexcept;
  States& operator=(States&&) = delete;

  // Waits for the next state. Returns nullopt after close(). Throws Error if the daemon refuses to continue.
  std::optional<Status> next();
  void close();

 private:
  std::unique_ptr<client::StateReader> reader_;
};

}  // namespace axisgate
