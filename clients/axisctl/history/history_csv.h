// Entries of the journal as a table for other programs.
#pragma once

#include <string>
#include <string_view>

#include "axisgate/v1/history.pb.h"

namespace axisgate::axisctl {

// The names of the columns of csv_row().
inline constexpr std::string_view kCsvHeader = "number,time,kind,device,who,motion,details";

// Quoted as RFC 4180 says. The time is in UTC, as RFC 3339 says; the other columns are as in HistoryEntry, without the
// names of their collections.
std::string csv_row(const v1::HistoryEntry& entry);

}  // namespace axisgate::axisctl
