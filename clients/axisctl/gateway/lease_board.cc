#include "clients/axisctl/gateway/lease_board.h"

#include <chrono>

#include "clients/axisctl/print.h"

namespace axisgate::axisctl {

std::string latch_text(const v1::Latch& latch) {
  return fmt::format("stopped by {} at {} on {}: must rearm", latch.caller().name(), time_text(latch.time()),
                     scope_text(latch));
}

v1::WatchLeasesResponse board_now(const Session& session, const std::string& device) {
  v1::WatchLeasesRequest request;
  request.set_device(device);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kQuestionLimit);
  const auto stream = session.connection.control->WatchLeases(&context, request);
  v1::WatchLeasesResponse board;
  const bool read = stream->Read(&board);
  context.TryCancel();
  v1::WatchLeasesResponse later;
  while (stream->Read(&later)) continue;
  const grpc::Status status = stream->Finish();
  if (!read) session.connection.check(status);
  return board;
}

}  // namespace axisgate::axisctl
