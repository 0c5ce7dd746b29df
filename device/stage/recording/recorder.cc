#include "device/stage/recording/recorder.h"

#include <utility>

namespace axisgate::stage {

namespace {

using Item = RecordedItem::Kind;
using Remark = RecordedRemark::Kind;

// Longest piece: a USB adapter with the usual latency timer delivers these bytes together.
constexpr Duration kOnePiece = std::chrono::milliseconds(16);
constexpr std::size_t kPieceBytes = 256;  // longer than any line

}  // namespace

Recorder::Recorder(RecordingHeader header, TimePoint began, Take take)
    : header_(std::move(header)), began_(began), take_(std::move(take)) {}

void Recorder::on_event(const Event& event, TimePoint now) {
  now_ = std::chrono::floor<std::chrono::microseconds>(now - began_);
  std::visit([this](const auto& what) { tell(what); }, event);
}

void Recorder::flush() {
  complete_ = false;
  if (open_) finish(*std::exchange(open_, {}));
}

void Recorder::tell(const BytesWritten& written) {
  const bool continues = written.exchange > 0 && written.exchange == in_flight_;
  if (continues) {
    go_on();
  } else {
    begin(written.exchange);
    in_flight_ = written.exchange;
    if (written.exchange > 0) {
      open_->lane = written.lane;
      open_->who = written.who;
      open_->completes = written.completes;
      open_->closed = written.closed;
    }
  }
  add(Item::written, written.bytes);
}

void Recorder::tell(const BytesReceived& received) {
  const bool rest_of_end = received.bytes == "\n" && last_byte_ == '\r' && open_;
  if (complete_ && !rest_of_end) flush();
  if (!complete_) go_on();
  const bool joined = continues_piece(rest_of_end);
  if (!joined) {
    add(Item::received, {});
    piece_began_ = now_;
  }
  RecordedItem& piece = open_->items.back();
  // A line is complete with its CR, so its LF does not change its time.
  if (!joined || !rest_of_end) piece.after = now_ - open_->at;
  piece.text += received.bytes;
  last_byte_ = received.bytes.back();
  complete_ = complete_ || (open_->exchange == 0 && received.bytes.ends_with('\n'));
}

// A piece ends with a line's LF, since the line's arrival time may decide how long the line must be silent.
bool Recorder::continues_piece(bool rest_of_end) const {
  if (open_->items.empty() || now_ - piece_began_ > kOnePiece) return false;
  const RecordedItem& last = open_->items.back();
  if (last.kind != Item::received || last.text.size() >= kPieceBytes) return false;
  const bool whole = last.text.find_first_of("\r\n", last.text.starts_with('\n') ? 1 : 0) != std::string::npos;
  return rest_of_end ? !last.text.ends_with('\n') : !whole;
}

void Recorder::tell(const ExchangeEnded& ended) {
  go_on();
  if (open_->lane) open_->waited = ended.waited;
  add(Item::ended, std::string(name(ended.outcome)));
  in_flight_ = 0;
  complete_ = true;
}

void Recorder::tell(const CompletionSeen& seen) {
  if (seen.deduced) return;
  if (!open_) go_on();
  add(Item::completion, std::to_string(seen.axis));
}

void Recorder::tell(const UnexpectedLine& line) {
  if (!open_) go_on();
  add(Item::unexpected, line.text);
}

void Recorder::tell(const LinkChanged& change) {
  in_flight_ = 0;
  switch (change.link) {
    case LinkState::connecting:
      return remark(Remark::connecting, {}, {});
    case LinkState::up:
      return remark(Remark::up, change.controllable, {});
    case LinkState::down:
    case LinkState::babbling:
      return remark(Remark::down, {}, change.why);
    default:
      return;
  }
}

void Recorder::tell(const BarrierEntered& barrier) { remark(Remark::barrier, {}, barrier.why); }

void Recorder::tell(const LineLearned& learned) {
  switch (learned.what) {
    case LineLearned::What::barrier_passed:
      return remark(Remark::barrier_passed, {}, {});
    case LineLearned::What::same_controller:
      return remark(Remark::same_controller, {}, {});
    case LineLearned::What::ready:
      return remark(Remark::ready, learned.axes, {});
    case LineLearned::What::busy:
      return remark(Remark::busy, learned.axes, {});
  }
}

void Recorder::begin(std::uint64_t exchange) {
  flush();
  open_.emplace();
  open_->at = now_;
  open_->exchange = exchange;
}

// Makes sure that a line is open for the exchange in flight, or for bytes outside any exchange: continues the current
// line or begins another.
void Recorder::go_on() {
  const bool full = open_ && open_->items.size() >= kItemsMax;
  if (!open_ || full || (open_->exchange != in_flight_ && !complete_)) begin(in_flight_);
}

void Recorder::add(RecordedItem::Kind kind, std::string text) {
  open_->items.push_back({now_ - open_->at, kind, std::move(text)});
}

void Recorder::remark(RecordedRemark::Kind kind, AxisSet axes, std::string text) {
  flush();
  finish(RecordedRemark{now_, kind, axes, std::move(text)});
}

void Recorder::finish(const RecordedEvent& event) {
  pass(header_, event);
  take_(to_text(event));
}

}  // namespace axisgate::stage
