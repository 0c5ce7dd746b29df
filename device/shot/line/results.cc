#include "device/shot/line/results.h"

#include <optional>

namespace axisgate::shot {

void Results::finish(const ExchangeResult& result, Outcome outcome, TimePoint now) {
  const std::optional<InFlight> done = exchange_.ended();
  if (!done) return;
  const ExchangeRequest& request = done->request();
  if (result.reply) {
    completions_.answered(done->written, busy_in(request, *result.reply));
    flood_.belonged(result.reply->text.size() + LineTiming::kTerminator);
    if (done->numbers.empty() && request.lane != Lane::stop) {  // a ?:CMD may have been sent before a stop
      timing_.answered(request.command.line.size(), result.reply->text.size(), now - done->written);
    }
  }
  report(*done, result, outcome, now);
  done->waiting->deliver(result);
}

void Results::report(const InFlight& ended, const ExchangeResult& result, Outcome outcome, TimePoint now) {
  const ExchangeRequest& request = ended.request();
  listener_.line_event(ExchangeEnded{.command = request.command.row->name,
                                     .line = request.command.line,
                                     .reply = result.reply ? result.reply->text : "",
                                     .lane = request.lane,
                                     .outcome = outcome,
                                     .latency = now - ended.written,
                                     .closed = !ended.numbers.empty(),
                                     .exchange = ended.exchange,
                                     .who = request.caller,
                                     .waited = ended.written - ended.waiting->asked},
                       now);
}

// Returns the axes that a reading shows as busy. The requester processes the reading only after the next line was sent.
AxisSet Results::busy_in(const ExchangeRequest& request, const Reply& reply) const {
  AxisSet busy;
  const bool positions = request.command.row->reads_each_axis() && reply.kind == Reply::Kind::data;
  const auto readings = positions ? parse_positions(model_, reply, controllable_) : std::nullopt;
  for (std::size_t axis = 0; readings && axis < readings->size(); ++axis) {
    if ((*readings)[axis].valid && (*readings)[axis].busy) busy.add(static_cast<int>(axis) + 1);
  }
  return busy;
}

}  // namespace axisgate::shot
