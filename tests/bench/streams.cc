// Many streams of events or of states: the delay of each event, and the number of lost events.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <latch>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "axisgate/v1/device.grpc.pb.h"
#include "axisgate/v1/event.grpc.pb.h"
#include "axisgate/v1/stage.grpc.pb.h"
#include "tests/bench/daemon.h"
#include "tests/bench/measurement.h"
#include "tests/bench/subcommands.h"

namespace axisgate::bench {
namespace {

using WallClock = std::chrono::system_clock;  // the clock of Event.time
using Seconds = std::chrono::duration<double>;

struct Options {
  std::vector<std::string> targets;
  bool states = false;
  int count = 1000;
  int connections = 20;
  double seconds = 8;
  double moves_per_second = 0;
};

constexpr std::chrono::milliseconds kUntilQuiet(500);
constexpr std::int64_t kPulses = 30;  // 12 ms at the simulator's speeds

// Returns the target of a connection. The connections are divided among the targets, because a thousand streams send
// more acknowledgements than the daemon accepts from one source.
const std::string& target_of(const Options& options, int connection) {
  return options.targets[static_cast<std::size_t>(connection) % options.targets.size()];
}

// State shared by the streams of a measurement.
struct Shared {
  explicit Shared(int count) : opened(count), ended(count) {}
  std::latch opened, ended;
  std::atomic<bool> measuring = false;
  std::atomic<bool> refused = false;
};

template <class Response>
class Stream : public grpc::ClientReadReactor<Response> {
 public:
  explicit Stream(Shared& shared) : shared_(shared) {}

  void begin() {
    this->StartRead(&response_);
    this->StartCall();
  }
  grpc::ClientContext& context() { return context_; }
  std::size_t messages() const { return messages_; }

  void OnReadInitialMetadataDone(bool ok) override {
    if (!ok) shared_.refused = true;
    shared_.opened.count_down();
  }
  void OnReadDone(bool ok) override {
    if (!ok) return;
    if (shared_.measuring) {
      ++messages_;
      take(response_);
    }
    this->StartRead(&response_);
  }
  void OnDone(const grpc::Status&) override { shared_.ended.count_down(); }

 private:
  virtual void take(const Response& response) = 0;

  Shared& shared_;
  grpc::ClientContext context_;
  Response response_;
  std::size_t messages_ = 0;
};

class States final : public Stream<v1::WatchDeviceResponse> {
 public:
  using Stream::Stream;

 private:
  void take(const v1::WatchDeviceResponse&) override {}
};

class Events final : public Stream<v1::WatchResponse> {
 public:
  using Stream::Stream;
  std::uint64_t first() const { return first_; }
  std::uint64_t last() const { return last_; }
  std::uint64_t left_out() const { return left_out_; }  // missing events between the first and the last
  const Latencies& delays() const { return delays_; }

 private:
  void take(const v1::WatchResponse& response) override {
    const v1::Event& event = response.event();
    const auto time = std::chrono::seconds(event.time().seconds()) + std::chrono::nanoseconds(event.time().nanos());
    delays_.add(WallClock::now().time_since_epoch() - time);
    if (first_ == 0) first_ = event.revision();
    if (last_ != 0) left_out_ += event.revision() - last_ - 1;
    last_ = event.revision();
  }

  std::uint64_t first_ = 0, left_out_ = 0;
  std::atomic<std::uint64_t> last_ = 0;
  Latencies delays_;
};

// Moves to and fro at equal intervals. Each move gives four events: queued, running, completion, outcome.
void move_often(const Options& options) {
  const auto stage = v1::StageService::NewStub(connect(target_of(options, 0)));
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::seconds(1) / options.moves_per_second);
  const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(Seconds(options.seconds));
  bool forward = true;
  for (auto next = Clock::now(); next < until; forward = !forward) {
    start_move(*stage, forward ? kPulses : -kPulses);
    next = std::max(next + period, Clock::now());
    std::this_thread::sleep_until(next);
  }
}

// Waits until every stream has the newest event, at most 5 s: a stream may have lost it. No more events may follow.
void await_newest(const std::vector<std::unique_ptr<Events>>& streams) {
  constexpr std::chrono::milliseconds kLongest(5000), kBetweenLooks(300);
  const auto until = Clock::now() + kLongest;
  const auto newest = [&] {
    const auto has_older = [](const auto& one, const auto& other) { return one->last() < other->last(); };
    return std::ranges::minmax_element(streams, has_older);
  };
  std::uint64_t before = 0;
  for (auto ends = newest(); Clock::now() < until; ends = newest()) {
    const std::uint64_t last = (*ends.max)->last();
    if ((*ends.min)->last() == last && last == before) return;
    before = last;
    std::this_thread::sleep_for(kBetweenLooks);
  }
}

void await_newest(const std::vector<std::unique_ptr<States>>&) {}

nlohmann::json figures_of(const std::vector<std::unique_ptr<Events>>& streams, bool events_have_ended) {
  Latencies delays;
  std::uint64_t first = std::numeric_limits<std::uint64_t>::max(), last = 0, lost = 0;
  for (const auto& stream : streams) {
    delays.add(stream->delays());
    first = std::min(first, stream->first());
    last = std::max(last, stream->last());
  }
  for (const auto& stream : streams) {
    lost += stream->left_out();
    // While events continue, some streams have the newest event and others do not yet.
    if (events_have_ended) lost += (stream->first() - first) + (last - stream->last());
  }
  auto figures = delays.summary();
  figures["events"] = last - first + 1;
  figures["lost"] = lost;
  return figures;
}

nlohmann::json figures_of(const std::vector<std::unique_ptr<States>>&, bool) { return nlohmann::json::object(); }

template <class OneStream, class Open>
void run(const Options& options, Open open) {
  Shared shared(options.count);
  std::vector<std::shared_ptr<grpc::Channel>> channels;
  for (int i = 0; i < options.connections; ++i) channels.push_back(connect(target_of(options, i)));
  std::vector<std::unique_ptr<OneStream>> streams;
  for (int i = 0; i < options.count; ++i) {
    streams.push_back(std::make_unique<OneStream>(shared));
    open(channels[static_cast<std::size_t>(i) % channels.size()], *streams.back());
    streams.back()->begin();
  }
  shared.opened.wait();
  std::this_thread::sleep_for(kUntilQuiet);  // events from the time of opening are still in transit to some streams
  shared.measuring = true;
  say_begun();
  const auto begun = Clock::now();
  if (options.moves_per_second <= 0) {
    std::this_thread::sleep_for(Seconds(options.seconds));
  } else {
    move_often(options);
    await_newest(streams);
  }
  const Seconds took = Clock::now() - begun;
  say_ended();
  for (const auto& stream : streams) stream->context().TryCancel();
  shared.ended.wait();
  if (shared.refused) throw std::runtime_error("a stream was refused");
  std::size_t messages = 0;
  for (const auto& stream : streams) messages += stream->messages();
  auto figures = figures_of(streams, options.moves_per_second > 0);
  figures["messages_per_second"] = static_cast<double>(messages) / took.count();
  print(figures);
}

void run_events(const Options& options) {
  const v1::WatchRequest request;
  run<Events>(options, [&](const std::shared_ptr<grpc::Channel>& channel, Events& stream) {
    v1::EventService::NewStub(channel)->async()->Watch(&stream.context(), &request, &stream);
  });
}

void run_states(const Options& options) {
  v1::WatchDeviceRequest request;
  request.set_device(kDevice);
  run<States>(options, [&](const std::shared_ptr<grpc::Channel>& channel, States& stream) {
    v1::DeviceService::NewStub(channel)->async()->WatchDevice(&stream.context(), &request, &stream);
  });
}

}  // namespace

void add_streams(CLI::App& program) {
  CLI::App& sub = *program.add_subcommand("streams", "Many streams of EventService.Watch, or of WatchDevice");
  const auto options = std::make_shared<Options>();
  sub.add_option("--target", options->targets, "unix:PATH or HOST:PORT; may be repeated")->required();
  sub.add_flag("--states", options->states, "WatchDevice");
  sub.add_option("--count", options->count, "How many")->check(CLI::Range(1, 2000));
  sub.add_option("--connections", options->connections, "Over how many")->check(CLI::Range(1, 500));
  sub.add_option("--seconds", options->seconds, "How long");
  sub.add_option("--moves", options->moves_per_second, "Move axis 1 meanwhile, so many times a second");
  sub.callback([options] { options->states ? run_states(*options) : run_events(*options); });
}

}  // namespace axisgate::bench
