#include "server/api/stage/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <utility>

#include "device/link/clock.h"
#include "server/api/request/audit.h"
#include "server/api/request/names.h"
#include "server/api/request/request_texts.h"
#include "server/journal/answers.h"
#include "server/limits.h"

namespace axisgate::api {
namespace {

using stage::ExecuteEvent;

constexpr std::size_t kLinesMax = 100;
constexpr std::size_t kLineBytesMax = 256;

// Checks only the limits of this subject; the controller checks the lines themselves.
Result<void> check_lines(const std::vector<std::string>& lines) {
  if (lines.empty() || lines.size() > kLinesMax) {
    return fail(Reason::invalid_request,
                fmt::format("a transaction has 1 to {} lines, not {}", kLinesMax, lines.size()));
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].size() > kLineBytesMax) {
      return fail(Reason::malformed_line, fmt::format("line {} is longer than {} characters", i + 1, kLineBytesMax));
    }
  }
  return {};
}

Result<void> check_timeout(Duration timeout) {
  if (timeout > Duration::zero() && timeout <= server::kExecuteLimitMax) return {};
  return fail(Reason::out_of_range, "timeout is not above 0 and at most 10 minutes");
}

Problem timed_out(Duration timeout) {
  return {.reason = Reason::deadline_passed,
          .message = fmt::format("not all replies and completions came within {} s",
                                 std::chrono::duration_cast<std::chrono::duration<double>>(timeout).count()),
          .hint = "what moves continues: WatchDevice shows it, Stop ends it"};
}

// An Execution is one transaction in progress.
class Execution final : public Subscription<ExecuteEvent> {
 public:
  Execution(server::Gateway& gateway, const Pipeline& pipeline, Call call, const Admitted& admitted,
            Transaction transaction, Streams::Place place)
      : Subscription(std::move(place)),
        gateway_(gateway),
        pipeline_(pipeline),
        call_(std::move(call)),
        device_(*admitted.device),
        request_{std::move(transaction.lines), admitted.context},
        timeout_(transaction.timeout.value_or(server::kRequestLimit)) {}

 private:
  void begin() override {
    if (device_.kind().changes_something(request_.lines)) {
      change();
    } else {
      device_.post([self = self<Execution>()](stage::StageController& controller, TimePoint now) {
        audit(RequestKind::execute, self->device_, self->request_.context, text_of("execute", self->request_.lines));
        self->execute(controller, now, nullptr);
      });
    }
    time_out_ =
        gateway_.timeouts().unless_dropped(timeout_ + server::kExecuteGrace, [waiting = weak_from_this(), this] {
          if (const auto still = waiting.lock()) end(timed_out(timeout_));
        });
  }

  void change() {
    pipeline_.act(
        {RequestKind::execute, call_, &device_},
        [self = self<Execution>()](const Turn&) -> Result<std::string> {
          return text_of("execute", self->request_.lines);
        },
        [self = self<Execution>()](const Turn& turn, const MutationPtr& mutation) {
          self->execute(turn.controller, turn.now, mutation);
        },
        [self = self<Execution>()](const Problem& problem) { self->end(problem); },
        [self = self<Execution>()](server::Stage&, const Result<Known>& known) { self->repeat(known); });
  }

  void execute(stage::StageController& controller, TimePoint now, const std::shared_ptr<Mutation>& mutation) {
    controller.execute(std::move(request_), now, [self = self<Execution>(), mutation](const ExecuteEvent& event) {
      if (mutation) self->remember(event, *mutation);
      self->on_event(event);
    });
  }

  // Runs on the strand. If no line was answered, possibly none was sent.
  void remember(const ExecuteEvent& event, Mutation& mutation) {
    events_.push_back(event);
    if (event.kind != ExecuteEvent::Kind::ended) return;
    const bool answered =
        std::ranges::any_of(events_, [](const ExecuteEvent& one) { return one.kind == ExecuteEvent::Kind::reply; });
    event.problem && !answered ? mutation.failed(*event.problem) : mutation.acted(server::journal::answer_of(events_));
  }

  void repeat(const Result<Known>& known) {
    if (!known) return end(known.error());
    if (const auto problem = server::journal::problem_in(known->answer)) return end(problem);
    for (const ExecuteEvent& event : server::journal::events_in(known->answer)) on_event(event);
  }

  void on_event(const ExecuteEvent& event) {
    if (event.kind == ExecuteEvent::Kind::ended) return end(event.problem);
    {
      const std::lock_guard lock(mutex_);
      due_.push_back(event);
    }
    wake();
  }

  // Only the first end counts.
  void end(const std::optional<Problem>& problem) {
    {
      const std::lock_guard lock(mutex_);
      if (!end_) end_ = StreamEnd{problem};
    }
    wake();
  }

  Reading read() override {
    if (!due_.empty()) {
      ExecuteEvent event = std::move(due_.front());
      due_.pop_front();
      return event;
    }
    if (end_) return *end_;
    return Nothing{};
  }

  void left() override { time_out_.reset(); }

  server::Gateway& gateway_;
  const Pipeline& pipeline_;
  const Call call_;
  server::Stage& device_;
  stage::ExecuteRequest request_;     // on the device's strand
  std::vector<ExecuteEvent> events_;  // on the device's strand
  const Duration timeout_;
  // Bounded by the transaction: one reply for each line, and one completion for each axis that the lines move.
  std::deque<ExecuteEvent> due_;
  std::optional<StreamEnd> end_;  // delivered after due_
  std::unique_ptr<server::Timeout> time_out_;
};

}  // namespace

Result<std::vector<stage::CommandInfo>> Commands::list(const Call& call, std::string_view device) const {
  const auto admitted = pipeline_.admit({RequestKind::list_commands, call, find_stage(gateway_, device)});
  if (!admitted) return tl::unexpected(admitted.error());
  return admitted->device->kind().commands();
}

// Refuses the whole transaction for one forbidden line, before any line is sent.
Result<void> Commands::check(const Transaction& transaction, const server::Caller& caller) const {
  if (const auto good = check_lines(transaction.lines); !good) return good;
  for (const std::string& line : transaction.lines) {
    if (const auto allowed = check_line(access_, line, caller); !allowed) return allowed;
  }
  return check_timeout(transaction.timeout.value_or(server::kRequestLimit));
}

Opened<ExecuteEvent> Commands::execute(const Call& call, std::string_view device, Transaction transaction) const {
  Result<Admitted> admitted = pipeline_.admit({RequestKind::execute, call, find_stage(gateway_, device)});
  if (!admitted) return tl::unexpected(admitted.error());
  if (const auto good = check(transaction, admitted->caller); !good) return tl::unexpected(good.error());
  if (call.validate_only) {
    const Result<void> checked = admitted->device->kind().check_lines(transaction.lines);
    if (!checked) return tl::unexpected(checked.error());
    return nullptr;
  }
  if (!call.not_after)
    admitted->context.not_after = monotonic_now() + transaction.timeout.value_or(server::kRequestLimit);
  Result<Streams::Place> place = streams_.take(RequestKind::execute, admitted->caller.who);
  if (!place) return tl::unexpected(place.error());
  return std::make_shared<Execution>(gateway_, pipeline_, call, *admitted, std::move(transaction), *std::move(place));
}

}  // namespace axisgate::api
