// Requests that read a whole job before they act on it: to start it, and to choose the place where it continues.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

#include "server/api/mill/job_acts.h"
#include "server/api/mill/job_upload.h"
#include "server/api/request/call.h"
#include "server/api/request/fair_worker.h"
#include "server/gateway.h"

namespace axisgate::api {

// A LineToChoose is the place in a part where the job continues. Both numbers count from 1. Line 0: no place is named.
struct LineToChoose {
  std::uint64_t line = 0, column = 1;
};

// Thread safe. Both members also fail as JobActs::act() and jobs::Machine do.
class JobStarts {
 public:
  // The referenced objects must outlive this one. `worker` is shared with tasks that are posted to a mill.
  JobStarts(server::Gateway& gateway, const MillPipeline& pipeline, const JobActs& acts,
            std::shared_ptr<FairWorker> worker)
      : gateway_(gateway), pipeline_(pipeline), acts_(acts), worker_(std::move(worker)) {}

  void start(const Call& call, std::string_view job, Answer<CurrentJob> answer) const;
  // Fails as server::chosen_rest() does.
  void choose_rest(const Call& call, std::string_view job, LineToChoose from, Answer<CurrentJob> answer) const;

 private:
  // Reads the newest published job on the worker, then acts on it with the result.
  template <class Read, class Act>
  void read_and_act(RequestKind kind, const Call& call, std::string_view job, Read read, Act act,
                    Answer<CurrentJob> answer) const;

  server::Gateway& gateway_;
  const MillPipeline& pipeline_;
  const JobActs& acts_;
  const std::shared_ptr<FairWorker> worker_;
};

}  // namespace axisgate::api
