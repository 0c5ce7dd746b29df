// Limits of one connection and of one source. server/connections/README.md lists the attack that each limit prevents.
#pragma once

#include <chrono>
#include <cstddef>

#include "device/core/time.h"
#include "server/front/budget.h"
#include "server/front/pace.h"

namespace axisgate::front {

struct FrontLimits {
  // In the order of Cost. Streams, bytes and refusals beyond the rate wait, up to a bound; anything else ends the
  // connection.
  Rates connection{
      {{4'000, 8'000}, {1 << 20, 4 << 20}, {200, 2'000}, {10'000, 20'000}, {10, 50}, {50, 200}, {32 << 20, 64 << 20}}};
  SourceRates source{
      .frames{{{8'000, 16'000},
               {2 << 20, 8 << 20},
               {400, 4'000},
               {20'000, 40'000},
               {50, 2'000},
               {100, 400},
               {64 << 20, 128 << 20}}},
      .connections{200, 1'000},
      .handshakes{100, 400},
  };
  // Rates that a connection keeps even when other connections of its source have used up the source's rates: enough for
  // a stop.
  Rates guaranteed{{{20, 40}, {16 << 10, 64 << 10}, {2, 10}, {20, 100}, {1, 10}, {1, 5}, {64 << 10, 256 << 10}}};
  // Rates until a call is let in. A client sends one SETTINGS and a few WINDOW_UPDATEs before that.
  Rates stranger{{{50, 200}, {64 << 10, 64 << 10}, {10, 20}, {200, 400}, {5, 10}, {50, 200}, {64 << 10, 256 << 10}}};

  std::size_t header_bytes = 16 << 10;  // of one call, as RFC 9113 counts them (6.5.2)
  std::size_t header_fields = 128;      // of one call
  std::size_t continuations = 8;        // frames of one call's headers beyond the first
  std::size_t open_calls = 4'096;       // of one connection
  std::size_t answers = 128;            // open uncounted calls (stops) of one connection
  std::size_t message_bytes = 4 << 20;  // of a request, before compression
  std::size_t stop_bytes = 64 << 10;    // of the request of an uncounted call
  std::size_t held_bytes = 32 << 20;    // of incomplete requests, over all connections

  Pace::Least pace{512, std::chrono::seconds(10)};  // of a frame, of headers, of a message
  Duration silence = std::chrono::seconds(20);      // until the first call is complete
  Duration reserve_idle = std::chrono::seconds(1);  // of a connection of the reserve without a call
  Duration reserve_age = std::chrono::seconds(2);   // total age of such a connection
};

}  // namespace axisgate::front
