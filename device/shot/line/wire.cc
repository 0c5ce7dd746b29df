#include "device/shot/line/wire.h"

#include <string>

namespace axisgate::shot {

std::uint64_t Wire::begin(const ExchangeRequest& request, TimePoint now) {
  write(request.command.line, ++exchanges_, &request, now);
  return exchanges_;
}

void Wire::write(std::string_view line, std::uint64_t exchange, const ExchangeRequest* cause, TimePoint now) {
  std::string bytes(line);
  bytes += "\r\n";
  // Saving to memory may take long, which is no sign of a restart.
  const Duration saving = cause ? cause->command.row->reply_limit : Duration::zero();
  continuity_.wrote(line, timing_.time_of(bytes.size() + timing_.reply_bytes_max()) + saving, now);
  BytesWritten written;
  written.bytes = bytes;
  written.exchange = exchange;
  if (cause) {
    written.who = cause->caller;
    written.lane = cause->lane;
    written.completes = cause->completes;
    written.motion = cause->motion;
    written.closed = cause->closed;
    written.question = cause->command.row->effect == Effect::question;
    if (!written.question) written.axes = cause->command.axes(controllable_);
  }
  // Reported before the bytes are written: a listener that records what was written must not be killed in between.
  listener_.line_event(written, now);
  link_.write(bytes);
}

}  // namespace axisgate::shot
