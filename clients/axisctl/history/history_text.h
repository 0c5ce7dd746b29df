// Entries of the journal as lines for people.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "axisgate/v1/history.pb.h"

namespace axisgate::axisctl {

// "2026-11-24 02:11:07  stage  stop of axes 1, 2, 3, by unix bert".
std::string line_of(const v1::HistoryEntry& entry);

// The lines that a controller was sent, each with its answer and when it was written after the motion's request:
// "  A:1+P20000  OK  2 ms".
std::vector<std::string> exchanges_of(const v1::HistoryEntry& entry);

// When a motion ended and where, by its entries, oldest first.
std::string life_text(std::uint64_t number, const std::vector<v1::HistoryEntry>& entries);

// How to get the recording of a motion, which begins `at` after the recording.
std::string record_text(const v1::HistoryEntry& requested, std::chrono::seconds at);

}  // namespace axisgate::axisctl
