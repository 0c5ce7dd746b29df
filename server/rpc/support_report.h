// The stream of GetSupportReport: what somebody who helps needs to know, with secrets taken out.
#pragma once

#include <grpcpp/support/server_callback.h>

#include <deque>
#include <memory>
#include <string>
#include <string_view>

#include "axisgate/v1/diagnostics.pb.h"
#include "server/gateway.h"
#include "server/recording/redaction.h"
#include "server/rpc/pull_stream.h"
#include "server/rpc/stream_limit.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

class SupportReport final
    : public PullStream<grpc::ServerWriteReactor<api::GetSupportReportResponse>, api::GetSupportReportResponse> {
 public:
  static SupportReport* start(server::Gateway& gateway, StreamLimit::Place place);

 private:
  // The recording of one device up to where it was when the report was asked for.
  struct Recording {
    std::string head;
    server::DeviceRecorder::Reader reader;
    server::RecordingRing::Position end;
  };

  SupportReport(server::Gateway& gateway, StreamLimit::Place place);

  void add_devices(server::Gateway& gateway);
  void add_recordings(server::Gateway& gateway);
  std::string next_of(Recording& recording);
  Next next() override;

  const StreamLimit::Place place_;
  server::Redactor redactor_;
  std::string first_;  // everything but the recordings, which may be long
  std::deque<Recording> recordings_;
  bool summary_due_ = true;
};

}  // namespace axisgate::rpc
