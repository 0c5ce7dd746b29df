// What options.cc and its groups of verbs share: a verb and what may stand behind several of them.
#pragma once

#include <optional>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/options.h"

namespace CLI {
class App;
}

namespace axisgate::axisctl {

// `options` outlives the parsing. The verb's own help ends with its examples.
CLI::App* add_verb(CLI::App& app, Options& options, Verb verb, const char* name, const char* description);

// --wait
void add_wait(CLI::App& verb, Options& options);

// [AXES]
void add_axes(CLI::App& verb, Options& options);

// option_bytes.cc: names the first argument, of what was parsed, that is not UTF-8. nullopt if all are.
std::optional<Failure> not_utf8(const CLI::App& app, Verb verb);

// setting_options.cc
void add_setting_verbs(CLI::App& app, Options& options);

// history_options.cc
void add_history_verbs(CLI::App& app, Options& options);

// mill_options.cc
void add_mill_verbs(CLI::App& app, Options& options);

}  // namespace axisgate::axisctl
