// Turns the events of a controller into the lines of a recording.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "device/stage/event.h"
#include "device/stage/recording/recording.h"

namespace axisgate::stage {

// Not thread safe: lives on the controller's strand, between it and its other listeners.
//
// A line is finished when the next one begins, so the newest stays here until then; flush() fetches it. An exchange
// that is interrupted, or has very many pieces, continues in a further line with its number.
class Recorder : public EventSink {
 public:
  // Takes a finished line without its newline, in order. Must not call back.
  using Take = std::function<void(std::string line)>;

  // `began` is time 0 of all lines; no event is older.
  Recorder(RecordingHeader header, TimePoint began, Take take);

  void on_event(const Event& event, TimePoint now) override;

  // Finishes the line under way: before a recording is read or a file is closed.
  void flush();

  // Heads a recording that begins with the next line to be finished.
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
  void tell(const Other&) {}  // not of the line

  void begin(std::uint64_t exchange);
  void go_on();
  void add(RecordedItem::Kind kind, std::string text);
  // Bytes that come in now belong to what came in last.
  bool continues_piece(bool rest_of_end) const;
  void remark(RecordedRemark::Kind kind, AxisSet axes, std::string text);
  void finish(const RecordedEvent& event);

  RecordingHeader header_;
  TimePoint began_;
  Take take_;
  Duration now_{};  // since began_
  std::optional<RecordedExchange> open_;
  Duration piece_began_{};
  char last_byte_ = '\0';        // that came in
  bool complete_ = false;        // what comes in next begins a line of its own
  std::uint64_t in_flight_ = 0;  // the exchange to which what comes in belongs; 0: none
};

}  // namespace axisgate::stage
