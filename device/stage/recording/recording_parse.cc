// Parses a recording's text strictly: an error names the line.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "device/core/escape.h"
#include "device/stage/event.h"
#include "device/stage/recording/recording.h"
#include "device/stage/recording/recording_words.h"

namespace axisgate::stage {
namespace {

// Upper limit for times: longer than any uptime, and far from overflow.
constexpr std::int64_t kRecordingSecondsMax = 1'000'000'000;

// A Cursor reads one line from its beginning. It keeps the first mistake and reads nothing after it.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : rest_(text) {}

  bool good() const { return mistake_.empty(); }
  bool at_end() const { return rest_.empty(); }
  const std::string& mistake() const { return mistake_; }
  void fail(std::string what) {
    if (good()) mistake_ = std::move(what);
    rest_ = {};
  }

  bool starts_with(std::string_view text) const { return rest_.starts_with(text); }
  bool take(std::string_view text) {
    if (!rest_.starts_with(text)) return false;
    rest_.remove_prefix(text.size());
    return true;
  }
  void want(std::string_view text) {
    if (!take(text)) fail_here(fmt::format("'{}' is due", text));
  }
  void want_end() {
    if (!at_end()) fail_here("the line should end");
  }

  // Returns the text up to the next blank.
  std::string_view word() {
    const auto taken = rest_.substr(0, rest_.find(' '));
    rest_.remove_prefix(taken.size());
    return taken;
  }

  template <class Number>
  Number number(Number minimum, Number maximum) {
    Number value{};
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc() || value < minimum || value > maximum) {
      fail_here(fmt::format("a number from {} to {} is due", minimum, maximum));
      return {};
    }
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }

  Duration seconds() {
    const auto whole = number<std::int64_t>(0, kRecordingSecondsMax);
    want(".");
    const auto digits = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
    if (digits != 6) {
      fail_here("a time in seconds with six decimals is due");
      return {};
    }
    const auto micros = number<std::int64_t>(0, 999'999);
    return std::chrono::seconds(whole) + std::chrono::microseconds(micros);
  }

  AxisSet axes() {
    AxisSet set;
    if (take(kNoAxes)) return set;
    do {
      const int axis = number(1, kAxesMax);
      if (good()) set.add(axis);
    } while (take(","));
    return set;
  }

  std::string quoted() {
    auto text = take_quoted_bytes(rest_);
    if (text) return *std::move(text);
    fail_here("a text between double quotes is due, with \\r \\n \\\" \\\\ and \\xNN for what is not printable ASCII");
    return {};
  }

 private:
  void fail_here(const std::string& what) {
    fail(rest_.empty() ? what + " at the end" : fmt::format("{} at '{}'", what, escaped(rest_, 40)));
  }

  std::string_view rest_;
  std::string mistake_;
};

bool is_outcome(std::string_view text) {
  for (auto outcome = ExchangeEnded::Outcome::ok; outcome <= ExchangeEnded::Outcome::link_lost;
       outcome = static_cast<ExchangeEnded::Outcome>(static_cast<int>(outcome) + 1)) {
    if (text == name(outcome)) return true;
  }
  return false;
}

RecordedItem parse_item(Cursor& line, Duration after) {
  RecordedItem item;
  item.after = after;
  const auto first = line.word();
  const auto kind = std::ranges::find(kItemKinds, first, [](auto one) { return word(one); });
  if (kind == kItemKinds.end()) {
    line.fail(fmt::format("'{}' is neither a lane nor one of > < = completion unexpected", escaped(first, 40)));
    return item;
  }
  item.kind = *kind;
  line.want(" ");
  switch (item.kind) {
    case RecordedItem::Kind::ended:
      item.text = line.word();
      if (line.good() && !is_outcome(item.text)) {
        line.fail(fmt::format("'{}' is no outcome of an exchange", escaped(item.text, 40)));
      }
      break;
    case RecordedItem::Kind::completion:
      item.text = std::to_string(line.number(1, kAxesMax));
      break;
    default:
      item.text = line.quoted();
  }
  return item;
}

// Parses the lane and caller of an exchange, which are omitted if the exchange continues.
void parse_cause(Cursor& line, RecordedExchange& exchange) {
  const auto lane =
      std::ranges::find_if(kLaneNames, [&](std::string_view one) { return line.take(fmt::format("{} ", one)); });
  if (lane == kLaneNames.end()) return;
  exchange.lane = static_cast<Lane>(lane - kLaneNames.begin());
  exchange.who = line.quoted();
  line.want(" ");
  if (line.take(kWaited)) {
    line.want(" ");
    exchange.waited = line.seconds();
    line.want(" ");
  }
  if (line.take(kCompletes)) {
    line.want(" ");
    exchange.completes = line.axes();
    line.want(" ");
  }
  if (line.take(kClosed)) {
    exchange.closed = true;
    line.want(" ");
  }
  if (line.good() && !line.starts_with(">")) line.fail("an exchange with a lane begins with what was written");
}

RecordedExchange parse_exchange(Cursor& line) {
  RecordedExchange exchange;
  exchange.at = line.seconds();
  line.want(" ");
  if (line.take("#")) {
    exchange.exchange = line.number<std::uint64_t>(1, UINT64_MAX);
  } else {
    line.want("-");
  }
  line.want(" ");
  if (exchange.exchange > 0) parse_cause(line, exchange);
  Duration after{};
  do {
    if (line.take("+")) {
      const Duration before = after;
      after = line.seconds();
      if (line.good() && after < before) line.fail("time runs backwards");
      line.want(" ");
    }
    if (line.good()) exchange.items.push_back(parse_item(line, after));
  } while (line.good() && line.take(" "));
  line.want_end();
  return exchange;
}

// Reports whether the line begins with a time; a note never does.
bool has_time(std::string_view text) {
  if (!text.starts_with("# ")) return false;
  const auto end = text.find_first_not_of("0123456789", 2);
  return end != std::string_view::npos && end > 2 && text[end] == '.' && end + 1 < text.size() &&
         text[end + 1] >= '0' && text[end + 1] <= '9';
}

RecordedRemark parse_happening(Cursor& line) {
  RecordedRemark remark;
  line.want("# ");
  remark.at = line.seconds();
  line.want(" ");
  if (!line.good()) return remark;
  const auto kind = std::ranges::find_if(kRemarkKinds, [&](auto one) { return line.take(word(one)); });
  if (kind == kRemarkKinds.end()) {
    line.fail("such a happening is unknown; a note has no time");
    return remark;
  }
  remark.kind = *kind;
  if (names_axes(remark.kind)) {
    line.want(" ");
    remark.axes = line.axes();
  }
  if (says_why(remark.kind)) {
    line.want(" ");
    remark.text = line.quoted();
  }
  line.want_end();
  return remark;
}

class Reader {
 public:
  Result<Recording> read(std::string_view text) {
    for (int number = 1; (number == 1 || !text.empty()) && mistake_.empty(); ++number) {
      const auto end = std::min(text.find('\n'), text.size());
      std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      if (line.ends_with('\r')) line.remove_suffix(1);
      take(line, number);
      if (!mistake_.empty()) mistake_ = fmt::format("line {}: {}", number, mistake_);
    }
    if (mistake_.empty() && !in_body_) end_header();
    if (mistake_.empty()) return std::move(recording_);
    return axisgate::fail(Reason::invalid_request, mistake_,
                          "recordings are made by `axisctl record`; a note may be added as a line that begins with #");
  }

 private:
  void take(std::string_view line, int number) {
    if (number == 1) {
      if (line != kFirstLine) mistake_ = fmt::format("a recording begins with '{}'", kFirstLine);
      return;
    }
    if (line.empty()) return;
    const bool note = line.starts_with('#') && !has_time(line);
    if (!in_body_ && note && take_key(line)) return;
    if (!in_body_ && !note) end_header();
    if (!mistake_.empty()) return;
    Cursor cursor(line);
    RecordedEvent event;
    if (note) {
      event = RecordedRemark{.text = std::string(line.substr(1))};
    } else if (line.starts_with('#')) {
      event = parse_happening(cursor);
    } else {
      event = parse_exchange(cursor);
    }
    if (cursor.good()) cursor = check_order(event);
    mistake_ = cursor.mistake();
    recording_.lines.push_back({number, std::move(event)});
  }

  // Returns false if the line is a note.
  bool take_key(std::string_view line) {
    Cursor cursor(line);
    if (!cursor.take("# ")) return false;
    auto& header = recording_.header;
    const auto found = [&](std::string_view key) {
      const std::string start = fmt::format("{}: ", key);
      if (!cursor.take(start)) return false;
      if (!keys_.insert(key).second) cursor.fail(fmt::format("'{}' is given twice", key));
      return true;
    };
    if (found(kKindKey)) {
      const auto kind = cursor.word();
      if (cursor.good() && kind != kKind) cursor.fail(fmt::format("'{}' is no known kind", escaped(kind, 40)));
    } else if (found(kDeviceKey)) {
      header.device = cursor.quoted();
    } else if (found(kSerialNumberKey)) {
      header.serial_number = cursor.quoted();
    } else if (found(kBaudKey)) {
      header.baud = cursor.number(1, 100'000'000);
    } else if (found(kReplyLimitKey)) {
      header.reply_limit = cursor.seconds();
    } else if (found(kStartedKey)) {
      header.started = cursor.quoted();
    } else if (found(kAxesKey)) {
      header.axes = cursor.axes();
    } else if (found(kMayCompleteKey)) {
      header.may_complete = cursor.axes();
    } else {
      return false;
    }
    cursor.want_end();
    mistake_ = cursor.mistake();
    return true;
  }

  void end_header() {
    in_body_ = true;
    for (const auto key : {kKindKey, kBaudKey, kReplyLimitKey}) {
      if (!keys_.contains(key)) mistake_ = fmt::format("the header lacks '# {}: ...'", key);
    }
  }

  Cursor check_order(const RecordedEvent& event) {
    Cursor cursor("");
    const auto* exchange = std::get_if<RecordedExchange>(&event);
    const auto* remark = std::get_if<RecordedRemark>(&event);
    if (remark && remark->kind == RecordedRemark::Kind::note) return cursor;
    const Duration at = exchange ? exchange->at : remark->at;
    if (at < newest_) cursor.fail("time runs backwards");
    newest_ = exchange ? at + exchange->items.back().after : at;
    return cursor;
  }

  Recording recording_;
  std::set<std::string_view> keys_;
  bool in_body_ = false;
  Duration newest_{};
  std::string mistake_;
};

}  // namespace

Result<Recording> parse_recording(std::string_view text) { return Reader().read(text); }

void pass(RecordingHeader& header, std::string_view line) {
  Cursor cursor(line);
  if (line.starts_with('#')) {
    if (!has_time(line)) return;
    const auto remark = parse_happening(cursor);
    if (cursor.good()) pass(header, RecordedEvent(remark));
    return;
  }
  const auto exchange = parse_exchange(cursor);
  if (cursor.good()) pass(header, RecordedEvent(exchange));
}

}  // namespace axisgate::stage
