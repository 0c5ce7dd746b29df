#include "tests/rml1/abort_bench.h"

#include <algorithm>
#include <charconv>

namespace axisgate::rml1 {
namespace {

constexpr char kXoff = 0x13;
constexpr std::size_t kBothEscapeK = 6;                   // bytes before the words of an abort
constexpr Duration kFinishes = std::chrono::minutes(30);  // enough for anything in the mill

// Returns the number after `key` in a line of the record.
std::optional<std::size_t> number_in(std::string_view line, std::string_view key) {
  const auto at = line.find(key);
  if (at == std::string_view::npos) return std::nullopt;
  std::size_t number = 0;
  std::from_chars(line.data() + at + key.size(), line.data() + line.size(), number);
  return number;
}

}  // namespace

LineToMill::LineToMill(simulator::MillBench& mill, Setup setup) : mill_(mill), setup_(setup) {}

void LineToMill::write(std::string_view bytes) {
  written += bytes;
  host_.insert(host_.end(), bytes.begin(), bytes.end());
  pump(mill_.now);
}

// Counts the byte in flight as unsent if there is no converter.
std::size_t LineToMill::unsent() const { return host_.size() + (byte_ && setup_.converter == 0 ? 1 : 0); }

bool LineToMill::stopped() const {
  return mill_.written.empty() ? mill_.mill.holds_back() : mill_.written.back() == kXoff;
}

bool LineToMill::may_leave() {
  if (!stopped()) late_left_ = setup_.late;
  if (ignores_ || !stopped()) return true;
  if (late_left_ == 0) return false;
  --late_left_;
  return true;
}

void LineToMill::pump(TimePoint now) {
  for (; !host_.empty() && converter_.size() + (byte_ ? 1 : 0) < setup_.converter; host_.pop_front()) {
    converter_.push_back(host_.front());
  }
  std::deque<char>& from = setup_.converter > 0 ? converter_ : host_;
  if (byte_ || from.empty() || !may_leave()) return;
  byte_ = from.front();
  from.pop_front();
  arrives_ = now + std::chrono::nanoseconds(std::chrono::seconds(10)) / setup_.baud;
}

std::size_t LineToMill::drop(bool converter_too) {
  host_.clear();
  if (converter_too || setup_.converter == 0) {
    converter_.clear();
    byte_.reset();
  }
  return converter_.size() + (byte_ ? 1 : 0);
}

char LineToMill::take() {
  const char byte = *byte_;
  byte_.reset();
  return byte;
}

AbortBench::AbortBench(std::string_view job, const Timeline& timeline, simulator::MillSetup mill,
                       jobs::SendSettings settings, LineToMill::Setup line, std::string_view before)
    : mill_(std::move(mill)),
      line_(mill_, line),
      beside_(profile_, settings, line_),
      sender_(job, timeline, profile_, settings, plan_of(job, timeline, settings), beside_.mill()) {
  mill_.send(before);
  mill_.finish();
  lines_read_ = mill_.lines.size();
  sender_.start(mill_.now);
}

void AbortBench::press_view() {
  mill_.mill.press_view(mill_.now);
  read_record();
  line_.pump(mill_.now);
}

void AbortBench::abort() {
  end_writing();
  sender_.abort(mill_.now);
}

void AbortBench::stop_writing() {
  end_writing();
  sender_.pause();
}

void AbortBench::end_writing() {
  const auto at = state();
  read_record();
  executed_at_end_ = at.moving || at.paused != "no" ? begun_before_ : job_begun_;
  certain_at_end_ = sender_.executed_for_certain(mill_.now);
  job_written_ = line_.written.size();
}

void AbortBench::run_for(Duration time) {
  const TimePoint end = mill_.now + time;
  while (step(end)) {
  }
  mill_.now = end;
  mill_.mill.advance(end);
}

void AbortBench::finish() {
  const TimePoint end = mill_.now + kFinishes;
  while (step(end)) {
  }
}

// Skips the sender's deadlines while the line is blocked, because a sender that has something to send then changes
// nothing.
std::optional<TimePoint> AbortBench::next() const {
  std::optional<TimePoint> first;
  const auto earlier = [&first](std::optional<TimePoint> other) {
    if (other && (!first || *other < *first)) first = other;
  };
  earlier(line_.next());
  earlier(mill_.mill.next_deadline());
  const bool blocked = line_.unsent() > 0 || line_.held();
  if (sender_.state() != jobs::SenderState::sending || !blocked) earlier(sender_.next_deadline(mill_.now));
  return first;
}

bool AbortBench::step(TimePoint until) {
  const auto at = next();
  if (!at || *at > until) return false;
  mill_.now = std::max(mill_.now, *at);
  mill_.mill.advance(mill_.now);
  read_record();
  if (const auto arrives = line_.next(); arrives && *arrives <= mill_.now) {
    const char byte = line_.take();
    ++delivered_;
    mill_.send({&byte, 1});
    read_record();
  }
  line_.pump(mill_.now);
  sender_.advance(mill_.now);
  return true;
}

void AbortBench::read_record() {
  for (; lines_read_ < mill_.lines.size(); ++lines_read_) {
    const std::string_view line = mill_.lines[lines_read_];
    if (line.find("\"error\":16") != std::string_view::npos) {
      ++lost_;
      if (delivers_job()) ++job_lost_;
      abort_lost_ = abort_lost_ || !delivers_job();
    } else if (const auto buffered = number_in(line, "\"buffered\":")) {
      begun(*buffered);
    } else if (number_in(line, "\"spindle\":").value_or(0) > 0) {
      raise_started_spindle_ = raise_started_spindle_ || abort_begun_;
    }
  }
}

// Computes how far commands have begun: each received byte is buffered, lost, or read.
void AbortBench::begun(std::size_t buffered) {
  const std::size_t through = delivered_ - lost_ - buffered;
  if (job_written_ && through >= *job_written_ - job_lost_ + kBothEscapeK) {
    abort_begun_ = true;
    return;
  }
  begun_before_ = job_begun_;
  job_begun_ = job_written_ ? std::min(through, *job_written_ - job_lost_) : through;
}

}  // namespace axisgate::rml1
