// jog: runs axes until Ctrl-C, or for a number of seconds.
#include <fmt/format.h>
#include <semaphore.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/interrupt.h"
#include "clients/axisctl/outcome.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

using Clock = std::chrono::steady_clock;
using JogStream = grpc::ClientReaderWriter<v1::JogRequest, v1::JogResponse>;

// Interval of the renewals. The daemon stops the axes after 500 ms without a renewal.
constexpr std::chrono::milliseconds kRenewEvery{100};

sem_t jog_ended;  // posted by a signal, or when the call is over

void end_jog(int) { sem_post(&jog_ended); }

timespec to_timespec(Clock::time_point time) {
  const auto since = time.time_since_epoch();
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since);
  timespec result{};
  result.tv_sec = static_cast<std::time_t>(seconds.count());
  result.tv_nsec = static_cast<long>(std::chrono::nanoseconds(since - seconds).count());
  return result;
}

// Renewals keeps the axes running from a separate thread, because a terminal that blocks output must not stop them.
// Ctrl-C, SIGTERM and SIGHUP close this side of the call; the daemon then stops the axes in order. Only one object may
// exist at a time.
class Renewals {
 public:
  explicit Renewals(JogStream& stream) : stream_(stream) {
    sem_init(&jog_ended, 0, 0);
    // A second signal ends axisctl, in case the daemon does not answer the first. SA_RESTART prevents half-printed
    // lines.
    on_end_signals(end_jog, static_cast<int>(SA_RESETHAND | SA_RESTART));
    renewer_ = std::thread([this] { renew(); });
  }

  ~Renewals() {
    sem_post(&jog_ended);
    renewer_.join();
  }

  void end_at(Clock::time_point time) { end_ = time; }

 private:
  void renew() {
    const v1::JogRequest run_on;
    Clock::time_point next = Clock::now();
    do {
      // A process that was halted does not send the renewals that it missed.
      next = std::max(next + kRenewEvery, Clock::now());
      if (ends_before(next)) {
        stream_.WritesDone();
        return;
      }
    } while (stream_.Write(run_on));
  }

  bool ends_before(Clock::time_point next) {
    const Clock::time_point end = end_;
    const timespec limit = to_timespec(std::min(next, end));
    while (sem_clockwait(&jog_ended, CLOCK_MONOTONIC, &limit) != 0) {
      if (errno != EINTR) return end <= next;
    }
    return true;
  }

  JogStream& stream_;
  std::atomic<Clock::time_point> end_ = Clock::time_point::max();
  std::thread renewer_;
};

v1::JogRequest make_request(const Options& options, const v1::CallContext& context, const v1::Device& device) {
  v1::JogRequest request;
  *request.mutable_context() = context;
  request.set_device(device.name());
  for (const std::string& place : options.places) {
    v1::AxisJog& one = *request.add_axes() = parse_direction(device, place);
    if (options.speed.empty()) continue;
    *one.mutable_speed() = parse_speed_for(find_axis(device, one.axis()), options.speed);
  }
  return request;
}

// Prints the Ctrl-C note only at a terminal: a program that started axisctl knows how to end it.
void say_how_it_ends(const v1::Device& device, const v1::JogRequest& request) {
  if (::isatty(STDIN_FILENO) != 1) return;
  std::vector<std::string> axes;
  for (const v1::AxisJog& one : request.axes()) {
    const std::string& name = find_axis(device, one.axis()).name();
    axes.push_back(fmt::format("axis {}{} {}", one.axis(), name.empty() ? "" : fmt::format(" ({})", name),
                               one.direction() == v1::AxisJog::DIRECTION_MINUS ? '-' : '+'));
  }
  print_note(fmt::format("jogging {}; Ctrl-C stops {}", fmt::join(axes, ", "), axes.size() == 1 ? "it" : "them"));
}

// Runs the jog to its outcome, or to the end of the call. The result has no name if the jog did not begin.
v1::Motion run(const Session& session, const v1::Device& device, const v1::JogRequest& request, JogStream& stream,
               MotionFollower& follower) {
  v1::Motion motion;
  stream.Write(request);  // if this fails, Read() fails too, and the status has the reason
  Renewals renewals(stream);
  v1::JogResponse response;
  while (stream.Read(&response)) {
    if (motion.name().empty()) {
      if (session.options.seconds) renewals.end_at(Clock::now() + std::chrono::seconds(*session.options.seconds));
      say_how_it_ends(device, request);
      follower.follow(response.motion().name());
    }
    motion = response.motion();
  }
  return motion;
}

int jog(const Session& session) {
  const v1::Device device = chosen_device(session);
  const v1::JogRequest request = make_request(session.options, session.connection.new_call_context(), device);
  MotionFollower follower(session, device);
  grpc::ClientContext context;
  const auto stream = session.connection.stage->Jog(&context);
  v1::Motion motion = run(session, device, request, *stream, follower);
  if (motion.name().empty()) {
    session.connection.check(stream->Finish());
    throw Failure{kFailed, "INTERNAL", "the daemon ended the call without starting the jog", "see its log"};
  }
  // The status is not needed if the outcome is known. Otherwise the daemon may still answer a question for the outcome.
  if (motion.state() < v1::MOTION_STATE_SUCCEEDED) motion = await_outcome(session, motion.name());
  follower.finish();
  return report_outcome(session, device, motion);
}

void jog_options(CLI::App& verb, Options& options) {
  verb.add_option("AXIS=DIRECTION", options.places, "direction of each axis, e.g. 1=+ 2=-")->required()->type_name("");
  verb.add_option("--speed", options.speed, "e.g. 1mm/s (default: the minimum speed of the axis)")->type_name("SPEED");
  verb.add_option("--seconds", options.seconds, "stop the axes after S seconds")
      ->check(CLI::Range(1, 1'000'000))
      ->type_name("S");
}

constexpr Verb kJogVerbs[] = {
    {.words = "jog",
     .heading = Heading::moving,
     .description = "move axes until Ctrl-C, which stops them",
     .help = "Ctrl-C stops the axes. So does the daemon when axisctl is killed or cut off.",
     .examples = "axisctl jog 1=- --speed 200um/s --seconds 1",
     .add_options = jog_options,
     .run = jog,
     .waits = true},
};

}  // namespace

std::span<const Verb> jog_verbs() { return kJogVerbs; }

}  // namespace axisgate::axisctl
