// scan: requests a scan, then waits for its outcome.
#include <CLI/CLI.hpp>

#include "clients/axisctl/arguments/verb_options.h"
#include "clients/axisctl/outcome.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

int scan(const Session& session) {
  const Options& options = session.options;
  const v1::Device device = chosen_device(session);
  const v1::Axis& axis = find_axis(device, options.axis);
  v1::ScanRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_device(device.name());
  request.set_axis(std::to_string(axis.number()));
  *request.mutable_start() = parse_amount_for(axis, options.from);
  *request.mutable_end() = parse_amount_for(axis, options.to);
  if (!options.speed.empty()) *request.mutable_speed() = parse_speed_for(axis, options.speed);
  if (options.acceleration_ms != 0) *request.mutable_acceleration_time() = from_milliseconds(options.acceleration_ms);
  if (options.by_scale) {
    request.set_scale_pulses(options.every);
  } else {
    request.mutable_distance()->set_pulses(options.every);
  }
  return start_and_wait(session, device, [&] {
    return session.connection.call(session.connection.stage, &v1::StageService::Stub::Scan, request, kStartLimit)
        .motion();
  });
}

void scan_options(CLI::App& verb, Options& options) {
  verb.add_option("AXIS", options.axis, "number or name")->required()->type_name("");
  verb.add_option("FROM", options.from, "position where the range begins, e.g. 0mm")->required()->type_name("");
  verb.add_option("TO", options.to, "position where it ends, e.g. 1mm")->required()->type_name("");
  verb.add_option("--every", options.every, "interval of the trigger pulses, in drive pulses (see below)")
      ->required()
      ->check(CLI::Range(2, 30'000))
      ->type_name("PULSES");
  verb.add_flag("--scale", options.by_scale,
                "count the pulses of the scale (the encoder), not the drive pulses of the motor");
  add_speed(verb, options, "speed over the range, e.g. 200um/s (default: the maximum speed of the axis)");
  add_waiting(verb, options);
}

constexpr Verb kScanVerbs[] = {
    {.words = "scan",
     .heading = Heading::moving,
     .description = "move over a range and give trigger pulses at equal distances",
     .help =
         R"(PULSES is the distance between two trigger pulses, 2 to 30000 drive pulses of the axis. `axisctl exec '?:P1'` shows the
length of one drive pulse of axis 1 in nm. The trigger also gives pulses before FROM and after TO, while the axis speeds
up and slows down. One pulse falls on FROM (not with --scale). `axisctl help scans` explains more.)",
     .examples = "axisctl scan 1 0mm 0.5mm --every 1000\naxisctl scan 1 0.5mm 0.25mm --every 500 --speed 100um/s",
     .add_options = scan_options,
     .run = scan,
     .waits = true},
};

}  // namespace

std::span<const Verb> scan_verbs() { return kScanVerbs; }

}  // namespace axisgate::axisctl
