#include "clients/cpp/src/connection.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "clients/cpp/src/channel.h"
#include "clients/cpp/src/identity.h"

namespace axisgate::client {
namespace {

using google::protobuf::util::TimeUtil;
using std::chrono::duration_cast;
using std::chrono::system_clock;

constexpr milliseconds kConnectionPoll{100};

// Returns by how much the daemon's clock is ahead of this machine's, just after the devices were listed.
system_clock::duration clock_ahead(const v1::ListDevicesResponse& listed) {
  if (!listed.has_time()) return {};
  const auto daemon = system_clock::time_point(milliseconds(TimeUtil::TimestampToMilliseconds(listed.time())));
  return daemon - system_clock::now();
}

// Waits for `time` or until `stop`.
void sleep_until_stop(milliseconds time, const std::stop_token& stop) {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any().wait_for(lock, stop, time, [] { return false; });
}

}  // namespace

Connection::Connection(const ConnectOptions& options)
    : target_(to_target(options)),
      half_(options.timeout / 2),
      log_(options.log),
      stop_services_(open_channel(target_)),
      services(open_channel(target_)) {}

v1::ListDevicesResponse Connection::open() {
  Repeat repeat({.until = Clock::now(), .target = target_.address, .answer = half_});
  v1::ListDevicesResponse listed = send(stop_services_, repeat, stop_services_.devices,
                                        &v1::DeviceService::Stub::ListDevices, v1::ListDevicesRequest());
  if (listed.version() != AXISGATE_VERSION) {
    log(fmt::format("this package has version {}, and the daemon {}", AXISGATE_VERSION, listed.version()));
  }
  return listed;
}

Connection::Action Connection::new_action(const std::string& lease_token, milliseconds patience) {
  const v1::ListDevicesResponse listed = list();
  patience += half_;
  const system_clock::time_point not_after =
      system_clock::now() + patience + (is_local(target_.address) ? system_clock::duration() : clock_ahead(listed));
  Action action{{},
                Repeat({.until = Clock::now() + patience,
                        .target = target_.address,
                        .answer = half_,
                        .acts = true,
                        .remembered = listed.requests_kept()})};
  action.context.set_request_id(new_uuid());
  action.context.set_lease_token(lease_token);
  if (listed.requests_kept()) action.context.set_request_memory(listed.request_memory());
  *action.context.mutable_not_after() =
      TimeUtil::MillisecondsToTimestamp(duration_cast<milliseconds>(not_after.time_since_epoch()).count());
  return action;
}

void Connection::send(Services& over, Repeat& repeat, std::string_view name, const Once& once) {
  while (true) {
    const Clock::time_point now = Clock::now();
    grpc::ClientContext context;
    context.set_deadline(system_clock::now() + repeat.limit(now));
    const grpc::Status status = once(context);
    log(fmt::format("{} {} {:.1f} ms", name, status.ok() ? "OK" : status.error_message(),
                    std::chrono::duration<double, std::milli>(Clock::now() - now).count()));
    if (status.ok()) return;
    const Failure failure(status);
    pause(over, failure, repeat.pause_after(failure, Clock::now()));
  }
}

void Connection::pause(Services& over, const Failure& failure, milliseconds pause, const std::stop_token& stop) {
  if (!failure.never_sent()) return sleep_until_stop(pause, stop);
  // gRPC connects only while something waits for the connection.
  const auto end = system_clock::now() + pause;
  while (!stop.stop_requested() && system_clock::now() < end &&
         !over.channel->WaitForConnected(std::min(end, system_clock::now() + kConnectionPoll))) {
  }
}

v1::Motion Connection::follow(v1::Motion motion, Clock::time_point end, std::stop_token stop) {
  Following following(std::move(motion), target_.address, Clock::now());
  while (!following.over()) {
    if (stop.stop_requested()) throw Interrupted(following.motion().name() + " has no outcome yet");
    const auto left =
        end == Clock::time_point::max() ? milliseconds::max() : duration_cast<milliseconds>(end - Clock::now());
    const v1::WaitMotionRequest question = following.question(left);
    grpc::ClientContext context;
    context.set_deadline(system_clock::now() + Following::limit(question));
    const std::stop_callback cancel(stop, [&] { context.TryCancel(); });
    v1::WaitMotionResponse answer;
    const grpc::Status status = services.stage.WaitMotion(&context, question, &answer);
    if (status.ok()) {
      following.take(answer.motion(), Clock::now());
    } else if (!stop.stop_requested()) {
      const Failure failure(status);
      const milliseconds wait = following.pause_after(failure, Clock::now());
      pause(services, failure, std::min(wait, std::max(left, milliseconds(0))), stop);
    }
    if (left <= milliseconds(0)) break;
  }
  return following.motion();
}

void Connection::log(std::string_view line) const {
  if (log_) log_(line);
}

}  // namespace axisgate::client
