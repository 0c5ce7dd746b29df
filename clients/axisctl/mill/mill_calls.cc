#include "clients/axisctl/mill/mill_calls.h"

#include <fmt/format.h>

#include <algorithm>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/mill/mill_times.h"
#include "clients/axisctl/print.h"

namespace axisgate::axisctl {

std::string chosen_mill(const Session& session) {
  return session.options.device.empty() ? only_mill(session).name() : session.options.device;
}

std::string mill_to_change(const Session& session) {
  const std::string& device = session.options.device;
  if (device.empty()) return only_mill(session).name();
  const Connection& connection = session.connection;
  connection.repeat_by(connection.call(connection.devices, &v1::DeviceService::Stub::ListDevices,
                                       v1::ListDevicesRequest(), kQuestionLimit));
  return device;
}

v1::Mill mill_now(const Session& session, const std::string& device) {
  v1::GetMillRequest request;
  request.set_device(device);
  return session.connection.call(session.connection.mills, &v1::MillService::Stub::GetMill, request, kQuestionLimit)
      .mill();
}

namespace {

// Returns the job whose number was typed, or else the first job that `wanted` accepts; empty if there is none.
template <class Wanted>
std::string typed_or_first(const Session& session, const v1::Mill& mill, Wanted wanted) {
  if (session.options.job.number) return fmt::format("{}/jobs/{}", mill.name(), *session.options.job.number);
  const auto found = std::ranges::find_if(mill.jobs(), wanted);
  return found == mill.jobs().end() ? "" : found->name();
}

}  // namespace

std::string wanted_job(const Session& session, const v1::Mill& mill) {
  const std::string job = typed_or_first(session, mill, waits);
  if (!job.empty()) return job;
  if (mill.has_running()) {
    throw Failure{
        kRefused, "NOT_FOUND",
        fmt::format("no job waits at {}: job {} runs", last_part(mill.name()), last_part(mill.running().job())),
        "ask again when it has ended, or is PAUSED with its tool up"};
  }
  throw Failure{kRefused, "NOT_FOUND", fmt::format("no job waits at {}", last_part(mill.name())),
                "send one with `axisctl mill send`"};
}

std::string fed_job(const Session& session, const v1::Mill& mill) {
  const auto is_fed = [](const v1::Job& one) { return one.state() == v1::JOB_STATE_FED; };
  const std::string job = typed_or_first(session, mill, is_fed);
  if (!job.empty()) return job;
  throw Failure{kRefused, "NOT_FOUND", fmt::format("no job of {} is FED", last_part(mill.name())),
                "`axisctl mill queue` shows what its jobs wait for"};
}

}  // namespace axisgate::axisctl
