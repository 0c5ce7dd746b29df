#include "clients/axisctl/mill/job_number.h"

#include <CLI/CLI.hpp>

namespace axisgate::axisctl {

CLI::Option* add_job_number(CLI::App& verb, Options& options, const char* description) {
  return verb.add_option("JOB", options.job.number, description)->type_name("");
}

}  // namespace axisgate::axisctl
