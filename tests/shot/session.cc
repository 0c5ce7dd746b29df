// Parts of the controller besides its motions: the link, readings, stops, and the end.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/core/escape.h"
#include "device/stage/own_questions.h"
#include "tests/shot/controller.h"

namespace axisgate::shot2 {
namespace {

using stage::kGateway;

constexpr Duration kWriteLimit = std::chrono::seconds(30);
constexpr Duration kHandshakePoll = std::chrono::milliseconds(100), kStopPoll = std::chrono::milliseconds(50);
const Scale kScale{{1000, 0}, false};  // 1 um per pulse

}  // namespace

ExchangeRequest Controller::request_of(Command command, Lane lane, const std::string& who) const {
  ExchangeRequest request;
  request.command = std::move(command);
  request.lane = lane;
  request.caller = who;
  request.not_after = tasks_.now() + kWriteLimit;
  return request;
}

// Returns the axes in sets that one letter names.
std::vector<AxisSet> Controller::by_letter(AxisSet axes) const {
  if (axes == AxisSet::first(2)) return {axes};
  std::vector<AxisSet> sets;
  for (const int axis : axes.list()) sets.push_back(AxisSet::of(axis));
  return sets;
}

ExchangeRequest Controller::stop_of(AxisSet axes) const {
  return request_of(model_.make("L:", axes), Lane::stop, kGateway);
}

std::vector<ExchangeRequest> Controller::stops_to_write(std::string_view heard, TimePoint) {
  std::vector<ExchangeRequest> due;
  for (const auto& open : stops_) {
    if (!heard.empty()) continue;
    for (const AxisSet axes : by_letter(open->axes)) due.push_back(stop_of(axes));
  }
  return due;
}

std::optional<Problem> Controller::may_write(const ExchangeRequest& request, TimePoint now) {
  const LivePtr live = find(request.motion);
  if (!live) return Problem{.reason = Reason::stopped, .message = "the motion has ended"};
  const auto good =
      permission_.authorize({live->context.who, live->context.lease, live->motion.axes, live->motion.id}, now);
  if (!good) return good.error();
  live->motion.written = true;
  return {};
}

void Controller::show_link(LinkState link, std::string why) {
  if (state_.link == link && state_.link_problem == why) return;
  state_.link = link;
  state_.link_problem = why;
  emit(LinkChanged{link, std::move(why), state_.controllable(), state_.serial_number});
  emit(StateChanged{});
}

void Controller::line_connected(const Identity& identity, const std::optional<std::string>&, TimePoint) {
  ++connection_;
  show_link(LinkState::connecting, "the line is open");
  tasks_.spawn(shake_hands(identity));
}

Task<void> Controller::shake_hands(Identity identity) {
  if (identity.model != model_.name()) {
    line_.disconnect(fmt::format("{} answers, but {} is configured", escaped(identity.model), model_.name()),
                     tasks_.now());
    co_return;
  }
  state_.vendor = identity.vendor;
  state_.model = identity.model;
  state_.serial_number = identity.serial_number;
  state_.firmware = identity.firmware;
  const std::uint64_t connection = connection_;
  for (;;) {
    const auto good = co_await read(Lane::question, kGateway, true);
    if (connection != connection_) co_return;
    if (!good) {
      line_.disconnect("the handshake failed: " + good.error().message, tasks_.now());
      co_return;
    }
    const auto is_busy = [](const AxisState& axis) { return axis.busy.value_or(false); };
    if (std::ranges::none_of(state_.axes, is_busy)) break;
    auto pause = tasks_.pause(kHandshakePoll);
    co_await pause;
    if (connection != connection_) co_return;
  }
  line_.open(model_.axes(), tasks_.now());
}

void Controller::line_trusted(TimePoint now) {
  for (const int number : model_.axes().list()) {
    state_.axis(number).controllable = true;
    state_.axis(number).scale = kScale;
  }
  if (++state_.device_epoch > 1) permission_.device_restarted(now);
  state_.epoch_began = now;
  ++state_.frame_epoch;
  state_.moving_unknown = false;
  show_link(LinkState::up, "");
  moved_.notify();
}

void Controller::line_lost(const std::string& why, TimePoint) {
  ++connection_;
  for (AxisState& axis : state_.axes) {
    state_.moving_unknown = state_.moving_unknown || axis.busy.value_or(false);
    axis.busy.reset();
    axis.position_pulses.reset();
  }
  show_link(LinkState::down, why);
  for (const LivePtr& live : std::deque<LivePtr>(live_)) {
    const bool wrote = live->motion.written;
    end(live, wrote ? MotionState::unknown : MotionState::failed,
        Problem{.reason = wrote ? Reason::outcome_unknown : Reason::not_sent, .message = "the line was lost: " + why});
  }
}

void Controller::barrier_entered(const std::string& why, TimePoint) {
  emit(BarrierEntered{why});
  show_link(LinkState::doubtful, why);
}

void Controller::barrier_passed(const Identity& identity, TimePoint now) {
  if (identity.serial_number != state_.serial_number) return line_.disconnect("another controller answers", now);
  if (line_.state().trusted()) show_link(LinkState::up, "");
}

// A restart cannot be ruled out here: the unit keeps no setting that a restart would change.
void Controller::restart_suspected(TimePoint now) { line_.disconnect("the controller may have restarted", now); }

void Controller::completion_seen(int axis, bool doubtful, TimePoint) {
  line_.completions().arrived(axis);
  const bool ours = !live_.empty() && live_.front()->motion.axes.has(axis);
  emit(CompletionSeen{.axis = axis, .motion = ours ? live_.front()->motion.id : 0, .deduced = doubtful});
}

Task<Result<void>> Controller::read(Lane lane, std::string who, bool handshake) {
  ExchangeRequest question = request_of(*model_.parse("Q:SPC"), lane, who);
  question.handshake = handshake;
  auto asked = line_.exchange(std::move(question), tasks_.now());
  const ExchangeResult result = co_await asked;
  if (result.problem) co_return tl::unexpected(*result.problem);
  const auto readings = parse_positions(model_, *result.reply, model_.axes());
  if (!readings) co_return fail(Reason::device_refused, "Q:SPC was answered by " + escaped(result.reply->text));
  AxisSet ready, busy;
  for (const int number : model_.axes().list()) {
    const AxisReading& reading = (*readings)[static_cast<std::size_t>(number - 1)];
    state_.axis(number).position_pulses = reading.pulses;
    state_.axis(number).busy = reading.busy;
    (reading.busy ? busy : ready).add(number);
  }
  state_.read = tasks_.now();
  line_.ready(ready, tasks_.now());
  line_.busy(busy, tasks_.now());
  emit(StateChanged{});
  co_return Result<void>();
}

Task<void> Controller::refresh_for(RequestContext context, OnState done) {
  const auto good = co_await read(Lane::question, context.who);
  done(good ? Result<State>(state_) : tl::unexpected(good.error()));
}

Task<void> Controller::poll() {
  for (;;) {
    auto pause = tasks_.pause(profile_.idle_poll);
    co_await pause;
    if (state_.link == LinkState::up && live_.empty()) co_await read(Lane::poll, kGateway);
  }
}

void Controller::stop_axes(AxisSet axes, const std::string& who, OnStopped done) {
  emit(StopRequested{axes, false, who, !live_.empty()});
  for (const LivePtr& live : std::deque<LivePtr>(live_)) {
    if (!live->motion.axes.touches(axes)) continue;
    live->stopped_by = who;
    if (!live->motion.written) {
      end(live, MotionState::stopped, Problem{.reason = Reason::stopped, .message = "stopped by " + who});
    } else if (live->motion.state == MotionState::running) {
      live->motion.state = MotionState::stopping;
      emit(MotionChanged{live->motion});
    }
  }
  const auto open = std::make_shared<OpenStop>(OpenStop{axes, std::move(done)});
  stops_.push_back(open);
  line_.open_at_once(tasks_.now());
  tasks_.spawn(carry_out(open));
}

// Repeats the stop, over connections, until its axes are READY.
Task<void> Controller::carry_out(std::shared_ptr<OpenStop> open) {
  StopReport report;
  for (;;) {
    std::string reply;
    for (const AxisSet axes : by_letter(open->axes)) {
      auto written = line_.exchange(stop_of(axes), tasks_.now());
      const ExchangeResult result = co_await written;
      reply = result.reply ? result.reply->text : "";
    }
    // A stop that is written again and again in a barrier would never let it pass.
    while (!line_.state().trusted()) {
      auto pause = tasks_.pause(kStopPoll);
      co_await pause;
    }
    const auto seen = co_await read(Lane::stop, kGateway);
    const auto stands = [this](int axis) { return !state_.axis(axis).busy.value_or(true); };
    if (seen && std::ranges::all_of(open->axes.list(), stands)) {
      for (const int axis : open->axes.list()) {
        report.axes.push_back({.axis = axis,
                               .wire_reply = reply,
                               .named = true,
                               .ready = true,
                               .position_pulses = state_.axis(axis).position_pulses});
      }
      break;
    }
    auto pause = tasks_.pause(kStopPoll);
    co_await pause;
  }
  std::erase(stops_, open);
  moved_.notify();
  open->done(report);
}

void Controller::carry_out_orders() {
  const use::Orders orders = permission_.advance(tasks_.now());
  for (const StopOrder& order : orders.stops) {
    stop_axes(AxisSet::in(order.scope), order.who,
              [this, id = order.id](const StopReport&) { permission_.stopped(id, tasks_.now()); });
  }
  for (const EndedLease& lease : orders.restoring) permission_.settings_restored(lease.token, tasks_.now());
}

Task<void> Controller::end_all(OnWoundDown done) {
  const TimePoint limit = tasks_.now() + kStopLimit;
  while ((!live_.empty() || !stops_.empty()) && tasks_.now() < limit) {
    auto moved = moved_.wait_until(limit);
    co_await moved;
  }
  done({motions(), {}});
}

}  // namespace axisgate::shot2
