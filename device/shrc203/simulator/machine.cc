#include "device/shrc203/simulator/machine.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "device/shrc203/simulator/commands/memory_switch_commands.h"
#include "device/shrc203/simulator/commands/program_commands.h"
#include "device/shrc203/simulator/commands/questions.h"
#include "device/shrc203/simulator/program_run.h"

namespace axisgate::shrc203::simulator {
namespace {

// Removes differences without a meaning: clients send lower case, and blanks as in the manual's examples.
std::string plain(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c != ' ' && c != '\t') result += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return result;
}

std::string_view text_of(Answer answer) {
  switch (answer) {
    case Answer::ok:
      return "OK";
    case Answer::ok_d:
      return "OK_D";
    case Answer::ng:
      break;
  }
  return "NG";
}

// Commands that work in every mode (manual 4).
bool works_in_every_mode(std::string_view command) {
  return command == "*IDN?" || command == "?:MODE" || command == "?:CMD" || command.starts_with("MODE:");
}

bool works_in_hit_format(std::string_view command) {
  return works_in_every_mode(command) || command == "?:FMT" || command.starts_with("FMT:");
}

}  // namespace

void Machine::receive(std::string_view bytes, TimePoint now) {
  advance(now);
  if (rig_.now < unplugged_until_) return;
  for (const char byte : bytes) {
    if (boots_until_) return;
    if (auto line = cutter_.push(byte)) take(std::move(*line));
  }
}

void Machine::take(LineCutter::Line line) {
  remember(line.text);
  const TimePoint due = std::max(rig_.now, waiting_.empty() ? rig_.now : waiting_.back().due) + answer_delay_;
  if (waiting_.empty() && std::max(due, stuck_until_) <= rig_.now) {
    handle(line);
  } else if (waiting_.size() < kWaitingMax) {
    waiting_.push_back({std::move(line), due});
  }
}

void Machine::advance(TimePoint now) {
  while (!waiting_.empty() && std::max(waiting_.front().due, stuck_until_) <= now) {
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    run_to(std::max(next.due, stuck_until_));
    handle(next.line);
  }
  run_to(now);
}

// Processes the events that occur without a command until then.
void Machine::run_to(TimePoint now) {
  run_until(rig_, now);
  rig_.now = std::max(rig_.now, now);
  send_completions();
  if (boots_until_ && rig_.now >= *boots_until_) boots_until_.reset();
}

std::optional<TimePoint> Machine::next_event() const {
  std::optional<TimePoint> next = next_due(rig_);
  const auto consider = [&next](TimePoint time) { next = next ? std::min(*next, time) : time; };
  if (stuck_until_ > rig_.now) consider(stuck_until_);
  if (!waiting_.empty()) consider(std::max(waiting_.front().due, stuck_until_));
  return next;
}

void Machine::reboot(TimePoint now) {
  advance(now);
  restart();
}

void Machine::restart() {
  rig_.power_on();
  if (boot_.mode != "HOST") rig_.mode = boot_.mode;
  if (boot_.format == "HIT") rig_.hit_format = true;
  cutter_.clear();
  waiting_.clear();
  stuck_until_ = rig_.now;
  boots_until_ = rig_.now + boot_.silence;
}

void Machine::remember(const std::string& text) {
  if (received_.size() == 2 * kReceivedKept) received_.erase(received_.begin(), received_.begin() + kReceivedKept);
  received_.push_back(text);
}

void Machine::handle(const LineCutter::Line& line) {
  if (line.bad_byte) {
    rig_.command_error = true;
    reply("NG_I");
    return;
  }
  const std::string command = plain(line.text);
  if (line.overlong || !knows(command)) {
    rig_.command_error = true;
    reply("NG");
    if (!line.overlong && rig_.options.is("previous_command_counts_refused", "yes")) rig_.previous_line = line.text;
    return;
  }
  respond(command, line.text);
}

bool Machine::knows(std::string_view command) const {
  if (rig_.mode == kMemorySwitchMode) return works_in_memory_switch_mode(command);
  const bool in_program = in_program_mode(rig_) && !rig_.hit_format;
  if (in_program && works_in_program_mode(rig_, command)) return true;
  if (rig_.mode != "HOST") return works_in_every_mode(command);
  if (!rig_.hit_format) return true;
  return works_in_hit_format(command) || answer_in_hit_format(rig_, command).has_value();
}

std::optional<std::string> Machine::answer_question(std::string_view command) const {
  if (rig_.hit_format && !works_in_hit_format(command)) return answer_in_hit_format(rig_, command);
  return answer(rig_, command);
}

void Machine::respond(const std::string& command, const std::string& as_sent) {
  const bool asks = is_question(command);
  const auto text = asks ? answer_question(command) : std::nullopt;
  const Answer done = asks ? Answer::ng : execute(rig_, command);
  const bool accepted = text || done != Answer::ng;
  if (!accepted) {
    rig_.command_error = true;
  } else if (!asks) {
    rig_.command_error = false;
  }
  if (accepted || rig_.options.is("previous_command_counts_refused", "yes")) rig_.previous_line = as_sent;
  // Immediate effects of a command, such as the end of a move without length, may be reported before its reply.
  run_until(rig_, rig_.now);
  const bool completion_first = rig_.options.is("late_go_order", "completion_first");
  if (completion_first) send_completions();
  reply(text ? std::string_view(*text) : text_of(done));
  send_completions();
  if (command == "RESET:") restart();
}

void Machine::send_completions() {
  if (rig_.now < stuck_until_) return;
  for (const int axis : rig_.motions.take_completions()) send(std::to_string(axis));
  for (const std::string& notice : take_notices(rig_)) send(notice);
}

void Machine::reply(std::string_view text) {
  answering_ = true;
  send(text);
  answering_ = false;
}

void Machine::send(std::string_view text) {
  if (rig_.now >= unplugged_until_) line_.write(std::string(text) + "\r\n");
}

}  // namespace axisgate::shrc203::simulator
