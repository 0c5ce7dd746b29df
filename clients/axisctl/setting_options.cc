// What is typed behind the verbs that show or change what the controller is set to.
#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "clients/axisctl/help_topics.h"
#include "clients/axisctl/verb_options.h"

namespace axisgate::axisctl {
namespace {

void add_several_axes(CLI::App& verb, Options& options) {
  verb.add_option("AXES", options.axes, "numbers or names, as 1,2")
      ->required()
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("");
}

// One word of these, in either case.
void add_value(CLI::App& verb, Options& options, const char* name, std::vector<std::string> values) {
  verb.add_option(name, options.value)
      ->required()
      ->check(CLI::IsMember(std::move(values), CLI::ignore_case))
      ->type_name("");
}

CLI::App* add_change(CLI::App& app, Options& options, Verb verb, const char* name, const char* description) {
  CLI::App* added = add_verb(app, options, verb, name, description);
  add_wait(*added, options);
  return added;
}

// What `speed`, `outputs` and `trigger` set ends with the lease under which it was set, so that they have no --wait.
void add_axis_settings(CLI::App& app, Options& options) {
  CLI::App* speed = add_verb(app, options, Verb::speed, "speed", "show or set the speeds of axes");
  add_axes(*speed, options);
  speed->add_option("--minimum", options.minimum, "speed at which a motion begins and ends, as 10um")
      ->type_name("SPEED");
  speed->add_option("--maximum", options.maximum, "highest speed, as 1mm")->type_name("SPEED");
  speed->add_option("--acceleration", options.acceleration_ms, "time from minimum to maximum speed")
      ->check(CLI::Range(1, 1000))
      ->type_name("MS");
  speed->add_flag("--origin-return", options.origin_return, "the speeds of the mechanical origin return");

  CLI::App* motor = add_change(app, options, Verb::motor, "motor", "switch the motors' current");
  add_several_axes(*motor, options);
  add_value(*motor, options, "SWITCH", {"on", "off"});
  CLI::App* loop =
      add_change(app, options, Verb::loop, "loop", "closed or open loop: whether the scale holds the axes");
  add_several_axes(*loop, options);
  add_value(*loop, options, "LOOP", {"closed", "open"});
  CLI::App* divisions =
      add_change(app, options, Verb::divisions, "divisions", "of the motor driver; they set the resolution");
  divisions->add_option("AXIS", options.axes)->required()->expected(1)->allow_extra_args(false)->type_name("");
  divisions->add_option("NUMBER", options.divisions, "1 to 8000, as 200")->required()->type_name("");
  add_axes(*add_change(app, options, Verb::zero, "zero", "set the coordinates of axes to 0, without motion"), options);
  add_axes(*add_change(app, options, Verb::unzero, "unzero", "undo `zero`"), options);
  add_change(app, options, Verb::preset, "preset", "set the coordinates of axes, without motion")
      ->add_option("AXIS=AMOUNT", options.places, "as 1=5mm")
      ->required()
      ->type_name("");
}

void add_controller_settings(CLI::App& app, Options& options) {
  add_verb(app, options, Verb::settings, "settings", "show all settings");
  add_change(app, options, Verb::settle, "settle", "set the time between positioning and READY")
      ->add_option("SECONDS", options.value, "0 to 255, in steps of 0.1")
      ->required()
      ->type_name("");
  add_change(app, options, Verb::sleep, "sleep", "switch the motors off until `wake`");
  add_change(app, options, Verb::wake, "wake", "switch the motors on again; stages move back");
  add_value(*add_change(app, options, Verb::display, "display", "switch the lights of the display"), options, "SWITCH",
            {"on", "off"});
  add_value(*add_change(app, options, Verb::beep, "beep", "switch the controller's beep"), options, "SWITCH",
            {"on", "off"});
  add_value(*add_change(app, options, Verb::mode, "mode", "for administrators: change the operation mode"), options,
            "MODE", {"HOST", "MANUAL", "REMOTE", "TEACHING", "EDIT", "LOAD", "TEST"});
  add_value(*add_change(app, options, Verb::dialect, "dialect", "for administrators: change the command format"),
            options, "DIALECT", {"SHOT_FC", "HIT"});
  add_verb(app, options, Verb::reset, "reset", "for administrators: restart the controller");
}

void add_signals(CLI::App& app, Options& options) {
  CLI::App* outputs = add_verb(app, options, Verb::outputs, "outputs", "show or switch OUT1 to OUT6");
  outputs->add_option("SWITCH", options.value, "on or off; none: all off")
      ->check(CLI::IsMember({"on", "off", "none"}))
      ->type_name("");
  outputs->add_option("OUT", options.outputs, "1 to 6; the others stay as they are")
      ->delimiter(',')
      ->check(CLI::Range(1, 6))
      ->type_name("");
  add_verb(app, options, Verb::inputs, "inputs", "show IN1 to IN6");
  CLI::App* trigger = app.add_subcommand("trigger", "the trigger output: every, off, fire");
  trigger->require_subcommand(1);
  trigger->fallthrough();
  trigger->footer(help_text("trigger"));
  CLI::App* every = add_verb(*trigger, options, Verb::trigger_every, "every", "give a pulse at equal intervals");
  every->add_option("INTERVAL", options.interval, "2 to 30000 pulses of --axis, as 1000; or a time, as 0.2s")
      ->required()
      ->type_name("");
  CLI::Option* axis = every->add_option("--axis", options.axis, "the axis whose pulses are counted")->type_name("AXIS");
  every->add_option("--scale", options.scale, "count scale pulses in this direction, not drive pulses")
      ->check(CLI::IsMember({"+", "-"}))
      ->needs(axis)
      ->type_name("+|-");
  add_verb(*trigger, options, Verb::trigger_off, "off", "give no more pulses");
  add_change(*trigger, options, Verb::trigger_fire, "fire", "give one pulse now");
}

}  // namespace

void add_setting_verbs(CLI::App& app, Options& options) {
  add_controller_settings(app, options);
  add_axis_settings(app, options);
  add_signals(app, options);
}

}  // namespace axisgate::axisctl
