// Input of the line: distinguishes replies, completions, notices and garbage.
#pragma once

#include <string_view>

#include "device/core/line_framer.h"
#include "device/core/time.h"
#include "device/shot/command/reply.h"
#include "device/shot/line/completions.h"
#include "device/shot/line/continuity.h"
#include "device/shot/line/exchange.h"
#include "device/shot/line/flood.h"
#include "device/shot/line/incoming.h"
#include "device/shot/line/line_listener.h"
#include "device/shot/line/link.h"
#include "device/shot/line/port.h"
#include "device/shot/line/recovery.h"
#include "device/shot/line/results.h"
#include "device/shot/line/second_reply.h"
#include "device/shot/line/wire.h"
#include "device/shot/stage.h"

namespace axisgate::shot {

class Receiving {
 public:
  // `controllable`: the axes of the present connection. The referenced objects must outlive this one.
  Receiving(const Model& model, Port& port, LineListener& listener, const Link& link, const AxisSet& controllable,
            Incoming& incoming, Flood& flood, Completions& completions, Continuity& continuity, Exchange& exchange,
            SecondReply& second_reply, Wire& wire, Results& results, Recovery& recovery)
      : model_(model),
        port_(port),
        listener_(listener),
        link_(link),
        controllable_(controllable),
        incoming_(incoming),
        flood_(flood),
        completions_(completions),
        continuity_(continuity),
        exchange_(exchange),
        second_reply_(second_reply),
        wire_(wire),
        results_(results),
        recovery_(recovery) {}

  void receive(std::string_view bytes, TimePoint now);
  // Begins a barrier if the reply to the exchange in flight is late.
  void check_time_limit(TimePoint now);

 private:
  void on_line(const LineFramer::Line& line, TimePoint now);
  bool on_axis_number(std::string_view text, TimePoint now);
  void on_answer(const LineFramer::Line& line, TimePoint now);
  bool refusal_is_unclear(std::string_view text);
  void on_reply(Reply reply, TimePoint now);
  void on_line_fault(Reply reply, TimePoint now);
  void on_number(int number, TimePoint now);
  void on_line_while_closing(std::string_view text, TimePoint now);
  void close(TimePoint now);
  void doubt_answer(std::string_view text, TimePoint now);
  bool shut_if_flooded(TimePoint now);
  void suspect_restart(TimePoint now);
  void unexpected(std::string_view text, TimePoint now);

  const Model& model_;
  Port& port_;
  LineListener& listener_;
  const Link& link_;
  const AxisSet& controllable_;
  Incoming& incoming_;
  Flood& flood_;
  Completions& completions_;
  Continuity& continuity_;
  Exchange& exchange_;
  SecondReply& second_reply_;
  Wire& wire_;
  Results& results_;
  Recovery& recovery_;
};

}  // namespace axisgate::shot
