// path, line and arc: read all segments, send them, and follow the path.
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/outcome.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/stage/path_grammar.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

using PathStream = grpc::ClientReaderWriter<v1::RunPathRequest, v1::RunPathResponse>;

PathOptions path_options(const Options& options) { return {options.speed, options.acceleration_ms, options.absolute}; }

std::vector<v1::Segment> read_segments(const Options& options, const v1::Device& device) {
  if (options.file == "-") return parse_path(device, path_options(options), std::cin, "standard input");
  std::ifstream file(options.file);
  if (!file)
    throw usage(fmt::format("{}: {}", options.file, std::strerror(errno)), "name a file, or - for the standard input");
  return parse_path(device, path_options(options), file, options.file);
}

void send_path(PathStream& stream, const v1::CallContext& context, const v1::Device& device,
               const std::vector<v1::Segment>& segments) {
  v1::RunPathRequest request;
  *request.mutable_header()->mutable_context() = context;
  request.mutable_header()->set_device(device.name());
  bool open = stream.Write(request);
  for (const v1::Segment& segment : segments) {
    if (!open) return;  // the daemon has refused; the status has the reason
    *request.mutable_segment() = segment;
    open = stream.Write(request);
  }
  stream.WritesDone();
}

// Reads up to the next Motion; false at the end of the stream. Skips progress messages, because the events show the
// progress, with the completions in order.
bool read_motion(PathStream& stream, v1::Motion& motion) {
  v1::RunPathResponse response;
  while (stream.Read(&response)) {
    if (!response.has_motion()) continue;
    motion = response.motion();
    return true;
  }
  return false;
}

v1::Motion start_path(const Session& session, PathStream& stream, const v1::Device& device,
                      const std::vector<v1::Segment>& segments) {
  send_path(stream, session.connection.new_call_context(), device, segments);
  v1::Motion motion;
  if (read_motion(stream, motion)) return motion;
  session.connection.check(stream.Finish());
  throw Failure{kFailed, "INTERNAL", "the daemon ended the call without starting the path", "see its log"};
}

int run(const Session& session, const v1::Device& device, const std::vector<v1::Segment>& segments) {
  grpc::ClientContext context;
  if (session.options.no_wait) {
    const auto stream = session.connection.stage->RunPath(&context);
    const v1::Motion started = start_path(session, *stream, device, segments);
    context.TryCancel();  // ends the call, not the path
    return report_started(session, started);
  }
  MotionFollower follower(session, device);
  const auto stream = session.connection.stage->RunPath(&context);
  v1::Motion motion = start_path(session, *stream, device, segments);
  say_on_interrupt_that_motion_continues();
  follower.follow(motion.name());
  while (read_motion(*stream, motion)) {
  }
  // The status is not needed if the outcome is known. Otherwise the daemon may still answer a question for the outcome.
  if (motion.state() < v1::MOTION_STATE_SUCCEEDED) motion = await_outcome(session, motion.name());
  follower.finish();
  return report_outcome(session, device, motion);
}

}  // namespace

int path(const Session& session) {
  const v1::Device device = chosen_device(session);
  return run(session, device, read_segments(session.options, device));
}

int line(const Session& session) {
  const v1::Device device = chosen_device(session);
  const v1::Segment segment = parse_segment(device, path_options(session.options), session.options.lines);
  if (segment.has_arc()) throw usage("that is not a straight line", "use axisctl arc");
  return run(session, device, {segment});
}

int arc(const Session& session) {
  const v1::Device device = chosen_device(session);
  const v1::Segment segment = parse_segment(device, path_options(session.options), session.options.lines);
  if (!segment.has_arc())
    throw usage("that is a straight line", "use axisctl line; an arc begins with around or through");
  return run(session, device, {segment});
}

}  // namespace axisgate::axisctl
