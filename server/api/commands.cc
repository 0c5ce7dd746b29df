#include "server/api/commands.h"

#include <fmt/format.h>

#include <chrono>
#include <deque>
#include <utility>

#include "device/link/clock.h"
#include "server/api/audit.h"
#include "server/api/names.h"
#include "server/api/request_texts.h"

namespace axisgate::api {
namespace {

using stage::ExecuteEvent;

constexpr std::size_t kLinesMax = 100;
constexpr std::size_t kLineBytesMax = 256;
constexpr Duration kTimeout = std::chrono::seconds(20);
constexpr Duration kTimeoutMax = std::chrono::minutes(10);

// What the controller says itself as the time runs out is more exact than that it has run out.
constexpr Duration kTimeoutGrace = std::chrono::milliseconds(100);

// What only this subject bounds; the lines themselves are the controller's to judge.
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
  if (timeout > Duration::zero() && timeout <= kTimeoutMax) return {};
  return fail(Reason::out_of_range, "timeout is not above 0 and at most 10 minutes");
}

Problem timed_out(Duration timeout) {
  return {.reason = Reason::deadline_passed,
          .message = fmt::format("not all replies and completions came within {} s",
                                 std::chrono::duration_cast<std::chrono::duration<double>>(timeout).count()),
          .hint = "what moves continues: WatchDevice shows it, Stop ends it"};
}

// One transaction under way.
class Execution final : public Subscription<ExecuteEvent> {
 public:
  Execution(server::Gateway& gateway, server::Stage& device, stage::ExecuteRequest request, Duration timeout,
            Streams::Place place)
      : Subscription(std::move(place)),
        gateway_(gateway),
        device_(device),
        request_(std::move(request)),
        timeout_(timeout) {}

 private:
  void begin() override {
    device_.post([self = self<Execution>()](stage::StageController& controller, TimePoint now) {
      audit(RequestKind::execute, self->device_, self->request_.context, text_of("execute", self->request_.lines));
      controller.execute(std::move(self->request_), now, [self](const ExecuteEvent& event) { self->on_event(event); });
    });
    time_out_ = gateway_.timeouts().unless_dropped(timeout_ + kTimeoutGrace, [waiting = weak_from_this(), this] {
      if (const auto still = waiting.lock()) end(timed_out(timeout_));
    });
  }

  void on_event(const ExecuteEvent& event) {
    if (event.kind == ExecuteEvent::Kind::ended) return end(event.problem);
    {
      const std::lock_guard lock(mutex_);
      due_.push_back(event);
    }
    wake();
  }

  // The first end counts.
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
  server::Stage& device_;
  stage::ExecuteRequest request_;  // on the device's strand
  const Duration timeout_;
  // Bounded by the transaction: a reply for each of its lines and a completion for each axis they move.
  std::deque<ExecuteEvent> due_;
  std::optional<StreamEnd> end_;  // after what is due
  std::unique_ptr<server::Timeout> time_out_;
};

}  // namespace

Result<std::vector<stage::CommandInfo>> Commands::list(const Call& call, std::string_view device) const {
  const auto admitted = pipeline_.admit({RequestKind::list_commands, call, find_stage(gateway_, device)});
  if (!admitted) return tl::unexpected(admitted.error());
  return admitted->device->kind().commands();
}

// Every such line is refused before any is sent.
Result<void> Commands::check(const Transaction& transaction, const server::Caller& caller) const {
  if (const auto good = check_lines(transaction.lines); !good) return good;
  for (const std::string& line : transaction.lines) {
    if (const auto allowed = check_line(access_, line, caller); !allowed) return allowed;
  }
  return check_timeout(transaction.timeout.value_or(kTimeout));
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
  const Duration timeout = transaction.timeout.value_or(kTimeout);
  if (!call.not_after) admitted->context.not_after = monotonic_now() + timeout;
  Result<Streams::Place> place = streams_.take(RequestKind::execute, admitted->caller.who);
  if (!place) return tl::unexpected(place.error());
  return std::make_shared<Execution>(gateway_, *admitted->device,
                                     stage::ExecuteRequest{std::move(transaction.lines), std::move(admitted->context)},
                                     timeout, *std::move(place));
}

}  // namespace axisgate::api
