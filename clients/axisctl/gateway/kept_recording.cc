#include "clients/axisctl/gateway/kept_recording.h"

#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <variant>

#include "clients/axisctl/failure.h"
#include "device/stage/recording/recording.h"

namespace axisgate::axisctl {
namespace {

using google::protobuf::util::TimeUtil;

// Returns the header and the first lines of the recording; empty if there are none. Reads two messages, because the
// header may be a separate message.
std::string beginning_of_recording(const Session& session, const std::string& device) {
  v1::RecordRequest request;
  request.set_device(device);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kQuestionLimit);
  const auto reader = session.connection.diagnostics->Record(&context, request);
  std::string text;
  v1::RecordResponse response;
  for (int messages = 0; messages < 2 && reader->Read(&response); ++messages) text += response.text();
  context.TryCancel();
  while (reader->Read(&response)) continue;
  reader->Finish();
  return text;
}

bool has_time(const stage::RecordedLine& line) {
  const auto* remark = std::get_if<stage::RecordedRemark>(&line.event);
  return remark == nullptr || remark->kind != stage::RecordedRemark::Kind::note;
}

Duration time_of(const stage::RecordedLine& line) {
  return std::visit([](const auto& event) { return event.at; }, line.event);
}

}  // namespace

std::optional<std::chrono::seconds> place_in_recording(const Session& session, const std::string& device,
                                                       const google::protobuf::Timestamp& time) {
  const Result<stage::Recording> kept = stage::parse_recording(beginning_of_recording(session, device));
  if (!kept) return std::nullopt;
  google::protobuf::Timestamp started;
  const auto first = std::ranges::find_if(kept->lines, has_time);
  if (first == kept->lines.end() || !TimeUtil::FromString(kept->header.started, &started)) return std::nullopt;
  const std::chrono::microseconds at(TimeUtil::DurationToMicroseconds(time - started));
  return at < time_of(*first) ? std::nullopt : std::optional(std::chrono::floor<std::chrono::seconds>(at));
}

}  // namespace axisgate::axisctl
