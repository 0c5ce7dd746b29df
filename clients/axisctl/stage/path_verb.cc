// path, line and arc: read all segments, send them, and follow the path.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>

#include "clients/axisctl/arguments/verb_options.h"
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

void add_manner_of_path(CLI::App& verb, Options& options) {
  verb.add_flag("--absolute", options.absolute, "the amounts are positions, not distances");
  add_speed(verb, options, "speed along the path, e.g. 2mm/s, for segments without speed=");
  add_waiting(verb, options);
}

void add_path_options(CLI::App& verb, Options& options) {
  verb.add_option("FILE", options.file,
                  "one segment per line, e.g. 1=1mm 2=-500um speed=2mm/s; - reads the standard input")
      ->required()
      ->type_name("");
  add_manner_of_path(verb, options);
}

void line_options(CLI::App& verb, Options& options) {
  verb.add_option("AXIS=AMOUNT", options.lines, "distance of each axis, e.g. 1=1mm 2=-500um")
      ->required()
      ->type_name("");
  add_manner_of_path(verb, options);
}

void arc_options(CLI::App& verb, Options& options) {
  verb.add_option("COURSE", options.lines, "e.g. around 1=0 2=1mm ccw 90deg (see `axisctl help paths`)")
      ->required()
      ->type_name("");
  add_manner_of_path(verb, options);
}

constexpr Verb kPathVerbs[] = {
    {.words = "path",
     .heading = Heading::moving,
     .description = "run a continuous path: lines and arcs without a stop between them",
     .help =
         "FILE has one segment per line: a straight line or an arc. `axisctl help paths` explains segments. Ctrl-C\n"
         "ends axisctl, not the motion: `axisctl stop` stops it.",
     .examples = R"(printf '1=1mm 2=-500um speed=2mm/s\n1=-1mm 2=500um\n' | axisctl path -
printf '1=0.1mm 2=0\naround 1=0 2=50um ccw 180deg\n1=-0.1mm 2=0 rest=0.5s\n' | axisctl path - --speed 1mm/s)",
     .add_options = add_path_options,
     .run = path,
     .waits = true},
    {.words = "line",
     .heading = Heading::moving,
     .description = "run a straight line: the axes start and end together",
     .help = "A path of one straight line. `axisctl help paths` explains it.",
     .examples = "axisctl line 1=0.1mm 2=-50um --speed 1mm/s",
     .add_options = line_options,
     .run = line,
     .waits = true},
    {.words = "arc",
     .heading = Heading::moving,
     .description = "run a circle, an arc or a helix",
     .help = "A path of one arc. `axisctl help paths` explains it.",
     .examples = R"(axisctl arc around 1=0 2=50um ccw 90deg --speed 1mm/s
axisctl arc through 1=20um 2=30um to 1=50um 2=20um --speed 1mm/s)",
     .add_options = arc_options,
     .run = arc,
     .waits = true},
};

}  // namespace

std::span<const Verb> path_verbs() { return kPathVerbs; }

}  // namespace axisgate::axisctl
