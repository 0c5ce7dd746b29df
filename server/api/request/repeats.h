// Answers to repeated requests, and how the first answer is remembered for them.
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

// A motion that has started; nullopt after a check with validate_only.
using StartedMotion = std::optional<CurrentMotion>;

// Answers a repeated request with the result of the first one. Called from any thread.
template <class Device, class Outcome>
using RepeatOf = std::function<void(Device& device, const Result<Known>& known, const Answer<Outcome>& answer)>;

// The answer is dropped, like any other, if the device's line is closed meanwhile.
void repeat_motion(server::Stage& device, const Result<Known>& known, const Answer<StartedMotion>& answer);
void repeat_done(const Result<Known>& known, const Answer<void>& answer);

// Returns the usual answer to a repeated request, for outcomes that can be remembered unchanged.
template <class Device, class Outcome>
RepeatOf<Device, Outcome> usual_repeat() {
  if constexpr (std::is_void_v<Outcome>) {
    return [](Device&, const Result<Known>& known, const Answer<void>& answer) { repeat_done(known, answer); };
  } else {
    static_assert(std::is_same_v<Outcome, StartedMotion>, "name how a repeat is answered");
    return repeat_motion;
  }
}

// Returns the answer to remember; nullopt for a motion, because its end is the answer.
template <class Outcome>
std::optional<std::string> remembered(const Result<Outcome>&) {
  return server::journal::answer_done();
}
template <>
inline std::optional<std::string> remembered(const Result<StartedMotion>&) {
  return std::nullopt;
}

// Returns an Answer that remembers the outcome before it passes it on.
template <class Outcome>
Answer<Outcome> settling(MutationPtr mutation, Answer<Outcome> answer) {
  return [mutation = std::move(mutation), answer = std::move(answer)](Result<Outcome> outcome) {
    outcome ? mutation->acted(remembered(outcome)) : mutation->failed(outcome.error());
    answer(std::move(outcome));
  };
}

}  // namespace axisgate::api
