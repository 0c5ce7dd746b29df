#include "server/api/stage/position_changes.h"

#include <memory>
#include <utility>

#include "server/api/stage/position_checks.h"
#include "server/events/wall_time.h"

namespace axisgate::api {
namespace {

using server::SavedPosition;
using stage::ExecuteEvent;
using stage::StageController;

// Runs a task that waits for the disk on a reader's thread, so that no line waits for it.
template <class Task>
void away_from_the_lines(server::Gateway& gateway, Task task) {
  gateway.timeouts().after(Duration::zero(), std::move(task));
}

using SavingPtr = std::shared_ptr<Saving>;

Result<void> read_back(Saving& saving, const ExecuteEvent& ended, const stage::State& state) {
  if (ended.problem && ended.problem->reason == Reason::not_found) {
    return fail(Reason::device_refused, "the controller accepted the position, but does not have it",
                "check its mode: `GetDevice`");
  }
  if (ended.problem) return tl::unexpected(*ended.problem);
  SavedPosition& position = saving.position;
  auto coordinates = reported_coordinates(position, saving.lines.tell,
                                          {saving.answers.begin() + 1, saving.answers.end()}, saving.kind, state);
  if (!coordinates) return tl::unexpected(coordinates.error());
  position.coordinates = *std::move(coordinates);
  position.saved = server::calendar_now();
  position.serial_number = state.serial_number;
  position.frame = server::frame_of(state);
  return {};
}

void refuse(const Saving& saving, const Problem& problem) {
  const bool line_failed = problem.reason == Reason::reply_timed_out || problem.reason == Reason::line_fault ||
                           problem.reason == Reason::link_down;
  // The number of the earlier position may have the new one by now.
  if (saving.before && (line_failed || !saving.answers.empty())) saving.positions.held_in(*saving.before, {});
  saving.answer(tl::unexpected(problem));
}

void keep(const SavingPtr& saving, const stage::State& state) {
  away_from_the_lines(saving->gateway, [saving, state] {
    const Result<void> kept = saving->positions.keep(saving->position);
    if (!kept) return refuse(*saving, kept.error());
    saving->answer(NamedPosition{saving->position, may_be_lost(saving->position, state)});
  });
}

struct RemovalRun {
  Removal removal;
  server::Stage& device;
  stage::PositionLines lines;
  use::RequestContext context;

  void refuse(const Problem& problem) const { removal.answer(tl::unexpected(problem)); }
};
using RemovalPtr = std::shared_ptr<RemovalRun>;

// Removes the name if it still belongs to that position.
void forget(const RemovalPtr& run) {
  away_from_the_lines(run->removal.gateway, [run] {
    const SavedPosition& position = run->removal.position;
    server::SavedPositions& positions = run->removal.positions;
    const auto now = positions.find(position.device, position.name);
    const bool still = now && now->place == position.place && now->number == position.number;
    run->removal.answer(still ? positions.forget(position.device, position.name) : Result<void>());
  });
}

void remove(const RemovalPtr& run, StageController& controller, TimePoint now) {
  controller.execute({{run->lines.forget}, run->context}, now, [run](const ExecuteEvent& event) {
    if (event.kind != ExecuteEvent::Kind::ended) return;
    event.problem ? run->refuse(*event.problem) : forget(run);
  });
}

// Asks for the position before DEL, because the manual does not say whether DEL accepts an empty number (manual 127),
// 132)).
void remove_if_there(const RemovalPtr& run, StageController& controller, TimePoint now) {
  controller.execute({{run->lines.tell}, run->context}, now, [run](const ExecuteEvent& event) {
    if (event.kind != ExecuteEvent::Kind::ended) return;
    if (event.problem && event.problem->reason == Reason::not_found) return forget(run);
    if (event.problem) return run->refuse(*event.problem);
    run->device.post([run](StageController& same, TimePoint then) { remove(run, same, then); });
  });
}

}  // namespace

// Saves and reads back in one transaction, so that no lines of other callers come between.
void begin(Saving wanted, const Turn& turn) {
  const SavingPtr saving(new Saving(std::move(wanted)));
  const stage::PositionLines& lines = saving->lines;
  turn.controller.execute({{lines.save, lines.tell, lines.tell}, turn.context}, turn.now,
                          [saving, &controller = turn.controller](const ExecuteEvent& event) {
                            if (event.kind == ExecuteEvent::Kind::reply) saving->answers.push_back(event.answer);
                            if (event.kind != ExecuteEvent::Kind::ended) return;
                            const Result<void> read = read_back(*saving, event, controller.state());
                            read ? keep(saving, controller.state()) : refuse(*saving, read.error());
                          });
}

void begin(Removal removal, const Turn& turn) {
  const auto lines = turn.device.kind().position_lines(slot_of(removal.position));
  // In the present controller, the number may belong to another position.
  const bool here = lines && check_unit(removal.position, turn.controller.state());
  const RemovalPtr run(
      new RemovalRun{std::move(removal), turn.device, lines.value_or(stage::PositionLines{}), turn.context});
  here ? remove_if_there(run, turn.controller, turn.now) : forget(run);
}

}  // namespace axisgate::api
