// Options that several verbs have.
#pragma once

#include "clients/axisctl/arguments/options.h"

namespace CLI {
class App;
}

namespace axisgate::axisctl {

// Adds the option --wait. Verbs with Verb::waits have it without this call.
void add_wait(CLI::App& verb, Options& options);

// Adds the optional argument AXES.
void add_axes(CLI::App& verb, Options& options);

// Adds the flag --no-wait.
void add_waiting(CLI::App& verb, Options& options);

// Adds the options --speed and --acceleration-ms. `description` is that of --speed.
void add_speed(CLI::App& verb, Options& options, const char* description);

}  // namespace axisgate::axisctl
