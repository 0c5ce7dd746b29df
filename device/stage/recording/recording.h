// A recording of the line: text, one line an exchange, made to be read and diffed. README.md shows one.
//
// What it holds is all that went over the line, byte for byte, who caused it, and what the gateway made of it; it is
// enough to feed the line's core with it again (replay.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "device/core/lane.h"
#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/stage/axes.h"
#include "device/stage/profile.h"

namespace axisgate::stage {

// All times of a recording are in microseconds, truncated.
struct RecordingHeader {
  std::string kind = "shrc203";  // as in the configuration; parse_recording() knows this one alone
  std::string device{};          // its name in the configuration
  std::string serial_number{};   // the configured one; may be empty
  int baud = Profile{}.baud;
  Duration reply_limit = Profile{}.reply_limit;
  std::string started{};  // the wall time of time 0, for people

  // Of a recording that begins when the line is up: the controllable axes, and those whose numbers may come because
  // they were started before.
  std::optional<AxisSet> axes{};
  AxisSet may_complete{};
};

struct RecordedItem {
  enum class Kind {
    written,   // bytes
    received,  // bytes; what came within 16 ms, up to the end of a line, is one piece, at the time of its last byte, of
               // a line its CR
    ended,     // the exchange; text: the outcome's name
    completion,  // a completion was received; text: the number
    unexpected,  // a line that nothing waited for
  };
  Duration after{};  // since RecordedExchange::at
  Kind kind = Kind::written;
  std::string text;

  friend bool operator==(const RecordedItem&, const RecordedItem&) = default;
};

// What belongs together, in the order in which it happened.
struct RecordedExchange {
  Duration at{};               // since the recording's beginning
  std::uint64_t exchange = 0;  // 0: a probe of a barrier, or bytes that came by themselves
  // Set with the bytes that begin an exchange; not where it continues after another line of the recording.
  std::optional<Lane> lane;
  std::string who;      // empty: the line itself
  Duration waited{};    // from the asking to the write
  AxisSet completes{};  // the axes whose numbers may come from then on
  bool closed = false;  // an !:S follows an answer that could be such a number
  std::vector<RecordedItem> items;

  friend bool operator==(const RecordedExchange&, const RecordedExchange&) = default;
};

// What happened to the line as a whole, or, in `note`, any other line that begins with #.
struct RecordedRemark {
  enum class Kind { connecting, up, down, barrier, barrier_passed, same_controller, ready, busy, note };
  Duration at{};  // not of a note
  Kind kind = Kind::note;
  AxisSet axes{};    // of up, ready and busy
  std::string text;  // why, of down and barrier; of a note what stands behind the #

  friend bool operator==(const RecordedRemark&, const RecordedRemark&) = default;
};

using RecordedEvent = std::variant<RecordedExchange, RecordedRemark>;

struct RecordedLine {
  int number = 0;  // in the text, from 1
  RecordedEvent event;
};

struct Recording {
  RecordingHeader header;
  std::vector<RecordedLine> lines;
};

// The header's lines, each ended by a newline.
std::string to_text(const RecordingHeader& header);
// One line, without its newline.
std::string to_text(const RecordedEvent& event);

// invalid_request names the line of the text and what is wrong with it.
Result<Recording> parse_recording(std::string_view text);

// Makes of the header of a recording that begins with this event that of one which begins behind it.
void pass(RecordingHeader& header, const RecordedEvent& event);
// The same for a finished line of text, as a ring of the newest lines drops them.
void pass(RecordingHeader& header, std::string_view line);

}  // namespace axisgate::stage
