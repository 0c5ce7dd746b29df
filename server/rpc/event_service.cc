#include "server/rpc/event_service.h"

#include <memory>
#include <string>
#include <utility>

#include "server/rpc/call.h"
#include "server/rpc/ended_stream.h"
#include "server/rpc/fact_reader.h"
#include "server/rpc/news.h"
#include "server/rpc/pull_stream.h"

namespace axisgate::rpc {
namespace {

class EventWatch final : public PullStream<grpc::ServerWriteReactor<api::WatchResponse>, api::WatchResponse> {
 public:
  // `device` is the one to tell of; empty: all.
  static EventWatch* start(server::Gateway& gateway, std::uint64_t from, std::string device, StreamLimit::Place place) {
    std::shared_ptr<EventWatch> watch(new EventWatch(gateway, from, std::move(device), std::move(place)));
    watch->open();
    // The subscription ends in closed(), before the watch does.
    watch->subscription_ = gateway.events().subscribe([raw = watch.get()] { raw->pump(); });
    watch->pump();
    return watch.get();
  }

 private:
  EventWatch(server::Gateway& gateway, std::uint64_t from, std::string device, StreamLimit::Place place)
      : run_(gateway.run()), device_(std::move(device)), place_(std::move(place)), reader_(gateway, from) {}

  Next next() override {
    for (;;) {
      const FactReader::Reading reading = reader_.next();
      if (const auto* compacted = std::get_if<FactReader::Compacted>(&reading)) return compacted_status(*compacted);
      const auto* record = std::get_if<std::shared_ptr<const server::FactRecord>>(&reading);
      if (record == nullptr) return Wait{};
      if (!device_.empty() && (*record)->device != device_) continue;
      api::WatchResponse response;
      *response.mutable_event() = to_proto(**record, run_);
      return response;
    }
  }

  void closed() override { subscription_.reset(); }

  const std::string& run_;
  const std::string device_;
  const StreamLimit::Place place_;
  FactReader reader_;
  std::unique_ptr<server::WakeUps::Subscription> subscription_;
};

}  // namespace

grpc::ServerWriteReactor<api::WatchResponse>* EventService::Watch(grpc::CallbackServerContext*,
                                                                  const api::WatchRequest* request) {
  using Ended = EndedStream<api::WatchResponse>;
  std::string device;
  if (!request->device().empty()) {
    const Result<server::Device*> found = find_device(gateway_, request->device());
    if (!found) return new Ended(found.error());
    device = (*found)->name();
  }
  const server::EventBus& bus = gateway_.events();
  if (!request->run().empty() && request->run() != gateway_.run()) {
    return new Ended(compacted_problem(), resume_at(bus.read(0, 0).next));
  }
  Result<StreamLimit::Place> place = streams_.take();
  if (!place) return new Ended(place.error());
  const std::uint64_t from = request->has_from_revision() ? request->from_revision() : bus.newest_revision() + 1;
  return EventWatch::start(gateway_, from, std::move(device), *std::move(place));
}

}  // namespace axisgate::rpc
