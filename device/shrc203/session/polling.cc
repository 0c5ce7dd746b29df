#include "device/shrc203/session/polling.h"

#include <utility>

#include "device/shrc203/limits.h"
#include "device/stage/own_questions.h"

namespace axisgate::shrc203 {

Polling::Polling(Reader& reader, StateStore& store, Motions& motions, const NonHost& non_host, Tasks& tasks,
                 std::function<bool()> watched)
    : reader_(reader),
      store_(store),
      motions_(motions),
      non_host_(non_host),
      tasks_(tasks),
      watched_(std::move(watched)) {
  tasks_.spawn(poll());
}

void Polling::refresh(Duration max_age, RequestContext context, StageController::OnState done) {
  tasks_.spawn(read_for(max_age, std::move(context), std::move(done)));
}

Duration Polling::interval() const {
  return motions_.anything_moves() ? store_.profile().moving_poll : store_.profile().idle_poll;
}

Task<void> Polling::poll() {
  while (true) {
    auto wait = motions_.pace_changed().wait_until(tasks_.now() + interval());
    co_await wait;
    if (store_.state().link != LinkState::up || non_host_.away() || watched_()) continue;
    if (tasks_.now() - store_.state().read < interval()) continue;  // somebody has just asked
    const auto read = co_await reader_.read_positions(Lane::poll, kGateway);
    if (!read) store_.publish();
  }
}

Task<void> Polling::read_for(Duration max_age, RequestContext context, StageController::OnState done) {
  if (non_host_.away()) {
    done(tl::unexpected(non_host_.problem()));
    co_return;
  }
  if (!store_.line_works()) {
    done(tl::unexpected(store_.not_up()));
    co_return;
  }
  if (store_.state().read == TimePoint{} || tasks_.now() - store_.state().read > max_age) {
    const auto read = co_await reader_.read_positions(Lane::question, context.who);
    if (!read) {
      done(tl::unexpected(read.error()));
      co_return;
    }
  }
  done(store_.state());
}

}  // namespace axisgate::shrc203
