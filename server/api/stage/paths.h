// Paths: taken in whole, then run; their reader receives the progress until the outcome.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "device/core/problem.h"
#include "device/stage/event.h"
#include "device/stage/stage_controller.h"
#include "server/api/request/call.h"
#include "server/api/request/facts.h"
#include "server/api/request/motion_watch.h"
#include "server/api/request/pipeline.h"
#include "server/api/request/subscription.h"
#include "server/gateway.h"

namespace axisgate::api {

// What bounds a segment whatever the device: its rest and inputs, the turns of its curve, and the plane of a helix.
// out_of_range, invalid_request.
Result<void> check_segment(const stage::Segment& segment);

struct PathStep {
  std::string_view device;  // its name in the configuration; valid as long as the gateway
  std::variant<CurrentMotion, stage::PathProgress> what;
};

// One path. start(), add() and run() are called one after the other; the rest is thread safe.
class Path final : public Subscription<PathStep> {
 public:
  // Both outlive this.
  Path(server::Gateway& gateway, const Pipeline& pipeline, Streams::Place place)
      : Subscription(std::move(place)), gateway_(gateway), pipeline_(pipeline), reader_(gateway, 0) {}

  // The head of the path. False: it was refused, the stream ends with the problem, and nothing more is taken in.
  bool start(const Call& call, std::string_view device);
  // The next segment, at most stage::PathRequest::kSegmentsMax. False: likewise.
  bool add(Result<stage::Segment> segment);
  // A part that is neither: the stream ends with `problem`. False, always.
  bool refuse_part(Problem problem) { return end(std::move(problem)); }

  // All segments have come: the path runs. It counts from now on, as far as its call does not say until when. `digest`
  // is of all that came: Call::digest.
  void run(std::string digest);
  // The caller has gone without a word: what has not been posted by then does not run, since it may be half a path.
  void break_off() override;

 private:
  Result<void> take_head(const Call& call, std::string_view device);
  Result<void> take_segment(Result<stage::Segment> segment);
  std::optional<Problem> fault() const;
  Result<std::string> ready(const Turn& turn);
  void check_only();
  void run_on(const Turn& turn, const MutationPtr& mutation);
  void repeat(server::Stage& device, const stage::StageController& controller, const Result<Known>& known);
  void follow(server::Stage& device, CurrentMotion motion);
  bool end(std::optional<Problem> problem);
  bool broken_off();

  void begin() override { woken_by(gateway_.events()); }
  Reading read() override;
  void read_progress();
  void set_due(const server::FactRecord& record);

  server::Gateway& gateway_;
  const Pipeline& pipeline_;

  // While the path comes in.
  std::optional<Call> call_;            // nothing: no head yet
  server::Stage* taken_for_ = nullptr;  // null: likewise
  stage::PathRequest path_;

  // Under mutex_.
  bool broken_off_ = false;
  FactReader reader_;
  server::Stage* device_ = nullptr;  // null: not started
  stage::MotionId motion_ = 0;
  std::optional<PathStep> due_;
  std::optional<StreamEnd> end_;  // after what is due
};

// Thread safe.
class Paths {
 public:
  // All outlive this.
  Paths(server::Gateway& gateway, const Pipeline& pipeline, Streams& streams)
      : gateway_(gateway), pipeline_(pipeline), streams_(streams) {}

  // queue_full.
  Result<std::shared_ptr<Path>> open(const Credential& caller) const;

 private:
  server::Gateway& gateway_;
  const Pipeline& pipeline_;
  Streams& streams_;
};

}  // namespace axisgate::api
