// Converts the events of a controller to the lines of a recording.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "device/stage/event.h"
#include "device/stage/recording/recording.h"

namespace axisgate::stage {

// Not thread safe: runs on the controller's strand, between the controller and its other listeners.
//
// A line is finished when the next one begins, so the newest line stays here until then; flush() finishes it early. An
// exchange that is interrupted, or has more than kItemsMax pieces, continues in another line with the same number.
class Recorder : public EventSink {
 public:
  // Called with each finished line, without its newline, in order. Must not call back.
  using Take = std::function<void(std::string line)>;

  // `began` is time 0 of all lines; no event may be older.
  Recorder(RecordingHeader header, TimePoint began, Take take);

  void on_event(const Event& event, TimePoint now) override;

  // Finishes the current line. Call before reading the recording or closing its file.
  void flush();

  // Returns the header for a recording that begins with the next finished line.
  const RecordingHeader& header() const { return header_; }

 private:
  static constexpr std::size_t kItemsMax = 64;

  void tell(const BytesWritten& written);
  void tell(const BytesReceived& received);
  void tell(const ExchangeEnded& ended);
  void tell(const CompletionSeen& seen);
  void tell(const UnexpectedLine& line);
  void tell(const LinkChanged& change);
  void tell(const BarrierEntered& barrier);
  void tell(const LineLearned& learned);
  template <class Other>
  void tell(const Other&) {}  // not an event of the line

  void begin(std::uint64_t exchange);
  void go_on();
  void add(RecordedItem::Kind kind, std::string text);
  // Reports whether bytes received now belong to the last received piece.
  bool continues_piece(bool rest_of_end) const;
  void remark(RecordedRemark::Kind kind, AxisSet axes, std::string text);
  void finish(const RecordedEvent& event);

  RecordingHeader header_;
  TimePoint began_;
  Take take_;
  Duration now_{};  // time since began_
  std::optional<RecordedExchange> open_;
  Duration piece_began_{};
  char last_byte_ = '\0';        // last byte received
  bool complete_ = false;        // the next bytes received begin a new line
  std::uint64_t in_flight_ = 0;  // exchange to which received bytes belong; 0: none
};

}  // namespace axisgate::stage
