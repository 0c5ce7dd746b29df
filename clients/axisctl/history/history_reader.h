// The entries of the journal, page by page, and as they are written.
#pragma once

#include <functional>

#include "axisgate/v1/history.pb.h"
#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// Notes that entries of other callers are left out, if they are: `own_only` of an answer.
void note_own_only(bool own_only);

using OnEntry = std::function<void(const v1::HistoryEntry&)>;

// At most --limit of them, in the order of the request. Throws Failure.
void list_history(const Session& session, v1::ListHistoryRequest request, const OnEntry& show);

// The newest, at most --limit, oldest first, and then each new one within a second. A daemon that ends is waited for.
// Returns only by a Failure.
[[noreturn]] void follow_history(const Session& session, v1::ListHistoryRequest request, const OnEntry& show);

}  // namespace axisgate::axisctl
