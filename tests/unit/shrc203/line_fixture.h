// A Line in virtual time, between a link that records its writes and a listener that records its reports.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/core/task.h"
#include "device/shot/line/line.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

inline constexpr std::string_view kIdentity = "SIGMAKOKI,SHRC-203,2106001001,V2.00.000";

class RecordingLink : public ByteLink {
 public:
  void write(std::string_view bytes) override { written += bytes; }
  void reopen(Duration wait) override { reopened.push_back(wait); }

  std::string written;
  std::vector<Duration> reopened;
};

// Keeps the line's reports as words: "connected", "completion 2", "completion 2 doubtful" ...
class RecordingListener : public LineListener {
 public:
  void line_connected(const Identity& identity, const std::optional<std::string>&, TimePoint) override {
    news.push_back("connected " + identity.serial_number);
  }
  void line_opened(TimePoint) override {}
  std::vector<ExchangeRequest> stops_to_write(std::string_view, TimePoint) override {
    std::vector<ExchangeRequest> stops;
    for (const std::string& text : open_stops) {
      ExchangeRequest request;
      request.command = model().parse(text).value();
      request.lane = Lane::stop;
      stops.push_back(std::move(request));
    }
    return stops;
  }
  bool stop_is_open() const override { return stop_open; }
  void line_trusted(TimePoint) override {}
  void same_controller(TimePoint) override {}
  void line_lost(const std::string& why, TimePoint) override { news.push_back("lost: " + why); }
  void barrier_entered(const std::string& why, TimePoint) override { news.push_back("barrier: " + why); }
  void barrier_passed(const Identity&, TimePoint) override { news.push_back("passed"); }
  void restart_suspected(TimePoint) override { news.push_back("restart suspected"); }
  void completion_seen(int axis, bool doubtful, TimePoint) override {
    news.push_back("completion " + std::to_string(axis) + (doubtful ? " doubtful" : ""));
  }
  void line_event(const Event& event, TimePoint) override {
    if (const auto* line = std::get_if<UnexpectedLine>(&event)) news.push_back("unexpected " + line->text);
    if (const auto* notice = std::get_if<ProgramNotice>(&event)) {
      news.push_back(notice->kind == ProgramNotice::Kind::ended ? "program ended" : "program trigger");
    }
    if (const auto* illegal = std::get_if<IllegalTransition>(&event)) {
      news.push_back(std::string("illegal ") + std::string(illegal->state) + ", " + std::string(illegal->event));
    }
    if (const auto* limit = std::get_if<TimeLimitPassed>(&event)) limits.emplace_back(name(limit->kind));
    if (const auto* ended = std::get_if<ExchangeEnded>(&event)) exchanges.push_back(*ended);
    if (const auto* learned = std::get_if<LineLearned>(&event)) learnt.push_back(learned->what);
    if (const auto* written = std::get_if<BytesWritten>(&event)) writes.push_back(*written);
  }
  std::optional<Problem> may_write(const ExchangeRequest& request, TimePoint) override {
    asked_for.push_back(request.command.line);
    return refuses && refuses(request) ? std::optional(refusal) : std::nullopt;
  }

  std::vector<std::string> open_stops;  // returned by stops_to_write()
  bool stop_open = false;
  std::vector<std::string> news, limits, asked_for;
  std::vector<ExchangeEnded> exchanges;
  std::vector<LineLearned::What> learnt;
  std::vector<BytesWritten> writes;
  std::function<bool(const ExchangeRequest&)> refuses;
  Problem refusal{Reason::lease_lost, "the lease is another's", {}, {}, {}, {}};
};

// A requested exchange; `result` is set once it has ended.
struct Asked {
  std::optional<ExchangeResult> result;

  bool ended() const { return result.has_value(); }
  bool written() const { return result && result->written; }
  std::string reply() const { return result && result->reply ? result->reply->text : ""; }
  Reason reason() const { return result && result->problem ? result->problem->reason : Reason::unspecified; }
  std::string message() const { return result && result->problem ? result->problem->message : ""; }
};
using AskedPtr = std::shared_ptr<Asked>;

// A line in virtual time at 10,000 baud, a millisecond a byte, so all times are whole milliseconds:
//
//   time limit of an answer: 500 ms, plus n + 64 ms for a line of n bytes with CR LF and the longest answer
//   time limit of a probe: 564 ms; silence: three longest answers, 192 ms
class LineFixture : public testing::Test {
 protected:
  void TearDown() override { EXPECT_EQ(sent(), "") << "written, and nobody looked for it"; }

  static constexpr Duration kProbeLimit = std::chrono::milliseconds(564);
  static constexpr Duration kSilence = std::chrono::milliseconds(192);
  static Duration limit_of(std::string_view line) {
    return std::chrono::milliseconds(500 + static_cast<int>(line.size()) + 2 + 64);
  }
  using Lines = std::vector<std::pair<std::string, std::string>>;

  // Advances the time and calls the line as its shell does: at each of its deadlines, and at the end.
  void pass(Duration time) {
    const TimePoint until = now + time;
    std::optional<TimePoint> before;
    for (auto due = line.next_deadline(now); due && *due <= until; due = line.next_deadline(now)) {
      ASSERT_NE(due, before) << "a deadline that does not go by";
      before = due;
      now = std::max(now, *due);
      line.advance(now);
      executor.run();
    }
    now = until;
    line.advance(now);
    executor.run();
  }
  void pass(int milliseconds) { pass(Duration(std::chrono::milliseconds(milliseconds))); }

  void receive(std::string_view bytes) {
    line.receive(bytes, now);
    executor.run();
  }
  // Returns the bytes written since the last call.
  std::string sent() { return std::exchange(link.written, {}); }
  std::vector<std::string> news() { return std::exchange(listener.news, {}); }

  // Expects each line to be written, and answers it 5 ms later; "" means no answer. Bytes written after the last answer
  // are left for the next call.
  void script(const Lines& lines) {
    for (const auto& [written, answer] : lines) {
      ASSERT_EQ(sent(), written);
      pass(5);
      if (!answer.empty()) receive(answer);
    }
  }

  // Puts a line in flight, so that every later line has to wait.
  void keep_the_line_busy() {
    ask("?:SN");
    EXPECT_EQ(sent(), "?:SN\r\n");
  }
  void let_go() {
    pass(5);
    receive("2106001001\r\n");
  }

  ExchangeRequest request(std::string_view text) const {
    ExchangeRequest one;
    one.command = *model().parse(text);
    one.lane = one.command.row->lane;
    one.caller = "somebody";
    one.not_after = now + std::chrono::seconds(10);
    return one;
  }
  AskedPtr ask(ExchangeRequest what) {
    auto asked = std::make_shared<Asked>();
    const auto wait = [](OneShot<ExchangeResult> answer, AskedPtr into) -> Task<void> {
      into->result = co_await answer;
    };
    executor.spawn(wait(line.exchange(std::move(what), now), asked));
    executor.run();
    return asked;
  }
  AskedPtr ask(std::string_view text) { return ask(request(text)); }
  AskedPtr ask_in(Lane lane, std::string_view text) {
    ExchangeRequest one = request(text);
    one.lane = lane;
    return ask(std::move(one));
  }

  void link_up() {
    line.link_up(now);
    executor.run();
  }
  void link_down(std::string_view why) {
    line.link_down(now, why);
    executor.run();
  }
  void connect() {
    link_up();
    script({{"*IDN?\r\n", std::string(kIdentity) + "\r\n"}});
    pass(kSilence);
  }
  void open(AxisSet controllable = kAllAxes) {
    line.open(controllable, now);
    executor.run();
  }
  // Connects, with all axes confirmed stationary for so long that none can complete any more.
  void open_and_rest(AxisSet controllable = kAllAxes) {
    connect();
    line.ready(kAllAxes, now);
    pass(kCompletionAfterReadyMax);
    line.completions().answered(now);
    open(controllable);
    forget();
  }
  // Discards all reports and written bytes up to now.
  void forget() {
    sent();
    news();
    listener.limits.clear();
    listener.exchanges.clear();
    listener.learnt.clear();
    listener.writes.clear();
    listener.asked_for.clear();
  }

  TimePoint now{std::chrono::hours(1)};
  shot::Profile profile = [] {
    shot::Profile one;
    one.baud = 10'000;
    return one;
  }();
  RecordingLink link;
  RecordingListener listener;
  Executor executor;
  Line line{model(), profile, link, executor, listener};
};

}  // namespace axisgate::shrc203
