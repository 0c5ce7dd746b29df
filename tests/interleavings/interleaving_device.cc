// Device side of an Interleaving, and the passing of time on the line.
#include <algorithm>
#include <utility>

#include "device/shot/command/command.h"
#include "device/shot/line/completions.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/limits.h"
#include "tests/interleavings/interleaving.h"

namespace axisgate::simulation {

using namespace shrc203;
using std::chrono::milliseconds;

namespace {

constexpr Duration kAnswersAfter = milliseconds(1);
// Number of readings after the question that still report BUSY. One reading is in flight when the question is asked;
// the second one reports the axes stationary.
constexpr int kBusyReadings = 1;

const std::map<std::string_view, std::string_view> kWholeAnswers = {
    {"*IDN?", "SIGMAKOKI,SHRC-203,2106001001,V2.00.000"},
    {"?:V", "V2.00.000"},
    {"?:SN", "2106001001"},
    {"?:FMT", "SHOT_FC"},
    {"?:T", "NS"},
    {"?:O", "0"},
    {"?:E", "NS"},
    {"?:EP", "NS"},
    {"?:K", "NS"},
    {"?:KP", "NS"},
};
const std::map<std::string_view, std::string_view> kAnswersOfEachAxis = {
    {"?:P", "10"}, {"?:D", "S1000F10000R100"}, {"?:B", "S1000F10000R100"}, {"?:C", "1"}};

// Returns the row of a command line, from a cache, because every run uses the same few lines.
const CommandRow* row_of(const std::string& line) {
  static std::map<std::string, const CommandRow*> known;
  const auto [entry, news] = known.try_emplace(line, nullptr);
  if (const auto command = news ? model().parse(line) : Result<Command>(); news && command)
    entry->second = command->row;
  return entry->second;
}

}  // namespace

void Interleaving::write(std::string_view bytes) {
  partial_ += bytes;
  for (auto end = partial_.find("\r\n"); end != std::string::npos; end = partial_.find("\r\n")) {
    const std::string line = partial_.substr(0, end);
    partial_.erase(0, end + 2);
    const TimePoint due = std::max(now_ + kAnswersAfter, replies_.empty() ? now_ : replies_.back().due);
    replies_.push_back({due, line, answer_to(line)});
    line_before_ = line;
  }
}

// After the memory switches the gateway reconnects to check the state again, so this is an error only in HOST mode.
void Interleaving::reopen(Duration) {
  closed_ = true;
  if (question_.row->needs.mode == Mode::host) wrong("the line was given up");
}

std::string Interleaving::of_each_axis(std::string_view field) const {
  std::string text(field);
  for (int axis = 1; axis < question_.controllable.count(); ++axis) (text += ',') += field;
  return text;
}

std::string Interleaving::of_each_axis_ready() const {
  std::string text;
  for (const int axis : question_.controllable.list()) {
    if (!text.empty()) text += ',';
    text += busy_ && question_.moving.has(axis) ? 'B' : 'R';
  }
  return text;
}

std::string Interleaving::answer_to(const std::string& line) {
  if (asked_ && !over_ && line == wire_line_) {
    if (!written_at_) written_at_ = now_;
    return question_.reply();
  }
  const CommandRow* known = row_of(line);
  if (!known) return "NG";
  const CommandRow& row = *known;
  if (row.name == "MS:ON" || row.name == "MS:OFF") {
    away_ = row.name == "MS:ON";
    return "OK";
  }
  if (away_ && !row.needs.any_mode) return "NG";
  if (row.name == "?:CMD") return line_before_;
  if (row.name == "?:MODE") return away_ ? "HOST,MS" : "HOST";
  if (row.name == "!:") return busy_ ? "B" : "R";
  if (row.name == "!:S") return of_each_axis_ready();
  if (row.name == "Q:S") {
    if (asked_ && question_.moment == Question::Moment::moving && ++readings_since_asked_ > kBusyReadings)
      busy_ = false;
    return of_each_axis("P+0") + ',' + of_each_axis("0") + ',' + of_each_axis_ready();
  }
  if (row.name == "?:AXIS") {
    for (const char digit : {'0', '1', '2', '3', '4', '5', '6'}) {
      if (from_axis_setting(std::string_view(&digit, 1)) == question_.controllable) return {digit};
    }
  }
  if (row.name == "HRT:") {
    started_ = busy_ = true;
    outstanding_ = question_.moving;
    return "OK";
  }
  if (const auto whole = kWholeAnswers.find(row.name); whole != kWholeAnswers.end()) return std::string(whole->second);
  if (const auto each = kAnswersOfEachAxis.find(row.name); each != kAnswersOfEachAxis.end()) {
    return of_each_axis(each->second);
  }
  if (row.effect == Effect::question && row.reply.ends_with('*')) return of_each_axis("NS");
  wrong("the device does not know " + line);
  return "NG";
}

// Reports whether an axis number can still arrive: while its axis moves, and for a short time after READY was read.
bool Interleaving::may_complete() const {
  return !closed_ && (!ready_seen_ || now_ <= *ready_seen_ + kCompletionAfterReadyMax);
}

std::optional<int> Interleaving::chosen_axis() {
  if (over_ || outstanding_.empty() || !may_complete()) return {};
  const std::size_t chosen = choices_.choose(static_cast<std::size_t>(outstanding_.count()) + 1);
  if (chosen == 0) return {};
  return outstanding_.list()[chosen - 1];
}

std::string Interleaving::number_of(int axis) {
  outstanding_.remove(axis);
  ++told_[axis];
  const std::string number = std::to_string(axis);
  order_ += ' ' + number;
  return number;
}

// Delivers a reply. Before each reply, any axis numbers may arrive, in separate pieces. After the reply to the
// question, and after that to the closing !:S, axis numbers may arrive before the gateway can write another line.
void Interleaving::deliver(const Reply& reply) {
  if (!asked_) return controller_->receive(reply.text + "\r\n", now_);
  while (const auto axis = chosen_axis()) controller_->receive(number_of(*axis) + "\r\n", now_);
  order_ += ' ' + reply.command + "=" + reply.text;
  std::string bytes = reply.text + "\r\n";
  const bool of_question = reply.command == wire_line_ || reply.command == "!:S";
  while (of_question) {
    const auto axis = chosen_axis();
    if (!axis) break;
    order_ += " +";
    bytes += number_of(*axis) + "\r\n";
  }
  controller_->receive(bytes, now_);
}

void Interleaving::step(TimePoint limit) {
  TimePoint next = limit;
  if (const auto deadline = controller_->next_deadline()) next = std::min(next, *deadline);
  if (!replies_.empty()) next = std::min(next, replies_.front().due);
  now_ = std::max(now_, next);
  if (!replies_.empty() && replies_.front().due <= now_) {
    const Reply reply = std::move(replies_.front());
    replies_.pop_front();
    deliver(reply);
  }
  controller_->advance(now_);
}

}  // namespace axisgate::simulation
