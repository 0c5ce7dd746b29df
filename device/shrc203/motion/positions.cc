// To a position that the controller keeps by number: a place, PIT:, or coordinates, PAV: (manual 127) to 136)).
#include <fmt/format.h>

#include <map>
#include <utility>

#include "device/shrc203/controller_impl.h"
#include "device/shrc203/planning/forecast.h"

namespace axisgate::shrc203 {
namespace {

constexpr int kNumbers = 20;

using Coordinates = std::map<int, std::int64_t>;  // by axis

commands::Saved kind_of(const GoToPositionRequest& request) {
  return request.place ? commands::Saved::place : commands::Saved::coordinates;
}

Command question_of(const GoToPositionRequest& request) {
  return commands::ask_saved(kind_of(request), std::to_string(request.number));
}

std::string label(const GoToPositionRequest& request) {
  return fmt::format("number {} of its {}", request.number, request.place ? "places (PIT:)" : "coordinates (PAV:)");
}

std::string in_words(const Coordinates& coordinates) {
  std::string text;
  for (const auto& [axis, pulses] : coordinates) text += fmt::format("{}{}", text.empty() ? "" : ",", pulses);
  return text;
}

// Manual 128), 130): a place is gone after a reset; and a number is anybody's who sends PIT:SET.
Result<void> as_expected(const GoToPositionRequest& request, const Coordinates& told) {
  if (!told.empty() && (request.expected.empty() || told == request.expected)) return {};
  Problem problem{.reason = Reason::epoch_passed, .sent = question_of(request).line};
  if (told.empty()) {
    problem.message = fmt::format("the controller holds nothing under {}", label(request));
    problem.hint = "save the position again";
    problem.wire_reply = "NG";
  } else {
    problem.message = fmt::format("the controller tells {} of {}, and not {}", in_words(told), label(request),
                                  in_words(request.expected));
    problem.hint = "somebody may have saved another position there, or set coordinates anew: save the position again";
    problem.wire_reply = in_words(told);
  }
  return tl::unexpected(std::move(problem));
}

// Their speeds are not looked at: the axes are slowed down where they would be too fast.
Result<Positions> within(const Envelope& envelope, const State& state, const Coordinates& coordinates) {
  Positions place{};
  for (const auto& [axis, pulses] : coordinates) place[static_cast<std::size_t>(axis - 1)] = pulses;
  Forecast forecast(envelope, positions_of(state), {}, state.controllable());
  if (const auto good = forecast.go_to(place); !good) return tl::unexpected(good.error());
  return place;
}

}  // namespace

Task<Result<Coordinates>> Controller::Impl::ask_for_position(LiveMotionPtr live, Command question) {
  const auto answer = co_await ask_twice(std::move(live), std::move(question));
  if (!answer) co_return tl::unexpected(answer.error());
  Coordinates told;
  if (answer->kind != Reply::Kind::data) co_return told;
  for (const auto& [axis, pulses] : by_axis(*answer, state_.controllable())) told[axis] = *parse_integer(pulses);
  co_return told;
}

void Controller::Impl::go_to_position(GoToPositionRequest request, OnStarted started) {
  const AxisSet axes = state_.controllable();
  if (axes.empty()) {
    return started(fail(Reason::link_down, "the device is not up: " + state_.link_problem, "see `axisctl status`"));
  }
  if (request.number < 1 || request.number > kNumbers) {
    return started(fail(Reason::out_of_range, fmt::format("positions are numbered 1 to {}", kNumbers)));
  }
  if (const auto near = within(envelope(request.context), state_, request.expected); !near) {
    return started(tl::unexpected(near.error()));
  }
  // Which axes need not move is the controller's business: it is one command for all.
  if (const auto allowed = may_use(request.context, AxisSet::all()); !allowed) {
    return started(tl::unexpected(allowed.error()));
  }
  auto live = create_motion(MotionKind::move, axes, request.context, std::move(started));
  live->uses = AxisSet::all();
  executor_.spawn(run_to_position(live, std::move(request)));
}

// What the controller holds is what counts, so it is asked at the motion's turn, when nobody else can change it.
Task<Result<void>> Controller::Impl::find_position(LiveMotionPtr live, GoToPositionRequest request) {
  const auto told = co_await ask_for_position(live, question_of(request));
  if (!told) co_return tl::unexpected(told.error());
  if (told->empty()) {
    const auto why = co_await explain_refused_question(question_of(request), live->context.who);
    if (why) co_return tl::unexpected(*why);
  }
  if (const auto good = as_expected(request, *told); !good) co_return good;
  const auto place = within(envelope(live->context), state_, *told);
  if (!place) co_return tl::unexpected(place.error());
  for (auto& result : live->motion.results) {
    result.target_pulses = (*place)[static_cast<std::size_t>(result.axis - 1)];
  }
  co_return Result<void>();
}

Task<void> Controller::Impl::run_to_position(LiveMotionPtr live, GoToPositionRequest request) {
  auto ready = co_await enter_gate(live, false);
  if (ready) ready = co_await prepare(live, Register::none);
  if (ready) ready = co_await find_position(live, request);
  const Speeds before = known_speeds(live->motion.axes);
  if (ready) ready = co_await slow_down(live);
  if (ready) {
    co_await start_and_watch(live, commands::go_to_saved(kind_of(request), std::to_string(request.number)));
  } else {
    const bool stopped = live->stop_requested || ready.error().reason == Reason::stopped;
    end_motion(live, stopped ? MotionState::stopped : MotionState::failed, ready.error());
  }
  co_await restore_speeds(live, before);
}

void Controller::go_to_position(GoToPositionRequest request, TimePoint now, OnStarted started) {
  if (impl_->ending_) return started(tl::unexpected(*impl_->ending_));
  impl_->at(now, [&] { impl_->go_to_position(std::move(request), std::move(started)); });
}

Result<void> Controller::check(const GoToPositionRequest& request) const {
  const auto place = within(impl_->envelope(request.context), impl_->state_, request.expected);
  if (!place) return tl::unexpected(place.error());
  return {};
}

}  // namespace axisgate::shrc203
