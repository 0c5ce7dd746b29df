#include "server/proto/motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "device/core/escape.h"
#include "server/api/request/names.h"
#include "server/proto/callers.h"
#include "server/proto/pages.h"
#include "server/proto/problem.h"
#include "server/proto/to_proto.h"

namespace axisgate::proto {
namespace {

using stage::MotionKind;
using stage::MotionState;

v1::MotionKind to_motion_kind(MotionKind kind) {
  static_assert(static_cast<int>(MotionKind::move) + 1 == v1::MOTION_KIND_MOVE);
  static_assert(static_cast<int>(MotionKind::scan) + 1 == v1::MOTION_KIND_SCAN);
  return static_cast<v1::MotionKind>(static_cast<int>(kind) + 1);
}

v1::MotionState to_motion_state(MotionState state) {
  static_assert(static_cast<int>(MotionState::queued) + 1 == v1::MOTION_STATE_QUEUED);
  static_assert(static_cast<int>(MotionState::succeeded) + 1 == v1::MOTION_STATE_SUCCEEDED);
  static_assert(static_cast<int>(MotionState::unknown) + 1 == v1::MOTION_STATE_UNKNOWN);
  return static_cast<v1::MotionState>(static_cast<int>(state) + 1);
}

v1::Scan to_scan(const stage::ScanResult& scan, int axis, const Shown& shown) {
  v1::Scan proto;
  proto.set_run_from_pulses(scan.run_from);
  proto.set_run_to_pulses(scan.run_to);
  proto.set_run_from(shown.text(axis, scan.run_from));
  proto.set_run_to(shown.text(axis, scan.run_to));
  if (scan.interval) proto.set_interval_pulses(*scan.interval);
  if (scan.expected) proto.set_expected_triggers(*scan.expected);
  if (scan.expected_in_range) proto.set_expected_triggers_in_range(*scan.expected_in_range);
  if (scan.observed) proto.set_observed_triggers(*scan.observed);
  return proto;
}

void set_times(v1::Motion& proto, const stage::Motion& motion, const server::Moment& clock) {
  *proto.mutable_create_time() = to_proto(clock.at(motion.created));
  if (motion.started != TimePoint{}) *proto.mutable_start_time() = to_proto(clock.at(motion.started));
  if (motion.ended != TimePoint{}) *proto.mutable_end_time() = to_proto(clock.at(motion.ended));
}

}  // namespace

v1::AxisResult to_proto(const stage::AxisResult& result, const Shown& shown) {
  v1::AxisResult proto;
  proto.set_axis(result.axis);
  if (result.target_pulses) proto.set_target_pulses(*result.target_pulses);
  if (result.command_pulses) proto.set_command_pulses(*result.command_pulses);
  proto.set_completion_seen(result.completion_seen);
  shown.describe(result.axis, proto);
  proto.set_target(shown.text(result.axis, result.target_pulses));
  proto.set_position(shown.text(result.axis, result.command_pulses));
  return proto;
}

v1::Motion to_proto(std::string_view device, const stage::Motion& motion, std::uint64_t revision,
                    const server::Moment& clock, const Shown& shown) {
  v1::Motion proto;
  proto.set_name(api::motion_name(device, motion.id));
  proto.set_kind(to_motion_kind(motion.kind));
  proto.set_state(to_motion_state(motion.state));
  for (const int axis : motion.axes.list()) proto.add_axes(axis);
  for (const stage::AxisResult& result : motion.results) *proto.add_results() = to_proto(result, shown);
  if (motion.problem) *proto.mutable_problem() = to_proto(*motion.problem);
  proto.set_revision(revision);
  set_times(proto, motion, clock);
  *proto.mutable_caller() = to_caller(motion.who);
  proto.set_request_id(motion.request_id);
  proto.set_segments_total(motion.segments_total);
  proto.set_segments_done(motion.segments_done);
  proto.set_underruns(motion.underruns);
  if (motion.scan) {
    *proto.mutable_scan() = to_scan(*motion.scan, motion.axes.list().front(), shown);
  }
  return proto;
}

v1::Motion to_proto(const api::CurrentMotion& motion) {
  v1::Motion proto = to_proto(motion.stage->name(), motion.motion, motion.revision, motion.clock, Shown(motion.stage));
  proto.set_repeated(motion.is_repeated);
  return proto;
}

void fill_page(const v1::ListMotionsRequest& request, std::vector<api::CurrentMotion> motions,
               v1::ListMotionsResponse& response) {
  if (!request.states().empty()) {
    std::erase_if(motions, [&](const api::CurrentMotion& motion) {
      return std::ranges::find(request.states(), to_motion_state(motion.motion.state)) == request.states().end();
    });
  }
  if (!request.request_id().empty()) {
    std::erase_if(motions,
                  [&](const api::CurrentMotion& motion) { return motion.motion.request_id != request.request_id(); });
  }
  // Newest first: the key descends as the id ascends.
  const auto key = [](const api::CurrentMotion& motion) {
    return fmt::format("{:020}", std::numeric_limits<stage::MotionId>::max() - motion.motion.id);
  };
  std::ranges::sort(motions, {}, key);
  response.set_next_page_token(cut_page(motions, request.page_size(), request.page_token(), key));
  for (const api::CurrentMotion& motion : motions) *response.add_motions() = to_proto(motion);
}

v1::PathProgress to_proto(std::string_view device, const stage::PathProgress& progress) {
  using Step = stage::PathProgress::Step;
  static_assert(static_cast<int>(Step::sent) + 1 == v1::PathProgress::STEP_SENT);
  static_assert(static_cast<int>(Step::underrun) + 1 == v1::PathProgress::STEP_UNDERRUN);
  v1::PathProgress proto;
  proto.set_motion(api::motion_name(device, progress.motion));
  proto.set_step(static_cast<v1::PathProgress::Step>(static_cast<int>(progress.step) + 1));
  proto.set_segment(progress.segment);
  proto.set_wire_reply(escaped(progress.wire_reply));
  return proto;
}

}  // namespace axisgate::proto
