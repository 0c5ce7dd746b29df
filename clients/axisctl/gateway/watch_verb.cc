// watch: prints every event exactly once, even if the connection breaks in between.
#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"
#include "clients/cpp/src/failure.h"

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

  // Watches forever. Throws Failure if the daemon does not answer at the start, or for an error that another attempt
  // cannot fix. If the daemon stops later, waits until it is back.
  [[noreturn]] void run() {
    session_.connection.call(session_.connection.devices, &v1::DeviceService::Stub::ListDevices,
                             v1::ListDevicesRequest(), kQuestionLimit);
    while (true) recover(watch_once());
  }

 private:
  // Watches until the stream breaks, and returns its status.
  grpc::Status watch_once() {
    grpc::ClientContext context;
    context.set_wait_for_ready(true);  // after a break the call waits until the daemon is back
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

  // Prints the reason for the break. An ending daemon sends a problem; a killed daemon does not.
  void tell_of_break(const v1::Problem& problem) const {
    Failure failure{kUnavailable, "UNAVAILABLE", "the connection to the daemon was lost", "trying again"};
    if (problem.reason() != v1::REASON_UNSPECIFIED) {
      failure.reason = client::reason_name(problem.reason());
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
    // If the first request asks for events that are gone, the caller decides how to continue. A later loss, because the
    // watcher was too slow or the daemon restarted, is only reported.
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

int watch(const Session& session) { Watcher(session).run(); }

void watch_options(CLI::App& verb, Options& options) {
  verb.add_option("--from", options.from_revision, "the first event wanted (default: the next one)")
      ->type_name("REVISION");
}

constexpr Verb kWatchVerbs[] = {
    {.words = "watch",
     .heading = Heading::looking,
     .description = "print every event (motions, stops, errors), each with its revision: its number",
     .examples = "axisctl watch --from 1   # all events from number 1 on, until Ctrl-C",
     .add_options = watch_options,
     .run = watch},
};

}  // namespace

std::span<const Verb> watch_verbs() { return kWatchVerbs; }

}  // namespace axisgate::axisctl
