// Compares the package with bare stubs that send the same messages, alternately in one process. Prints the median times
// in microseconds. usage: clients/conformance/example.py build/bin/axisgate-cpp-bench
#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

#include "axisgate/axisgate.h"
#include "clients/cpp/src/channel.h"
#include "clients/cpp/src/identity.h"
#include "clients/cpp/src/services.h"

namespace {

using axisgate::client::Services;
namespace v1 = axisgate::v1;
using google::protobuf::util::TimeUtil;

constexpr int kWarmUp = 20, kQuestions = 300, kMoves = 60;
constexpr std::chrono::seconds kLimit{10};

void require(const grpc::Status& status) {
  if (!status.ok()) throw std::runtime_error(status.error_message());
}

template <class Stub, class Request, class Response>
Response bare_call(Stub& stub, grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                   const Request& request) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kLimit);
  Response response;
  require((stub.*method)(&context, request, &response));
  return response;
}

void bare_get_device(Services& services) {
  v1::GetDeviceRequest request;
  request.set_device("devices/stage");
  bare_call(services.devices, &v1::DeviceService::Stub::GetDevice, request);
}

void bare_move(Services& services, int pulses) {
  const auto listed = bare_call(services.devices, &v1::DeviceService::Stub::ListDevices, v1::ListDevicesRequest());
  v1::MoveRequest move;
  move.mutable_context()->set_request_id(axisgate::client::new_uuid());
  move.mutable_context()->set_request_memory(listed.request_memory());
  *move.mutable_context()->mutable_not_after() = TimeUtil::GetCurrentTime() + TimeUtil::SecondsToDuration(5);
  move.set_device("devices/stage");
  move.set_relative(true);
  v1::AxisTarget& target = *move.add_targets();
  target.set_axis("x");
  target.mutable_distance()->set_pulses(pulses);
  v1::WaitMotionRequest wait;
  wait.set_motion(bare_call(services.stage, &v1::StageService::Stub::Move, move).motion().name());
  *wait.mutable_max_wait() = TimeUtil::SecondsToDuration(5);
  const auto ended = bare_call(services.stage, &v1::StageService::Stub::WaitMotion, wait);
  if (ended.motion().state() != v1::MOTION_STATE_SUCCEEDED) throw std::runtime_error("a move did not succeed");
}

double median_us(std::vector<double>& times) {
  std::ranges::sort(times);
  return times[times.size() / 2];
}

// Returns the medians of both, which run alternately, as JSON.
std::string compared(int count, const std::function<void(int)>& package, const std::function<void(int)>& bare) {
  std::vector<double> package_us, bare_us;
  const auto timed = [](std::vector<double>& times, const std::function<void(int)>& run, int i) {
    const auto begun = std::chrono::steady_clock::now();
    run(i);
    times.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begun).count());
  };
  for (int i = 0; i < kWarmUp; ++i) package(i), bare(i);
  for (int i = 0; i < count; ++i) {
    timed(package_us, package, i);
    timed(bare_us, bare, i);
  }
  return fmt::format(R"({{"package_us": {:.0f}, "bare_us": {:.0f}}})", median_us(package_us), median_us(bare_us));
}

int one_pulse(int i) { return i % 2 == 0 ? 1 : -1; }

}  // namespace

int main() {
  const axisgate::Stage stage;
  const axisgate::Axis x = stage["x"];
  Services services(axisgate::client::open_channel(axisgate::client::to_target({})));
  const std::string questions = compared(
      kQuestions, [&](int) { stage.status(); }, [&](int) { bare_get_device(services); });
  const std::string moves = compared(
      kMoves, [&](int i) { x.move_by(axisgate::pulses(one_pulse(i))); },
      [&](int i) { bare_move(services, one_pulse(i)); });
  fmt::print(R"({{"get_device": {}, "move": {}}})"
             "\n",
             questions, moves);
}
