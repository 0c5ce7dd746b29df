#include "device/shrc203/recording/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <set>

#include "device/shot/command/reply.h"
#include "device/shot/line/line.h"
#include "device/shrc203/command/builders.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/recording/replay_moments.h"

namespace axisgate::shrc203 {
namespace {

using What = Moment::What;
using std::chrono::microseconds;
using std::chrono::milliseconds;

Result<Command> command_of(const Moment& moment) {
  std::string_view text = moment.text;
  if (text.ends_with("\r\n")) text.remove_suffix(2);
  return model().parse(text);
}

class Replay : LineListener, ByteLink {
 public:
  explicit Replay(const Recording& recording)
      : header_(recording.header), moments_(moments_of(recording)), profile_(profile_of(header_)) {}

  ReplayReport run();

 private:
  struct Operation {
    What what;
    std::string text;
  };

  static shot::Profile profile_of(const RecordingHeader& header) {
    shot::Profile profile;
    profile.baud = header.baud;
    profile.reply_limit = header.reply_limit;
    return profile;
  }

  std::string first_identity() const;
  void connect_before(TimePoint first);
  void take(std::size_t index);
  void let_stops_wait(std::size_t index);
  void feed(std::size_t index);
  void expect(std::size_t index);
  void check_number(const Moment& moment);
  void provoke(std::size_t index);
  void ask_for(std::size_t index);
  void ask(std::size_t index);
  std::optional<ExchangeRequest> request_of(const Moment& moment) const;
  void lose(std::size_t index);
  std::size_t next_asked_by_somebody(std::size_t index) const;
  bool waited_at(std::size_t index, const Moment& question) const;
  bool is_stop_at_once(std::size_t index, TimePoint at) const;
  void let_time_pass(TimePoint until);
  void advance();
  void report_unrecorded(int line);
  void differ(int line, std::string recorded, std::string now);
  bool full() const { return report_.differences.size() >= ReplayReport::kDifferencesMax; }

  // LineListener
  void line_opened(TimePoint) override {}
  std::vector<ExchangeRequest> stops_to_write(std::string_view heard, TimePoint now) override;
  bool stop_is_open() const override { return false; }
  void line_connected(const Identity&, const std::optional<std::string>&, TimePoint) override {}
  void line_trusted(TimePoint) override {}
  void same_controller(TimePoint) override {}
  void line_lost(const std::string& why, TimePoint) override {
    up_ = suspected_ = false;
    operations_.push_back({What::down, why});
  }
  void barrier_entered(const std::string& why, TimePoint) override { operations_.push_back({What::barrier, why}); }
  void barrier_passed(const Identity&, TimePoint) override {}
  void restart_suspected(TimePoint) override { suspected_ = true; }
  void completion_seen(int axis, bool, TimePoint) override {
    line_.completions().arrived(axis);
    operations_.push_back({What::completion, std::to_string(axis)});
  }
  void line_event(const Event& event, TimePoint) override;
  std::optional<Problem> may_write(const ExchangeRequest&, TimePoint) override { return {}; }

  // ByteLink: written bytes are reported as an event, and the recording says when the line comes up.
  void write(std::string_view) override {}
  void reopen(Duration) override {}

  RecordingHeader header_;
  std::vector<Moment> moments_;
  shot::Profile profile_;
  Executor executor_;
  Line line_{model(), profile_, *this, executor_, *this};
  TimePoint now_{};
  bool up_ = false, suspected_ = false;
  std::uint64_t last_exchange_ = 0;
  std::size_t fed_ = 0;               // moment that the line is receiving now
  std::deque<Operation> operations_;  // operations of the core not compared yet
  std::set<std::size_t> asked_;       // moments whose exchange has been requested
  std::set<std::size_t> applied_;     // moments that were fed early
  ReplayReport report_;
};

void Replay::line_event(const Event& event, TimePoint) {
  if (const auto* written = std::get_if<BytesWritten>(&event)) operations_.push_back({What::written, written->bytes});
  if (const auto* line = std::get_if<UnexpectedLine>(&event)) operations_.push_back({What::unexpected, line->text});
  if (const auto* ended = std::get_if<ExchangeEnded>(&event)) {
    operations_.push_back({What::ended, std::string(name(ended->outcome))});
  }
  const auto* learned = std::get_if<LineLearned>(&event);
  if (learned && learned->what == LineLearned::What::barrier_passed) operations_.push_back({What::barrier_passed, {}});
}

void Replay::differ(int line, std::string recorded, std::string now) {
  if (full()) return;
  report_.differences.push_back({line, std::move(recorded), std::move(now)});
}

void Replay::report_unrecorded(int line) {
  for (const Operation& operation : operations_) differ(line, "nothing", describe(operation.what, operation.text));
  operations_.clear();
}

void Replay::advance() {
  line_.advance(now_);
  const auto due = line_.next_deadline(now_);
  if (!operations_.empty() || !due || *due > now_ + kRecordedTimeError) return;
  now_ = std::max(now_, *due);
  line_.advance(now_);
}

void Replay::let_time_pass(TimePoint until) {
  std::optional<TimePoint> before;
  while (const auto due = line_.next_deadline(now_)) {
    if (*due + kReplayLateMax > until || due == before) break;
    now_ = std::max(now_, *due);
    line_.advance(now_);
    before = due;
  }
  now_ = std::max(now_, until);
}

// Returns the identity that the recorded controller reports; a default identity if the recording has none.
std::string Replay::first_identity() const {
  for (const Moment& moment : moments_) {
    const std::string_view line = std::string_view(moment.text).substr(0, moment.text.find('\r'));
    if (moment.what == Moment::What::received && parse_identity(line)) return moment.text;
  }
  return "SIGMAKOKI,SHRC-203,0,V0\r\n";
}

// Puts the line into the state of one that has been up for long without motion, except for what the header says.
void Replay::connect_before(TimePoint first) {
  line_.link_up(first - 4 * kReplayConnectStep);
  line_.receive(first_identity(), first - 4 * kReplayConnectStep);
  line_.advance(first - 3 * kReplayConnectStep);
  line_.ready(kAllAxes, first - 2 * kReplayConnectStep);
  line_.completions().answered(first - kReplayConnectStep);
  line_.completions().started(header_.may_complete, first - kReplayConnectStep);
  line_.open(*header_.axes, first);
  up_ = true;
  operations_.clear();
}

ReplayReport Replay::run() {
  const std::size_t first = first_known(moments_, header_);
  if (first == moments_.size()) return std::move(report_);
  report_.first_line = moments_[first].line;
  now_ = moments_[first].at;
  if (header_.axes) connect_before(now_);
  for (std::size_t i = first; i < moments_.size(); ++i) {
    take(i);
    if (full()) break;
  }
  // Remaining operations are no difference: their records may come after the recording's end.
  return std::move(report_);
}

void Replay::take(std::size_t index) {
  const Moment& moment = moments_[index];
  let_time_pass(moment.at);
  if (moment.what == What::received || moment.what == What::ended) let_stops_wait(index);
  switch (moment.what) {
    case What::received:
    case What::connecting:
    case What::up:
    case What::same_controller:
    case What::ready:
    case What::busy:
      report_unrecorded(moment.line);
      return feed(index);
    default:
      return expect(index);
  }
}

// Requests stops in advance: stops that wait during an exchange are written together when it ends in a barrier.
void Replay::let_stops_wait(std::size_t index) {
  const TimePoint at = moments_[index].at;
  const auto same = [&](std::size_t next) {
    return next < moments_.size() && moments_[next].at == at && moments_[next].what != What::received;
  };
  std::size_t next = index + 1;
  while (same(next) && moments_[next].what != What::barrier) ++next;
  if (!same(next) || !same(next + 1) || moments_[next + 1].what != What::written) return;
  for (next += 2; is_stop_at_once(next, at); ++next) {
    if (!asked_.contains(next)) ask(next);
  }
}

// Returns the stops that were open according to the recording: those recorded directly after what the line did with its
// present input.
std::vector<ExchangeRequest> Replay::stops_to_write(std::string_view, TimePoint) {
  std::vector<ExchangeRequest> stops;
  for (std::size_t next = fed_ + 1 + operations_.size(); is_stop_at_once(next, moments_[fed_].at); ++next) {
    if (!asked_.insert(next).second) continue;
    if (auto stop = request_of(moments_[next])) stops.push_back(*std::move(stop));
  }
  return stops;
}

void Replay::feed(std::size_t index) {
  const Moment& moment = moments_[index];
  fed_ = index;
  switch (moment.what) {
    case What::received:
      report_.bytes_received += moment.text.size();
      return line_.receive(moment.text, now_);
    case What::connecting:
      return line_.link_up(now_);
    case What::up:
      up_ = true;
      return line_.open(moment.axes, now_);
    case What::same_controller:
      suspected_ = false;
      return line_.confirm_no_restart(now_);
    case What::ready:
      return line_.ready(moment.axes, now_);
    default:
      return line_.busy(moment.axes, now_);
  }
}

void Replay::expect(std::size_t index) {
  const Moment& moment = moments_[index];
  if (moment.begins) check_number(moment);
  if (moment.what == What::written) report_.bytes_written += moment.text.size();
  if (moment.what == What::ended) ++report_.exchanges;
  if (operations_.empty()) provoke(index);
  const std::string recorded = describe(moment.what, moment.text);
  if (operations_.empty()) return differ(moment.line, recorded, "nothing");
  const Operation did = std::move(operations_.front());
  operations_.pop_front();
  // A reason is text for people, which may change between versions.
  const bool in_words = moment.what == What::barrier || moment.what == What::down;
  if (did.what == moment.what && (in_words || did.text == moment.text)) return;
  differ(moment.line, recorded, describe(did.what, did.text));
}

// Checks that exchanges are numbered without a gap.
void Replay::check_number(const Moment& moment) {
  const std::uint64_t number = moment.begins->exchange;
  if (last_exchange_ > 0 && number != last_exchange_ + 1) {
    differ(moment.line, fmt::format("exchange {} after exchange {}", number, last_exchange_),
           fmt::format("exchange {}", last_exchange_ + 1));
  }
  last_exchange_ = number;
}

// Causes the recorded operation if the line has not done it yet: by the passing of time, a caller's request, or the
// loss of the line.
void Replay::provoke(std::size_t index) {
  const Moment& moment = moments_[index];
  advance();
  if (!operations_.empty()) return;
  if (moment.what == What::written) ask_for(index);
  if (moment.what == What::down && !applied_.contains(index)) lose(index);
  if (moment.what == What::ended) {
    const bool lost = index + 1 < moments_.size() && moments_[index + 1].what == What::down;
    if (lost && moments_[index + 1].at == moment.at) lose(index + 1);
  }
}

void Replay::lose(std::size_t index) {
  applied_.insert(index);
  line_.link_down(now_, moments_[index].text);
}

void Replay::ask_for(std::size_t index) {
  const Moment& moment = moments_[index];
  if (!moment.begins) {
    // The line asks ?:CMD before a stop.
    if (!moment.of_exchange && is_stop_at_once(index + 1, moment.at)) ask(index + 1);
    return;
  }
  if (asked_.contains(index)) return;
  if (moment.begins->who.empty()) {
    // The line asks on behalf of a waiting caller. A caller who withdrew before their turn is not in the recording. The
    // request is withdrawn here and made again at its turn, since a path or a suspected restart may have decided when
    // that turn comes.
    const std::size_t cause = next_asked_by_somebody(index);
    if (waited_at(cause, moment)) {
      ask(cause);
      asked_.erase(cause);
      line_.withdraw([](const ExchangeRequest& request) { return request.lane != Lane::stop; }, {});
    }
    if (!operations_.empty()) return;
  }
  ask(index);
  if (operations_.empty()) advance();
  if (!operations_.empty()) return;
  line_.withdraw([](const ExchangeRequest&) { return true; }, {});
}

std::size_t Replay::next_asked_by_somebody(std::size_t index) const {
  do {
    ++index;
  } while (index < moments_.size() && !(moments_[index].begins && !moments_[index].begins->who.empty()));
  return index;
}

// Reports whether the exchange that begins at `index` was waiting when the line wrote its own `question`, and may be
// the reason for it.
bool Replay::waited_at(std::size_t index, const Moment& question) const {
  if (index >= moments_.size() || asked_.contains(index)) return false;
  const Moment& waits = moments_[index];
  if (waits.begins_in(Lane::stop) || waits.at - waits.begins->waited > question.at + kRecordedTimeError) return false;
  const std::string line_before = std::string(commands::text(commands::Question::previous_command)) + "\r\n";
  if (question.text == line_before) return waits.text != line_before;
  const auto command = command_of(waits);
  if (!command || waits.begins->closed) return false;
  return command->row->separation == Separation::waits || command->row->separation == Separation::closed;
}

bool Replay::is_stop_at_once(std::size_t index, TimePoint at) const {
  return index < moments_.size() && moments_[index].begins_in(Lane::stop) && moments_[index].at == at;
}

void Replay::ask(std::size_t index) {
  asked_.insert(index);
  if (auto request = request_of(moments_[index])) line_.exchange(*std::move(request), now_);
}

// Returns nullopt for a line that is not a command: nothing is written then, which counts as a difference.
std::optional<ExchangeRequest> Replay::request_of(const Moment& moment) const {
  auto command = command_of(moment);
  if (!command) return std::nullopt;
  ExchangeRequest request;
  request.command = *std::move(command);
  request.lane = *moment.begins->lane;
  request.caller = moment.begins->who;
  request.not_after = now_ + kReplayWriteLimit;
  request.completes = moment.begins->completes;
  request.closed = moment.begins->closed;
  request.handshake = !up_ || suspected_;
  return request;
}

}  // namespace

ReplayReport replay(const Recording& recording) { return Replay(recording).run(); }

}  // namespace axisgate::shrc203
