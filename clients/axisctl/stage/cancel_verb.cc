// cancel: stops one motion, or drops it if it waits.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/outcome.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

// Returns "devices/stage/motions/12" for the same text or for "12".
std::string motion_name(const Session& session, const std::string& text) {
  if (text.starts_with("devices/")) return text;
  const bool is_number = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  if (!is_number) throw usage("'" + text + "' is no motion", "give its number, as `axisctl motions` shows it");
  return fmt::format("{}/motions/{}", chosen_device(session).name(), text);
}

v1::Device device_of_motion(const Session& session, const std::string& motion) {
  v1::GetDeviceRequest request;
  request.set_device(motion.substr(0, motion.find("/motions/")));
  return session.connection
      .call(session.connection.devices, &v1::DeviceService::Stub::GetDevice, request, kQuestionLimit)
      .device();
}

v1::Motion motion_now(const Session& session, const std::string& name) {
  v1::GetMotionRequest request;
  request.set_motion(name);
  return session.connection.call(session.connection.stage, &v1::StageService::Stub::GetMotion, request, kQuestionLimit)
      .motion();
}

// Returns "motion 12 (move) STOPPED; axis 1 at 2.5 mm".
std::string fate_text(const v1::Device& device, const v1::Motion& motion, std::string_view remark) {
  const std::string ends = ends_text(device, motion);
  return fmt::format("motion {} ({}) {}{}{}{}", last_part(motion.name()), kind_name(motion.kind()), remark,
                     state_name(motion.state()), ends.empty() ? "" : "; ", ends);
}

int cancel(const Session& session) {
  v1::CancelMotionRequest request;
  *request.mutable_context() = new_stop_context();
  request.set_motion(motion_name(session, session.options.name));
  const v1::Device device = device_of_motion(session, request.motion());
  const bool ended_before = motion_now(session, request.motion()).state() >= v1::MOTION_STATE_SUCCEEDED;
  session.connection.call(session.connection.stage, &v1::StageService::Stub::CancelMotion, request, kStopLimit);
  const v1::Motion motion = await_outcome(session, request.motion());
  if (!ended_before && motion.state() != v1::MOTION_STATE_STOPPED) return report_outcome(session, device, motion);
  if (session.options.json) {
    v1::GetMotionResponse answer;
    *answer.mutable_motion() = motion;
    print_json(answer);
  } else {
    print_line(fate_text(device, motion, ended_before ? "had ended before: " : ""));
  }
  return kDone;
}

void cancel_options(CLI::App& verb, Options& options) {
  verb.add_option("MOTION", options.name, "its number, as `axisctl motions` shows it")->required()->type_name("");
}

constexpr Verb kCancelVerbs[] = {
    {.words = "cancel",
     .heading = Heading::stopping,
     .description = "stop one motion, or drop it if it waits",
     .help = "Needs no lease. After a cancel by somebody else, motions are refused until their caller types `axisctl "
             "rearm`.",
     .examples = "axisctl cancel 1",
     .add_options = cancel_options,
     .run = cancel},
};

}  // namespace

std::span<const Verb> cancel_verbs() { return kCancelVerbs; }

}  // namespace axisgate::axisctl
