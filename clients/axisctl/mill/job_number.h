// Argument JOB of the verbs of `axisctl mill`.
#pragma once

#include "clients/axisctl/arguments/options.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace axisgate::axisctl {

// Adds the optional argument JOB.
CLI::Option* add_job_number(CLI::App& verb, Options& options, const char* description);

}  // namespace axisgate::axisctl
