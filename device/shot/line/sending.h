// Output of the line: which waiting line is sent next, and when.
#pragma once

#include <optional>

#include "device/core/time.h"
#include "device/shot/command/model.h"
#include "device/shot/line/completions.h"
#include "device/shot/line/continuity.h"
#include "device/shot/line/exchange.h"
#include "device/shot/line/incoming.h"
#include "device/shot/line/line_listener.h"
#include "device/shot/line/line_timing.h"
#include "device/shot/line/link.h"
#include "device/shot/line/reservations.h"
#include "device/shot/line/second_reply.h"
#include "device/shot/line/waiting_lines.h"
#include "device/shot/line/wire.h"
#include "device/shot/profile.h"

namespace axisgate::shot {

class Sending {
 public:
  // The referenced objects must outlive this one.
  Sending(const Model& model, const Profile& profile, LineListener& listener, const Link& link,
          const LineTiming& timing, Incoming& incoming, Completions& completions, const Continuity& continuity,
          const Reservations& reservations, Exchange& exchange, const SecondReply& second_reply, WaitingLines& waiting,
          Wire& wire)
      : model_(model),
        profile_(profile),
        listener_(listener),
        link_(link),
        timing_(timing),
        incoming_(incoming),
        completions_(completions),
        continuity_(continuity),
        reservations_(reservations),
        exchange_(exchange),
        second_reply_(second_reply),
        waiting_(waiting),
        wire_(wire) {}

  // Sends the next line that may be sent now, if any.
  void pump(TimePoint now);
  // Returns the time at which pump() may have something to send; nullopt if none is known.
  std::optional<TimePoint> next_deadline(TimePoint now) const;

 private:
  bool can_send() const { return link_.port_open() && exchange_.idle(); }
  void send(WaitingPtr waiting, TimePoint now);
  void ask(LineQuestion question, TimePoint now);
  bool asks_first(TimePoint now) const;
  bool asks_now(const WaitingLines::Chosen& may_go, bool settle) const;
  bool may_send(const ExchangeRequest& request) const;
  bool leaves_refills_alone(const ExchangeRequest& request, TimePoint now) const;
  bool may_settle(TimePoint now) const;
  bool line_is_coming(TimePoint now);

  const Model& model_;
  const Profile& profile_;
  LineListener& listener_;
  const Link& link_;
  const LineTiming& timing_;
  Incoming& incoming_;
  Completions& completions_;
  const Continuity& continuity_;
  const Reservations& reservations_;
  Exchange& exchange_;
  const SecondReply& second_reply_;
  WaitingLines& waiting_;
  Wire& wire_;
};

}  // namespace axisgate::shot
