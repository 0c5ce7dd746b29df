// Any kind of request, asked as a door would, and the reason that refuses it.
#pragma once

#include <string_view>

#include "tests/api/world.h"

namespace axisgate::api {

inline constexpr const char* kSaved = "devices/turn/positions/saved";      // that there is
inline constexpr const char* kUnknownMotion = "devices/turn/motions/999";  // that there is not

// A position under that name.
void save_position(World& world);

// unspecified: it was done. What it started has ended by then.
Reason ask(World& world, RequestKind kind, const Call& call);

}  // namespace axisgate::api
