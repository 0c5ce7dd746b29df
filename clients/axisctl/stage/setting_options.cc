// Options of the verbs that show or change settings of the controller.
#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "clients/axisctl/help_topics.h"
#include "clients/axisctl/verb_options.h"

namespace axisgate::axisctl {
namespace {

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

CLI::App* add_change(CLI::App& app, Options& options, OldVerb verb, const char* name, const char* description) {
  CLI::App* added = add_verb(app, options, verb, name, description);
  add_wait(*added, options);
  return added;
}

// `speed`, `outputs` and `trigger` have no --wait, because their settings end with the lease under which they were set.
void add_axis_settings(CLI::App& app, Options& options) {
  CLI::App* speed = add_verb(app, options, OldVerb::speed, "speed", "show or set the speeds of axes");
  add_axes(*speed, options);
  speed->add_option("--minimum", options.minimum, "speed at which a motion begins and ends, e.g. 10um/s")
      ->type_name("SPEED");
  speed->add_option("--maximum", options.maximum, "highest speed, e.g. 1mm/s")->type_name("SPEED");
  speed
      ->add_option("--acceleration", options.acceleration_ms,
                   "time in ms to speed up from the minimum to the maximum speed, and to slow down")
      ->check(CLI::Range(1, 1000))
      ->type_name("MS");
  speed->add_flag("--origin-return", options.origin_return, "the speeds of `home`: the mechanical origin return");

  CLI::App* motor = add_change(app, options, OldVerb::motor, "motor", "switch the current of motors on or off");
  add_several_axes(*motor, options);
  add_value(*motor, options, "SWITCH", {"on", "off"});
  CLI::App* loop = add_change(app, options, OldVerb::loop, "loop",
                              "closed loop (position feedback from the scale, the encoder) or open loop");
  add_several_axes(*loop, options);
  add_value(*loop, options, "LOOP", {"closed", "open"});
  CLI::App* divisions = add_change(app, options, OldVerb::divisions, "divisions",
                                   "set the microstep divisions of a motor driver: the resolution");
  divisions->add_option("AXIS", options.axes)->required()->expected(1)->allow_extra_args(false)->type_name("");
  divisions->add_option("NUMBER", options.divisions, "1 to 8000, e.g. 200")->required()->type_name("");
  add_axes(*add_change(app, options, OldVerb::zero, "zero", "set the coordinates of axes to 0, without motion"),
           options);
  add_axes(*add_change(app, options, OldVerb::unzero, "unzero", "undo `zero`"), options);
  add_change(app, options, OldVerb::preset, "preset", "set the coordinates of axes, without motion")
      ->add_option("AXIS=AMOUNT", options.places, "the new coordinate of each axis, e.g. 1=5mm")
      ->required()
      ->type_name("");
}

void add_controller_settings(CLI::App& app, Options& options) {
  add_verb(app, options, OldVerb::settings, "settings", "show all settings");
  add_change(app, options, OldVerb::settle, "settle",
             "set the settling time: the wait after a motion before the axis is READY")
      ->add_option("SECONDS", options.value, "0 to 255, in steps of 0.1")
      ->required()
      ->type_name("");
  add_change(app, options, OldVerb::sleep, "sleep", "put the controller to sleep: all motors off until `wake`");
  add_change(app, options, OldVerb::wake, "wake",
             "end the sleep: motors on. CAUTION: the stage moves back to its position before the sleep");
  add_value(*add_change(app, options, OldVerb::display, "display", "switch the light of the display on or off"),
            options, "SWITCH", {"on", "off"});
  add_value(*add_change(app, options, OldVerb::beep, "beep", "switch the beep of the controller on or off"), options,
            "SWITCH", {"on", "off"});
  add_value(*add_change(app, options, OldVerb::mode, "mode",
                        "for administrators: change the operation mode: HOST, MANUAL, REMOTE, ..."),
            options, "MODE", {"HOST", "MANUAL", "REMOTE", "TEACHING", "EDIT", "LOAD", "TEST"});
  add_value(*add_change(app, options, OldVerb::dialect, "dialect",
                        "for administrators: change the command format: SHOT_FC or HIT"),
            options, "DIALECT", {"SHOT_FC", "HIT"});
  add_verb(app, options, OldVerb::reset, "reset", "for administrators: restart the controller");
}

void add_signals(CLI::App& app, Options& options) {
  CLI::App* outputs = add_verb(app, options, OldVerb::outputs, "outputs", "show or switch OUT1 to OUT6");
  outputs->add_option("SWITCH", options.value, "on or off, then OUT; or the word none: all off")
      ->check(CLI::IsMember({"on", "off", "none"}))
      ->type_name("");
  outputs->add_option("OUT", options.outputs, "1 to 6; the others stay as they are")
      ->delimiter(',')
      ->check(CLI::Range(1, 6))
      ->type_name("");
  add_verb(app, options, OldVerb::inputs, "inputs", "show IN1 to IN6");
  CLI::App* trigger =
      app.add_subcommand("trigger", "set the trigger output: pulses at intervals (every), off, one pulse (fire)");
  trigger->require_subcommand(1);
  trigger->fallthrough();
  trigger->footer(help_text("trigger"));
  CLI::App* every = add_verb(*trigger, options, OldVerb::trigger_every, "every", "give a pulse at equal intervals");
  every->add_option("INTERVAL", options.interval, "2 to 30000 pulses of --axis, e.g. 1000; or a time, e.g. 0.2s")
      ->required()
      ->type_name("");
  CLI::Option* axis = every->add_option("--axis", options.axis, "the axis whose pulses are counted")->type_name("AXIS");
  every->add_option("--scale", options.scale, "count scale pulses in this direction, not drive pulses")
      ->check(CLI::IsMember({"+", "-"}))
      ->needs(axis)
      ->type_name("+|-");
  add_verb(*trigger, options, OldVerb::trigger_off, "off", "give no more pulses");
  add_change(*trigger, options, OldVerb::trigger_fire, "fire", "give one pulse now");
}

}  // namespace

void add_setting_verbs(CLI::App& app, Options& options) {
  add_controller_settings(app, options);
  add_axis_settings(app, options);
  add_signals(app, options);
}

}  // namespace axisgate::axisctl
