// The stream of one motion: as it is now and at every change, until its outcome.
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

// A motion as it is now.
struct CurrentMotion {
  // On the device's strand.
  CurrentMotion(server::Stage& its_device, stage::Motion its_motion)
      : device(its_device.name()),
        motion(std::move(its_motion)),
        revision(its_device.motion_revision(motion.id)),
        clock(its_device.motion_clock(motion.id)) {}
  // As a fact had it.
  CurrentMotion(const server::Stage& its_device, stage::Motion its_motion, std::uint64_t of_fact,
                const server::Moment& its_clock)
      : device(its_device.name()), motion(std::move(its_motion)), revision(of_fact), clock(its_clock) {}

  // Of a request that came before. Likewise on the strand.
  static CurrentMotion repeated(const server::Stage& its_device, stage::Motion its_motion) {
    const server::Moment its_clock = its_device.motion_clock(its_motion.id);
    CurrentMotion current(its_device, std::move(its_motion), 0, its_clock);
    current.is_repeated = true;
    return current;
  }

  std::string_view device;  // its name in the configuration; valid as long as the gateway
  stage::Motion motion;
  std::uint64_t revision = 0;  // of the newest fact about it; 0: not known
  bool is_repeated = false;    // the answer to a request that came before
  server::Moment clock;        // by which its times are shown
};

// The motion: of the controller, or else as its newest fact that is kept has it, also of an earlier run; or not_found.
// On the device's strand.
Result<CurrentMotion> find_motion(const server::EventBus& bus, server::Stage& device,
                                  const stage::StageController& controller, stage::MotionId id);

// The motion of a request that came before, as it is or as it ended; or what the request came to instead. On the
// device's strand.
Result<stage::Motion> motion_of(const server::journal::RequestMemory::Known& known,
                                const stage::StageController& controller);

// What the streams of one motion share: they follow its changes, and where a reader was too slow for all of them, the
// motion as it is now takes the place of those that were missed.
class MotionSubscription : public Subscription<CurrentMotion> {
 protected:
  // `gateway` outlives this.
  MotionSubscription(server::Gateway& gateway, Streams::Place place)
      : Subscription(std::move(place)), gateway_(gateway), reader_(gateway, 0) {}

  void begin() override { woken_by(gateway_.events()); }
  Reading read() override;

  // On the device's strand: no change from now on is missed.
  void follow_from_now();
  // On the device's strand. Follows it from then on; or ends with what kept it from starting.
  void show(server::Stage& device, const Result<stage::Motion>& motion);
  // Likewise, of a request that came before.
  void show_repeated(server::Stage& device, const stage::StageController& controller,
                     const Result<server::journal::RequestMemory::Known>& known);
  // Ends with that problem, after what is due; the first end counts.
  void end(const Problem& problem);
  // Fetches the motion as it is now.
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
  std::uint64_t shown_ = 0;       // its revision, or that of the one before
  std::optional<StreamEnd> end_;  // after what is due
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
