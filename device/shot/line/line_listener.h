// Interface through which the line reports to the session.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/shot/command/reply.h"
#include "device/shot/line/exchange_request.h"
#include "device/shot/stage.h"

namespace axisgate::shot {

class LineListener {
 public:
  virtual ~LineListener() = default;
  virtual void line_opened(TimePoint now) = 0;
  // Returns the stops to write now, before any probe. Called when the port was opened (`heard` is empty), or when a
  // line other than an axis number was received during a barrier. The replies to these stops are not awaited.
  virtual std::vector<ExchangeRequest> stops_to_write(std::string_view heard, TimePoint now) = 0;
  // Reports whether a stop is open, so that a closed port is opened again soon.
  virtual bool stop_is_open() const = 0;
  // Called when the identity was received and the line fell silent: the handshake may run. `line_before` is the line
  // that the controller received before the connect, if Line::ask_line_before() was called.
  virtual void line_connected(const Identity& identity, const std::optional<std::string>& line_before,
                              TimePoint now) = 0;
  virtual void line_trusted(TimePoint now) = 0;  // open() was called; waiting lines are sent next
  virtual void line_lost(const std::string& why, TimePoint now) = 0;
  virtual void barrier_entered(const std::string& why, TimePoint now) = 0;
  virtual void barrier_passed(const Identity& identity, TimePoint now) = 0;
  // Called when the controller may have restarted. Only stops and lines of the handshake are sent until
  // confirm_no_restart() or disconnect().
  virtual void restart_suspected(TimePoint now) = 0;
  virtual void same_controller(TimePoint now) = 0;  // confirm_no_restart() was called
  // `doubtful`: the completion was not expected now, or was received in a barrier.
  virtual void completion_seen(int axis, bool doubtful, TimePoint now) = 0;
  virtual void line_event(const Event& event, TimePoint now) = 0;
  // Called right before a line that belongs to a motion or uses axes is written. The line is not written if this
  // returns a problem.
  virtual std::optional<Problem> may_write(const ExchangeRequest& request, TimePoint now) = 0;
};

}  // namespace axisgate::shot
