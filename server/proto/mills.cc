#include "server/proto/mills.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "server/api/request/names.h"
#include "server/devices/spooled_jobs.h"
#include "server/proto/amounts.h"
#include "server/proto/callers.h"
#include "server/proto/digest.h"
#include "server/proto/to_proto.h"

namespace axisgate::proto {
namespace {

constexpr double kLongestStock = 10'000;  // mm

using jobs::JobState;
using jobs::SenderState;

v1::JobState to_job_state(JobState state) {
  static_assert(static_cast<int>(JobState::queued) + 1 == v1::JOB_STATE_QUEUED);
  static_assert(static_cast<int>(JobState::running) + 1 == v1::JOB_STATE_RUNNING);
  static_assert(static_cast<int>(JobState::cancelled) + 1 == v1::JOB_STATE_CANCELLED);
  static_assert(static_cast<int>(JobState::tool_change) + 1 == v1::JOB_STATE_TOOL_CHANGE);
  static_assert(static_cast<int>(JobState::paused) + 1 == v1::JOB_STATE_PAUSED);
  static_assert(static_cast<int>(JobState::expired) + 1 == v1::JOB_STATE_EXPIRED);
  return static_cast<v1::JobState>(static_cast<int>(state) + 1);
}

void add_parts(const jobs::Job& job, v1::Job& proto) {
  std::uint64_t begin = 0;
  for (const jobs::JobPart& part : job.parts) {
    v1::JobPart& added = *proto.add_parts();
    added.set_tool(part.tool);
    added.set_bytes(static_cast<std::int64_t>(part.end - begin));
    begin = part.end;
  }
  proto.set_part(static_cast<std::int32_t>(job.part) + 1);
}

v1::JobPlace place_of(const jobs::Place& place) {
  v1::JobPlace proto;
  proto.set_byte(static_cast<std::int64_t>(place.offset));
  proto.set_line(static_cast<std::int64_t>(place.line));
  proto.set_column(static_cast<std::int64_t>(place.column));
  return proto;
}

v1::Distance millimeters(double mm) {
  return to_distance({.value = decimal_of(mm, true).value_or(Decimal{}), .unit = Unit::millimeters});
}

// Fails with unknown_unit if the distance is in pulses or degrees: the size of a workpiece is not in steps of a mill.
Result<double> to_mm(const v1::Distance& distance) {
  const Result<Quantity> length = to_quantity(distance);
  if (!length) return tl::unexpected(length.error());
  if (length->unit == Unit::pulses || length->unit == Unit::degrees) {
    return fail(Reason::unknown_unit, fmt::format("a workpiece has no size in {}", symbol(length->unit)),
                "use mm, um or nm");
  }
  const double unit_mm = length->unit == Unit::millimeters ? 1 : length->unit == Unit::micrometers ? 1e-3 : 1e-6;
  return std::stod(to_string(length->value)) * unit_mm;
}

Result<jobs::Stock> to_stock(const v1::Stock& stock) {
  const Result<double> x = to_mm(stock.x()), y = to_mm(stock.y()), z = to_mm(stock.z());
  for (const auto& length : {x, y, z}) {
    if (!length) return tl::unexpected(length.error());
    if (*length > 0 && *length <= kLongestStock) continue;
    return fail(Reason::invalid_request, "the workpiece has no size, or one that cannot be",
                fmt::format("give its three lengths, each above 0 and at most {} mm", kLongestStock));
  }
  return jobs::Stock{*x, *y, *z};
}

v1::JobSetup setup_of(const jobs::JobSetup& setup) {
  v1::JobSetup proto;
  proto.set_digest(setup.digest);
  proto.set_profile(setup.profile);
  proto.set_origin(setup.origin);
  proto.set_tool(setup.tool);
  *proto.mutable_left() = {setup.left.begin(), setup.left.end()};
  if (setup.from) *proto.mutable_start() = place_of(*setup.from);
  return proto;
}

}  // namespace

// The other states cannot occur here: a job that has ended does not run.
v1::SendingState to_sending_state(SenderState state) {
  switch (state) {
    case SenderState::sending:
      return v1::SENDING_STATE_SENDING;
    case SenderState::paused:
      return v1::SENDING_STATE_PAUSED;
    case SenderState::finishing:
      return v1::SENDING_STATE_FINISHING;
    case SenderState::aborting:
      return v1::SENDING_STATE_ABORTING;
    case SenderState::raising:
      return v1::SENDING_STATE_RAISING;
    default:
      return v1::SENDING_STATE_UNSPECIFIED;
  }
}

v1::Streaming to_streaming(jobs::Streaming streaming) {
  return streaming == jobs::Streaming::full ? v1::STREAMING_FULL : v1::STREAMING_PACED;
}

v1::AxisExtent to_proto(const jobs::Reach& reach) {
  v1::AxisExtent proto;
  proto.set_least_mm(reach.lowest);
  proto.set_most_mm(reach.highest);
  return proto;
}

v1::JobExtent to_proto(const jobs::Extent& extent) {
  v1::JobExtent proto;
  *proto.mutable_x() = to_proto(extent.driven.x);
  *proto.mutable_y() = to_proto(extent.driven.y);
  *proto.mutable_z() = to_proto(extent.driven.z);
  if (!extent.cut.z.any) return proto;
  *proto.mutable_cut_x() = to_proto(extent.cut.x);
  *proto.mutable_cut_y() = to_proto(extent.cut.y);
  proto.set_deepest_mm(extent.deepest());
  return proto;
}

v1::Job to_proto(const api::CurrentJob& current) {
  v1::Job proto = to_proto(current.mill->name(), current.job, current.clock);
  proto.set_streaming(to_streaming(current.job.streaming.value_or(current.mill->config().sending.streaming)));
  if (const auto run_on = jobs::run_on(current.job)) *proto.mutable_run_on() = to_proto(*run_on);
  if (current.job.extent.driven.z.any) *proto.mutable_extent() = to_proto(current.job.extent);
  return proto;
}

v1::Job to_proto(std::string_view mill, const jobs::Job& job, const server::Moment& clock) {
  v1::Job proto;
  proto.set_name(api::job_name(mill, job.number));
  proto.set_title(job.name);
  *proto.mutable_owner() = to_caller(job.owner);
  *proto.mutable_setup() = setup_of(job.setup);
  proto.set_bytes(static_cast<std::int64_t>(job.bytes));
  if (const jobs::TimeRange takes = jobs::takes(job); takes.most > Duration()) {
    *proto.mutable_shortest_time() = to_proto(takes.least);
    *proto.mutable_longest_time() = to_proto(takes.most);
  }
  proto.set_state(to_job_state(job.state));
  if (job.confirmation) {
    *proto.mutable_confirmed_by() = to_caller(job.confirmation->by);
    *proto.mutable_confirmation_expire_time() = to_proto(clock.at(job.confirmation->until));
  }
  proto.set_not_confirmed_because(job.void_because);
  if (job.written) {
    proto.set_sent_least(static_cast<std::int64_t>(job.written->least));
    proto.set_sent_most(static_cast<std::int64_t>(job.written->most));
  }
  if (job.executed) *proto.mutable_executed() = to_proto(*job.executed);
  if (job.continues != 0) proto.set_continues(api::job_name(mill, job.continues));
  if (job.stock) {
    *proto.mutable_stock()->mutable_x() = millimeters(job.stock->x);
    *proto.mutable_stock()->mutable_y() = millimeters(job.stock->y);
    *proto.mutable_stock()->mutable_z() = millimeters(job.stock->z);
  }
  for (const std::string& warning : job.accepted) proto.add_accepted_warnings(warning);
  add_parts(job, proto);
  return proto;
}

v1::JobPlaceRange to_proto(const jobs::PlaceRange& range) {
  v1::JobPlaceRange proto;
  *proto.mutable_least() = place_of(range.least);
  *proto.mutable_most() = place_of(range.most);
  return proto;
}

v1::RunOn to_proto(const jobs::RunOn& run_on) {
  v1::RunOn proto;
  proto.set_at_most(static_cast<std::int64_t>(run_on.at_most));
  proto.set_if_held(static_cast<std::int64_t>(run_on.if_held));
  *proto.mutable_longest_time() = to_proto(run_on.longest);
  proto.set_mm(run_on.mm);
  return proto;
}

v1::RunningJob to_proto(const api::CurrentRun& run) {
  v1::RunningJob proto;
  if (!run.running) return proto;
  const jobs::RunningJob& job = *run.running;
  proto.set_job(api::job_name(run.mill->name(), job.number));
  proto.set_sending(to_sending_state(job.sender));
  proto.set_written(static_cast<std::int64_t>(job.progress.written));
  proto.set_unsent(static_cast<std::int64_t>(job.progress.unsent));
  proto.set_taken(static_cast<std::int64_t>(job.progress.taken));
  proto.set_executed_least(static_cast<std::int64_t>(job.progress.executed_least));
  proto.set_executed_most(static_cast<std::int64_t>(job.progress.executed_most));
  *proto.mutable_run_on() = to_proto(job.run_on);
  *proto.mutable_shortest_remaining_time() = to_proto(job.left.least);
  *proto.mutable_longest_remaining_time() = to_proto(job.left.most);
  proto.set_busy(job.busy);
  *proto.mutable_start_time() = to_proto(run.clock.at(job.started));
  return proto;
}

v1::Mill to_proto(const api::MillState& state) {
  v1::Mill proto;
  const server::MillConfig& config = state.mill->config();
  proto.set_name(api::device_name(state.mill->name()));
  proto.set_profile(std::string(config.model->name()));
  proto.set_line_open(state.now->link == jobs::MachineLink::open);
  for (const jobs::Job& job : state.now->jobs) {
    *proto.add_jobs() = to_proto(api::CurrentJob{state.mill, job, state.now->clock});
  }
  if (state.now->running) {
    *proto.mutable_running() = to_proto(api::CurrentRun{state.mill, state.now->running, state.now->clock});
  }
  if (const auto& measured = state.now->measured_pace) {
    proto.mutable_measured_pace()->set_least(measured->least);
    proto.mutable_measured_pace()->set_most(measured->most);
  }
  if (state.now->ended)
    *proto.mutable_ended() = to_proto(api::CurrentJob{state.mill, *state.now->ended, state.now->clock});
  for (const std::string& tool : config.tools) proto.add_tools(tool);
  for (const jobs::NamedOrigin& origin : config.origins) {
    proto.add_origins(origin.name);
    const jobs::Origin place = config.model->place_of(origin);
    v1::OriginPlace& shown = *proto.add_origin_places();
    shown.set_x_mm(place.x);
    shown.set_y_mm(place.y);
    shown.set_z_mm(place.z);
  }
  proto.set_job_bytes_at_most(state.mill->spool().job_bytes_at_most());
  return proto;
}

v1::Device device_of(const api::MillState& state) {
  v1::Device proto;
  proto.set_name(api::device_name(state.mill->name()));
  proto.set_kind(std::string(state.mill->kind_name()));
  const bool open = state.now->link == jobs::MachineLink::open;
  proto.set_link(open ? v1::LINK_STATE_UP : v1::LINK_STATE_DOWN);
  proto.set_link_problem(state.now->why_closed);
  proto.set_model(std::string(state.mill->config().model->name()));
  proto.add_capabilities(v1::CAPABILITY_JOBS);
  return proto;
}

jobs::JobSetup to_setup(const v1::JobSetup& proto) {
  jobs::JobSetup setup{
      proto.digest(), proto.profile(), proto.origin(), proto.tool(), {proto.left().begin(), proto.left().end()}};
  if (proto.has_start()) {
    const v1::JobPlace& from = proto.start();
    setup.from = {static_cast<std::uint64_t>(from.byte()), static_cast<std::uint64_t>(from.line()),
                  static_cast<std::uint64_t>(from.column())};
  }
  return setup;
}

Result<jobs::JogStep> to_step(const v1::JogStep& proto) {
  jobs::JogStep step;
  const auto read = [](bool is_set, const auto& amount, auto& into) -> Result<void> {
    if (!is_set) return {};
    return to_quantity(amount).map([&into](const Quantity& quantity) { into = quantity; });
  };
  Result<void> good = read(proto.has_x(), proto.x(), step.x);
  if (good) good = read(proto.has_y(), proto.y(), step.y);
  if (good) good = read(proto.has_z(), proto.z(), step.z);
  if (good) good = read(proto.has_speed(), proto.speed(), step.speed);
  if (!good) return tl::unexpected(good.error());
  return step;
}

Result<api::HandRequest> to_hand_request(const v1::OperateMillRequest& request) {
  switch (request.act_case()) {
    case v1::OperateMillRequest::kStep:
      return to_step(request.step()).map([](const jobs::JogStep& step) { return api::HandRequest{step}; });
    case v1::OperateMillRequest::kSurface: {
      const v1::SetZ0& surface = request.surface();
      if (!surface.has_z()) return api::HandRequest{jobs::SetZ0{}, surface.origin()};
      return to_quantity(surface.z()).map([&](const Quantity& z) {
        return api::HandRequest{jobs::SetZ0{z}, surface.origin()};
      });
    }
    case v1::OperateMillRequest::kSpindle:
      return api::HandRequest{jobs::TurnSpindle{request.spindle()}};
    case v1::OperateMillRequest::kRaiseTool:
      return api::HandRequest{jobs::RaiseTool{}};
    case v1::OperateMillRequest::ACT_NOT_SET:
      break;
  }
  return fail(Reason::invalid_request, "the request names no act", "set step, surface, spindle or raise_tool");
}

api::LineToChoose to_line(std::int64_t line, std::int64_t column) {
  const auto number = [](std::int64_t value) { return static_cast<std::uint64_t>(std::max<std::int64_t>(value, 0)); };
  return {number(line), std::max<std::uint64_t>(number(column), 1)};
}

api::JobToRepeat to_repeat(const v1::RepeatJobRequest& request) {
  return {request.rest(),
          to_line(request.line(), request.column()),
          {request.accepted_warnings().begin(), request.accepted_warnings().end()}};
}

Result<api::JobToSend> to_job(const v1::JobHeader& header) {
  api::JobToSend job{
      header.title(), header.origin(), {}, {header.accepted_warnings().begin(), header.accepted_warnings().end()}};
  job.made_for = header.made_for();
  job.continues = header.continues();
  if (header.has_stock()) {
    const Result<jobs::Stock> stock = to_stock(header.stock());
    if (!stock) return tl::unexpected(stock.error());
    job.stock = *stock;
  }
  if (!v1::Streaming_IsValid(header.streaming())) {
    return fail(Reason::invalid_request, fmt::format("there is no streaming {}", static_cast<int>(header.streaming())),
                "use PACED or FULL, or leave it out");
  }
  if (header.streaming() != v1::STREAMING_UNSPECIFIED) {
    job.streaming = header.streaming() == v1::STREAMING_FULL ? jobs::Streaming::full : jobs::Streaming::paced;
  }
  if (header.parts().empty()) {
    job.parts.push_back({header.tool()});
    return job;
  }
  if (!header.tool().empty()) {
    return fail(Reason::invalid_request, "the job has a tool, and parts with tools of their own",
                "name the tool of each part only");
  }
  for (const v1::JobPart& part : header.parts()) {
    job.parts.push_back({part.tool(), static_cast<std::uint64_t>(std::max<std::int64_t>(part.bytes(), 0))});
  }
  return job;
}

std::string job_digest(std::string_view header_digest, const std::string& bytes_digest) {
  v1::SendJobRequest data;
  data.set_data(bytes_digest);
  return digest_of(header_digest, data);
}

}  // namespace axisgate::proto
