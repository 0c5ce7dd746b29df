// Parsing of the places in a job's file that --from names, and texts for places.
#pragma once

#include <string>
#include <string_view>

#include "axisgate/v1/mill.pb.h"
#include "device/jobs/place.h"

namespace axisgate::axisctl {

// Parses "12" or "12:340": a line, or a line and a column, both from 1. The offset of the result is 0. Throws Failure
// if the text is not valid, as does job_range().
jobs::Place job_place(const std::string& text);

// Parses one place, or two places with a hyphen between them: "8:1-13:1". One place is both ends of the range.
jobs::PlaceRange job_range(const std::string& text);

// Returns "line 8, column 75".
std::string place_text(const v1::JobPlace& place);
// Returns "line 8" for the first column, otherwise the same as place_text().
std::string line_text(const v1::JobPlace& place);

}  // namespace axisgate::axisctl
