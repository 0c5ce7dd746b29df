// Writes lines to the controller, and reports what it writes.
#pragma once

#include <cstdint>
#include <string_view>

#include "device/core/line_machine.h"
#include "device/core/time.h"
#include "device/shot/line/continuity.h"
#include "device/shot/line/exchange_request.h"
#include "device/shot/line/line_listener.h"
#include "device/shot/line/line_timing.h"
#include "device/shot/stage.h"

namespace axisgate::shot {

class Wire {
 public:
  // `controllable`: the axes of the present connection. The referenced objects must outlive this one.
  Wire(ByteLink& link, LineListener& listener, const LineTiming& timing, Continuity& continuity,
       const AxisSet& controllable)
      : link_(link), listener_(listener), timing_(timing), continuity_(continuity), controllable_(controllable) {}

  // Writes a line of an exchange. Returns the exchange's number.
  std::uint64_t begin(const ExchangeRequest& request, TimePoint now);
  // Writes another line of the same exchange.
  void go_on(std::string_view line, std::uint64_t exchange, const ExchangeRequest& request, TimePoint now) {
    write(line, exchange, &request, now);
  }
  // Writes a line that no request caused.
  void probe(std::string_view line, TimePoint now) { write(line, 0, nullptr, now); }

 private:
  void write(std::string_view line, std::uint64_t exchange, const ExchangeRequest* cause, TimePoint now);

  ByteLink& link_;
  LineListener& listener_;
  const LineTiming& timing_;
  Continuity& continuity_;
  const AxisSet& controllable_;
  std::uint64_t exchanges_ = 0;
};

}  // namespace axisgate::shot
