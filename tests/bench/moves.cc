// Relative moves of axis 1, one after another, to and fro: the duration of the call that starts a move, and the time
// from its completion until a watcher of the events receives its outcome.
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>

#include "axisgate/v1/event.grpc.pb.h"
#include "axisgate/v1/stage.grpc.pb.h"
#include "tests/bench/daemon.h"
#include "tests/bench/measurement.h"
#include "tests/bench/subcommands.h"

namespace axisgate::bench {
namespace {

using WallClock = std::chrono::system_clock;  // the clock of Event.time

struct Options {
  std::string target;
  std::int64_t pulses = 1000;
  int count = 20;
};

WallClock::time_point time_of(const google::protobuf::Timestamp& stamp) {
  return WallClock::time_point(std::chrono::seconds(stamp.seconds()) + std::chrono::nanoseconds(stamp.nanos()));
}

class Mover {
 public:
  explicit Mover(const std::string& target)
      : stage_(v1::StageService::NewStub(connect(target))), events_(v1::EventService::NewStub(connect(target))) {
    v1::WatchRequest request;
    watching_ = events_->Watch(&context_, request);
    watching_->WaitForInitialMetadata();
  }
  ~Mover() {
    context_.TryCancel();
    watching_->Finish();
  }
  Mover(const Mover&) = delete;
  Mover& operator=(const Mover&) = delete;

  void move(std::int64_t pulses) {
    const auto called = Clock::now();
    const std::string motion = start_move(*stage_, pulses);
    started_.add(Clock::now() - called);
    await_outcome(motion);
  }

  nlohmann::json figures() const {
    auto figures = after_completion_.summary();
    figures["started"] = started_.summary();
    return figures;
  }

 private:
  void await_outcome(const std::string& motion) {
    WallClock::time_point completed{};
    v1::WatchResponse response;
    while (watching_->Read(&response)) {
      const auto now = WallClock::now();
      const v1::Event& event = response.event();
      if (event.has_completion() && event.completion().motion() == motion) completed = time_of(event.time());
      if (!event.has_motion() || event.motion().name() != motion) continue;
      const v1::MotionState state = event.motion().state();
      if (state < v1::MOTION_STATE_SUCCEEDED) continue;
      if (state != v1::MOTION_STATE_SUCCEEDED) throw std::runtime_error("a move is " + v1::MotionState_Name(state));
      if (completed == WallClock::time_point{}) throw std::runtime_error("a move ended without a completion");
      after_completion_.add(now - completed);
      return;
    }
    throw std::runtime_error("the events ended");
  }

  std::unique_ptr<v1::StageService::Stub> stage_;
  std::unique_ptr<v1::EventService::Stub> events_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReader<v1::WatchResponse>> watching_;
  Latencies started_, after_completion_;
};

void run(const Options& options) {
  Mover mover(options.target);
  say_begun();
  for (int i = 0; i < options.count; ++i) mover.move(i % 2 == 0 ? options.pulses : -options.pulses);
  say_ended();
  print(mover.figures());
}

}  // namespace

void add_moves(CLI::App& program) {
  CLI::App& sub = *program.add_subcommand("moves", "Relative moves of axis 1, one after another");
  const auto options = std::make_shared<Options>();
  sub.add_option("--target", options->target, "unix:PATH or HOST:PORT of the daemon")->required();
  sub.add_option("--pulses", options->pulses, "The displacement, to and fro");
  sub.add_option("--count", options->count, "How many")->check(CLI::Range(1, 10'000));
  sub.callback([options] { run(*options); });
}

}  // namespace axisgate::bench
