#include "device/shrc203/motion/trigger_count.h"

#include <utility>

#include "device/shrc203/command/command_table.h"
#include "device/shrc203/planning/scan_plan.h"
#include "device/shrc203/session/answers.h"

namespace axisgate::shrc203 {

Task<std::optional<Decimal>> TriggerCount::read_scale_pulse(int axis, std::string caller) {
  const auto reported = co_await dialogue_.ask(Dialogue::Question::scale_resolution, Lane::motion, std::move(caller));
  if (!is_data(reported)) co_return std::nullopt;
  const auto fields = by_axis(model(), *reported.reply, store_.controllable());
  const auto field = fields.find(axis);
  if (field == fields.end()) co_return std::nullopt;
  const auto resolution = parse_decimal(field->second);
  co_return resolution ? std::optional(*resolution) : std::nullopt;
}

// Returns the present value of the counter that the trigger counts; nullopt if unknown.
Task<std::optional<std::int64_t>> TriggerCount::read(LiveMotionPtr live) {
  const int axis = live->motion.axes.lowest();
  if (live->scan->trigger.target == Trigger::Target::drive_pulses) {
    co_return store_.state().axis(axis).position_pulses;
  }
  const auto reported = co_await dialogue_.ask(Dialogue::Question::scale_counters, Lane::motion, live->context.who);
  if (!is_data(reported)) co_return std::nullopt;
  const auto readings = parse_positions(model(), *reported.reply, store_.controllable());
  if (!readings) co_return std::nullopt;
  co_return (*readings)[static_cast<std::size_t>(axis - 1)].pulses;
}

Task<void> TriggerCount::begin(LiveMotionPtr live) { live->scan->armed_at = co_await read(live); }

Task<void> TriggerCount::count(LiveMotionPtr live) {
  if (!live->scan->armed_at) co_return;
  const auto counter = co_await read(live);
  if (!counter) co_return;
  live->motion.scan->observed = triggers_on(*counter - *live->scan->armed_at, live->scan->trigger);
}

}  // namespace axisgate::shrc203
