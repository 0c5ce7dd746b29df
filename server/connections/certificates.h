// Checks of certificate files, since gRPC would fail without a message.
#pragma once

#include <string>

#include "device/core/problem.h"
#include "server/events/wall_time.h"

namespace axisgate::server {

// Checks that the PEM file contains certificates and no damaged ones. Fails with invalid_request.
Result<void> check_certificate(const std::string& path);

// Checks that the PEM file contains a private key without a passphrase, which only this user and group may read, which
// others may not change, and which belongs to the first certificate in `certificate`, if that is not empty. Fails with
// invalid_request.
Result<void> check_key(const std::string& path, const std::string& certificate);

// Returns the time at which the first certificate of the file expires. Fails with invalid_request.
Result<WallTime> expiry(const std::string& path);

}  // namespace axisgate::server
