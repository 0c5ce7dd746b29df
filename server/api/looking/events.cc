#include "server/api/looking/events.h"

#include <utility>
#include <variant>

#include "server/api/request/facts.h"
#include "server/api/request/names.h"

namespace axisgate::api {
namespace {

class EventWatch final : public Subscription<Event> {
 public:
  // `device` selects the events of one device; empty: all devices.
  EventWatch(server::Gateway& gateway, std::uint64_t from, std::string device, Streams::Place place)
      : Subscription(std::move(place)), bus_(gateway.events()), device_(std::move(device)), reader_(gateway, from) {}

 private:
  // A start of the daemon concerns all readers.
  bool concerns(const server::FactRecord& record) const {
    return device_.empty() || record.device.empty() || record.device == device_;
  }

  void begin() override {
    woken_by(bus_);
    wake();
  }

  Reading read() override {
    for (;;) {
      FactReader::Reading reading = reader_.next();
      if (const auto* compacted = std::get_if<FactReader::Compacted>(&reading)) return compacted_at(compacted->resume);
      auto* record = std::get_if<Event>(&reading);
      if (record == nullptr) return Nothing{};
      if (concerns(**record)) return std::move(*record);
    }
  }

  server::EventBus& bus_;
  const std::string device_;
  FactReader reader_;
};

// An EndedWatch ends before the first event.
class EndedWatch final : public Subscription<Event> {
 public:
  EndedWatch(StreamEnd end, Streams::Place place) : Subscription(std::move(place)), end_(std::move(end)) {}

 private:
  void begin() override { wake(); }
  Reading read() override { return end_; }

  const StreamEnd end_;
};

}  // namespace

Opened<Event> Events::watch(const Call& call, const EventRange& range) const {
  const auto caller = admission_.check_role(RequestKind::watch_events, call.credential);
  if (!caller) return tl::unexpected(caller.error());
  std::string device;
  if (!range.device.empty()) {
    const Result<server::Device*> found = find_device(gateway_, range.device);
    if (!found) return tl::unexpected(found.error());
    device = (*found)->name();
  }
  const server::EventBus& bus = gateway_.events();
  const std::uint64_t from = range.from.value_or(bus.newest_revision() + 1);
  if (!range.run.empty() && !bus.resumes(range.run, from)) {
    return std::make_shared<EndedWatch>(compacted_at(bus.read(0, 0).next), nullptr);
  }
  Result<Streams::Place> place = streams_.take(RequestKind::watch_events, caller->who);
  if (!place) return tl::unexpected(place.error());
  return std::make_shared<EventWatch>(gateway_, from, std::move(device), *std::move(place));
}

}  // namespace axisgate::api
