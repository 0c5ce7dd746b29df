#include "clients/axisctl/mill_calls.h"

#include <fmt/format.h>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/mill_times.h"
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

std::string wanted_job(const Session& session, const v1::Mill& mill) {
  if (session.options.job.number) return fmt::format("{}/jobs/{}", mill.name(), *session.options.job.number);
  for (const v1::Job& job : mill.jobs()) {
    if (waits(job)) return job.name();
  }
  throw Failure{kRefused, "NOT_FOUND", fmt::format("no job waits at {}", last_part(mill.name())),
                "send one with `axisctl mill send`"};
}

}  // namespace axisgate::axisctl
