#include "server/api/stage/paths.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <string>
#include <utility>

#include "server/api/request/awaited.h"
#include "server/api/request/names.h"

namespace axisgate::api {
namespace {

using stage::StageController;

constexpr int kInputsMax = 63;                          // IN1 to IN6 (manual 95) I:)
constexpr std::array<int, 2> kHelixPlane = {1, 2};      // manual 74) to 76), 80) to 82): A is the only axis setting
constexpr int kCircleTurns = 1, kHelixTurnsMax = 1000;  // manual 71), 74)

// Checks the wait before a segment, while the axes are stationary.
Result<void> check_halt(const stage::Segment& segment) {
  using std::chrono::milliseconds;
  constexpr auto most = std::chrono::duration_cast<milliseconds>(stage::Segment::kRestMax).count();
  if (segment.rest < Duration::zero() || segment.rest > stage::Segment::kRestMax) {
    const auto rest = std::chrono::duration_cast<milliseconds>(segment.rest).count();
    return fail(Reason::out_of_range, fmt::format("a rest of {} ms; 0 to {} ms are possible", rest, most));
  }
  if (!segment.inputs || (*segment.inputs >= 0 && *segment.inputs <= kInputsMax)) return {};
  return fail(Reason::out_of_range,
              fmt::format("inputs that show {}; 0 to {} are possible", *segment.inputs, kInputsMax),
              "add 1 for IN1, 2 for IN2, 4 for IN3, 8 for IN4, 16 for IN5 and 32 for IN6");
}

Result<void> check_turns(int turns, bool helix) {
  const int most = helix ? kHelixTurnsMax : kCircleTurns;
  if (turns >= 1 && turns <= most) return {};
  if (helix) {
    return fail(Reason::out_of_range, fmt::format("a helix of {} turns; 1 to {} are possible", turns, most));
  }
  return fail(Reason::out_of_range, fmt::format("a circle of {} turns; in one plane it has 1", turns),
              "send it again as another segment, or give it a `rise`");
}

Result<void> check_curve(const stage::Curve& curve) {
  const bool helix = curve.rise.has_value();
  const auto* around = std::get_if<stage::Curve::Around>(&curve.course);
  const int* turns = around == nullptr ? nullptr : std::get_if<int>(&around->extent);
  if (turns != nullptr) {
    if (const auto good = check_turns(*turns, helix); !good) return good;
  }
  if (!helix || curve.axes == kHelixPlane) return {};
  return fail(
      Reason::invalid_request,
      fmt::format("the circle of a helix is one of axes 1 and 2, not of axes {} and {}", curve.axes[0], curve.axes[1]),
      "the controller's helices are circles of axes 1 and 2 while axis 3 goes along");
}

}  // namespace

Result<void> check_segment(const stage::Segment& segment) {
  if (const auto good = segment.curve ? check_curve(*segment.curve) : Result<void>(); !good) return good;
  return check_halt(segment);
}

Result<std::shared_ptr<Path>> Paths::open(const Credential& caller) const {
  Result<Streams::Place> place = streams_.take(RequestKind::run_path, name_of(caller));
  if (!place) return tl::unexpected(place.error());
  return std::make_shared<Path>(gateway_, pipeline_, *std::move(place));
}

void Paths::start(const Call& call, std::string_view device, std::vector<Result<stage::Segment>> segments,
                  Answer<StartedMotion> answer) const {
  if (segments.size() > kSegmentsInOneMessage) {
    return answer(
        fail(Reason::invalid_request,
             fmt::format("the path has {} segments, and one message takes {}", segments.size(), kSegmentsInOneMessage),
             "send a longer path with RunPath"));
  }
  const auto path = open(call.credential);
  if (!path) return answer(tl::unexpected(path.error()));
  const auto started = [](const PathStep& step) { return std::holds_alternative<CurrentMotion>(step.what); };
  Awaited<PathStep>::start(*path, started, [answer = std::move(answer)](Result<std::optional<PathStep>> step) {
    if (!step) return answer(tl::unexpected(step.error()));
    answer(*step ? StartedMotion(std::get<CurrentMotion>((*step)->what)) : std::nullopt);
  });
  bool taken = (*path)->start(call, device);
  for (Result<stage::Segment>& segment : segments) taken = taken && (*path)->add(std::move(segment));
  if (taken) (*path)->run(call.digest);
}

bool Path::start(const Call& call, std::string_view device) {
  const Result<void> taken = take_head(call, device);
  return taken || end(taken.error());
}

bool Path::add(Result<stage::Segment> segment) {
  const Result<void> taken = take_segment(std::move(segment));
  return taken || end(taken.error());
}

// Admits the call now, so that no caller sends a long path in vain. run() admits it again, and its time counts from
// then.
Result<void> Path::take_head(const Call& call, std::string_view device) {
  if (call_) return fail(Reason::invalid_request, "a path has one header, and a second one came");
  const auto admitted = pipeline_.admit({RequestKind::run_path, call, find_stage(gateway_, device)});
  if (!admitted) return tl::unexpected(admitted.error());
  taken_for_ = admitted->device;
  call_ = call;
  return {};
}

Result<void> Path::take_segment(Result<stage::Segment> segment) {
  if (!call_) return fail(Reason::invalid_request, "a segment came before the header");
  const std::size_t number = path_.segments.size() + 1;
  if (number > stage::PathRequest::kSegmentsMax) {
    return fail(Reason::invalid_request, fmt::format("segment {} is one too many", number),
                fmt::format("a path has at most {} segments", stage::PathRequest::kSegmentsMax));
  }
  const Result<void> good = segment ? check_segment(*segment) : tl::unexpected(segment.error());
  if (!good) {
    Problem problem = good.error();
    problem.message = fmt::format("segment {}: {}", number, problem.message);
    return tl::unexpected(std::move(problem));
  }
  path_.segments.push_back(*std::move(segment));
  return {};
}

std::optional<Problem> Path::fault() const {
  if (!path_.segments.empty()) return std::nullopt;
  return Problem{
      .reason = Reason::invalid_request, .message = "the path has no segment", .hint = "send a header, then segments"};
}

void Path::run(std::string digest) {
  if (broken_off()) return;
  if (!call_) {
    end(fault());
    return;
  }
  call_->digest = std::move(digest);
  if (call_->validate_only) return check_only();
  pipeline_.act(
      {RequestKind::run_path, *call_, taken_for_, fault()},
      [self = self<Path>()](const Turn& turn) { return self->ready(turn); },
      [self = self<Path>()](const Turn& turn, const MutationPtr& mutation) { self->run_on(turn, mutation); },
      [self = self<Path>()](const Problem& problem) { self->end(problem); },
      [self = self<Path>()](server::Stage& device, const Result<Known>& known) {
        device.post([self, &device, known](const StageController& controller, TimePoint) {
          self->repeat(device, controller, known);
        });
      });
}

void Path::check_only() {
  pipeline_.ask<void>(
      {RequestKind::run_path, *call_, taken_for_, fault()},
      [self = self<Path>()](const Result<void>& checked) { self->end(fault_of(checked)); },
      [self = self<Path>()](const Turn& turn, const Answer<void>& respond) {
        self->path_.context = turn.context;
        respond(turn.controller.check(self->path_));
      });
}

Result<std::string> Path::ready(const Turn& turn) {
  if (broken_off()) return fail(Reason::stopped, "the call of the path broke off before it ran");
  if (const auto good = check_deadline(RequestKind::run_path, turn.context, turn.now); !good) {
    return tl::unexpected(good.error());
  }
  return fmt::format("run a path of {} segments", path_.segments.size());
}

void Path::run_on(const Turn& turn, const MutationPtr& mutation) {
  {
    const std::lock_guard lock(mutex_);
    reader_.go_to_newest();
  }
  path_.context = turn.context;
  turn.controller.run_path(std::move(path_), turn.now,
                           [self = self<Path>(), mutation, &device = turn.device](const Result<stage::Motion>& motion) {
                             if (!motion) {
                               mutation->failed(motion.error());
                               self->end(motion.error());
                               return;
                             }
                             mutation->acted({});
                             self->follow(device, CurrentMotion(device, *motion));
                           });
}

// Must be called on the device's strand.
void Path::repeat(server::Stage& device, const StageController& controller, const Result<Known>& known) {
  const auto motion = known ? motion_of(*known, controller) : tl::unexpected(known.error());
  if (!motion) {
    end(motion.error());
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    reader_.go_to_newest();
  }
  follow(device, CurrentMotion::repeated(device, *motion));
}

void Path::follow(server::Stage& device, CurrentMotion motion) {
  {
    const std::lock_guard lock(mutex_);
    device_ = &device;
    motion_ = motion.motion.id;
    if (stage::is_outcome(motion.motion.state)) end_ = StreamEnd{};
    due_ = PathStep{device.name(), std::move(motion)};
  }
  wake();
}

void Path::break_off() {
  const std::lock_guard lock(mutex_);
  broken_off_ = true;
}

bool Path::broken_off() {
  const std::lock_guard lock(mutex_);
  return broken_off_;
}

bool Path::end(std::optional<Problem> problem) {
  {
    const std::lock_guard lock(mutex_);
    end_ = StreamEnd{std::move(problem)};
  }
  wake();
  return false;
}

Path::Reading Path::read() {
  if (!due_ && !end_ && device_ != nullptr) read_progress();
  if (due_) {
    PathStep step = *std::move(due_);
    due_.reset();
    return step;
  }
  if (end_) return *end_;
  return Nothing{};
}

// Reads up to the next fact about this path.
void Path::read_progress() {
  while (!due_ && !end_) {
    const FactReader::Reading reading = reader_.next();
    if (std::holds_alternative<FactReader::Nothing>(reading)) return;
    if (const auto* compacted = std::get_if<FactReader::Compacted>(&reading)) {
      end_ = compacted_at(compacted->resume);
      return;
    }
    set_due(*std::get<std::shared_ptr<const server::FactRecord>>(reading));
  }
}

void Path::set_due(const server::FactRecord& record) {
  if (record.device != device_->name()) return;
  if (const auto* progress = std::get_if<stage::PathProgress>(&record.fact)) {
    if (progress->motion == motion_) due_ = PathStep{device_->name(), *progress};
  } else if (const auto* change = std::get_if<stage::MotionChanged>(&record.fact)) {
    if (change->motion.id != motion_ || !stage::is_outcome(change->motion.state)) return;
    due_ = PathStep{device_->name(), CurrentMotion(*device_, change->motion, record.revision, record.clock)};
    end_ = StreamEnd{};
  }
}

}  // namespace axisgate::api
