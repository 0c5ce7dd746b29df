// Reader of journal entries: page by page, or as they are written.
#pragma once

#include <functional>

#include "axisgate/v1/history.pb.h"
#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// Prints a note if the daemon left out the entries of other callers: `own_only` of an answer.
void note_own_only(bool own_only);

using OnEntry = std::function<void(const v1::HistoryEntry&)>;

// Shows at most --limit entries, in the order of the request. Throws Failure.
void list_history(const Session& session, v1::ListHistoryRequest request, const OnEntry& show);

// Shows the newest entries, at most --limit, oldest first, and then each new entry within a second. Waits for a daemon
// that has ended. Never returns; throws Failure.
[[noreturn]] void follow_history(const Session& session, v1::ListHistoryRequest request, const OnEntry& show);

}  // namespace axisgate::axisctl
