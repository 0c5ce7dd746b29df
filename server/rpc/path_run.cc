#include "server/rpc/path_run.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>
#include <variant>

#include "server/rpc/call.h"
#include "server/rpc/news.h"
#include "server/rpc/status.h"
#include "server/rpc/targets.h"

namespace axisgate::rpc {
namespace {

// gRPC ends the reading alike for a client that has sent all and for one that broke off; only the second is then
// cancelled, at once but after. A path whose client broke off must not start: it may be half a path.
constexpr Duration kBreakOffWait = std::chrono::milliseconds(10);

}  // namespace

PathRun* PathRun::start(server::Gateway& gateway, const server::Access& access,
                        const grpc::CallbackServerContext& context, Result<StreamLimit::Place> place) {
  std::shared_ptr<PathRun> run(new PathRun(gateway, access, context));
  run->open();
  if (!place) {
    run->end(to_status(place.error()));
    return run.get();
  }
  run->place_ = *std::move(place);
  // The subscription ends in closed(), before the run does.
  run->subscription_ = gateway.events().subscribe([raw = run.get()] { raw->pump(); });
  run->StartRead(&run->incoming_);
  return run.get();
}

void PathRun::OnReadDone(bool ok) {
  if (!ok) {
    gateway_.after(kBreakOffWait, [run = self<PathRun>()] { run->begin(); });
  } else if (const Result<void> taken = take(incoming_); !taken) {
    end(to_status(taken.error()));
  } else {
    StartRead(&incoming_);
  }
}

Result<void> PathRun::take(const api::RunPathRequest& part) {
  if (part.has_header()) return take(part.header());
  if (!part.has_segment()) return fail(Reason::invalid_request, "a part of the path is empty");
  if (device_ == nullptr) return fail(Reason::invalid_request, "a segment came before the header");
  return take(part.segment());
}

Result<void> PathRun::take(const api::PathHeader& header) {
  if (device_ != nullptr) return fail(Reason::invalid_request, "a path has one header, and a second one came");
  const Result<server::Device*> device = find_device(gateway_, header.device());
  if (!device) return tl::unexpected(device.error());
  // Checked now, so that nobody sends a long path for nothing; counted from the path's end, in begin().
  const Result<stage::RequestContext> asked = motion_context(context_, header.context(), access_);
  if (!asked) return tl::unexpected(asked.error());
  header_context_ = header.context();
  validate_only_ = header.validate_only();
  device_ = *device;
  return {};
}

Result<void> PathRun::take(const api::Segment& segment) {
  const std::size_t number = path_.segments.size() + 1;
  if (number > stage::PathRequest::kSegmentsMax) {
    return fail(Reason::invalid_request, fmt::format("segment {} is one too many", number),
                fmt::format("a path has at most {} segments", stage::PathRequest::kSegmentsMax));
  }
  Result<stage::Segment> stretch = to_segment(segment);
  if (!stretch) {
    Problem problem = stretch.error();
    problem.message = fmt::format("segment {}: {}", number, problem.message);
    return tl::unexpected(std::move(problem));
  }
  path_.segments.push_back(*std::move(stretch));
  return {};
}

void PathRun::begin() {
  if (cancelled()) return;
  if (path_.segments.empty()) {
    const Problem problem{.reason = Reason::invalid_request,
                          .message = "the path has no segment",
                          .hint = "send a header, then segments"};
    return end(to_status(problem));
  }
  path_.context = motion_context(context_, header_context_, access_).value();
  device_->post(
      [run = self<PathRun>()](stage::StageController& controller, TimePoint now) { run->run(controller, now); });
}

void PathRun::run(stage::StageController& controller, TimePoint now) {
  if (cancelled()) return;
  if (validate_only_) {
    const Result<void> checked = controller.check(path_);
    return end(checked ? grpc::Status::OK : to_status(checked.error()));
  }
  {
    // Facts of this device are published on this strand only: none about this path lies before this revision.
    const std::lock_guard lock(mutex_);
    reader_.go_to(gateway_.events().newest_revision() + 1);
  }
  controller.run_path(std::move(path_), now,
                      [run = self<PathRun>()](const Result<stage::Motion>& motion) { run->on_started(motion); });
}

void PathRun::on_started(const Result<stage::Motion>& motion) {
  if (!motion) return end(to_status(motion.error()));
  {
    const std::lock_guard lock(mutex_);
    motion_ = motion->id;
    due_.emplace();
    *due_->mutable_motion() = to_proto(device_->name(), *motion, device_->motion_revision(motion->id));
  }
  pump();
}

void PathRun::end(grpc::Status status) {
  {
    const std::lock_guard lock(mutex_);
    end_ = std::move(status);
  }
  pump();
}

PathRun::Next PathRun::next() {
  if (!due_ && !end_ && motion_ != 0) read_progress();
  if (due_) return *std::exchange(due_, std::nullopt);
  if (end_) return *end_;
  return Wait{};
}

// Up to the next fact about this path.
void PathRun::read_progress() {
  while (!due_ && !end_) {
    const FactReader::Reading reading = reader_.next();
    if (std::holds_alternative<FactReader::Nothing>(reading)) return;
    if (const auto* compacted = std::get_if<FactReader::Compacted>(&reading)) {
      end_ = compacted_status(*compacted);
      return;
    }
    const server::FactRecord& record = *std::get<std::shared_ptr<const server::FactRecord>>(reading);
    if (record.device != device_->name()) continue;
    if (const auto* progress = std::get_if<stage::PathProgress>(&record.fact)) {
      if (progress->motion != motion_) continue;
      due_.emplace();
      *due_->mutable_progress() = to_proto(record.device, *progress);
    } else if (const auto* change = std::get_if<stage::MotionChanged>(&record.fact)) {
      if (change->motion.id != motion_ || !stage::is_outcome(change->motion.state)) continue;
      due_.emplace();
      *due_->mutable_motion() = to_proto(record.device, change->motion, record.revision);
      end_ = grpc::Status::OK;
    }
  }
}

}  // namespace axisgate::rpc
