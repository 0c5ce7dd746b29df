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
      watched_(std::move(watched)),
      reading_ended_(tasks.executor()) {
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
    if (store_.state().link != LinkState::up || non_host_.away()) continue;
    bool read = true;
    for (int attempt = 0; read && attempt < kReadingsOfAChange && positions_due(); ++attempt) {
      const auto positions = co_await reader_.read_positions(Lane::poll, kGateway);
      read = positions.has_value();
    }
    for (int attempt = 0; read && attempt < kReadingsOfAChange && excitation_due(); ++attempt) {
      const auto excitation = co_await reader_.read_excitation(kGateway, Lane::poll);
      read = excitation.has_value();
    }
    if (!read) store_.publish();
  }
}

// Reports whether the positions are due: not read recently, or a change that a second reading must confirm.
bool Polling::positions_due() const {
  if (store_.conditions().status_doubtful()) return true;
  return !watched_() && tasks_.now() - store_.state().read >= interval();
}

// Reports whether the excitation is due. Positions do not show that a stationary axis's motor was switched off at the
// front panel.
bool Polling::excitation_due() const {
  if (!reader_.may_poll_excitation()) return false;
  const Duration age = tasks_.now() - store_.conditions().motors_last_read();
  return store_.conditions().motors_doubtful() || age >= store_.profile().idle_poll;
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
  co_await join(max_age);
  if (!is_fresh(max_age)) {
    const auto read = co_await read_now(context.who);
    if (!read) {
      done(tl::unexpected(read.error()));
      co_return;
    }
  }
  done(store_.state());
}

bool Polling::is_fresh(Duration max_age) const {
  return store_.state().read != TimePoint{} && tasks_.now() - store_.state().read <= max_age;
}

// Waits for a reading in flight if its reply is fresh enough for the caller: it is not older than its question.
Task<void> Polling::join(Duration max_age) {
  if (is_fresh(max_age) || !reading_since_ || tasks_.now() - *reading_since_ > max_age) co_return;
  auto ended = reading_ended_.wait_until(tasks_.now() + kCallerWriteLimit);
  co_await ended;
}

Task<Result<void>> Polling::read_now(std::string caller) {
  const TimePoint begun = tasks_.now();
  reading_since_ = begun;
  auto read = co_await reader_.read_positions(Lane::question, std::move(caller));
  if (reading_since_ == begun) reading_since_.reset();
  reading_ended_.notify();
  co_return read;
}

}  // namespace axisgate::shrc203
