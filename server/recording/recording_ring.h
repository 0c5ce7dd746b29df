// The newest lines of a device's recording, for readers at their own pace.
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

// Thread safe. Appending never waits for a reader, but for the copying of one portion. All memory is taken at the
// start.
class RecordingRing {
 public:
  // Some ten minutes of an axis that moves, hours of one that rests.
  static constexpr std::size_t kBytesKept = 4 << 20;

  // `header` is that of the whole recording.
  RecordingRing(stage::RecordingHeader header, Executor readers, std::size_t bytes_kept = kBytesKept);

  // `line` is without a line end. The oldest lines make room; of a line that is too long for the whole ring only the
  // beginning is kept.
  void append(std::string_view line);

  // Where a reader is: just before a line. Counts on as long as the ring lives.
  struct Position {
    std::uint64_t byte = 0;
    std::uint64_t line = 0;
    friend bool operator==(const Position&, const Position&) = default;
  };
  // A place to begin, and what to say there first so that what follows is a recording.
  struct Beginning {
    std::string header;  // lines, each with its \n
    Position position;
  };
  Beginning oldest() const;
  Position newest() const;  // behind the newest line

  struct Reading {
    std::string text;  // whole lines, each with its \n; empty: there is nothing new
    Position next;     // where to read on
    // Lines from `from` on that were no longer kept; then the text begins with a header.
    std::uint64_t lost = 0;
  };
  // At most `bytes_max`, but one line at least; a header comes on top.
  Reading read(Position from, std::size_t bytes_max) const;

  // `wake` is called after lines were appended, perhaps once for many.
  std::unique_ptr<WakeUps::Subscription> subscribe(std::function<void()> wake);

 private:
  std::uint64_t end_of_line(std::uint64_t byte) const;  // the byte behind its \n
  void put(std::string_view text);
  void drop_oldest();
  std::string copy(std::uint64_t from, std::uint64_t to) const;

  mutable std::mutex mutex_;
  stage::RecordingHeader header_;  // of a recording that begins with the oldest line
  std::string bytes_;              // the byte at position p stands at p modulo its size
  Position oldest_, newest_;
  WakeUps wake_ups_;
};

}  // namespace axisgate::server
