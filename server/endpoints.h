// Addresses to listen on, looked at before they are handed over, so that what is wrong with them can be said.
#pragma once

#include <string>

#include "device/core/problem.h"
#include "server/config.h"

namespace axisgate::server {

// Whether nobody listens there yet. Somebody may come in between: the listener then still fails, with fewer words.
Result<void> check_port_free(const TcpAddress& address);

// Makes the directory, one level, if it is missing (0755 under /run, else 0700: for this user alone) and removes a
// socket that nobody listens on any more. Refuses a directory in /tmp that is another's or open to others, a path that
// is not a socket, and a socket that somebody serves.
Result<void> prepare_socket(const std::string& path);

// Every local user may connect, as to the loopback port; the directory decides who reaches the socket.
void open_socket_to_users(const std::string& path);

}  // namespace axisgate::server
