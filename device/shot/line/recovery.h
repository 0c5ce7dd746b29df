// Recovery from doubt: begins and ends barriers, and writes the stops that cannot wait for their end.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "device/core/time.h"
#include "device/shot/line/barrier.h"
#include "device/shot/line/completions.h"
#include "device/shot/line/continuity.h"
#include "device/shot/line/exchange.h"
#include "device/shot/line/line_listener.h"
#include "device/shot/line/line_timing.h"
#include "device/shot/line/link.h"
#include "device/shot/line/port.h"
#include "device/shot/line/results.h"
#include "device/shot/line/second_reply.h"
#include "device/shot/line/waiting_lines.h"
#include "device/shot/line/wire.h"
#include "device/shot/profile.h"

namespace axisgate::shot {

class Recovery {
 public:
  // `controllable`: the axes of the present connection. The referenced objects must outlive this one.
  Recovery(const Model& model, const Profile& profile, Port& port, LineListener& listener, const Link& link,
           const LineTiming& timing, const AxisSet& controllable, Completions& completions, Continuity& continuity,
           Exchange& exchange, SecondReply& second_reply, WaitingLines& waiting, Wire& wire, Results& results)
      : model_(model),
        profile_(profile),
        port_(port),
        listener_(listener),
        link_(link),
        timing_(timing),
        controllable_(controllable),
        completions_(completions),
        continuity_(continuity),
        exchange_(exchange),
        second_reply_(second_reply),
        waiting_(waiting),
        wire_(wire),
        results_(results) {}

  // Makes each connect begin with ?:CMD until a controller has answered.
  void ask_line_before() { asks_line_before_ = true; }
  // Begins the first barrier of a connection, after the stops that are open.
  void connect(TimePoint now);
  // Begins a barrier because the reply to the exchange in flight cannot be trusted: `doubted` is its result.
  void doubt(ExchangeResult doubted, ExchangeEnded::Outcome outcome, TimePoint now);

  // Takes a complete line that is not a completion, during a barrier.
  void on_line(std::string_view text, TimePoint now);
  void advance(TimePoint now);
  // Writes the waiting stops at once in a barrier. Their replies cannot be distinguished from late replies.
  void send_stops(TimePoint now);
  // Compares the reply to ?:CMD with the lines sent, and disconnects if another program has written. That program may
  // have changed any setting or the frame, so the state is unknown as after a restart.
  void on_last_command(std::string_view line_before, TimePoint now);

  // Takes note that open() was called: the present controller is the one to expect from now on.
  void trust() { trusted_ = answering_; }
  // Time for the reply to a probe.
  Duration reply_limit() const { return limits().reply; }
  OutstandingAnswers& outstanding() { return outstanding_; }
  // Returns the number of replies to abandoned probes that may still arrive.
  int outstanding_count() const { return outstanding_.echoes + outstanding_.identities; }

 private:
  Barrier::Limits limits() const;
  Barrier::Limits connect_limits();
  void begin(std::string line_in_doubt, Barrier::Limits limits, std::optional<Doubted> doubted);
  bool is_known(const Identity& identity) const;
  bool write_open_stops(std::string_view heard, TimePoint now);
  void moved(TimePoint now);

  const Model& model_;
  const Profile& profile_;
  Port& port_;
  LineListener& listener_;
  const Link& link_;
  const LineTiming& timing_;
  const AxisSet& controllable_;
  Completions& completions_;
  Continuity& continuity_;
  Exchange& exchange_;
  SecondReply& second_reply_;
  WaitingLines& waiting_;
  Wire& wire_;
  Results& results_;
  OutstandingAnswers outstanding_;
  bool asks_line_before_ = false;
  bool connected_before_ = false;
  std::string answering_;  // serial number read in the present connect
  std::string trusted_;    // serial number of the newest passed handshake; empty before the first
};

}  // namespace axisgate::shot
