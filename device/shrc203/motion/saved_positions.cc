#include "device/shrc203/motion/saved_positions.h"

#include <fmt/format.h>

#include <utility>

#include "device/shrc203/command/command_table.h"
#include "device/shrc203/planning/transaction_prediction.h"

namespace axisgate::shrc203 {
namespace {

constexpr int kNumbers = 20;

commands::Saved kind_of(const GoToPositionRequest& request) {
  return request.place ? commands::Saved::place : commands::Saved::coordinates;
}

Command question_of(const GoToPositionRequest& request) {
  return commands::ask_saved(kind_of(request), std::to_string(request.number));
}

std::string label(const GoToPositionRequest& request) {
  return fmt::format("number {} of its {}", request.number, request.place ? "positions (PIT:)" : "coordinates (PAV:)");
}

std::string in_words(const Coordinates& coordinates) {
  std::string text;
  for (const auto& [axis, pulses] : coordinates) text += fmt::format("{}{}", text.empty() ? "" : ",", pulses);
  return text;
}

// Compares the reported position with the expected one. A place is lost after a reset, and anybody may overwrite a
// number by PIT:SET (manual 128), 130)).
Result<void> as_expected(const GoToPositionRequest& request, const Coordinates& reported) {
  if (!reported.empty() && (request.expected.empty() || reported == request.expected)) return {};
  Problem problem{.reason = Reason::epoch_passed, .sent = question_of(request).line};
  if (reported.empty()) {
    problem.message = fmt::format("the controller holds nothing under {}", label(request));
    problem.hint = "save the position again";
    problem.wire_reply = "NG";
  } else {
    problem.message = fmt::format("the controller reports {} for {}, and not {}", in_words(reported), label(request),
                                  in_words(request.expected));
    problem.hint = "somebody may have saved another position there, or set other coordinates: save the position again";
    problem.wire_reply = in_words(reported);
  }
  return tl::unexpected(std::move(problem));
}

// Checks the coordinates, but not the speeds: axes that would be too fast are slowed down.
Result<Positions> within(const Envelope& envelope, const State& state, const Coordinates& coordinates) {
  Positions place{};
  for (const auto& [axis, pulses] : coordinates) {
    if (const auto good = envelope.check_axis(axis); !good) return tl::unexpected(good.error());
    place[static_cast<std::size_t>(axis - 1)] = pulses;
  }
  TransactionPrediction prediction(envelope, positions_of(state), {}, state.controllable());
  if (const auto good = prediction.go_to(place); !good) return tl::unexpected(good.error());
  return place;
}

}  // namespace

Task<Result<Coordinates>> ask_for_position(Dialogue& dialogue, LiveMotionPtr live, Command question,
                                           AxisSet controllable) {
  const auto answer = co_await dialogue.ask_twice(std::move(live), std::move(question));
  if (!answer) co_return tl::unexpected(answer.error());
  Coordinates reported;
  if (answer->kind != Reply::Kind::data) co_return reported;
  for (const auto& [axis, pulses] : by_axis(model(), *answer, controllable)) reported[axis] = *parse_integer(pulses);
  co_return reported;
}

Result<void> SavedPositions::check(const GoToPositionRequest& request) const {
  const auto place = within(store_.envelope(request.context), store_.state(), request.expected);
  return place ? Result<void>() : tl::unexpected(place.error());
}

void SavedPositions::go_to(GoToPositionRequest request, StageController::OnStarted started) {
  const AxisSet axes = store_.controllable();
  if (axes.empty()) return started(tl::unexpected(store_.not_up()));
  if (request.number < 1 || request.number > kNumbers) {
    return started(fail(Reason::out_of_range, fmt::format("positions are numbered 1 to {}", kNumbers)));
  }
  auto good = check(request);
  // The controller decides which axes need not move: it is one command for all.
  if (good) good = rights_.authorize_motion(request.context, kAllAxes);
  if (!good) return started(tl::unexpected(good.error()));
  auto live = motions_.create(MotionKind::move, axes, request.context, std::move(started));
  live->uses = kAllAxes;
  tasks_.spawn(run(live, std::move(request)));
}

// Reads and checks the saved position in the motion's turn, when nobody else can change it.
Task<Result<void>> SavedPositions::find(LiveMotionPtr live, GoToPositionRequest request) {
  const auto reported = co_await ask_for_position(dialogue_, live, question_of(request), store_.controllable());
  if (!reported) co_return tl::unexpected(reported.error());
  if (reported->empty()) {
    const auto why = co_await explainer_.explain_question(question_of(request), live->context.who);
    if (why) co_return tl::unexpected(*why);
  }
  if (const auto good = as_expected(request, *reported); !good) co_return good;
  const auto place = within(store_.envelope(live->context), store_.state(), *reported);
  if (!place) co_return tl::unexpected(place.error());
  for (auto& result : live->motion.results) {
    result.target_pulses = (*place)[static_cast<std::size_t>(result.axis - 1)];
  }
  co_return Result<void>();
}

Task<void> SavedPositions::run(LiveMotionPtr live, GoToPositionRequest request) {
  auto ready = co_await motions_.enter(live, false);
  if (ready) ready = co_await entry_.prepare(live, Register::none);
  if (ready) ready = co_await find(live, request);
  if (ready) ready = co_await speeds_.slow_down(live);
  if (ready) {
    const auto command = commands::go_to_saved(kind_of(request), std::to_string(request.number));
    const auto start = co_await starter_.start(live, command);
    if (start) co_await watch_.run(live, *start);
  } else {
    motions_.disconnect(*live, ready.error());
  }
  co_await restorer_.restore_after(live);
}

}  // namespace axisgate::shrc203
