// Conversion of journal entries to lines for people.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "axisgate/v1/history.pb.h"

namespace axisgate::axisctl {

// Returns the entry as one line: "2026-11-24 02:11:07+01:00  stage  stop of axes 1, 2, 3, by unix bert".
std::string line_of(const v1::HistoryEntry& entry);

// Returns the command lines that were sent to the controller, each with its answer and the time from the motion's
// request until it was written: "  A:1+P20000  OK  2 ms".
std::vector<std::string> exchanges_of(const v1::HistoryEntry& entry);

// Returns when and where a motion ended, according to its entries, which are oldest first.
std::string life_text(std::uint64_t number, const std::vector<v1::HistoryEntry>& entries);

// Returns the command that writes the recording of a motion, which begins `at` after the start of the recording.
std::string record_text(const v1::HistoryEntry& requested, std::chrono::seconds at);

}  // namespace axisgate::axisctl
