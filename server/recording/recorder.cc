#include "server/recording/recorder.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "device/link/clock.h"

namespace axisgate::server {
namespace {

// Bytes copied at once. The strand may wait a few microseconds meanwhile.
constexpr std::size_t kPortionBytes = 16 << 10;

}  // namespace

stage::RecordingHeader recording_header(const stage::Profile& profile, std::string_view kind) {
  stage::RecordingHeader header;
  header.kind = kind;
  header.device = profile.name;
  header.serial_number = profile.serial_number;
  header.baud = profile.baud;
  header.reply_limit = profile.reply_limit;
  return beginning_now(std::move(header));
}

stage::RecordingHeader beginning_now(stage::RecordingHeader header) {
  const auto now = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const auto seconds = std::chrono::floor<std::chrono::seconds>(now);
  header.started = fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(seconds), (now - seconds).count());
  return header;
}

DeviceRecorder::DeviceRecorder(const stage::RecordingHeader& header, Executor readers, prometheus::Counter& drops,
                               std::size_t bytes_kept)
    : drops_(drops),
      ring_(header, std::move(readers), bytes_kept),
      recorder_(header, monotonic_now(), [this](const std::string& line) { ring_.append(line); }) {}

RecordingRing::Beginning DeviceRecorder::begin() {
  flush();
  return {to_text(recorder_.header()), ring_.newest()};
}

std::string DeviceRecorder::Reader::next() {
  RecordingRing::Reading reading = recorder_->ring_.read(position_, kPortionBytes);
  position_ = reading.next;
  if (reading.lost == 0) return std::move(reading.text);
  recorder_->drops_.Increment(static_cast<double>(reading.lost));
  return fmt::format("# {} lines lost: the reader was too slow\n", reading.lost) + reading.text;
}

}  // namespace axisgate::server
