// Boost.Asio's TLS, separate from asio.h because it includes OpenSSL's headers.
#pragma once

// clang-format off
#include "device/link/asio.h"
#include <boost/asio/ssl.hpp>
// clang-format on
