// Recordings of the lines, and the support report.
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

// A DoorReport is the part of a support report that only the door knows.
struct DoorReport {
  std::string versions;  // "gRPC 1.51\nprotobuf 3.21\n": each line ends with \n
  // Describes a device's state as the door shows it to callers.
  std::function<std::string(const server::Stage& device, const stage::State& state)> describe;
};

// Thread safe. Both streams carry text: whole lines, each with its \n.
class Diagnostics {
 public:
  // The referenced objects must outlive this one.
  Diagnostics(server::Gateway& gateway, const Admission& admission, const DevicePipeline& pipeline, Streams& streams)
      : gateway_(gateway), admission_(admission), pipeline_(pipeline), streams_(streams) {}

  // Streams the kept lines of a device's recording, unless `skip_kept`. With `follow`, new lines are added; otherwise
  // the stream ends with the line that was the newest when it began. A slow reader misses lines, and a remark says so.
  Opened<std::string> record(const Call& call, std::string_view device, bool skip_kept, bool follow) const;

  // Streams versions, configuration, state, metrics and recordings, without secrets, and then ends.
  Opened<std::string> report(const Call& call, const DoorReport& door) const;

 private:
  server::Gateway& gateway_;
  const Admission& admission_;
  const DevicePipeline& pipeline_;
  Streams& streams_;
};

}  // namespace axisgate::api
