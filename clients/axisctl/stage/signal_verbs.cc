// outputs, inputs and trigger: the controller's digital signals.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/stage/setting_calls.h"
#include "clients/axisctl/verbs.h"
#include "device/core/quantity.h"

namespace axisgate::axisctl {
namespace {

v1::Pins switched(const v1::Pins& now, const Options& options) {
  std::set<int> on(now.on().begin(), now.on().end());
  for (const int output : options.outputs) {
    if (options.value == "on") {
      on.insert(output);
    } else {
      on.erase(output);
    }
  }
  v1::Pins pins;
  pins.mutable_on()->Add(on.begin(), on.end());
  return pins;
}

void check_outputs(const Options& options) {
  const bool none = options.value == "none";
  if (none == options.outputs.empty()) return;
  throw none ? usage("`outputs none` switches all of them off, and takes no numbers", "e.g. `axisctl outputs off 1 3`")
             : usage(fmt::format("which outputs are to be {}?", options.value),
                     fmt::format("e.g. `axisctl outputs {} 1 3`", options.value));
}

int show_outputs(const Session& session, const v1::Settings& settings) {
  if (session.options.json) {
    v1::Settings shown;
    if (settings.has_outputs()) *shown.mutable_outputs() = settings.outputs();
    print_json(shown);
  } else {
    print_line(settings.has_outputs() ? pins_text(settings.outputs(), "OUT") : "?");
  }
  return kDone;
}

Failure no_interval(std::string_view text) {
  return usage(fmt::format("\"{}\" is not an interval", text),
               "2 to 30000 pulses of an axis, e.g. `1000 --axis 1`, or 0.01s to 100s, e.g. `0.2s`");
}

// Reports whether the text is a time, such as "0.2s", and not a number of pulses, such as "20pulses".
bool is_time(std::string_view text) {
  return text.ends_with('s') && text.find_first_not_of("+-.0123456789") == text.size() - 1;
}

// Returns the interval in hundredths of a second.
std::int64_t timer_interval(std::string_view text) {
  constexpr std::int64_t most = 10'000;
  const std::optional<std::int64_t> hundredths = parse_steps(text.substr(0, text.size() - 1), 2, most);
  if (!hundredths || *hundredths == 0) throw no_interval(text);
  return *hundredths;
}

std::int64_t pulse_interval(std::string_view text) {
  constexpr std::int64_t least = 2, most = 30'000;
  const Result<Quantity> pulses = parse_quantity(text, Unit::pulses);
  if (!pulses || pulses->unit != Unit::pulses || pulses->value.decimals != 0) throw no_interval(text);
  if (pulses->value.digits < least || pulses->value.digits > most) throw no_interval(text);
  return pulses->value.digits;
}

v1::Trigger timer(const Options& options) {
  if (!options.axis.empty()) {
    throw usage(fmt::format("{} is a time, and the timer has no axis", options.interval),
                "leave out --axis, or give a number of pulses, e.g. `1000 --axis 1`");
  }
  v1::Trigger trigger;
  trigger.set_target(v1::Trigger::TARGET_TIMER);
  constexpr int milliseconds_per_hundredth = 10;
  *trigger.mutable_period() = from_milliseconds(milliseconds_per_hundredth * timer_interval(options.interval));
  return trigger;
}

v1::Trigger wanted_trigger(const Options& options, const v1::Device& device) {
  if (is_time(options.interval)) return timer(options);
  v1::Trigger trigger;
  const std::int64_t interval = pulse_interval(options.interval);
  if (options.axis.empty()) {
    throw usage(fmt::format("an interval of {} pulses needs an axis", interval),
                fmt::format("e.g. `{} --axis 1`; a time has a unit, e.g. `0.2s`", options.interval));
  }
  trigger.set_axis(std::to_string(find_axis(device, options.axis).number()));
  trigger.set_target(options.scale.empty()  ? v1::Trigger::TARGET_DRIVE_PULSES
                     : options.scale == "+" ? v1::Trigger::TARGET_SCALE_PLUS
                                            : v1::Trigger::TARGET_SCALE_MINUS);
  if (options.scale.empty()) {
    trigger.mutable_distance()->set_pulses(interval);
  } else {
    trigger.set_scale_pulses(interval);
  }
  return trigger;
}

int outputs(const Session& session) {
  const Options& options = session.options;
  if (!options.value.empty()) check_outputs(options);
  const v1::Device device = chosen_device(session);
  v1::Settings wanted;
  wanted.mutable_outputs();  // none
  if (options.value == "none") return change_settings(session, device, wanted);
  // The daemon tracks the outputs, so the controller need not be asked while an axis moves.
  v1::Settings settings;
  if (device.has_outputs()) *settings.mutable_outputs() = device.outputs();
  if (options.value.empty()) return show_outputs(session, settings);
  if (!settings.has_outputs()) {
    throw Failure{kRefused, "INVALID_REQUEST", "the state of the other outputs is unknown",
                  "try again, or begin with `axisctl outputs none`"};
  }
  *wanted.mutable_outputs() = switched(settings.outputs(), options);
  return change_settings(session, device, wanted);
}

int inputs(const Session& session) {
  const v1::Settings settings = settings_of(session, chosen_device(session));
  if (session.options.json) {
    v1::Settings shown;
    if (settings.has_inputs()) *shown.mutable_inputs() = settings.inputs();
    print_json(shown);
  } else {
    print_line(settings.has_inputs() ? pins_text(settings.inputs(), "IN") : "?");
  }
  return kDone;
}

int trigger_every(const Session& session) {
  const v1::Device device = chosen_device(session);
  v1::Settings wanted;
  *wanted.mutable_trigger() = wanted_trigger(session.options, device);
  return change_settings(session, device, wanted);
}

int trigger_off(const Session& session) {
  v1::Settings wanted;
  wanted.mutable_trigger()->set_target(v1::Trigger::TARGET_NONE);
  return change_settings(session, chosen_device(session), wanted);
}

int trigger_fire(const Session& session) {
  v1::FireTriggerRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_device(chosen_device(session).name());
  return report_done(session, session.connection.call(session.connection.settings,
                                                      &v1::SettingService::Stub::FireTrigger, request, kSettingLimit));
}

void outputs_options(CLI::App& verb, Options& options) {
  verb.add_option("SWITCH", options.value, "on or off, then OUT; or the word none: all off")
      ->check(CLI::IsMember({"on", "off", "none"}))
      ->type_name("");
  verb.add_option("OUT", options.outputs, "1 to 6; the others stay as they are")
      ->delimiter(',')
      ->check(CLI::Range(1, 6))
      ->type_name("");
}

void trigger_every_options(CLI::App& verb, Options& options) {
  verb.add_option("INTERVAL", options.interval, "2 to 30000 pulses of --axis, e.g. 1000; or a time, e.g. 0.2s")
      ->required()
      ->type_name("");
  CLI::Option* axis = verb.add_option("--axis", options.axis, "the axis whose pulses are counted")->type_name("AXIS");
  verb.add_option("--scale", options.scale, "count scale pulses in this direction, not drive pulses")
      ->check(CLI::IsMember({"+", "-"}))
      ->needs(axis)
      ->type_name("+|-");
}

// `outputs`, `trigger every` and `trigger off` have no --wait, because their settings end with the lease under which
// they were set.
constexpr Verb kSignalVerbs[] = {
    {.words = "outputs",
     .heading = Heading::settings,
     .description = "show or switch OUT1 to OUT6",
     .help = "Outputs that are not named stay as they are. Without arguments it shows which are on.",
     .examples = "axisctl outputs on 1 3\naxisctl outputs off 3\naxisctl outputs\naxisctl outputs none",
     .add_options = outputs_options,
     .run = outputs},
    {.words = "inputs",
     .heading = Heading::settings,
     .description = "show IN1 to IN6",
     .help = "Shows which inputs are on.",
     .examples = "axisctl inputs",
     .run = inputs},
    {.words = "trigger",
     .heading = Heading::settings,
     .description = "set the trigger output: pulses at intervals (every), off, one pulse (fire)",
     .help = "`axisctl help triggers` explains it.",
     .examples = "axisctl trigger every 0.2s\naxisctl trigger off\naxisctl trigger fire"},
    {.words = "trigger every",
     .description = "give a pulse at equal intervals",
     .add_options = trigger_every_options,
     .run = trigger_every},
    {.words = "trigger off", .description = "give no more pulses", .run = trigger_off},
    {.words = "trigger fire", .description = "give one pulse now", .run = trigger_fire, .waits = true},
};

}  // namespace

std::span<const Verb> signal_verbs() { return kSignalVerbs; }

}  // namespace axisgate::axisctl
