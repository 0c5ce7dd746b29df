// What went over the lines, and a report for somebody who helps.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "device/stage/state.h"
#include "server/api/request/admission.h"
#include "server/api/request/call.h"
#include "server/api/request/pipeline.h"
#include "server/api/request/subscription.h"
#include "server/gateway.h"

namespace axisgate::api {

// Of what a report says, what only the door knows.
struct DoorReport {
  std::string versions;  // "gRPC 1.51\nprotobuf 3.21\n": lines, each with its \n
  // A device's state as the door shows it to callers.
  std::function<std::string(const server::Stage& device, const stage::State& state)> describe;
};

// Thread safe. Both streams are of text: whole lines, each with its \n.
class Diagnostics {
 public:
  // All outlive this.
  Diagnostics(server::Gateway& gateway, const Admission& admission, const DevicePipeline& pipeline, Streams& streams)
      : gateway_(gateway), admission_(admission), pipeline_(pipeline), streams_(streams) {}

  // What is kept of a device's recording, unless `skip_kept`, and with `follow` each new line; without it the stream
  // ends with the line that was the newest as it began. A slow reader misses lines, and a remark says so.
  Opened<std::string> record(const Call& call, std::string_view device, bool skip_kept, bool follow) const;

  // Versions, configuration, state, metrics and recordings, without secrets. It ends.
  Opened<std::string> report(const Call& call, const DoorReport& door) const;

 private:
  server::Gateway& gateway_;
  const Admission& admission_;
  const DevicePipeline& pipeline_;
  Streams& streams_;
};

}  // namespace axisgate::api
