// axisgate-paced-load: a path over a real line while sixteen clients request the status without a pause, and sixteen
// more each repeat a different question. Prints the result for tests/integration/paced_path_test.py.
#include <fmt/format.h>
#include <grpcpp/grpcpp.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "axisgate/v1/command.grpc.pb.h"
#include "axisgate/v1/device.grpc.pb.h"
#include "axisgate/v1/stage.grpc.pb.h"
#include "device/link/clock.h"
#include "tests/paced/track.h"

namespace axisgate::paced {
namespace {

constexpr const char* kDevice = "devices/stage";

// Opens a separate connection, like another program on the machine.
std::shared_ptr<grpc::Channel> connect(const std::string& target) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel(target, grpc::InsecureChannelCredentials(), arguments);
}

// Clients of one kind, each on its own thread.
class Clients {
 public:
  using Channel = std::shared_ptr<grpc::Channel>;
  using Ask = std::function<grpc::Status(const Channel& channel, std::size_t client)>;

  Clients(std::string name, const std::string& target, Ask ask) : name_(std::move(name)), ask_(std::move(ask)) {
    for (std::size_t client = 0; client < kCallers; ++client) {
      threads_.emplace_back([this, target, client] { ask_on(connect(target), client); });
    }
  }
  ~Clients() {
    ending_ = true;
    for (auto& thread : threads_) thread.join();
    fmt::print("{}: answered {}, failed {}, longest {} ms{}\n", name_, answered_, failed_, longest_.count(), first_);
  }
  Clients(const Clients&) = delete;
  Clients& operator=(const Clients&) = delete;

 private:
  void ask_on(const Channel& channel, std::size_t client) {
    while (!ending_) {
      const auto asked = monotonic_now();
      const grpc::Status status = ask_(channel, client);
      const std::lock_guard lock(mutex_);
      longest_ = std::max(longest_, std::chrono::duration_cast<std::chrono::milliseconds>(monotonic_now() - asked));
      ++(status.ok() ? answered_ : failed_);
      if (!status.ok() && first_.empty()) first_ = "; first: " + status.error_message();
    }
  }

  const std::string name_;
  const Ask ask_;
  std::atomic<bool> ending_ = false;
  std::mutex mutex_;
  int answered_ = 0, failed_ = 0;
  std::chrono::milliseconds longest_{};
  std::string first_;
  std::vector<std::thread> threads_;
};

grpc::Status ask_for_status(const Clients::Channel& channel, std::size_t) {
  v1::GetDeviceRequest request;
  request.set_device(kDevice);
  request.mutable_max_age();  // 0: read now, as axisctl status does
  v1::GetDeviceResponse response;
  grpc::ClientContext context;
  return v1::DeviceService::NewStub(channel)->GetDevice(&context, request, &response);
}

grpc::Status ask_own_question(const Clients::Channel& channel, std::size_t client) {
  v1::ExecuteRequest request;
  request.set_device(kDevice);
  request.add_lines(std::string(kOwnQuestions[client]));
  grpc::ClientContext context;
  const auto stream = v1::CommandService::NewStub(channel)->Execute(&context, request);
  v1::ExecuteResponse response;
  while (stream->Read(&response)) {
  }
  return stream->Finish();
}

void add_way(v1::Line& line, int axis, std::int64_t way) {
  v1::AxisDistance& distance = *line.add_distances();
  distance.set_axis(std::to_string(axis));
  distance.mutable_distance()->set_pulses(way);
}

bool run_path(const std::string& target, int segments, std::chrono::milliseconds each) {
  grpc::ClientContext context;
  const auto stage = v1::StageService::NewStub(connect(target));
  const auto stream = stage->RunPath(&context);
  v1::RunPathRequest request;
  request.mutable_header()->set_device(kDevice);
  bool open = stream->Write(request);
  const Track track{each};
  for (int i = 0; open && i < segments; ++i) {
    v1::Segment& segment = *request.mutable_segment();
    segment.Clear();
    segment.set_relative(true);
    segment.mutable_speed()->set_pulses_per_s(Track::kSpeed);
    add_way(*segment.mutable_line(), 1, track.way(i)[0]);
    add_way(*segment.mutable_line(), 2, track.way(i)[1]);
    open = stream->Write(request);
  }
  stream->WritesDone();
  int chained = 0;
  v1::Motion motion;
  v1::RunPathResponse response;
  while (stream->Read(&response)) {
    if (response.has_motion()) motion = response.motion();
    chained += response.progress().wire_reply() == "OK_D" ? 1 : 0;
  }
  const grpc::Status status = stream->Finish();
  if (!status.ok()) {
    fmt::print("path: {}\n", status.error_message());
    return false;
  }
  const auto took = motion.end_time().seconds() - motion.start_time().seconds();
  fmt::print("path: {}, segments {}, chained {}, underruns {}, took {} s, due at {} {}\n",
             v1::MotionState_Name(motion.state()), motion.segments_done(), chained, motion.underruns(), took,
             track.end(segments)[0], track.end(segments)[1]);
  return true;
}

int main_program(int count, char** words) {
  CLI::App program("Runs a path while clients ask without a pause.", "axisgate-paced-load");
  std::string target;
  int segments = 300, each_ms = 60;
  program.add_option("--target", target, "unix:PATH or HOST:PORT of the daemon")->required();
  program.add_option("--segments", segments, "Segments of the path")->check(CLI::Range(1, 100'000));
  program.add_option("--milliseconds", each_ms, "What each lasts")->check(CLI::Range(1, 10'000));
  CLI11_PARSE(program, count, words);
  const Clients status("status", target, ask_for_status);
  const Clients questions("questions", target, ask_own_question);
  return run_path(target, segments, std::chrono::milliseconds(each_ms)) ? 0 : 1;
}

}  // namespace
}  // namespace axisgate::paced

int main(int count, char** words) { return axisgate::paced::main_program(count, words); }
