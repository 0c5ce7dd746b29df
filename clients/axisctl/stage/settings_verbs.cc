// settings, speed, motor, loop, divisions, settle, sleep, wake, display, beep, mode, dialect, reset: settings of the
// controller.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clients/axisctl/arguments/verb_options.h"
#include "clients/axisctl/failure.h"
#include "clients/axisctl/parse.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/stage/setting_calls.h"
#include "clients/axisctl/verbs.h"
#include "device/core/quantity.h"

namespace axisgate::axisctl {
namespace {

bool switched_on(const Session& session) { return session.options.value == "on"; }

std::string label_of(const v1::Device& device, const std::string& axis) { return axis_label(find_axis(device, axis)); }

std::string profile_text(const v1::Profile& profile) {
  const std::string time =
      profile.has_acceleration_time() ? fmt::format("{} ms", milliseconds(profile.acceleration_time())) : "?";
  return fmt::format("minimum {}, maximum {}, acceleration {}", speed_text(profile.minimum()),
                     speed_text(profile.maximum()), time);
}

void print_axis(const v1::Device& device, const v1::AxisSettings& axis) {
  const auto print = [name = label_of(device, axis.axis())](std::string_view item, std::string_view value) {
    print_line(fmt::format("{}  {}  {}", name, item, value));
  };
  print("motor", !axis.has_excited() ? "?" : axis.excited() ? "on" : "off");
  print("loop", !axis.has_closed_loop() ? "?" : axis.closed_loop() ? "closed" : "open");
  print("speed", profile_text(axis.speeds()));
  print("speed of the origin return", profile_text(axis.origin_speeds()));
  print("divisions", axis.has_divisions() ? std::to_string(axis.divisions()) : "?");
  print("name on the device", axis.name_on_device().empty() ? "?" : axis.name_on_device());
  print("scale resolution", axis.scale_resolution().empty() ? "?" : axis.scale_resolution() + " nm");
}

std::string settling_text(const v1::Settings& settings) {
  if (!settings.has_settling_time()) return "?";
  constexpr std::int64_t nanoseconds_per_tenth = 100'000'000;
  const std::int64_t tenths =
      settings.settling_time().seconds() * 10 + settings.settling_time().nanos() / nanoseconds_per_tenth;
  return to_string(Decimal{tenths, 1}) + " s";
}

void print_settings(const v1::Device& device, const v1::Settings& settings) {
  const auto print = [](std::string_view item, std::string_view value) {
    print_line(fmt::format("{}  {}", item, value));
  };
  const auto on_or_off = [](bool known, bool on) { return !known ? "?" : on ? "on" : "off"; };
  for (const v1::AxisSettings& axis : settings.axes()) print_axis(device, axis);
  print("settling", settling_text(settings));
  print("sleep", on_or_off(settings.has_sleeping(), settings.sleeping()));
  print("display", on_or_off(settings.has_display_lit(), settings.display_lit()));
  print("beep", on_or_off(settings.has_beep(), settings.beep()));
  print("outputs", settings.has_outputs() ? pins_text(settings.outputs(), "OUT") : "?");
  print("inputs", settings.has_inputs() ? pins_text(settings.inputs(), "IN") : "?");
  print("trigger", settings.has_trigger() ? trigger_text(settings.trigger()) : "?");
  print("mode", settings.mode() == v1::MODE_UNSPECIFIED ? "?" : mode_text(settings.mode()));
  print("dialect", settings.format() == v1::COMMAND_FORMAT_UNSPECIFIED ? "?" : format_text(settings.format()));
}

int show_speeds(const Session& session, const v1::Device& device) {
  const v1::Settings settings = settings_of(session, device);
  for (const int wanted : chosen_axes(session, device)) {
    for (const v1::AxisSettings& axis : settings.axes()) {
      if (axis.axis() != std::to_string(wanted)) continue;
      const v1::Profile& profile = session.options.origin_return ? axis.origin_speeds() : axis.speeds();
      if (session.options.json) {
        print_json(axis);
      } else {
        print_line(fmt::format("{}  {}", label_of(device, axis.axis()), profile_text(profile)));
      }
    }
  }
  return kDone;
}

v1::Profile wanted_profile(const Options& options, const v1::Axis& axis) {
  v1::Profile profile;
  if (!options.minimum.empty()) *profile.mutable_minimum() = parse_speed_for(axis, options.minimum);
  if (!options.maximum.empty()) *profile.mutable_maximum() = parse_speed_for(axis, options.maximum);
  if (options.acceleration_ms != 0) *profile.mutable_acceleration_time() = from_milliseconds(options.acceleration_ms);
  return profile;
}

// Changes the settings that `set` sets, for every axis that was named.
template <class Set>
int change_axes(const Session& session, Set set) {
  const v1::Device device = chosen_device(session);
  v1::Settings wanted;
  for (const int number : chosen_axes(session, device)) {
    v1::AxisSettings& axis = *wanted.add_axes();
    axis.set_axis(std::to_string(number));
    set(axis, find_axis(device, std::to_string(number)));
  }
  return change_settings(session, device, wanted);
}

template <class Set>
int change_controller(const Session& session, Set set) {
  v1::Settings wanted;
  set(wanted);
  return change_settings(session, chosen_device(session), wanted);
}

std::int64_t settling_tenths(const std::string& text) {
  constexpr std::int64_t most = 2550;  // 255 s (manual 56))
  if (const std::optional<std::int64_t> tenths = parse_steps(text, 1, most)) return *tenths;
  throw usage(fmt::format("\"{}\" is not 0 to 255 s in steps of 0.1 s", text), "e.g. `axisctl settle 0.1`");
}

int show_settings(const Session& session) {
  const v1::Device device = chosen_device(session);
  const v1::Settings settings = settings_of(session, device);
  session.options.json ? print_json(settings) : print_settings(device, settings);
  return kDone;
}

int speeds(const Session& session) {
  const Options& options = session.options;
  if (options.minimum.empty() && options.maximum.empty() && options.acceleration_ms == 0) {
    return show_speeds(session, chosen_device(session));
  }
  return change_axes(session, [&](v1::AxisSettings& wanted, const v1::Axis& axis) {
    *(options.origin_return ? wanted.mutable_origin_speeds() : wanted.mutable_speeds()) = wanted_profile(options, axis);
  });
}

int switch_motor(const Session& session) {
  return change_axes(session,
                     [&](v1::AxisSettings& wanted, const v1::Axis&) { wanted.set_excited(switched_on(session)); });
}

int change_loop(const Session& session) {
  return change_axes(session, [&](v1::AxisSettings& wanted, const v1::Axis&) {
    wanted.set_closed_loop(session.options.value == "closed");
  });
}

int change_divisions(const Session& session) {
  return change_axes(
      session, [&](v1::AxisSettings& wanted, const v1::Axis&) { wanted.set_divisions(session.options.divisions); });
}

int change_settling(const Session& session) {
  const std::int64_t tenths = settling_tenths(session.options.value);
  return change_controller(session, [&](v1::Settings& wanted) {
    wanted.mutable_settling_time()->set_seconds(tenths / 10);
    wanted.mutable_settling_time()->set_nanos(static_cast<std::int32_t>(tenths % 10) * 100'000'000);
  });
}

int sleep_controller(const Session& session) {
  return change_controller(session, [](v1::Settings& wanted) { wanted.set_sleeping(true); });
}

int wake_controller(const Session& session) {
  return change_controller(session, [](v1::Settings& wanted) { wanted.set_sleeping(false); });
}

int switch_display(const Session& session) {
  return change_controller(session, [&](v1::Settings& wanted) { wanted.set_display_lit(switched_on(session)); });
}

int switch_beep(const Session& session) {
  return change_controller(session, [&](v1::Settings& wanted) { wanted.set_beep(switched_on(session)); });
}

int change_mode(const Session& session) {
  return change_controller(session, [&](v1::Settings& wanted) { wanted.set_mode(parse_mode(session.options.value)); });
}

int change_dialect(const Session& session) {
  return change_controller(session,
                           [&](v1::Settings& wanted) { wanted.set_format(parse_format(session.options.value)); });
}

int reset_controller(const Session& session) {
  v1::ResetDeviceRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_device(chosen_device(session).name());
  return report_done(session, session.connection.call(session.connection.settings,
                                                      &v1::SettingService::Stub::ResetDevice, request, kSettingLimit));
}

void add_several_axes(CLI::App& verb, Options& options) {
  verb.add_option("AXES", options.axes, "numbers or names, e.g. 1,2")
      ->required()
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("");
}

// Adds an argument that must be one of `values`, in upper or lower case.
void add_value(CLI::App& verb, Options& options, const char* name, std::vector<std::string> values) {
  verb.add_option(name, options.value)
      ->required()
      ->check(CLI::IsMember(std::move(values), CLI::ignore_case))
      ->type_name("");
}

void add_switch(CLI::App& verb, Options& options) { add_value(verb, options, "SWITCH", {"on", "off"}); }

void settle_options(CLI::App& verb, Options& options) {
  verb.add_option("SECONDS", options.value, "0 to 255, in steps of 0.1")->required()->type_name("");
}

void mode_options(CLI::App& verb, Options& options) {
  add_value(verb, options, "MODE", {"HOST", "MANUAL", "REMOTE", "TEACHING", "EDIT", "LOAD", "TEST"});
}

void dialect_options(CLI::App& verb, Options& options) { add_value(verb, options, "DIALECT", {"SHOT_FC", "HIT"}); }

void speed_options(CLI::App& verb, Options& options) {
  add_axes(verb, options);
  verb.add_option("--minimum", options.minimum, "speed at which a motion begins and ends, e.g. 10um/s")
      ->type_name("SPEED");
  verb.add_option("--maximum", options.maximum, "highest speed, e.g. 1mm/s")->type_name("SPEED");
  verb.add_option("--acceleration", options.acceleration_ms,
                  "time in ms to speed up from the minimum to the maximum speed, and to slow down")
      ->check(CLI::Range(1, 1000))
      ->type_name("MS");
  verb.add_flag("--origin-return", options.origin_return, "the speeds of `home`: the mechanical origin return");
}

void motor_options(CLI::App& verb, Options& options) {
  add_several_axes(verb, options);
  add_switch(verb, options);
}

void loop_options(CLI::App& verb, Options& options) {
  add_several_axes(verb, options);
  add_value(verb, options, "LOOP", {"closed", "open"});
}

void divisions_options(CLI::App& verb, Options& options) {
  verb.add_option("AXIS", options.axes)->required()->expected(1)->allow_extra_args(false)->type_name("");
  verb.add_option("NUMBER", options.divisions, "1 to 8000, e.g. 200")->required()->type_name("");
}

// `speed` has no --wait, because speeds end with the lease under which they were set.
constexpr Verb kSettingsVerbs[] = {
    {.words = "settings",
     .heading = Heading::settings,
     .description = "show all settings",
     .help =
         R"(Shows all settings, one per line. These commands change settings: speed, motor, loop, divisions, settle, sleep, wake,
display, beep, mode, dialect, outputs, trigger. zero, unzero and preset set coordinates. reset restarts the controller.
A setting stays until it is set again, or until the controller restarts. Speeds, outputs and the trigger end with the
lease under which they were set.)",
     .examples = "axisctl settings\naxisctl --json settings",
     .run = show_settings},
    {.words = "settle",
     .heading = Heading::settings,
     .description = "set the settling time: the wait after a motion before the axis is READY",
     .help = "The wait between the end of positioning and READY: 0 to 255 s in steps of 0.1 s.",
     .examples = "axisctl settle 0.1\naxisctl settle 0",
     .add_options = settle_options,
     .run = change_settling,
     .waits = true},
    {.words = "sleep",
     .heading = Heading::settings,
     .description = "put the controller to sleep: all motors off until `wake`",
     .help = "Nothing moves until `axisctl wake`.",
     .examples = "axisctl sleep",
     .run = sleep_controller,
     .waits = true},
    {.words = "wake",
     .heading = Heading::settings,
     .description = "end the sleep: motors on. CAUTION: the stage moves back to its position before the sleep",
     .help = "CAUTION: axes move. The stage moves back to its position before the sleep.",
     .examples = "axisctl wake",
     .run = wake_controller,
     .waits = true},
    {.words = "display",
     .heading = Heading::settings,
     .description = "switch the light of the display on or off",
     .examples = "axisctl display off\naxisctl display on",
     .add_options = add_switch,
     .run = switch_display,
     .waits = true},
    {.words = "beep",
     .heading = Heading::settings,
     .description = "switch the beep of the controller on or off",
     .examples = "axisctl beep off\naxisctl beep on",
     .add_options = add_switch,
     .run = switch_beep,
     .waits = true},
    {.words = "mode",
     .heading = Heading::settings,
     .description = "for administrators: change the operation mode: HOST, MANUAL, REMOTE, ...",
     .help = "In a non-host mode the daemon cannot reach the controller until HOST is chosen at the front panel.",
     .examples = "axisctl mode HOST",
     .add_options = mode_options,
     .run = change_mode,
     .waits = true},
    {.words = "dialect",
     .heading = Heading::settings,
     .description = "for administrators: change the command format: SHOT_FC or HIT",
     .help = "The daemon uses SHOT_FC. In HIT the device is down until SHOT_FC is chosen at the front panel.",
     .examples = "axisctl dialect SHOT_FC",
     .add_options = dialect_options,
     .run = change_dialect,
     .waits = true},
    {.words = "reset",
     .heading = Heading::settings,
     .description = "for administrators: restart the controller",
     .help =
         R"(Settings return to the values of the memory switches, and coordinates become 0: home the axes again. Leases end.)",
     .examples = "axisctl reset",
     .run = reset_controller},
    {.words = "speed",
     .heading = Heading::settings,
     .description = "show or set the speeds of axes",
     .help =
         R"(An axis speeds up from MINIMUM to MAXIMUM within the time of --acceleration. An option that is left out stays as it is.
Without options the present speeds are shown. With --origin-return they are those of the mechanical origin return.)",
     .examples = R"(axisctl speed 1,2
axisctl speed 1 --minimum 10um --maximum 1mm --acceleration 50
axisctl speed 1,2 --maximum 0.5mm/s --origin-return)",
     .add_options = speed_options,
     .run = speeds},
    {.words = "motor",
     .heading = Heading::settings,
     .description = "switch the current of motors on or off",
     .help = "Without current an axis can be moved by hand, and its position is uncertain.",
     .examples = "axisctl motor 3 off\naxisctl motor 3 on",
     .add_options = motor_options,
     .run = switch_motor,
     .waits = true},
    {.words = "loop",
     .heading = Heading::settings,
     .description = "closed loop (position feedback from the scale, the encoder) or open loop",
     .help = "In closed loop the controller holds an axis at its position by its scale, an encoder.",
     .examples = "axisctl loop 1 closed\naxisctl loop 1,2 open",
     .add_options = loop_options,
     .run = change_loop,
     .waits = true},
    {.words = "divisions",
     .heading = Heading::settings,
     .description = "set the microstep divisions of a motor driver: the resolution",
     .help = "They change the resolution, and so the meaning of all coordinates in pulses.",
     .examples = "axisctl divisions 3 100\naxisctl divisions 3 200",
     .add_options = divisions_options,
     .run = change_divisions,
     .waits = true},
};

}  // namespace

std::span<const Verb> settings_verbs() { return kSettingsVerbs; }

}  // namespace axisgate::axisctl
