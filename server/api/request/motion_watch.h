// Stream of one motion: its state now and at every change, until its outcome.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/stage/motion.h"
#include "device/stage/stage_controller.h"
#include "server/api/request/facts.h"
#include "server/api/request/names.h"
#include "server/api/request/subscription.h"
#include "server/gateway.h"
#include "server/journal/request_memory.h"

namespace axisgate::api {

// A CurrentMotion is a motion as it is now.
struct CurrentMotion {
  // Must be called on the device's strand.
  CurrentMotion(server::Stage& its_device, stage::Motion its_motion)
      : stage(&its_device),
        motion(std::move(its_motion)),
        revision(its_device.motion_revision(motion.id)),
        clock(its_device.motion_clock(motion.id)) {}
  // Takes the motion from a fact.
  CurrentMotion(const server::Stage& its_device, stage::Motion its_motion, std::uint64_t of_fact,
                const server::Moment& its_clock)
      : stage(&its_device), motion(std::move(its_motion)), revision(of_fact), clock(its_clock) {}

  // Returns the answer to a repeated request. Must be called on the device's strand.
  static CurrentMotion repeated(const server::Stage& its_device, stage::Motion its_motion) {
    const server::Moment its_clock = its_device.motion_clock(its_motion.id);
    CurrentMotion current(its_device, std::move(its_motion), 0, its_clock);
    current.is_repeated = true;
    return current;
  }

  const server::Stage* stage;  // never null
  stage::Motion motion;
  std::uint64_t revision = 0;  // of the newest fact about the motion; 0: unknown
  bool is_repeated = false;    // answers a repeated request
  server::Moment clock;        // converts its times for display
};

// Returns the motion from the controller, or from the newest kept fact about it, also of an earlier run. Fails with
// not_found. Must be called on the device's strand.
Result<CurrentMotion> find_motion(const server::EventBus& bus, server::Stage& device,
                                  const stage::StageController& controller, stage::MotionId id);

// Returns the motion of a repeated request, as it is or as it ended, or the problem that the first request resulted in.
// Must be called on the device's strand.
Result<stage::Motion> motion_of(const server::journal::RequestMemory::Known& known,
                                const stage::StageController& controller);

// A MotionSubscription follows the changes of one motion. If its reader is too slow to receive all of them, the present
// state of the motion replaces the missed changes.
class MotionSubscription : public Subscription<CurrentMotion> {
 protected:
  // `gateway` must outlive this object.
  MotionSubscription(server::Gateway& gateway, Streams::Place place)
      : Subscription(std::move(place)), gateway_(gateway), reader_(gateway, 0) {}

  void begin() override { woken_by(gateway_.events()); }
  Reading read() override;

  // Must be called on the device's strand; every later change is then delivered.
  void follow_from_now();
  // Follows the motion from now on, or ends with the problem that kept it from starting. Must be called on the device's
  // strand.
  void show(server::Stage& device, const Result<stage::Motion>& motion);
  // Does the same for a repeated request. Must be called on the device's strand.
  void show_repeated(server::Stage& device, const stage::StageController& controller,
                     const Result<server::journal::RequestMemory::Known>& known);
  // Ends the stream with `problem`, after due_. Only the first end counts.
  void end(const Problem& problem);
  // Fetches the present state of the motion.
  void look(server::Stage& device, stage::MotionId id);

  server::Gateway& gateway_;

 private:
  void read_changes();
  void set_due(CurrentMotion motion);
  void follow(server::Stage& device, CurrentMotion motion);

  FactReader reader_;
  server::Stage* device_ = nullptr;  // null: no motion is followed
  stage::MotionId followed_ = 0;
  std::optional<CurrentMotion> due_;
  std::uint64_t shown_ = 0;       // revision of the motion that was set due last
  std::optional<StreamEnd> end_;  // delivered after due_
};

class MotionWatch final : public MotionSubscription {
 public:
  MotionWatch(server::Gateway& gateway, const MotionName& motion, Streams::Place place)
      : MotionSubscription(gateway, std::move(place)), name_(motion) {}

 private:
  void begin() override;

  const MotionName name_;
};

}  // namespace axisgate::api
