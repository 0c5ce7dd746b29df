// Ends exchanges: takes note of what the reply shows, and gives the result to those who wait for it.
#pragma once

#include "device/core/time.h"
#include "device/shot/line/completions.h"
#include "device/shot/line/exchange.h"
#include "device/shot/line/flood.h"
#include "device/shot/line/line_listener.h"
#include "device/shot/line/line_timing.h"
#include "device/shot/stage.h"

namespace axisgate::shot {

class Results {
 public:
  using Outcome = ExchangeEnded::Outcome;

  // `controllable`: the axes of the present connection. The referenced objects must outlive this one.
  Results(const Model& model, LineListener& listener, Exchange& exchange, Completions& completions, LineTiming& timing,
          Flood& flood, const AxisSet& controllable)
      : model_(model),
        listener_(listener),
        exchange_(exchange),
        completions_(completions),
        timing_(timing),
        flood_(flood),
        controllable_(controllable) {}

  // Ends the exchange in flight.
  void finish(const ExchangeResult& result, Outcome outcome, TimePoint now);
  // Reports an exchange that has ended.
  void report(const InFlight& ended, const ExchangeResult& result, Outcome outcome, TimePoint now);

 private:
  AxisSet busy_in(const ExchangeRequest& request, const Reply& reply) const;

  const Model& model_;
  LineListener& listener_;
  Exchange& exchange_;
  Completions& completions_;
  LineTiming& timing_;
  Flood& flood_;
  const AxisSet& controllable_;
};

}  // namespace axisgate::shot
