// Paths: received completely, then run; the reader receives the progress until the outcome.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

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

// Checks the limits that are the same for all devices: rest and inputs, the turns of a curve, and the plane of a helix.
// Fails with out_of_range or invalid_request.
Result<void> check_segment(const stage::Segment& segment);

struct PathStep {
  std::string_view device;  // name in the configuration; valid as long as the gateway
  std::variant<CurrentMotion, stage::PathProgress> what;
};

// A Path receives and runs one path. start(), add() and run() are called one after the other; all else is thread safe.
class Path final : public Subscription<PathStep> {
 public:
  // The referenced objects must outlive this one.
  Path(server::Gateway& gateway, const Pipeline& pipeline, Streams::Place place)
      : Subscription(std::move(place)), gateway_(gateway), pipeline_(pipeline), reader_(gateway, 0) {}

  // Handles the header of the path. Returns false if it was refused: the stream ends with the problem, and later
  // messages are ignored.
  bool start(const Call& call, std::string_view device);
  // Adds the next segment; at most stage::PathRequest::kSegmentsMax. Returns false if it was refused, like start().
  bool add(Result<stage::Segment> segment);
  // Ends the stream with `problem` because of a message that is neither. Always returns false.
  bool refuse_part(Problem problem) { return end(std::move(problem)); }

  // Runs the path after its last segment. Without a not_after in the call, its time counts from now. `digest` covers
  // all messages: see Call::digest.
  void run(std::string digest);
  // Handles a caller who disconnected without ending the stream. A path that is not posted yet does not run, because it
  // may be incomplete.
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

  // Used while the path is received.
  std::optional<Call> call_;            // nullopt: no header yet
  server::Stage* taken_for_ = nullptr;  // null: no header yet
  stage::PathRequest path_;

  // Under mutex_.
  bool broken_off_ = false;
  FactReader reader_;
  server::Stage* device_ = nullptr;  // null: not started
  stage::MotionId motion_ = 0;
  std::optional<PathStep> due_;
  std::optional<StreamEnd> end_;  // delivered after due_
};

// Thread safe.
class Paths {
 public:
  // The referenced objects must outlive this one.
  Paths(server::Gateway& gateway, const Pipeline& pipeline, Streams& streams)
      : gateway_(gateway), pipeline_(pipeline), streams_(streams) {}

  // Fails with queue_full.
  Result<std::shared_ptr<Path>> open(const Credential& caller) const;
  // Runs a path that has arrived in one message, and answers once it has started; with nullopt after validate_only.
  // Fails with invalid_request for more than kSegmentsInOneMessage segments.
  static constexpr std::size_t kSegmentsInOneMessage = 10'000;
  void start(const Call& call, std::string_view device, std::vector<Result<stage::Segment>> segments,
             Answer<StartedMotion> answer) const;

 private:
  server::Gateway& gateway_;
  const Pipeline& pipeline_;
  Streams& streams_;
};

}  // namespace axisgate::api
