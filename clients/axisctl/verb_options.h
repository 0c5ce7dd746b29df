// Options that several verbs have.
#pragma once

#include "clients/axisctl/options.h"

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

// Adds a verb, whose help ends with its examples. `options` must outlive the parsing.
CLI::App* add_verb(CLI::App& app, Options& options, OldVerb verb, const char* name, const char* description);

// Defined in mill_options.cc.
void add_mill_verbs(CLI::App& app, Options& options);

}  // namespace axisgate::axisctl
