#include "device/shrc203/planning/scan_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace axisgate::shrc203 {
namespace {

__extension__ typedef __int128 Wide;

constexpr std::int64_t kIntervalMin = 2, kIntervalMax = 30'000;  // pulses (manual 98), 101))

// Scale pulses per drive pulse, as a fraction.
struct Ratio {
  std::int64_t above = 1, below = 1;
};

std::int64_t power_of_ten(int exponent) {
  std::int64_t value = 1;
  for (int i = 0; i < exponent; ++i) value *= 10;
  return value;
}

// Returns nullopt if the scale's resolution is unknown or outside the range of the computation.
std::optional<Ratio> drive_to_scale(const Decimal& drive_pulse, const std::optional<Decimal>& scale_pulse) {
  constexpr std::int64_t kDigitsMax = 1'000'000'000;
  if (!scale_pulse || scale_pulse->digits <= 0) return {};
  const bool small = drive_pulse.digits < kDigitsMax && scale_pulse->digits < kDigitsMax && drive_pulse.decimals < 9 &&
                     scale_pulse->decimals < 9;
  if (!small) return {};
  return Ratio{drive_pulse.digits * power_of_ten(scale_pulse->decimals),
               scale_pulse->digits * power_of_ten(drive_pulse.decimals)};
}

std::optional<std::int64_t> triggers_by_scale(std::int64_t way, const std::optional<Ratio>& ratio,
                                              const Trigger& trigger) {
  if (!ratio) return {};
  const auto pulses = static_cast<Wide>(std::abs(way)) * ratio->above / ratio->below / trigger.interval;
  return static_cast<std::int64_t>(pulses);
}

Result<SpeedSetting> speed_of(const ScanRequest& request, const Envelope& envelope) {
  const AxisState& axis = envelope.state().axis(request.axis);
  if (!axis.minimum_speed || !axis.maximum_speed || !axis.acceleration_ms) {
    return fail_on(request.axis, Reason::line_fault, "the speeds of " + envelope.label(request.axis) + " are not known",
                   "wait until the device is up");
  }
  SpeedSetting speed{*axis.minimum_speed, *axis.maximum_speed, request.acceleration_ms.value_or(*axis.acceleration_ms)};
  if (request.speed) {
    const auto asked = envelope.speed(request.axis, *request.speed);
    if (!asked) return tl::unexpected(asked.error());
    speed.maximum = *asked;
  }
  speed.minimum = std::min(speed.minimum, speed.maximum);
  if (auto good = envelope.check_speed(request.axis, speed.maximum); !good) return tl::unexpected(good.error());
  if (auto good = check_acceleration(request.axis, speed.acceleration_ms); !good) return tl::unexpected(good.error());
  if (speed.maximum <= kTriggeredSpeedMax) return speed;
  return fail_on(request.axis, Reason::too_fast,
                 fmt::format("{} would run at {} pulses/s; above {} trigger pulses may be missing (manual 98) T:P)",
                             envelope.label(request.axis), speed.maximum, kTriggeredSpeedMax),
                 "give a lower speed");
}

// Returns the distance from S to F in R, in pulses; rounded up.
std::int64_t way_of_ramp(const SpeedSetting& speed) {
  return ((speed.minimum + speed.maximum) * speed.acceleration_ms + 1999) / 2000;
}

Result<Trigger> trigger_of(const ScanRequest& request, int direction) {
  if (request.interval < kIntervalMin || request.interval > kIntervalMax) {
    return fail(Reason::out_of_range, fmt::format("a trigger pulse every {} pulses; {} to {} are possible",
                                                  request.interval, kIntervalMin, kIntervalMax));
  }
  const auto by_scale = direction > 0 ? Trigger::Target::scale_plus : Trigger::Target::scale_minus;
  return Trigger{request.by_scale ? by_scale : Trigger::Target::drive_pulses, request.axis, request.interval};
}

Segment segment_to(int axis, std::int64_t place, std::optional<SpeedProfile> profile) {
  Segment segment;
  segment.moves.push_back({axis, pulses(place), std::move(profile)});
  segment.relative = false;
  return segment;
}

struct Range {
  std::int64_t from = 0, to = 0;
  int direction() const { return to < from ? -1 : 1; }
};

Result<Range> range_of(const ScanRequest& request, const Envelope& envelope) {
  if (auto good = envelope.check_axis(request.axis); !good) return tl::unexpected(good.error());
  const auto from = envelope.pulses(request.axis, request.from);
  if (!from) return tl::unexpected(from.error());
  const auto to = envelope.pulses(request.axis, request.to);
  if (!to) return tl::unexpected(to.error());
  if (*from != *to) return Range{*from, *to};
  return fail_on(request.axis, Reason::invalid_request, "the range of the scan begins where it ends",
                 "give two positions that differ");
}

}  // namespace

Result<ScanPlan> plan_scan(const ScanRequest& request, const Positions& from, std::optional<Decimal> scale_pulse,
                           const Envelope& envelope) {
  const auto range = range_of(request, envelope);
  if (!range) return tl::unexpected(range.error());
  const auto speed = speed_of(request, envelope);
  if (!speed) return tl::unexpected(speed.error());
  const auto trigger = trigger_of(request, range->direction());
  if (!trigger) return tl::unexpected(trigger.error());

  const std::int64_t ramp = way_of_ramp(*speed);
  // The run-up is a whole number of intervals, so that a trigger pulse falls on the start of the range.
  const std::int64_t intervals = std::max<std::int64_t>(1, (ramp + request.interval - 1) / request.interval);
  const std::int64_t before = request.by_scale ? ramp : intervals * request.interval;
  ScanPlan plan{{}, *trigger, {}};
  plan.due.run_from = range->from - range->direction() * before;
  plan.due.run_to = range->to + range->direction() * ramp;

  for (const std::int64_t place : {plan.due.run_from, plan.due.run_to}) {
    if (auto good = envelope.check_target(request.axis, place); !good) return tl::unexpected(good.error());
  }

  const SpeedProfile profile{pulses(speed->minimum), pulses(speed->maximum), speed->acceleration_ms};
  PathRequest path{{}, request.context};
  const auto at = from[static_cast<std::size_t>(request.axis - 1)];
  if (at != plan.due.run_from) path.segments.push_back(segment_to(request.axis, plan.due.run_from, {}));
  path.segments.push_back(segment_to(request.axis, plan.due.run_to, profile));
  auto planned = plan_path(path, from, envelope);
  if (!planned) return tl::unexpected(planned.error());
  plan.path = *std::move(planned);
  plan.path.segments.back().arm = *trigger;

  const std::int64_t run = plan.due.run_to - plan.due.run_from, within = range->to - range->from;
  if (request.by_scale) {
    const auto ratio = drive_to_scale(envelope.state().axis(request.axis).scale->per_pulse, scale_pulse);
    plan.due.expected = triggers_by_scale(run, ratio, *trigger);
    plan.due.expected_in_range = triggers_by_scale(within, ratio, *trigger);
  } else {
    plan.due.interval = range->direction() * request.interval;
    plan.due.expected = triggers_on(run, *trigger);
    plan.due.expected_in_range = triggers_on(within, *trigger) + 1;
  }
  return plan;
}

}  // namespace axisgate::shrc203
