// The right to use a device: the interface through which server/access controls a controller. The controller calls it
// before it takes a request, and again when it sends the bytes of a motion or a job, so that no byte is sent after the
// caller has lost the right.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/use/occupation.h"
#include "device/use/scope.h"

namespace axisgate::use {

using ActivityId = std::uint64_t;  // a motion of a stage, or a job; 0: none

// A Use is one caller's use of a scope.
struct Use {
  std::string who;
  std::uint64_t lease = 0;  // fencing token; 0: no lease, the scope is borrowed for the duration of the motion
  Scope scope;
  ActivityId activity = 0;  // 0: not created yet
  // Session of the calling program, over all of its connections: a stop by the session does not block the session's own
  // motions. Empty: unknown. It gives no rights.
  std::string session{};
};

// A StopOrder stops what a caller moves who has lost the right to it.
struct StopOrder {
  std::uint64_t id = 0;
  Scope scope;
  std::string who;  // person or caller on whose behalf, as text
};

// A lease under which nothing moves any longer, and whose holder changed settings that must be restored.
struct EndedLease {
  std::uint64_t token = 0;
  std::string who;
};

struct Orders {
  std::vector<StopOrder> stops;       // each is answered by stopped(), whatever the result
  std::vector<EndedLease> restoring;  // each is answered by settings_restored(); nobody has its axes until then
};

// Not thread safe: called on the controller's strand, and must not call back into the controller.
class Permission {
 public:
  virtual ~Permission() = default;

  // Fails with lease_held, lease_lost or stopped_by if the caller may not use all of the scope now.
  virtual Result<void> authorize(const Use& use, TimePoint now) = 0;

  // Report the progress of a motion or a job: begin() when it has its turn on its scope, due() when its expected end is
  // known, end() when it has left its scope, with any outcome. `occupation` is the text that other callers are shown.
  virtual void begin(const Use& use, Occupation occupation, TimePoint now) = 0;
  virtual void due(ActivityId activity, TimePoint over) = 0;
  virtual void end(ActivityId activity, TimePoint now) = 0;

  // Reports that a stop of these axes was requested. `waiting`: motions on these axes that have not had their turn and
  // will never start.
  virtual void stop_asked(const Use& stop, const std::vector<Use>& waiting, TimePoint now) = 0;
  // Reports that the controller may have restarted: rights from before the restart are void.
  virtual void device_restarted(TimePoint now) = 0;

  // Reports that a setting was changed under this lease which must be restored when the lease ends.
  virtual void settings_changed(std::uint64_t lease) = 0;

  // Advances the time and returns the orders to carry out.
  virtual Orders advance(TimePoint now) = 0;
  virtual void stopped(std::uint64_t order, TimePoint now) = 0;
  virtual void settings_restored(std::uint64_t lease, TimePoint now) = 0;
  virtual std::optional<TimePoint> next_deadline() const = 0;
};

// A Permission that allows everything, for a gateway without leases.
Permission& everybody_may();

}  // namespace axisgate::use
