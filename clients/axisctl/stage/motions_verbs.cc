// motions, cancel: list the motions that the daemon has, and stop one of them.
#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/outcome.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/table.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

using google::protobuf::util::TimeUtil;

constexpr int kNewestWithOutcome = 20;

bool has_outcome(const v1::Motion& motion) { return motion.state() >= v1::MOTION_STATE_SUCCEEDED; }

// Returns the motions to show, oldest first, in the order of the answer.
std::vector<v1::Motion> shown_of(const v1::ListMotionsResponse& there, bool all) {
  auto hidden =
      all ? 0 : std::max<std::ptrdiff_t>(0, std::ranges::count_if(there.motions(), has_outcome) - kNewestWithOutcome);
  std::vector<v1::Motion> shown;
  for (const v1::Motion& motion : there.motions()) {
    if (has_outcome(motion) && hidden > 0) {
      --hidden;
    } else {
      shown.push_back(motion);
    }
  }
  return shown;
}

// Returns the cells of a row. The last cell is the end of the motion, or its duration up to `now` if it has no outcome.
std::vector<std::string> cells_of(const v1::Motion& motion, const google::protobuf::Timestamp& now) {
  const auto& since = motion.has_start_time() ? motion.start_time() : motion.create_time();
  return {std::string(last_part(motion.name())),
          kind_name(motion.kind()),
          fmt::format("{}", fmt::join(motion.axes(), ",")),
          state_name(motion.state()),
          motion.who(),
          motion.has_start_time() ? time_text(motion.start_time()) : "not started",
          motion.has_end_time() ? time_text(motion.end_time()) : "for " + duration_text(since, now)};
}

// Returns "devices/stage/motions/12" for the same text or for "12".
std::string motion_name(const Session& session, const std::string& text) {
  if (text.starts_with("devices/")) return text;
  const bool is_number = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  if (!is_number) throw usage("'" + text + "' is no motion", "give its number, as `axisctl motions` shows it");
  return fmt::format("{}/motions/{}", chosen_device(session).name(), text);
}

v1::Device device_of_motion(const Session& session, const std::string& motion) {
  v1::GetDeviceRequest request;
  request.set_name(motion.substr(0, motion.find("/motions/")));
  return session.connection
      .call(session.connection.devices, &v1::DeviceService::Stub::GetDevice, request, kQuestionLimit)
      .device();
}

v1::Motion motion_now(const Session& session, const std::string& name) {
  v1::GetMotionRequest request;
  request.set_name(name);
  return session.connection.call(session.connection.stage, &v1::StageService::Stub::GetMotion, request, kQuestionLimit)
      .motion();
}

// Returns "motion 12 (move) STOPPED; axis 1 at 2.5 mm".
std::string fate_text(const v1::Device& device, const v1::Motion& motion, std::string_view remark) {
  const std::string ends = ends_text(device, motion);
  return fmt::format("motion {} ({}) {}{}{}{}", last_part(motion.name()), kind_name(motion.kind()), remark,
                     state_name(motion.state()), ends.empty() ? "" : "; ", ends);
}

}  // namespace

int motions(const Session& session) {
  v1::ListMotionsRequest request;
  request.set_device(chosen_device(session).name());
  const v1::ListMotionsResponse there =
      session.connection.call(session.connection.stage, &v1::StageService::Stub::ListMotions, request, kQuestionLimit);
  const std::vector<v1::Motion> shown = shown_of(there, session.options.all);
  if (session.options.json) {
    for (const v1::Motion& motion : shown) print_json(motion);
    return kDone;
  }
  if (shown.empty()) {
    print_line("no motions");
    return kDone;
  }
  std::vector<std::vector<std::string>> rows{{"number", "kind", "axes", "state", "who", "started", "ended"}};
  for (const v1::Motion& motion : shown) rows.push_back(cells_of(motion, TimeUtil::GetCurrentTime()));
  for (const std::string& line : table_lines(rows)) print_line(line);
  return kDone;
}

int cancel(const Session& session) {
  v1::CancelMotionRequest request;
  *request.mutable_context() = new_stop_context();
  request.set_name(motion_name(session, session.options.name));
  const v1::Device device = device_of_motion(session, request.name());
  const bool ended_before = has_outcome(motion_now(session, request.name()));
  session.connection.call(session.connection.stage, &v1::StageService::Stub::CancelMotion, request, kStopLimit);
  const v1::Motion motion = await_outcome(session, request.name());
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

}  // namespace axisgate::axisctl
