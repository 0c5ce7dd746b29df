// Places in a job's file, as they are typed with --from, and as they are shown.
#pragma once

#include <string>
#include <string_view>

#include "axisgate/v1/mill.pb.h"
#include "device/rml1/language/place.h"

namespace axisgate::axisctl {

// "12" or "12:340": a line, or a line and a column, from 1; its offset is 0. Throws Failure, also below.
rml1::Place job_place(const std::string& text);

// The same, or two of them with a hyphen between: "8:1-13:1". Alone it is both ends.
rml1::PlaceRange job_range(const std::string& text);

// "line 8, column 75"
std::string place_text(const v1::JobPlace& place);
// The same without the column if that is the first one: "line 8".
std::string line_text(const v1::JobPlace& place);

}  // namespace axisgate::axisctl
