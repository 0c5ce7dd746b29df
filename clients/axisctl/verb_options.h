// Functions shared by options.cc and its groups of verbs.
#pragma once

#include <optional>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/options.h"

namespace CLI {
class App;
}

namespace axisgate::axisctl {

// Adds a verb, whose help ends with its examples. `options` must outlive the parsing.
CLI::App* add_verb(CLI::App& app, Options& options, Verb verb, const char* name, const char* description);

// Adds the option --wait.
void add_wait(CLI::App& verb, Options& options);

// Adds the optional argument AXES.
void add_axes(CLI::App& verb, Options& options);

// Returns an error for the first parsed argument that is not UTF-8; nullopt if all are. Defined in option_bytes.cc.
std::optional<Failure> not_utf8(const CLI::App& app, Verb verb);

// Defined in setting_options.cc.
void add_setting_verbs(CLI::App& app, Options& options);

// Defined in history_options.cc.
void add_history_verbs(CLI::App& app, Options& options);

// Defined in mill_options.cc.
void add_mill_verbs(CLI::App& app, Options& options);

}  // namespace axisgate::axisctl
