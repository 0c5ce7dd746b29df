// How a request is answered that came before under the same id; and how the first answer is remembered for that.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "device/core/problem.h"
#include "server/api/request/call.h"
#include "server/api/request/motion_watch.h"
#include "server/api/request/mutations.h"
#include "server/devices/stage.h"
#include "server/journal/answers.h"

namespace axisgate::api {

using Known = server::journal::RequestMemory::Known;

// A motion that has started. Nothing: it was to be checked only.
using StartedMotion = std::optional<CurrentMotion>;

// Answers a repeat with what the first request came to. From any thread.
template <class Device, class Outcome>
using RepeatOf = std::function<void(Device& device, const Result<Known>& known, const Answer<Outcome>& answer)>;

// Where the device's line is closed meanwhile, the answer is dropped, as any other.
void repeat_motion(server::Stage& device, const Result<Known>& known, const Answer<StartedMotion>& answer);
void repeat_done(const Result<Known>& known, const Answer<void>& answer);

// Of outcomes that can be remembered as they are.
template <class Device, class Outcome>
RepeatOf<Device, Outcome> usual_repeat() {
  if constexpr (std::is_void_v<Outcome>) {
    return [](Device&, const Result<Known>& known, const Answer<void>& answer) { repeat_done(known, answer); };
  } else {
    static_assert(std::is_same_v<Outcome, StartedMotion>, "name how a repeat is answered");
    return repeat_motion;
  }
}

// Nothing, of a motion: its end is its answer.
template <class Outcome>
std::optional<std::string> remembered(const Result<Outcome>&) {
  return server::journal::answer_done();
}
template <>
inline std::optional<std::string> remembered(const Result<StartedMotion>&) {
  return std::nullopt;
}

// The same answer, which is remembered before it is given.
template <class Outcome>
Answer<Outcome> settling(MutationPtr mutation, Answer<Outcome> answer) {
  return [mutation = std::move(mutation), answer = std::move(answer)](Result<Outcome> outcome) {
    outcome ? mutation->acted(remembered(outcome)) : mutation->failed(outcome.error());
    answer(std::move(outcome));
  };
}

}  // namespace axisgate::api
