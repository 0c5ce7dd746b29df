// A recording of the line: text with one exchange per line, made to be read and compared. device/shrc203/README.md
// shows an example.
//
// A recording has every byte on the line, the caller who caused it, and the gateway's interpretation; it is enough to
// feed the line's core again (replay.h).
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

// A RecordingHeader describes the device and the start of the recording. All times of a recording are in microseconds,
// truncated.
struct RecordingHeader {
  std::string kind = "shrc203";  // kind of device in the configuration; parse_recording() accepts only this one
  std::string device{};          // name of the device in the configuration
  std::string serial_number{};   // configured serial number; may be empty
  int baud = Profile{}.baud;
  Duration reply_limit = Profile{}.reply_limit;
  std::string started{};  // wall time at time 0, for people

  // For a recording that begins when the line is up: the controllable axes, and the axes whose completions may come
  // because they were started earlier.
  std::optional<AxisSet> axes{};
  AxisSet may_complete{};
};

struct RecordedItem {
  enum class Kind {
    written,     // bytes
    received,    // bytes; all bytes within 16 ms, up to the end of a line, form one piece, with the time of the last
                 // byte, or of the CR for a whole line
    ended,       // end of the exchange; text: name of the outcome
    completion,  // completion; text: axis number
    unexpected,  // unexpected line
  };
  Duration after{};  // time since RecordedExchange::at
  Kind kind = Kind::written;
  std::string text;

  friend bool operator==(const RecordedItem&, const RecordedItem&) = default;
};

// The items of one exchange, in the order in which they happened.
struct RecordedExchange {
  Duration at{};               // time since the beginning of the recording
  std::uint64_t exchange = 0;  // 0: a probe of a barrier, or bytes outside any exchange
  // Set with the bytes that begin an exchange; nullopt if the exchange continues after another line of the recording.
  std::optional<Lane> lane;
  std::string who;      // empty: the line itself
  Duration waited{};    // from the request to the write
  AxisSet completes{};  // axes whose completions may come from then on
  bool closed = false;  // an !:S follows, since the answer could be mistaken for a completion
  std::vector<RecordedItem> items;

  friend bool operator==(const RecordedExchange&, const RecordedExchange&) = default;
};

// An event of the line as a whole, or, as a `note`, any other line that begins with #.
struct RecordedRemark {
  enum class Kind { connecting, up, down, barrier, barrier_passed, same_controller, ready, busy, note };
  Duration at{};  // unset for a note
  Kind kind = Kind::note;
  AxisSet axes{};    // for up, ready and busy
  std::string text;  // reason, for down and barrier; for a note the text after the #

  friend bool operator==(const RecordedRemark&, const RecordedRemark&) = default;
};

using RecordedEvent = std::variant<RecordedExchange, RecordedRemark>;

struct RecordedLine {
  int number = 0;  // line number in the text, from 1
  RecordedEvent event;
};

struct Recording {
  RecordingHeader header;
  std::vector<RecordedLine> lines;
};

// Returns the header's lines, each with a newline.
std::string to_text(const RecordingHeader& header);
// Returns one line, without a newline.
std::string to_text(const RecordedEvent& event);

// Parses a recording. Fails with invalid_request, which names the line and its error.
Result<Recording> parse_recording(std::string_view text);

// Changes the header of a recording that begins with this event into the header of one that begins after it.
void pass(RecordingHeader& header, const RecordedEvent& event);
// Does the same for a finished line of text; used by a ring buffer that drops its oldest lines.
void pass(RecordingHeader& header, std::string_view line);

}  // namespace axisgate::stage
