// State of a mill, and its running job.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "device/core/problem.h"
#include "device/jobs/machine.h"
#include "server/api/mill/job_acts.h"
#include "server/api/mill/job_upload.h"
#include "server/api/request/call.h"
#include "server/api/request/subscription.h"
#include "server/devices/mill.h"
#include "server/gateway.h"

namespace axisgate::api {

// A CurrentRun is the running job; `running` is nullopt if no job runs.
struct CurrentRun {
  const server::Mill* mill = nullptr;  // never null
  std::optional<jobs::RunningJob> running;
  server::Moment clock;
  std::optional<jobs::PlaceRange> executed{};  // jobs::Job::executed of the running job
};

struct MillState {
  const server::Mill* mill = nullptr;          // never null
  std::shared_ptr<const server::MillNow> now;  // never null
};

// Returns the problem of an abort that waits for the line.
Problem not_sent_to(const server::Mill& mill);

// Thread safe. All members also fail as MillPipeline::admit() and jobs::Machine do.
class Mills {
 public:
  // The referenced objects must outlive this one.
  Mills(server::Gateway& gateway, const MillPipeline& pipeline, Streams& streams)
      : gateway_(gateway), pipeline_(pipeline), streams_(streams) {}

  void get(const Call& call, std::string_view device, Answer<MillState> answer) const;
  // Reports the mill whenever it has changed.
  Opened<MillState> watch(const Call& call, std::string_view device) const;

  void pause(const Call& call, std::string_view device, bool raise, Answer<CurrentRun> answer) const;
  void resume(const Call& call, std::string_view device, Answer<CurrentRun> answer) const;
  // Aborts the running job; never refused. Fails with link_down if the line is closed; the abort is then sent when the
  // line is back.
  void abort(const Call& call, std::string_view device, Answer<CurrentRun> answer) const;

 private:
  using RunAct = std::function<Result<void>(const TurnOf<server::Mill>&)>;
  void act_on_run(RequestKind kind, const Call& call, std::string_view device, RunAct act,
                  Answer<CurrentRun> answer) const;

  server::Gateway& gateway_;
  const MillPipeline& pipeline_;
  Streams& streams_;
};

}  // namespace axisgate::api
