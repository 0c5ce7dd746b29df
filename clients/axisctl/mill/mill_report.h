// Reports about a checked job, for people and for programs.
#pragma once

#include <string>

#include "device/rml1/check/check.h"

namespace axisgate::axisctl {

// Prints each diagnostic as `job.rml:3:7: error 2: ... [2-3]`, in the order of the job, and then how many are not
// shown.
void print_diagnostics(const std::string& file, const rml1::Diagnostics& diagnostics);
// Prints the job's moves on this machine, in mm.
void print_summary(const rml1::Check& check, const rml1::Profile& profile, bool origin_known);

// Prints one JSON object for each diagnostic, and one for the job, in steps of the workpiece's system and in mm.
// Defined in mill_json.cc.
void print_json(const rml1::Check& check, const rml1::Profile& profile);

}  // namespace axisgate::axisctl
