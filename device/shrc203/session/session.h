// Reactions to the reports of the line: connect and loss, completions, and whether a line may still be written. Also
// the reaction to an internal error of the gateway.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/tasks.h"
#include "device/core/violations.h"
#include "device/shot/line/line.h"
#include "device/shrc203/session/ending.h"
#include "device/shrc203/session/handshake.h"
#include "device/shrc203/session/previous_run.h"
#include "device/shrc203/session/restart_check.h"
#include "device/shrc203/session/stops.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/registers.h"
#include "device/shrc203/state/rights.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class Session : public LineListener, public Violations {
 public:
  Session(Line& line, Handshake& handshake, RestartCheck& restart_check, Stops& stops, StopWriter& stop_writer,
          PreviousRun& previous_run, StateStore& store, Motions& motions, Registers& registers, Rights& rights,
          const Ending& ending, Tasks& tasks)
      : line_(line),
        handshake_(handshake),
        restart_check_(restart_check),
        stops_(stops),
        stop_writer_(stop_writer),
        previous_run_(previous_run),
        store_(store),
        motions_(motions),
        registers_(registers),
        rights_(rights),
        ending_(ending),
        tasks_(tasks) {}

  void line_opened(TimePoint now) override;
  std::vector<ExchangeRequest> stops_to_write(std::string_view heard, TimePoint now) override;
  bool stop_is_open() const override { return !store_.state().open_stops.empty(); }
  void line_connected(const Identity& identity, const std::optional<std::string>& line_before, TimePoint now) override;
  void line_trusted(TimePoint now) override;
  void line_lost(const std::string& why, TimePoint now) override;
  void barrier_entered(const std::string& why, TimePoint now) override;
  void barrier_passed(const Identity& identity, TimePoint now) override;
  void restart_suspected(TimePoint now) override;
  void same_controller(TimePoint now) override;
  void completion_seen(int axis, bool doubtful, TimePoint now) override;
  void line_event(const Event& event, TimePoint now) override;
  // Checks the right once more before the bytes are sent: it may have ended since the exchange was queued.
  std::optional<Problem> may_write(const ExchangeRequest& request, TimePoint now) override;

  // Stops all axes, and opens the line again. Running motions end UNKNOWN, and nothing starts before a handshake.
  void illegal(std::string_view machine, std::string_view state, std::string_view event) override;

  // Called for a completion that was recognised only when two replies agreed.
  void completion_deduced(int axis);

 private:
  void show_link() { store_.show_link(line_.state().phase()); }
  void stop_jogs();
  Task<void> tell_notices(ProgramNotice::Kind kind);

  struct NoticeCount {
    std::int64_t untold = 0;
    bool telling = false;
  };

  Line& line_;
  Handshake& handshake_;
  RestartCheck& restart_check_;
  Stops& stops_;
  StopWriter& stop_writer_;
  PreviousRun& previous_run_;
  StateStore& store_;
  Motions& motions_;
  Registers& registers_;
  Rights& rights_;
  const Ending& ending_;
  Tasks& tasks_;
  std::map<ProgramNotice::Kind, NoticeCount> notices_;
};

}  // namespace axisgate::shrc203
