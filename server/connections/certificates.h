// What is wrong with certificate files, found before gRPC would fail to serve with them and say nothing.
#pragma once

#include <string>

#include "device/core/problem.h"
#include "server/events/wall_time.h"

namespace axisgate::server {

// Whether the PEM file holds certificates and nothing broken. invalid_request with what is wrong.
Result<void> check_certificate(const std::string& path);

// Whether the PEM file holds a private key without a passphrase, which only this user and group may read, which others
// may not change, and which belongs to the first of `certificate`, if that is not empty. invalid_request with what is
// wrong.
Result<void> check_key(const std::string& path, const std::string& certificate);

// When the first certificate of the file expires. invalid_request as above.
Result<WallTime> expiry(const std::string& path);

}  // namespace axisgate::server
