#include "clients/axisctl/arguments/verb_options.h"

#include <CLI/CLI.hpp>

namespace axisgate::axisctl {

void add_wait(CLI::App& verb, Options& options) {
  verb.add_option("--wait", options.wait_s, "if another lease holds the axes, wait up to S seconds for them")
      ->check(CLI::Range(1, 86'400))
      ->type_name("S");
}

void add_axes(CLI::App& verb, Options& options) {
  verb.add_option("AXES", options.axes, "numbers or names (default: all axes)")->delimiter(',')->type_name("");
}

void add_waiting(CLI::App& verb, Options& options) {
  verb.add_flag("--no-wait", options.no_wait, "exit once the motion has started; do not wait for its end");
}

void add_speed(CLI::App& verb, Options& options, const char* description) {
  verb.add_option("--speed", options.speed, description)->type_name("SPEED");
  verb.add_option("--acceleration-ms", options.acceleration_ms,
                  "time in ms to speed up from the minimum to the maximum speed, and to slow down")
      ->check(CLI::Range(1, 1000))
      ->type_name("MS");
}

}  // namespace axisgate::axisctl
