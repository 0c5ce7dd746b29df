// watch: every event, each once, also across a broken connection.
#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

constexpr std::chrono::milliseconds kBackoffFirst{250};
constexpr std::chrono::milliseconds kBackoffMost{5000};

class Watcher {
 public:
  explicit Watcher(const Session& session) : session_(session), backoff_(kBackoffFirst) {
    request_.set_device(session.options.device);
    if (session.options.from_revision) request_.set_from_revision(*session.options.from_revision);
  }

  // Returns only by a Failure that trying again would not fix. It is first checked that the daemon is there at all. If
  // the daemon stops later, it waits for it.
  [[noreturn]] void run() {
    session_.connection.call(session_.connection.devices, &v1::DeviceService::Stub::ListDevices,
                             v1::ListDevicesRequest(), kQuestionLimit);
    while (true) recover(watch_once());
  }

 private:
  // Until the stream breaks; its status.
  grpc::Status watch_once() {
    grpc::ClientContext context;
    context.set_wait_for_ready(true);  // after a break the call waits for the daemon to come back
    const auto reader = session_.connection.events->Watch(&context, request_);
    v1::WatchResponse response;
    while (reader->Read(&response)) {
      show(response.event());
      request_.set_from_revision(response.event().revision() + 1);
      request_.set_run(response.event().run());
      seen_any_ = true;
      backoff_ = kBackoffFirst;
    }
    return reader->Finish();
  }

  void show(const v1::Event& event) const {
    if (session_.options.json) return print_json(event);
    const std::string_view whose = event.device().empty() ? "daemon" : last_part(event.device());
    print_line(fmt::format("{} {} {} {}", event.revision(), google::protobuf::util::TimeUtil::ToString(event.time()),
                           whose, describe(event)));
  }

  void recover(const grpc::Status& status) {
    const v1::Problem problem = problem_of(status);
    if (problem.reason() == v1::REASON_COMPACTED) return skip_what_is_gone(problem);
    if (status.error_code() != grpc::StatusCode::UNAVAILABLE) session_.connection.check(status);
    if (backoff_ == kBackoffFirst) tell_of_break(problem);
    std::this_thread::sleep_for(backoff_);
    backoff_ = std::min(backoff_ * 2, kBackoffMost);
  }

  // A daemon that is ending says so; a daemon that was killed sends no problem.
  void tell_of_break(const v1::Problem& problem) const {
    Failure failure{kUnavailable, "UNAVAILABLE", "the connection to the daemon was lost", "trying again"};
    if (problem.reason() != v1::REASON_UNSPECIFIED) {
      failure.reason = short_name(problem.reason());
      failure.message = problem.message();
    }
    if (request_.has_from_revision())
      failure.hint = fmt::format("trying again from revision {}", request_.from_revision());
    print_failure(failure);
  }

  void skip_what_is_gone(const v1::Problem& problem) {
    const auto found = problem.metadata().find("resume_revision");
    const std::string text = found == problem.metadata().end() ? "" : found->second;
    std::uint64_t resume = 0;
    if (std::from_chars(text.data(), text.data() + text.size(), resume).ec != std::errc()) throw to_failure(problem);
    // A caller that requested lost events decides how to continue. A watcher that was too slow, or outlived a daemon,
    // is notified and continues.
    if (!seen_any_) throw Failure{kRefused, "COMPACTED", problem.message(), fmt::format("use --from {}", resume)};
    print_failure({kRefused, "COMPACTED", problem.message(), fmt::format("continuing from revision {}", resume)});
    request_.set_from_revision(resume);
    request_.clear_run();
  }

  const Session& session_;
  v1::WatchRequest request_;
  std::chrono::milliseconds backoff_;
  bool seen_any_ = false;
};

}  // namespace

int watch(const Session& session) { Watcher(session).run(); }

}  // namespace axisgate::axisctl
