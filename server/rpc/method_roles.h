// Which role each method asks for.
#pragma once

#include <string_view>

#include "server/access/access.h"

namespace axisgate::rpc {

// Of "/axisgate.v1.StageService/Move"; admin for one that nobody has given a role.
server::Role role_for(std::string_view method, const server::Access& access);

}  // namespace axisgate::rpc
