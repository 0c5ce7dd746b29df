// Sends any kind of request as a door would, and returns the reason of its refusal.
#pragma once

#include <string_view>

#include "tests/api/world.h"

namespace axisgate::api {

inline constexpr const char* kSaved = "devices/turn/positions/saved";      // a position that exists
inline constexpr const char* kUnknownMotion = "devices/turn/motions/999";  // a motion that does not exist

// Saves the position kSaved.
void save_position(World& world);

// Sends the request, and returns the reason of its refusal; unspecified if it was done. A motion that it started has
// ended when the function returns.
Reason ask(World& world, RequestKind kind, const Call& call);

}  // namespace axisgate::api
