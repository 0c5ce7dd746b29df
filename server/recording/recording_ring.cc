#include "server/recording/recording_ring.h"

#include <algorithm>
#include <utility>

namespace axisgate::server {

// The memory is written to at once, so that the system provides it at the start and not only when it is needed.
RecordingRing::RecordingRing(stage::RecordingHeader header, Executor readers, std::size_t bytes_kept)
    : header_(std::move(header)), bytes_(bytes_kept, '\0'), wake_ups_(std::move(readers)) {}

void RecordingRing::append(std::string_view line) {
  line = line.substr(0, bytes_.size() - 1);
  {
    const std::lock_guard lock(mutex_);
    while (newest_.byte + line.size() + 1 - oldest_.byte > bytes_.size()) drop_oldest();
    put(line);
    put("\n");
    ++newest_.line;
  }
  wake_ups_.wake_all();
}

RecordingRing::Beginning RecordingRing::oldest() const {
  const std::lock_guard lock(mutex_);
  return {to_text(header_), oldest_};
}

RecordingRing::Position RecordingRing::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

RecordingRing::Reading RecordingRing::read(Position from, std::size_t bytes_max) const {
  const std::lock_guard lock(mutex_);
  Reading reading{{}, from, 0};
  if (from.byte < oldest_.byte) {
    reading.lost = oldest_.line - from.line;
    reading.next = from = oldest_;
    reading.text = to_text(header_);
  }
  if (from == newest_) return reading;
  std::uint64_t end = std::min(newest_.byte, from.byte + bytes_max);
  while (end > from.byte && bytes_[(end - 1) % bytes_.size()] != '\n') --end;
  if (end == from.byte) end = end_of_line(from.byte);
  const std::string lines = copy(from.byte, end);
  reading.next = {end, from.line + static_cast<std::uint64_t>(std::count(lines.begin(), lines.end(), '\n'))};
  reading.text += lines;
  return reading;
}

std::unique_ptr<WakeUps::Subscription> RecordingRing::subscribe(std::function<void()> wake) {
  return wake_ups_.subscribe(std::move(wake));
}

std::uint64_t RecordingRing::end_of_line(std::uint64_t byte) const {
  while (bytes_[byte % bytes_.size()] != '\n') ++byte;
  return byte + 1;
}

void RecordingRing::drop_oldest() {
  const std::uint64_t end = end_of_line(oldest_.byte);
  pass(header_, copy(oldest_.byte, end - 1));
  oldest_ = {end, oldest_.line + 1};
}

void RecordingRing::put(std::string_view text) {
  const std::size_t at = newest_.byte % bytes_.size();
  const std::string_view before_the_edge = text.substr(0, bytes_.size() - at);
  std::copy(before_the_edge.begin(), before_the_edge.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(at));
  const std::string_view behind_it = text.substr(before_the_edge.size());
  std::copy(behind_it.begin(), behind_it.end(), bytes_.begin());
  newest_.byte += text.size();
}

std::string RecordingRing::copy(std::uint64_t from, std::uint64_t to) const {
  const std::size_t at = from % bytes_.size();
  const std::size_t count = to - from;
  const std::size_t before_the_edge = std::min(count, bytes_.size() - at);
  return bytes_.substr(at, before_the_edge) + bytes_.substr(0, count - before_the_edge);
}

}  // namespace axisgate::server
