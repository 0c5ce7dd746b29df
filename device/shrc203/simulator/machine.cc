#include "device/shrc203/simulator/machine.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "device/shrc203/simulator/questions.h"

namespace axisgate::shrc203::simulator {
namespace {

// Clients send lower case, and blanks as the manual's examples have them; both mean nothing.
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

// Manual 4: these work in every mode.
bool works_in_every_mode(std::string_view command) {
  return command == "*IDN?" || command == "?:MODE" || command == "?:CMD" || command.starts_with("MODE:");
}

bool works_in_hit_format(std::string_view command) {
  return works_in_every_mode(command) || command == "?:FMT" || command.starts_with("FMT:");
}

}  // namespace

void Machine::receive(std::string_view bytes, TimePoint now) {
  advance(now);
  for (const char byte : bytes) {
    if (boots_until_) return;
    if (const auto line = cutter_.push(byte)) handle(*line);
  }
}

void Machine::advance(TimePoint now) {
  rig_.motions.process(now);
  rig_.now = std::max(rig_.now, now);
  send_completions();
  if (boots_until_ && rig_.now >= *boots_until_) boots_until_.reset();
}

void Machine::reboot(TimePoint now) {
  advance(now);
  rig_.power_on();
  cutter_.clear();
  boots_until_ = now + kBoot;
}

void Machine::remember(const std::string& text) {
  if (received_.size() == 2 * kReceivedKept) received_.erase(received_.begin(), received_.begin() + kReceivedKept);
  received_.push_back(text);
}

void Machine::handle(const LineCutter::Line& line) {
  remember(line.text);
  if (line.bad_byte) {
    rig_.command_error = true;
    send("NG_I");
    return;
  }
  const std::string command = plain(line.text);
  if (line.overlong || !knows(command)) {
    rig_.command_error = true;
    send("NG");
    if (!line.overlong && rig_.options.is("previous_command_counts_refused", "yes")) rig_.previous_line = line.text;
    return;
  }
  respond(command, line.text);
}

bool Machine::knows(std::string_view command) const {
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
  // What a command brings about at once, such as the end of a move of no length, may be told before its reply.
  rig_.motions.process(rig_.now);
  const bool completion_first = rig_.options.is("late_go_order", "completion_first");
  if (completion_first) send_completions();
  send(text ? std::string_view(*text) : text_of(done));
  send_completions();
  if (command == "RESET:") reboot(rig_.now);
}

void Machine::send_completions() {
  for (const int axis : rig_.motions.take_completions()) send(std::to_string(axis));
}

void Machine::send(std::string_view text) { line_.write(std::string(text) + "\r\n"); }

}  // namespace axisgate::shrc203::simulator
