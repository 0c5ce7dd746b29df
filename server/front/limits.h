// What one connection, and one source, may cost the daemon. The table with the attack that each limit answers is in
// server/connections/README.md.
#pragma once

#include <chrono>
#include <cstddef>

#include "device/core/time.h"
#include "server/front/budget.h"
#include "server/front/pace.h"

namespace axisgate::front {

struct FrontLimits {
  // In the order of Cost. Streams, bytes and refusals beyond it wait, up to a bound; anything else ends the connection.
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
  // What a connection may do although others of its source have used up everything: enough for a stop.
  Rates spared{{{20, 40}, {16 << 10, 64 << 10}, {2, 10}, {20, 100}, {1, 10}, {1, 5}, {64 << 10, 256 << 10}}};
  // Until a call was let in. A client sends one SETTINGS and a few WINDOW_UPDATEs before that.
  Rates stranger{{{50, 200}, {64 << 10, 64 << 10}, {10, 20}, {200, 400}, {5, 10}, {50, 200}, {64 << 10, 256 << 10}}};

  std::size_t header_bytes = 16 << 10;  // of one call, as RFC 9113 counts them (6.5.2)
  std::size_t header_fields = 128;      // likewise
  std::size_t continuations = 8;        // frames of one call's headers beyond the first
  std::size_t open_calls = 4'096;       // of one connection
  std::size_t answers = 128;            // at once on one connection, of those that count for nobody: stops
  std::size_t message_bytes = 4 << 20;  // of a request, before compression
  std::size_t stop_bytes = 64 << 10;    // likewise, of those that count for nobody
  std::size_t held_bytes = 32 << 20;    // of requests that are not whole, of all connections together

  Pace::Least pace{512, std::chrono::seconds(10)};  // of a frame, of headers, of a message
  Duration silence = std::chrono::seconds(20);      // until the first call is whole
  Duration reserve_idle = std::chrono::seconds(1);  // of a connection of the reserve without a call
  Duration reserve_age = std::chrono::seconds(2);   // likewise, in all
};

}  // namespace axisgate::front
