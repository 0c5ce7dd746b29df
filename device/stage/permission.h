// Who may use which axes: the seam through which server/access speaks to a controller. It is asked before a request is
// taken, and again as the bytes of a motion go out, so that no byte follows the loss of the right to send it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/stage/axes.h"
#include "device/stage/motion.h"

namespace axisgate::stage {

// One caller's business with some axes.
struct Use {
  std::string who;
  std::uint64_t lease = 0;  // the fencing token; 0: none, the axes are borrowed for the motion's own duration
  AxisSet axes;
  MotionId motion = 0;  // of a mill, its job; 0: not yet one
  // The program that asks, over whatever connections: its stop does not hold its own motions back. Empty: unknown. It
  // gives no rights.
  std::string session{};
};

// Axes that are to be stopped, since their user may not move them any longer.
struct StopOrder {
  std::uint64_t id = 0;
  AxisSet axes;
  std::string who;  // on whose behalf, for people
};

// A lease under which nothing moves any more, whose holder had changed settings that would outlast it.
struct EndedLease {
  std::uint64_t token = 0;
  std::string who;
};

struct Orders {
  std::vector<StopOrder> stops;       // each is answered by stopped(), whatever became of it
  std::vector<EndedLease> restoring;  // each by settings_restored(); its axes are nobody's until then
};

// Not thread safe: called on the controller's strand, and must not call back into the controller.
class Permission {
 public:
  virtual ~Permission() = default;

  // lease_held, lease_lost or stopped_by, where the caller may not use all of these axes now.
  virtual Result<void> authorize(const Use& use, TimePoint now) = 0;

  // The motion has its turn on its axes; should be over by then; and has left them, whatever became of it. What others
  // are shown of it is `occupation`.
  virtual void begin(const Use& use, Occupation occupation, TimePoint now) = 0;
  virtual void due(MotionId motion, TimePoint over) = 0;
  virtual void end(MotionId motion, TimePoint now) = 0;

  // A stop of these axes was requested. `waiting`: motions on them that have not had their turn, and never will.
  virtual void stop_asked(const Use& stop, const std::vector<Use>& waiting, TimePoint now) = 0;
  // The controller may have restarted: what was promised about it before is void.
  virtual void device_restarted(TimePoint now) = 0;

  // Under that lease a setting was changed that is to be what it was when the lease has ended.
  virtual void settings_changed(std::uint64_t lease) = 0;

  // Lets time pass, and fetches what is to be done.
  virtual Orders advance(TimePoint now) = 0;
  virtual void stopped(std::uint64_t order, TimePoint now) = 0;
  virtual void settings_restored(std::uint64_t lease, TimePoint now) = 0;
  virtual std::optional<TimePoint> next_deadline() const = 0;
};

// Where nobody keeps leases.
Permission& everybody_may();

}  // namespace axisgate::stage
