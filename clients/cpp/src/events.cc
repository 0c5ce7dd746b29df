#include "axisgate/events.h"

#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/time_util.h>

#include <charconv>
#include <utility>

#include "clients/cpp/src/outcomes.h"
#include "clients/cpp/src/readers.h"

namespace axisgate {
namespace client {
namespace {

Event event_of(const v1::Event& message) {
  namespace util = google::protobuf::util;
  Event event;
  event.revision = message.revision();
  event.time = std::chrono::system_clock::time_point(
      std::chrono::microseconds(util::TimeUtil::TimestampToMicroseconds(message.time())));
  event.device = last_part(message.device());
  event.run = message.run();
  const auto* const fact =
      message.GetReflection()->GetOneofFieldDescriptor(message, v1::Event::descriptor()->FindOneofByName("fact"));
  if (fact != nullptr) event.kind = fact->name();
  util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  (void)util::MessageToJsonString(message, &event.json, options);
  return event;
}

}  // namespace

EventReader::EventReader(std::shared_ptr<DeviceSession> session, v1::WatchRequest cursor)
    : session_(std::move(session)),
      cursor_(std::move(cursor)),
      feed_(
          session_,
          [this](grpc::ClientContext& context) { return session_->services().events.Watch(&context, cursor_); },
          [this](const Failure& failure) { return skip(failure); }) {}

std::optional<std::variant<Event, Gap>> EventReader::next() {
  while (true) {
    if (gap_) return *std::exchange(gap_, std::nullopt);
    v1::WatchResponse response;
    if (feed_.read(response)) {
      cursor_.set_from_revision(response.event().revision() + 1);
      cursor_.set_run(response.event().run());
      return event_of(response.event());
    }
    if (!feed_.resume()) return std::nullopt;
  }
}

bool EventReader::skip(const Failure& failure) {
  if (failure.reason() != "COMPACTED") return false;
  const auto& metadata = failure.problem->metadata();
  const auto found = metadata.find("resume_revision");
  if (found == metadata.end()) return false;
  const std::string& text = found->second;
  std::uint64_t resume = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), resume).ec != std::errc()) return false;
  cursor_.set_from_revision(resume);
  cursor_.clear_run();
  gap_ = Gap{resume};
  return true;
}

StateReader::StateReader(std::shared_ptr<DeviceSession> session, milliseconds interval)
    : feed_(
          session,
          [session, interval](grpc::ClientContext& context) {
            v1::WatchDeviceRequest request;
            request.set_device(session->device());
            *request.mutable_min_interval() =
                google::protobuf::util::TimeUtil::MillisecondsToDuration(interval.count());
            return session->services().devices.WatchDevice(&context, request);
          },
          [](const Failure&) { return false; }) {}

std::optional<Status> StateReader::next() {
  v1::WatchDeviceResponse response;
  while (!feed_.read(response)) {
    if (!feed_.resume()) return std::nullopt;
  }
  return status_of(response.device());
}

}  // namespace client

Events::Events(std::unique_ptr<client::EventReader> reader) : reader_(std::move(reader)) {}
Events::~Events() = default;
Events::Events(Events&&) noexcept = default;
std::optional<std::variant<Event, Gap>> Events::next() { return reader_->next(); }
void Events::close() { reader_->close(); }

States::States(std::unique_ptr<client::StateReader> reader) : reader_(std::move(reader)) {}
States::~States() = default;
States::States(States&&) noexcept = default;
std::optional<Status> States::next() { return reader_->next(); }
void States::close() { reader_->close(); }

}  // namespace axisgate
