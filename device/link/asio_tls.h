// Boost.Asio's TLS, apart from asio.h: it brings OpenSSL's headers.
#pragma once

// clang-format off
#include "device/link/asio.h"
#include <boost/asio/ssl.hpp>
// clang-format on
