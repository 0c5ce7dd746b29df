// What is reported about a job, for people and for programs.
#pragma once

#include <string>

#include "device/rml1/check/check.h"

namespace axisgate::axisctl {

// `job.rml:3:7: error 2: ... [2-3]` for each, in the order of the job, and how many are not shown.
void print_diagnostics(const std::string& file, const rml1::Diagnostics& diagnostics);
// What the job does on this machine, in mm.
void print_summary(const rml1::Check& check, const rml1::Profile& profile, bool origin_known);

// One object for each diagnostic, and one of the job (mill_json.cc). Steps of the workpiece system, and mm.
void print_json(const rml1::Check& check, const rml1::Profile& profile);

}  // namespace axisgate::axisctl
