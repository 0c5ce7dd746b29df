#include "tests/bench/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "tests/bench/daemon.h"

namespace axisgate::bench {
namespace {

Duration seconds_in(const std::string& text) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(std::stod(text)));
}

// Parses `12.345678 #9 question "unix anna" > "?:V\r\n" +0.003125 < "V2.00.000\r\n" = data`. Empty if the line does not
// begin with `line_begin`.
std::optional<RecordedTimes> times_in(const std::string& line, std::string_view line_begin) {
  const auto written = line.find(fmt::format(" > \"{}", line_begin));
  if (line.starts_with('#') || written == std::string::npos) return {};
  const Duration at = seconds_in(line);
  const auto received = line.find(" < \"", written);
  const auto plus = line.find(" +", written);
  const bool later = received != std::string::npos && plus < received;
  return RecordedTimes{at, later ? at + seconds_in(line.substr(plus + 2)) : at};
}

}  // namespace

Recording::Recording(const std::shared_ptr<grpc::Channel>& channel) : stub_(v1::DiagnosticsService::NewStub(channel)) {
  v1::RecordRequest request;
  request.set_device(kDevice);
  request.set_skip_kept(true);
  request.set_follow(true);
  reader_ = stub_->Record(&context_, request);
  reader_->WaitForInitialMetadata();
  thread_ = std::thread([this] { read(); });
}

Recording::~Recording() {
  context_.TryCancel();
  thread_.join();
  reader_->Finish();
}

void Recording::read() {
  v1::RecordResponse response;
  while (reader_->Read(&response)) {
    const std::lock_guard lock(mutex_);
    text_ += response.text();
  }
}

std::vector<RecordedTimes> Recording::times_of(std::string_view line_begin) const {
  const std::lock_guard lock(mutex_);
  std::vector<RecordedTimes> all;
  std::istringstream lines(text_);
  for (std::string line; std::getline(lines, line);) {
    if (const auto times = times_in(line, line_begin)) all.push_back(*times);
  }
  return all;
}

Beginning beginning_of(const std::vector<CallTimes>& calls, const std::vector<RecordedTimes>& recorded) {
  if (calls.empty() || calls.size() != recorded.size()) {
    throw std::runtime_error(fmt::format("{} calls, but {} lines in the recording", calls.size(), recorded.size()));
  }
  Beginning beginning{TimePoint::min(), TimePoint::max()};
  for (std::size_t i = 0; i < calls.size(); ++i) {
    beginning.earliest = std::max(beginning.earliest, calls[i].called - recorded[i].written);
    beginning.latest = std::min(beginning.latest, calls[i].ended - recorded[i].replied);
  }
  return beginning;
}

}  // namespace axisgate::bench
