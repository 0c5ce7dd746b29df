#include "device/shrc203/session/settings_reader.h"

#include <map>
#include <string>

#include "device/core/guard.h"
#include "device/shot/command/trigger_reply.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/session/answers.h"
#include "device/stage/own_questions.h"

namespace axisgate::shrc203 {

struct SettingsReader::Answers {
  ExchangeResult axes, axes_again, serial, scale, speeds, excitation;
  ExchangeResult outputs, trigger, origin_speeds;  // may stay unread; code that sets them reads them if necessary
};

Task<bool> SettingsReader::read(std::uint64_t connection) {
  Answers answers;
  const bool asked = co_await ask(answers, connection);
  if (!asked || !take(answers)) co_return false;
  const auto positions = co_await reader_.read_positions(Lane::question, kGateway, true);
  co_return positions.has_value();
}

Task<bool> SettingsReader::ask(Answers& answers, std::uint64_t connection) {
  using Question = Dialogue::Question;
  struct Step {
    Question question;
    ExchangeResult* answer;
  };
  // The axes are read twice: everything else depends on this one digit, and the line can turn a 6 into a 2.
  for (const Step step : {Step{Question::axes, &answers.axes}, Step{Question::axes, &answers.axes_again},
                          Step{Question::serial_number, &answers.serial}, Step{Question::pulse_length, &answers.scale},
                          Step{Question::speeds, &answers.speeds}, Step{Question::excitation, &answers.excitation}}) {
    for (int attempt = 0; attempt < kHandshakeTries && !is_data(*step.answer); ++attempt) {
      if (connection != store_.connection()) co_return false;
      *step.answer = co_await dialogue_.ask(step.question, Lane::question, kGateway, true);
    }
    if (!is_data(*step.answer)) co_return false;
  }
  for (const Step step : {Step{Question::outputs, &answers.outputs}, Step{Question::trigger, &answers.trigger},
                          Step{Question::origin_speeds, &answers.origin_speeds}}) {
    if (connection != store_.connection()) co_return false;
    *step.answer = co_await dialogue_.ask(step.question, Lane::question, kGateway, true);
  }
  co_return true;
}

bool SettingsReader::take(const Answers& answers) {
  store_.note_reported_scales(answers.scale.reply->text);
  std::optional<int> outputs;
  if (is_data(answers.outputs)) outputs = static_cast<int>(*parse_integer(answers.outputs.reply->text));
  store_.note_outputs(outputs);
  store_.note_trigger(is_data(answers.trigger) ? parse_trigger(answers.trigger.reply->text, model().axes())
                                               : std::nullopt);
  const auto controllable = from_axis_setting(answers.axes.reply->text);
  const bool twice = answers.axes_again.reply->text == answers.axes.reply->text || !guarded(Guard::axes_twice);
  if (!controllable || !twice) return false;
  const bool same_unit = answers.serial.reply->text == store_.state().serial_number;
  if (!same_unit && guarded(Guard::serial_number_twice)) return false;
  store_.note_controllable(*controllable);
  return take_of_axes(answers, *controllable);
}

bool SettingsReader::take_of_axes(const Answers& answers, AxisSet controllable) {
  const auto scales = by_axis(model(), *answers.scale.reply, controllable),
             speeds = by_axis(model(), *answers.speeds.reply, controllable),
             excited = by_axis(model(), *answers.excitation.reply, controllable);
  for (const auto* fields : {&scales, &speeds, &excited}) {
    if (fields->size() != static_cast<std::size_t>(controllable.count())) return false;
  }
  const auto origins = is_data(answers.origin_speeds) ? by_axis(model(), *answers.origin_speeds.reply, controllable)
                                                      : std::map<int, std::string>();
  store_.note_excitation(excited);
  for (const int axis : controllable.list()) {
    const auto per_pulse = parse_decimal(scales.at(axis));
    const auto speed = parse_speed_setting(speeds.at(axis));
    if (!per_pulse || per_pulse->digits == 0 || !speed) return false;
    const bool rotary = store_.profile().axis(axis).rotary();
    store_.note_scale(axis, Scale{*per_pulse, rotary});
    store_.note_speeds({{axis, *speed}});
    store_.note_origin_speeds(axis, origins.contains(axis) ? parse_speed_setting(origins.at(axis)) : std::nullopt);
    store_.note_armed(AxisSet::of(axis), false);
  }
  return true;
}

}  // namespace axisgate::shrc203
