// The newest lines of a device's recording, for readers at different speeds.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "device/stage/recording/recording.h"
#include "server/events/wake_ups.h"

namespace axisgate::server {

// Thread safe. Appending never waits for a reader, except while a reader copies one portion. All memory is taken at the
// start.
class RecordingRing {
 public:
  // About ten minutes of a moving axis, or hours of a stationary one.
  static constexpr std::size_t kBytesKept = 4 << 20;

  // `header` is the header of the whole recording.
  RecordingRing(stage::RecordingHeader header, Executor readers, std::size_t bytes_kept = kBytesKept);

  // Adds `line`, which has no line end. The oldest lines are removed to make room; a line longer than the whole ring is
  // cut.
  void append(std::string_view line);

  // Position of a reader, just before a line. Its numbers ascend as long as the ring lives.
  struct Position {
    std::uint64_t byte = 0;
    std::uint64_t line = 0;
    friend bool operator==(const Position&, const Position&) = default;
  };
  // Start of a recording: a position, and the header to put before its lines.
  struct Beginning {
    std::string header;  // lines, each with its \n
    Position position;
  };
  Beginning oldest() const;
  Position newest() const;  // after the newest line

  struct Reading {
    std::string text;  // whole lines, each with its \n; empty: no new lines
    Position next;     // position for the next read
    // Number of lines from `from` on that were no longer kept; if not 0, the text begins with a header.
    std::uint64_t lost = 0;
  };
  // Reads at most `bytes_max`, but at least one line; a header is not counted.
  Reading read(Position from, std::size_t bytes_max) const;

  // Calls `wake` after lines were appended, possibly once for many.
  std::unique_ptr<WakeUps::Subscription> subscribe(std::function<void()> wake);

 private:
  std::uint64_t end_of_line(std::uint64_t byte) const;  // the byte after its \n
  void put(std::string_view text);
  void drop_oldest();
  std::string copy(std::uint64_t from, std::uint64_t to) const;

  mutable std::mutex mutex_;
  stage::RecordingHeader header_;  // of a recording that begins with the oldest line
  std::string bytes_;              // the byte at position p is at index p modulo the size
  Position oldest_, newest_;
  WakeUps wake_ups_;
};

}  // namespace axisgate::server
