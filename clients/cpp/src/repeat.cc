#include "clients/cpp/src/repeat.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace axisgate::client {

using std::chrono::duration_cast;

milliseconds Backoff::pause() { return std::exchange(next_, std::min(2 * next_, kLongest)); }

milliseconds Repeat::limit(Clock::time_point now) const {
  return std::max(duration_cast<milliseconds>(terms_.until - now), milliseconds(0)) + terms_.answer;
}

milliseconds Repeat::pause_after(const Failure& failure, Clock::time_point now) {
  may_have_acted_ = may_have_acted_ || (terms_.acts && failure.lost() && !failure.never_sent());
  if (may_be_repeated(failure)) {
    const milliseconds pause = std::min(backoff_.pause(), duration_cast<milliseconds>(terms_.until - now));
    if (pause > milliseconds(0)) return pause;
  }
  end(failure);
}

bool Repeat::may_be_repeated(const Failure& failure) const {
  if (may_have_acted_ && !terms_.remembered) return false;
  return failure.passing() || (may_have_acted_ && failure.reason() == "QUEUE_FULL");
}

void Repeat::end(const Failure& failure) const {
  if (!terms_.acts && failure.lost()) throw_unavailable(failure, terms_.target);
  if (!may_have_acted_ || failure.decides_repeat()) throw_error(failure, terms_.target);
  try {
    throw_error(failure, terms_.target);
  } catch (const OutcomeUnknown&) {
    throw;
  } catch (const Error& error) {
    throw_look_first(fmt::format("the answer to the request was lost, and a repeat was refused: {}", error.message()),
                     error.code());
  }
}

}  // namespace axisgate::client
