// What one connection, and one source, may cost the daemon. The table with the attack that each limit answers is in
// server/connections/README.md.
#pragma once

#include <chrono>
#include <cstddef>

#include "device/core/time.h"
#include "server/front/budget.h"

namespace axisgate::front {

struct FrontLimits {
  // In the order of Cost. Streams, bytes of headers and refusals beyond it wait, up to a bound; anything else ends the
  // connection.
  Rates connection{{{4'000, 8'000}, {1 << 20, 4 << 20}, {200, 2'000}, {10'000, 20'000}, {10, 50}, {50, 200}}};
  SourceRates source{
      .frames{{{8'000, 16'000}, {2 << 20, 8 << 20}, {400, 4'000}, {20'000, 40'000}, {50, 2'000}, {100, 400}}},
      .connections{200, 1'000},
      .handshakes{100, 400},
  };
  // What a connection may do although others of its source have used up everything: enough for a stop.
  Rates spared{{{20, 40}, {16 << 10, 64 << 10}, {2, 10}, {20, 100}, {1, 10}, {1, 5}}};
  // Until a call was let in. A client sends one SETTINGS and a few WINDOW_UPDATEs before that.
  Rates stranger{{{50, 200}, {64 << 10, 64 << 10}, {10, 20}, {200, 400}, {5, 10}, {50, 200}}};

  std::size_t header_bytes = 16 << 10;   // names and values of one call
  std::size_t continuations = 8;         // frames of one call's headers beyond the first
  std::size_t open_calls = 4'096;        // of one connection
  std::size_t answers = 64;              // at once on one connection, of those that count for nobody: stops
  std::size_t message_bytes = 64 << 10;  // of a request that the front answers itself
  std::size_t requests_bytes = 4 << 20;  // of all of them on one connection that are not whole

  Duration silence = std::chrono::seconds(20);      // until the first call is whole
  Duration frame_time = std::chrono::seconds(10);   // for the rest of a frame, or of a call's headers
  Duration reserve_idle = std::chrono::seconds(1);  // of a connection of the reserve without a call
  Duration reserve_age = std::chrono::seconds(2);   // likewise, in all
};

}  // namespace axisgate::front
