#include "axisgate/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "clients/cpp/src/devices.h"
#include "clients/cpp/src/execute.h"
#include "clients/cpp/src/jog_runner.h"
#include "clients/cpp/src/lease_keeper.h"
#include "clients/cpp/src/outcomes.h"
#include "clients/cpp/src/path.h"
#include "clients/cpp/src/readers.h"
#include "clients/cpp/src/requests.h"
#include "clients/cpp/src/session.h"

namespace axisgate {
namespace {

using client::DeviceSession;
using StageStub = v1::StageService::Stub;

template <class Request>
Request about(const DeviceSession& session, const std::vector<std::string>& axes = {}) {
  Request request;
  request.set_device(session.device());
  if constexpr (requires { request.add_axes(std::string()); }) {
    for (const std::string& axis : axes) request.add_axes(axis);
  }
  return request;
}

Events events_at(const std::shared_ptr<DeviceSession>& session, v1::WatchRequest cursor) {
  cursor.set_device(session->device());
  return Events(std::make_unique<client::EventReader>(session, std::move(cursor)));
}

}  // namespace

Stage::Stage(const ConnectOptions& options) : session_(client::open_stage(options)) {}

std::vector<std::string> Stage::find(const ConnectOptions& options) { return client::stage_names(options); }

std::string Stage::name() const { return client::last_part(session_->device()); }

std::vector<Axis> Stage::axes() const {
  std::vector<Axis> axes;
  for (const AxisState& axis : session_->axes()) axes.emplace_back(*this, axis.name, axis.number, axis.position.unit);
  return axes;
}

Axis Stage::operator[](std::string_view axis) const {
  const std::vector<Axis> all = axes();
  auto found = std::ranges::find(all, axis, &Axis::name);
  if (found == all.end()) {
    found = std::ranges::find_if(all, [&](const Axis& one) { return std::to_string(one.number()) == axis; });
  }
  if (found != all.end()) return *found;
  std::vector<std::string> names;
  for (const Axis& one : all) names.push_back(one.name());
  throw InvalidArgument(fmt::format("{} has no axis {}; its axes are {}", name(), axis, fmt::join(names, ", ")));
}

CallerIdentity Stage::whoami() const {
  const auto answer = session_->connection().ask(session_->services().access, &v1::AccessService::Stub::GetCaller,
                                                 v1::GetCallerRequest());
  constexpr std::string_view prefix = "ROLE_";
  std::string role = v1::Role_Name(answer.role());
  role.erase(0, std::min(prefix.size(), role.size()));
  for (char& letter : role) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return {answer.caller().name(), std::move(role)};
}

Status Stage::status(std::optional<std::chrono::milliseconds> max_age) const {
  return client::status_of(session_->read(max_age));
}

States Stage::watch(std::chrono::milliseconds interval) const {
  return States(std::make_unique<client::StateReader>(session_, interval));
}

Events Stage::events() const {
  const v1::ListDevicesResponse listed = session_->connection().list();
  v1::WatchRequest cursor;  // has a place from the beginning, to resume there if the connection breaks at once
  cursor.set_from_revision(listed.next_revision());
  cursor.set_run(listed.run());
  return events_at(session_, std::move(cursor));
}

Events Stage::events_after(const Event& last) const {
  v1::WatchRequest cursor;
  cursor.set_from_revision(last.revision + 1);
  cursor.set_run(last.run);
  return events_at(session_, std::move(cursor));
}

Events Stage::events_from(std::uint64_t revision) const {
  v1::WatchRequest cursor;
  cursor.set_from_revision(revision);
  return events_at(session_, std::move(cursor));
}

std::vector<Motion> Stage::motions() const {
  const auto listed = session_->connection().ask(session_->services().stage, &StageStub::ListMotions,
                                                 about<v1::ListMotionsRequest>(*session_));
  std::vector<Motion> motions;
  for (const v1::Motion& motion : listed.motions()) motions.push_back(session_->to_motion(motion));
  return motions;
}

void Stage::check(const Targets& targets, const MoveOptions& options) const {
  v1::MoveRequest request = client::move_request(session_->device(), targets, false, options);
  request.set_validate_only(true);
  session_->act(session_->services().stage, &StageStub::Move, std::move(request));
}

Motion Stage::start(const Targets& targets, const MoveOptions& options) const {
  return session_->start(session_->services().stage, &StageStub::Move,
                         client::move_request(session_->device(), targets, false, options));
}

Motion Stage::start_by(const Targets& displacements, const MoveOptions& options) const {
  return session_->start(session_->services().stage, &StageStub::Move,
                         client::move_request(session_->device(), displacements, true, options));
}

MotionResult Stage::move_to(const Targets& targets, const MoveOptions& options) const {
  return session_->finish(session_->services().stage, &StageStub::Move,
                          client::move_request(session_->device(), targets, false, options), options.stop);
}

MotionResult Stage::move_by(const Targets& displacements, const MoveOptions& options) const {
  return session_->finish(session_->services().stage, &StageStub::Move,
                          client::move_request(session_->device(), displacements, true, options), options.stop);
}

MotionResult Stage::home(const std::vector<std::string>& axes, std::stop_token stop) const {
  return session_->finish(session_->services().stage, &StageStub::Home, about<v1::HomeRequest>(*session_, axes),
                          std::move(stop));
}

MotionResult Stage::home_if_needed(const std::vector<std::string>& axes, std::stop_token stop) const {
  std::vector<std::string> needed;
  const Status now = status();
  for (const AxisState& state : now.known_axes()) {
    const bool chosen = axes.empty() || std::ranges::any_of(axes, [&](const std::string& axis) {
                          return axis == state.name || axis == std::to_string(state.number);
                        });
    if (chosen && !state.homed) needed.push_back(state.name);
  }
  return needed.empty() ? MotionResult() : home(needed, std::move(stop));
}

Motion Stage::start_path(const std::vector<Point>& points, const std::vector<std::string>& axes,
                         const std::optional<Speed>& speed) const {
  std::vector<v1::Segment> segments;
  for (const Point& point : points) segments.push_back(client::segment(axes, point, speed));
  return client::start_path(*session_, segments);
}

Targets Stage::targets_at(const std::vector<std::string>& axes, const Point& point) {
  client::check_point(axes, point);
  Targets targets;
  for (std::size_t i = 0; i < axes.size(); ++i) targets.emplace(axes[i], point[i]);
  return targets;
}

Motion Stage::scan(const ScanTerms& terms) const {
  return session_->start(session_->services().stage, &StageStub::Scan, client::scan_request(session_->device(), terms));
}

Jog Stage::jog(const std::map<std::string, Speed, std::less<>>& speeds) const {
  auto request = about<v1::JogRequest>(*session_);
  request.mutable_context()->set_lease_token(session_->token());
  for (const auto& [axis, speed] : speeds) *request.add_axes() = client::axis_jog(axis, speed);
  return Jog(std::make_unique<client::JogRunner>(session_, request));
}

Executed Stage::execute(const std::vector<std::string>& lines) const { return client::execute(*session_, lines); }

void Stage::clear_errors(const std::vector<std::string>& axes) const {
  session_->act(session_->services().devices, &v1::DeviceService::Stub::ClearErrors,
                about<v1::ClearErrorsRequest>(*session_, axes));
}

std::vector<int> Stage::rearm() const {
  const auto answer =
      session_->act(session_->services().control, &v1::ControlService::Stub::Rearm, about<v1::RearmRequest>(*session_));
  return {answer.axes().begin(), answer.axes().end()};
}

Lease Stage::lease(const LeaseTerms& terms) const {
  return Lease(std::make_unique<client::LeaseKeeper>(session_, terms));
}

Places Stage::places() const { return Places(session_); }

}  // namespace axisgate
