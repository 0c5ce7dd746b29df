#include "tests/rml1/bad_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

#include "device/rml1/language/quoted.h"
#include "device/rml1/sending/commands.h"
#include "tests/rml1/mill.h"

namespace axisgate::rml1 {
namespace {

constexpr Duration kLongAfter = std::chrono::minutes(10);         // only a stuck line takes as long
constexpr Duration kAbortOnLine = std::chrono::milliseconds(50);  // the abort's 40 bytes need 42 ms
constexpr std::size_t kLinesShown = 25;
constexpr std::size_t kStepsAtOnce = 10'000;  // limit for steps without progress of time

jobs::Job job_of(jobs::JobNumber number) {
  return {.number = number,
          .name = "part.rml",
          .owner = "unix anna",
          .setup = {.digest = fmt::format("d{}", number), .profile = "test", .origin = "corner", .tool = "T1"}};
}

}  // namespace

BadLine::BadLine(std::uint64_t seed)
    : seed_(seed),
      plan_(line_fault_plan(seed, profile_)),
      prepared_(std::make_shared<const PreparedJob>(plan_.body, "d1", profile_, kWork, plan_.settings.sending)),
      text_(prepared_->text()),
      bench_(plan_.mill),
      line_(bench_, plan_.line, plan_.mill.flow, plan_.loses_xon, [this](std::string_view bytes) { writes(bytes); }),
      mill_(profile_, plan_.settings, line_, *this, permission_),
      executed_(prepared_->text(), profile_) {}

LineFaultRun BadLine::run() {
  before_start();
  start();
  run_job();
  expect_end();
  expect_next_waits();
  if (const auto& other = executed_.violation()) violate(*other);
  result_.outcome = state();
  result_.xon_lost = line_.has_lost_xon();
  result_.replay = fmt::format("AXISGATE_SEED={}: {}\n", seed_, text_of(plan_));
  const std::size_t shown = std::min(happened_.size(), kLinesShown);
  for (auto line = happened_.end() - static_cast<std::ptrdiff_t>(shown); line != happened_.end(); ++line) {
    result_.replay += *line + "\n";
  }
  return result_;
}

// Expects that a void confirmation starts nothing, for every reason that makes it void.
void BadLine::before_start() {
  mill_.link_up(bench_.now);
  mill_.add(job_of(kFirst), bench_.now);
  mill_.add(job_of(kSecond), bench_.now);
  expect_not_startable("nobody has confirmed it");
  if (plan_.before_start == BeforeStart::nothing) return;
  if (!confirm(kFirst)) violate("it cannot be confirmed");
  if (plan_.before_start == BeforeStart::line_breaks) {
    break_line();
    run_for(std::chrono::seconds(1));
    bring_line_back();
  } else {
    abort();
  }
  expect_not_startable("its confirmation is void");
  run_for(plan_.before_start == BeforeStart::abort_and_at_once ? kAbortOnLine : std::chrono::seconds(1));
}

Result<void> BadLine::confirm(jobs::JobNumber number) {
  return mill_.confirm(number, job_of(number).setup, kAtMill.who, bench_.now);
}

void BadLine::start() {
  if (result_.violation) return;
  if (!confirm(kFirst) || !mill_.start(kFirst, prepared_, kOwner, bench_.now)) {
    return violate("the job cannot be started");
  }
  bound_ = prepared_->plan().run_on;
}

// Runs until all drawn acts have happened and the job has ended or cannot end.
void BadLine::run_job() {
  const TimePoint began = bench_.now;
  const auto longest = std::chrono::duration<double>(prepared_->timeline().slowest_s() * plan_.settings.sending.slack);
  for (const Act& one : plan_.acts) {
    while (!result_.violation && step_of_job(began + one.at)) {
    }
    if (result_.violation) return;
    act(one.kind);
  }
  const TimePoint end = bench_.now + std::chrono::duration_cast<Duration>(longest) + kLongAfter;
  while (!result_.violation && runs() && step_of_job(end)) {
  }
}

bool BadLine::step_of_job(TimePoint until) {
  const bool any = step(until);
  if (state() == jobs::JobState::fed && !std::exchange(fed_looked_at_, true)) expect_fed_is_true();
  return any;
}

void BadLine::act(Act::Kind kind) {
  note(std::string(name(kind)));
  expect_progress_is_true();
  switch (kind) {
    case Act::Kind::pause:
      return static_cast<void>(mill_.pause(false, bench_.now));
    case Act::Kind::resume:
      return static_cast<void>(mill_.resume(kOwner, bench_.now));
    case Act::Kind::abort:
      return abort();
    case Act::Kind::stick:
      line_.stuck = true;
      result_.stuck = runs();
      return;
    case Act::Kind::release:
      line_.stuck = false;
      return line_.pump(bench_.now);
    case Act::Kind::unplug:
      return break_line();
    case Act::Kind::plug_in:
      return bring_line_back();
  }
}

void BadLine::abort() {
  const bool open = mill_.link() == jobs::MachineLink::open;
  if (runs()) {
    aborted_ = true;
    executed_.flow_control_is_ignored();
    const bool moving = bench_.mill.state(bench_.now).moving;
    read_record();
    executed_at_abort_ = moving ? executed_.begun_before() : executed_.begun();
  }
  const std::size_t before = abort_writes_;
  if (mill_.abort(kAtMill, bench_.now) != open) violate("an abort is said to be sent with the line closed, or not");
  if ((abort_writes_ > before) != open) violate("an abort is not written with the line open, or is with it closed");
  abort_outstanding_ = abort_outstanding_ || !open;
  abort_requested_ = true;
}

void BadLine::break_line() {
  const bool ran = runs();
  result_.line_broke = result_.line_broke || ran;
  in_transit_.resize(line_.drop(!plan_.keeps_converter));
  mill_.link_down(bench_.now, "unplugged");
  if (!ran) return;
  abort_outstanding_ = true;
  if (state() != jobs::JobState::paused_unknown) return violate("the line broke and the job is not PAUSED_UNKNOWN");
  range_ = mill_.jobs().front().written;
}

// Reconnects the line. The abort must then be written first.
void BadLine::bring_line_back() {
  const std::size_t before = abort_writes_;
  mill_.link_up(bench_.now);
  const bool sent = abort_writes_ > before;
  // An abort that was requested earlier may have been lost with the line.
  if (sent != abort_outstanding_ && !(sent && abort_requested_)) {
    violate(abort_outstanding_ ? "the line is back and no abort is sent" : "an abort is sent that nobody requested");
  }
  if (std::exchange(abort_outstanding_, false)) executed_.flow_control_is_ignored();
  if (state() != jobs::JobState::paused_unknown) return;
  expect_not_startable("its line was lost");
  expect_refused(confirm(kFirst), Reason::wrong_job_state, "it is PAUSED_UNKNOWN and is confirmed");
}

bool BadLine::step(TimePoint until) {
  std::optional<TimePoint> first;
  for (const auto& one : {line_.next(), bench_.mill.next_deadline(), mill_.next_deadline()}) {
    if (one && (!first || *one < *first)) first = one;
  }
  const bool any = first && *first <= until;
  const TimePoint before = std::exchange(bench_.now, std::max(bench_.now, any ? *first : until));
  without_time_ = bench_.now > before ? 0 : without_time_ + 1;
  if (without_time_ > kStepsAtOnce) violate("a deadline has passed and stays");
  bench_.mill.advance(bench_.now);
  read_record();
  if (const auto arrives = line_.next(); arrives && *arrives <= bench_.now) deliver(line_.take());
  line_.take_flow_control();
  line_.pump(bench_.now);
  mill_.advance(bench_.now);
  if (const std::string broken = mill_.broken_invariant(); !broken.empty()) violate(broken);
  return any;
}

void BadLine::run_for(Duration time) {
  const TimePoint end = bench_.now + time;
  while (!result_.violation && step(end)) {
  }
}

void BadLine::deliver(char byte) {
  const std::uint64_t through = in_transit_.front();
  in_transit_.pop_front();
  job_arrived_ = std::max(job_arrived_, through);
  if (through != plan_.byte_at + 1 || plan_.byte == ByteFault::none) return give_to_mill(byte, through);
  result_.byte_changed = true;
  executed_.changed(through);
  note(fmt::format("byte {} of the text is changed", plan_.byte_at));
  if (plan_.byte == ByteFault::lost) return;
  if (plan_.byte == ByteFault::flipped) byte = static_cast<char>(byte ^ (1 << plan_.bit));
  give_to_mill(byte, through);
  if (plan_.byte == ByteFault::doubled) give_to_mill(byte, through);
}

void BadLine::give_to_mill(char byte, std::uint64_t through) {
  executed_.receives(byte, through);
  bench_.send({&byte, 1});
  read_record();
}

void BadLine::read_record() {
  for (; lines_read_ < bench_.lines.size(); ++lines_read_) executed_.recorded(bench_.lines[lines_read_]);
}

void BadLine::writes(std::string_view bytes) {
  if (mill_.link() != jobs::MachineLink::open) violate("written with the line closed");
  const bool is_abort = bytes == abort_commands(profile_, true) || bytes == abort_commands(profile_, false);
  note(fmt::format("{} written", is_abort ? "the abort" : in_quotes(bytes)));
  if (!is_abort) return writes_of_job(bytes);
  ++abort_writes_;
  in_transit_.insert(in_transit_.end(), bytes.size(), 0);
}

void BadLine::writes_of_job(std::string_view bytes) {
  if (!runs()) violate("written of a job that does not run");
  if (aborted_) violate("written of the job after its abort");
  if (abort_outstanding_ || range_) violate("written of the job after its line was lost");
  if (text_.substr(job_written_, bytes.size()) != bytes) violate("not what comes next in the job");
  if (line_.unsent() > 0) violate("a command is written while another has not left the host");
  if (line_.held()) violate("a command is written while CTS is low");
  for (std::size_t i = 0; i < bytes.size(); ++i) in_transit_.push_back(++job_written_);
  if (noted_ < prepared_->of_body(job_written_)) violate("written before it was noted");
}

void BadLine::violate(std::string what) {
  note("VIOLATION: " + what);
  if (!result_.violation) result_.violation = std::move(what);
}

void BadLine::note(std::string what) {
  happened_.push_back(fmt::format("{:>9} ms  {}", bench_.now.time_since_epoch() / std::chrono::milliseconds(1), what));
}

void BadLine::link_changed(jobs::MachineLink link, std::string_view, TimePoint) {
  note(link == jobs::MachineLink::open ? "the line is open" : "the line is closed");
}

void BadLine::job_changed(const jobs::Job& job, std::string_view by, std::string_view why, TimePoint) {
  note(fmt::format("job {} is {} ({} {})", job.number, name(job.state), by, why));
  states_[job.number] = job.state;
  if (job.state == jobs::JobState::paused_unknown && !range_) range_ = job.written;
  if (job.state == jobs::JobState::done && by.empty()) violate("DONE, and nobody has said so");
}

void BadLine::sender_changed(const jobs::RunningJob& running, TimePoint) {
  note(fmt::format("{}{}", name(running.sender), running.busy ? ", busy" : ""));
}

}  // namespace axisgate::rml1
