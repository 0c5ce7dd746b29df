#include "server/api/mill/mills.h"

#include <fmt/format.h>

#include <utility>

#include "server/api/request/audit.h"
#include "server/api/request/names.h"
#include "server/journal/answers.h"

namespace axisgate::api {
namespace {

using server::Mill;
using MillTurn = TurnOf<Mill>;

// A MillWatch streams the newest state.
class MillWatch final : public Subscription<MillState> {
 public:
  MillWatch(Mill& mill, Streams::Place place) : Subscription(std::move(place)), mill_(mill) {}

 private:
  void begin() override {
    woken_by(mill_.newest());
    wake();
  }

  Reading read() override {
    const auto newest = mill_.newest().get();
    if (newest.version == taken_) return Nothing{};
    taken_ = newest.version;
    return MillState{&mill_, newest.value};
  }

  Mill& mill_;
  std::optional<std::uint64_t> taken_;  // version that was delivered last
};

}  // namespace

Problem not_sent_to(const Mill& mill) {
  return {.reason = Reason::link_down,
          .message = fmt::format("the line to {} is closed: the abort is sent when it is back", mill.name()),
          .hint = "use the mill's own emergency stop"};
}

void Mills::get(const Call& call, std::string_view device, Answer<MillState> answer) const {
  pipeline_.ask({RequestKind::get_mill, call, find_mill(gateway_, device)}, std::move(answer),
                [](const MillTurn& turn, const Answer<MillState>& respond) {
                  respond(MillState{&turn.device, std::make_shared<const server::MillNow>(turn.device.now(turn.now))});
                });
}

Opened<MillState> Mills::watch(const Call& call, std::string_view device) const {
  const auto admitted = pipeline_.admit({RequestKind::watch_mill, call, find_mill(gateway_, device)});
  if (!admitted) return tl::unexpected(admitted.error());
  Result<Streams::Place> place = streams_.take(RequestKind::watch_mill, admitted->caller.who);
  if (!place) return tl::unexpected(place.error());
  return std::make_shared<MillWatch>(*admitted->device, *std::move(place));
}

void Mills::act_on_run(RequestKind kind, const Call& call, std::string_view device, RunAct act,
                       Answer<CurrentRun> answer) const {
  const auto now = [](const MillTurn& turn) {
    return CurrentRun{&turn.device, turn.controller.running(turn.now), server::moment_of(turn.now)};
  };
  pipeline_.act(
      {kind, call, find_mill(gateway_, device)},
      [kind](const MillTurn& turn) { return check_in_time(turn).map([kind] { return std::string(api::name(kind)); }); },
      [act, now, answer](const MillTurn& turn, const MutationPtr& mutation) {
        const Result<void> done = act(turn);
        if (!done) {
          mutation->failed(done.error());
          return answer(tl::unexpected(done.error()));
        }
        mutation->acted(server::journal::answer_done());
        answer(now(turn));
      },
      [answer](const Problem& problem) { answer(tl::unexpected(problem)); },
      [answer](Mill& mill, const Result<Known>& known) {
        repeat_done(known, [&](const Result<void>& done) {
          if (!done) return answer(tl::unexpected(done.error()));
          mill.post([&mill, answer](jobs::Machine& controller, TimePoint at) {
            answer(CurrentRun{&mill, controller.running(at), server::moment_of(at)});
          });
        });
      });
}

void Mills::pause(const Call& call, std::string_view device, bool raise, Answer<CurrentRun> answer) const {
  act_on_run(
      RequestKind::pause_job, call, device,
      [raise](const MillTurn& turn) { return turn.controller.pause(raise, turn.now); }, std::move(answer));
}

void Mills::resume(const Call& call, std::string_view device, Answer<CurrentRun> answer) const {
  act_on_run(
      RequestKind::resume_job, call, device,
      [](const MillTurn& turn) { return turn.controller.resume(turn.context, turn.now); }, std::move(answer));
}

// Uses no request id: an abort always acts, like a stop.
void Mills::abort(const Call& call, std::string_view device, Answer<CurrentRun> answer) const {
  pipeline_.ask({RequestKind::abort_job, call, find_mill(gateway_, device)}, std::move(answer),
                [](const MillTurn& turn, const Answer<CurrentRun>& respond) {
                  audit(RequestKind::abort_job, turn.device, turn.context, "abort");
                  CurrentRun run{&turn.device, turn.controller.running(turn.now), server::moment_of(turn.now)};
                  if (!turn.controller.abort(turn.context, turn.now)) {
                    return respond(tl::unexpected(not_sent_to(turn.device)));
                  }
                  if (const jobs::JobNumber number = turn.controller.running_job(); number != 0) {
                    run.running = turn.controller.running(turn.now);
                    run.executed = find_job(turn.controller, number)->executed;
                  }
                  respond(std::move(run));
                });
}

}  // namespace axisgate::api
