// Conversion of journal entries to CSV, for other programs.
#pragma once

#include <string>
#include <string_view>

#include "axisgate/v1/history.pb.h"

namespace axisgate::axisctl {

// Column names of csv_row().
inline constexpr std::string_view kCsvHeader = "number,time,kind,device,who,motion,details";

// Returns one row, quoted according to RFC 4180. The time is in UTC, according to RFC 3339. The other columns are as in
// HistoryEntry; devices and motions are shortened to the last part of their names.
std::string csv_row(const v1::HistoryEntry& entry);

}  // namespace axisgate::axisctl
