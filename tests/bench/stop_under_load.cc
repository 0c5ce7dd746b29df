// Stops while many calls of other callers wait or are refused: the time from each call to the first byte of its stop on
// the line.
#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "axisgate/v1/command.grpc.pb.h"
#include "axisgate/v1/stage.grpc.pb.h"
#include "device/link/clock.h"
#include "tests/bench/daemon.h"
#include "tests/bench/measurement.h"
#include "tests/bench/recording.h"
#include "tests/bench/subcommands.h"

namespace axisgate::bench {
namespace {

struct Options {
  std::string target;
  std::string line = "?:O";  // equal questions share an exchange, except questions for the outputs
  int calls = 990;
  int connections = 20;
  int stops = 60;
  int pause_ms = 50;
};

// Question that no other caller asks, used to find the beginning of the recording.
constexpr const char* kOwnQuestion = "?:AN";
constexpr int kOwnQuestions = 20;
constexpr auto kUntilLoaded = std::chrono::seconds(1);

class OtherCallers {
 public:
  explicit OtherCallers(const Options& options) {
    request_.set_device(kDevice);
    request_.add_lines(options.line);
    request_.mutable_timeout()->set_seconds(600);  // longer than any call waits in this program
    for (int i = 0; i < options.connections; ++i) {
      stubs_.push_back(v1::CommandService::NewStub(connect(options.target)));
    }
    for (int i = 0; i < options.calls; ++i) {
      calls_.push_back(std::make_unique<Repeated>(*this, *stubs_[static_cast<std::size_t>(i) % stubs_.size()]));
    }
  }
  int ended() const { return ended_; }
  int refused() const { return refused_; }
  std::string first_refusal() const {
    const std::lock_guard lock(mutex_);
    return first_refusal_;
  }

 private:
  // A Repeated is an Execute call that is made again as soon as it ends, whatever its result, while the program runs.
  class Repeated final : public grpc::ClientReadReactor<v1::ExecuteResponse> {
   public:
    Repeated(OtherCallers& all, v1::CommandService::Stub& stub) : all_(all), stub_(stub) { call(); }
    void OnReadDone(bool ok) override {
      if (ok) StartRead(&response_);
    }
    void OnDone(const grpc::Status& status) override {
      all_.count(status);
      call();
    }

   private:
    void call() {
      context_.emplace();
      stub_.async()->Execute(&*context_, &all_.request_, this);
      StartRead(&response_);
      StartCall();
    }

    OtherCallers& all_;
    v1::CommandService::Stub& stub_;
    std::optional<grpc::ClientContext> context_;
    v1::ExecuteResponse response_;
  };

  void count(const grpc::Status& status) {
    ++ended_;
    if (status.ok() || refused_++ > 0) return;
    const std::lock_guard lock(mutex_);
    first_refusal_ = status.error_message();
  }

  v1::ExecuteRequest request_;
  std::atomic<int> ended_ = 0, refused_ = 0;
  mutable std::mutex mutex_;
  std::string first_refusal_;
  std::vector<std::unique_ptr<v1::CommandService::Stub>> stubs_;
  std::vector<std::unique_ptr<Repeated>> calls_;
};

std::vector<CallTimes> ask_own_questions(const std::string& target) {
  const auto stub = v1::CommandService::NewStub(connect(target));
  std::vector<CallTimes> calls;
  for (int i = 0; i < kOwnQuestions; ++i) {
    const TimePoint called = monotonic_now();
    execute(*stub, {kOwnQuestion});
    calls.push_back({called, monotonic_now()});
  }
  return calls;
}

// Stops repeatedly, at random times that do not depend on the exchanges on the line.
std::vector<CallTimes> stop_often(const Options& options) {
  const auto stub = v1::StageService::NewStub(connect(options.target));
  std::mt19937 random;
  std::uniform_int_distribution<int> pause_us(0, options.pause_ms * 1000);
  std::vector<CallTimes> calls;
  for (int i = 0; i < options.stops; ++i) {
    std::this_thread::sleep_for(std::chrono::microseconds(pause_us(random)));
    v1::StopRequest request;
    request.set_device(kDevice);
    grpc::ClientContext context;
    v1::StopResponse response;
    const TimePoint called = monotonic_now();
    check(stub->Stop(&context, request, &response));
    calls.push_back({called, monotonic_now()});
  }
  return calls;
}

nlohmann::json figures_of(const std::vector<CallTimes>& stops, const Beginning& beginning,
                          const std::vector<RecordedTimes>& written) {
  Latencies first_byte, answered;
  const Duration uncertain = beginning.latest - beginning.earliest;
  auto next = written.begin();
  for (const CallTimes& stop : stops) {
    answered.add(stop.ended - stop.called);
    const auto at = [&] { return beginning.middle() + next->written; };
    while (next != written.end() && at() < stop.called - uncertain) ++next;
    if (next != written.end() && at() <= stop.ended) first_byte.add(at() - stop.called);
  }
  auto figures = first_byte.summary();
  figures["answered"] = answered.summary();
  figures["uncertain_by"] = std::chrono::duration<double, std::micro>(uncertain).count() / 2;
  return figures;
}

void run(const Options& options) {
  const Recording recording(connect(options.target));
  const auto own_calls = ask_own_questions(options.target);
  const OtherCallers& others = *new OtherCallers(options);  // never deleted: they end with the program
  std::this_thread::sleep_for(kUntilLoaded);
  say_begun();
  const int ended_before = others.ended(), refused_before = others.refused();
  const auto begun = Clock::now();
  const auto stops = stop_often(options);
  const std::chrono::duration<double> took = Clock::now() - begun;
  const int ended = others.ended() - ended_before, refused = others.refused() - refused_before;
  say_ended();
  const auto beginning = beginning_of(own_calls, recording.times_of(kOwnQuestion));
  auto figures = figures_of(stops, beginning, recording.times_of("L:"));
  figures["others_per_second"] = ended / took.count();
  figures["refused"] = refused;
  figures["first_refusal"] = others.first_refusal();
  print(figures);
  std::_Exit(0);
}

}  // namespace

void add_stop_under_load(CLI::App& program) {
  CLI::App& sub = *program.add_subcommand("stop_under_load", "Stops while many calls wait or are refused");
  const auto options = std::make_shared<Options>();
  sub.add_option("--target", options->target, "unix:PATH or HOST:PORT of the daemon")->required();
  sub.add_option("--line", options->line, "What the others execute without a pause: a question, or what is refused");
  sub.add_option("--calls", options->calls, "How many of these are open at once");
  sub.add_option("--connections", options->connections, "Of the others")->check(CLI::Range(1, 100));
  sub.add_option("--stops", options->stops, "How many");
  sub.add_option("--pause", options->pause_ms, "The longest pause between two stops, in milliseconds");
  sub.callback([options] { run(*options); });
}

}  // namespace axisgate::bench
