// Parts of ask(), by subject. Each has the contract of ask().
#pragma once

#include "tests/api/world.h"

namespace axisgate::api {

// Recordings, reports and events; tokens; history.
Reason ask_readers(World& world, RequestKind kind, const Call& call);
Reason ask_tokens(World& world, RequestKind kind, const Call& call);
Reason ask_history(World& world, RequestKind kind, const Call& call);

// Forms with one answer of requests that are streams, too.
bool is_unary_form(RequestKind kind);
Reason ask_unary_form(World& world, RequestKind kind, const Call& call);

}  // namespace axisgate::api
