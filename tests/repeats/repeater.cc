// Program with three callers. Each moves one axis and repeats every request, with its id, until its result is known,
// while connections and daemons are killed. After each motion the axis must be where exactly one run, or none, leads:
// integration/kill_test.py.
//
// Distances are powers of four, so that the sum shows how often each one ran.
#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "axisgate/v1/device.grpc.pb.h"
#include "axisgate/v1/stage.grpc.pb.h"
#include "device/link/clock.h"
#include "server/events/wall_time.h"

namespace axisgate {
namespace {

using std::chrono::milliseconds;

constexpr int kAxes = 3, kPowers = 9;
constexpr auto kCallLimit = std::chrono::seconds(5);
constexpr auto kPause = milliseconds(20);

struct Counts {
  std::atomic<int> succeeded = 0, unknown_ran = 0, unknown_not_ran = 0, repeats = 0, wrong = 0;
};

class Caller {
 public:
  Caller(std::string target, int axis, const std::atomic<bool>& ended, Counts& counts, std::uint64_t seed)
      : target_(std::move(target)), axis_(axis), ended_(ended), counts_(counts), random_(seed) {}

  void run() {
    connect();
    std::optional<std::int64_t> place = stationary_place();
    for (std::int64_t sign = 1; place && !ended_; sign = -sign) {
      for (int power = 0; place && power < kPowers && !ended_; ++power) {
        const std::int64_t way = sign * (std::int64_t{1} << (2 * power));
        const std::optional<bool> ran = move(way);
        if (!ran) return;
        place = compare(*place, way, *ran);
      }
    }
  }

 private:
  // Opens a new connection for the next attempt.
  void connect() {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    const auto channel = grpc::CreateCustomChannel(target_, grpc::InsecureChannelCredentials(), arguments);
    devices_ = v1::DeviceService::NewStub(channel);
    stage_ = v1::StageService::NewStub(channel);
  }
  void pause() {
    std::this_thread::sleep_for(kPause);  // between two attempts; `ended_` and the caller's time limit bound them
    connect();
  }

  static void limit(grpc::ClientContext& context) {
    context.set_deadline(server::to_wall(monotonic_now() + kCallLimit));
  }

  std::optional<std::string> mark() {
    while (!ended_) {
      grpc::ClientContext context;
      limit(context);
      v1::ListDevicesResponse response;
      if (devices_->ListDevices(&context, v1::ListDevicesRequest(), &response).ok()) return response.request_memory();
      pause();
    }
    return std::nullopt;
  }

  // Returns nullopt if this program ends first.
  std::optional<std::int64_t> stationary_place() {
    while (!over()) {
      grpc::ClientContext context;
      limit(context);
      v1::GetDeviceRequest request;
      request.set_device("devices/stage");
      request.mutable_max_age();
      v1::GetDeviceResponse response;
      const bool answered = devices_->GetDevice(&context, request, &response).ok();
      const auto& axes = response.device().axes();
      if (answered && response.device().link() == v1::LINK_STATE_UP) {
        for (const v1::Axis& one : axes) {
          if (one.number() == axis_ && one.has_busy() && !one.busy() && one.has_position_pulses()) {
            return one.position_pulses();
          }
        }
      }
      pause();
    }
    return std::nullopt;
  }

  // Returns true if the move ran, false if it may or may not have run. nullopt if this program ends before the outcome
  // is known.
  std::optional<bool> move(std::int64_t way) {
    const auto memory = mark();
    if (!memory) return std::nullopt;
    v1::MoveRequest request;
    request.mutable_context()->set_request_id(fmt::format("{}-{}-{:x}", axis_, ++number_, random_()));
    request.mutable_context()->set_request_memory(*memory);
    request.set_device("devices/stage");
    request.set_relative(true);
    v1::AxisTarget& target = *request.add_targets();
    target.set_axis(std::to_string(axis_));
    target.mutable_distance()->set_pulses(way);
    target.mutable_profile()->mutable_maximum()->set_pulses_per_s(500'000);
    target.mutable_profile()->mutable_minimum()->set_pulses_per_s(100'000);
    for (int attempt = 0; !over(); ++attempt) {
      if (attempt > 0) ++counts_.repeats;
      grpc::ClientContext context;
      limit(context);
      v1::MoveResponse response;
      const grpc::Status status = stage_->Move(&context, request, &response);
      if (status.ok() && is_outcome(response.motion().state())) return ran(response.motion());
      if (!status.ok() && status.error_message().find("memory of request ids") != std::string::npos) {
        fmt::print("WRONG axis {}: {}\n", axis_, status.error_message());
        ++counts_.wrong;
      }
      pause();
    }
    return std::nullopt;
  }

  static bool is_outcome(v1::MotionState state) { return state >= v1::MOTION_STATE_SUCCEEDED; }

  bool ran(const v1::Motion& motion) {
    last_ = motion.ShortDebugString();
    if (motion.state() == v1::MOTION_STATE_SUCCEEDED) ++counts_.succeeded;
    return motion.state() == v1::MOTION_STATE_SUCCEEDED;
  }

  // Returns the present position. nullopt if this program ends first.
  std::optional<std::int64_t> compare(std::int64_t before, std::int64_t way, bool ran) {
    const auto now = stationary_place();
    if (!now) return std::nullopt;
    const bool once = *now == before + way, never = *now == before;
    if (!ran && once) ++counts_.unknown_ran;
    if (!ran && never) ++counts_.unknown_not_ran;
    if (once || (never && !ran)) return now;
    ++counts_.wrong;
    fmt::print("WRONG axis {}: from {} by {}, reported {}, is at {}: {}\n", axis_, before, way,
               ran ? "SUCCEEDED" : "not succeeded", *now, last_);
    return now;
  }

  // Reports whether the caller must end. After the end of the test a motion in progress is followed for 10 s more.
  bool over() {
    if (!ended_) return false;
    if (!leaving_) leaving_ = monotonic_now() + std::chrono::seconds(10);
    return monotonic_now() > *leaving_;
  }

  const std::string target_;
  const int axis_;
  const std::atomic<bool>& ended_;
  Counts& counts_;
  std::mt19937_64 random_;
  int number_ = 0;
  std::string last_;
  std::optional<TimePoint> leaving_;
  std::unique_ptr<v1::DeviceService::Stub> devices_;
  std::unique_ptr<v1::StageService::Stub> stage_;
};

int run(const std::string& socket, std::uint64_t seed) {
  std::atomic<bool> ended = false;
  Counts counts;
  std::vector<std::thread> threads;
  std::vector<std::unique_ptr<Caller>> callers;
  for (int axis = 1; axis <= kAxes; ++axis) {
    callers.push_back(std::make_unique<Caller>("unix:" + socket, axis, ended, counts, seed + axis));
    threads.emplace_back([&caller = *callers.back()] { caller.run(); });
  }
  fmt::print("moving\n");
  std::fflush(stdout);
  (void)std::getchar();  // until standard input ends or has a byte
  ended = true;
  for (std::thread& thread : threads) thread.join();
  fmt::print("succeeded {} unknown-ran {} unknown-not-ran {} repeats {} wrong {}\n", counts.succeeded.load(),
             counts.unknown_ran.load(), counts.unknown_not_ran.load(), counts.repeats.load(), counts.wrong.load());
  return counts.wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace axisgate

int main(int count, char** words) {
  CLI::App program("Three callers who repeat relative moves until they know what became of them.", "axisgate-repeater");
  std::string socket;
  std::uint64_t seed = 1;
  program.add_option("--socket", socket, "The daemon's Unix socket")->required();
  program.add_option("--seed", seed, "Of the request ids");
  CLI11_PARSE(program, count, words);
  return axisgate::run(socket, seed);
}
