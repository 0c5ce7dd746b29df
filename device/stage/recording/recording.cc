#include "device/stage/recording/recording.h"

#include <fmt/format.h>

#include "device/core/escape.h"
#include "device/stage/recording/recording_words.h"

namespace axisgate::stage {
namespace {

using std::chrono::microseconds;

std::string seconds_of(Duration time) {
  const auto count = std::chrono::duration_cast<microseconds>(time).count();
  return fmt::format("{}.{:06}", count / 1'000'000, count % 1'000'000);
}

std::string digits_of(AxisSet axes) {
  if (axes.empty()) return std::string(kNoAxes);
  std::string text;
  for (const int axis : axes.list()) text += fmt::format("{}{}", text.empty() ? "" : ",", axis);
  return text;
}

std::string text_of(const RecordedItem& item) {
  const bool plain = item.kind == RecordedItem::Kind::ended || item.kind == RecordedItem::Kind::completion;
  return fmt::format("{} {}", word(item.kind), plain ? item.text : quoted_bytes(item.text));
}

std::string text_of(const RecordedExchange& exchange) {
  std::string text = seconds_of(exchange.at);
  text += exchange.exchange > 0 ? fmt::format(" #{}", exchange.exchange) : " -";
  if (exchange.lane) {
    text += fmt::format(" {} {}", name(*exchange.lane), quoted_bytes(exchange.who));
    if (exchange.waited > Duration::zero()) text += fmt::format(" {} {}", kWaited, seconds_of(exchange.waited));
    if (!exchange.completes.empty()) text += fmt::format(" {} {}", kCompletes, digits_of(exchange.completes));
    if (exchange.closed) text += fmt::format(" {}", kClosed);
  }
  std::string after = seconds_of(Duration::zero());
  for (const RecordedItem& item : exchange.items) {
    const std::string at = seconds_of(item.after);
    if (at != after) text += " +" + at;
    after = at;
    text += " " + text_of(item);
  }
  return text;
}

std::string text_of(const RecordedRemark& remark) {
  if (remark.kind == RecordedRemark::Kind::note) return "#" + remark.text;
  std::string text = fmt::format("# {} {}", seconds_of(remark.at), word(remark.kind));
  if (names_axes(remark.kind)) text += " " + digits_of(remark.axes);
  if (says_why(remark.kind)) text += " " + quoted_bytes(remark.text);
  return text;
}

}  // namespace

std::string to_text(const RecordingHeader& header) {
  std::string text = fmt::format("{}\n", kFirstLine);
  const auto add = [&text](std::string_view key, const std::string& value) {
    text += fmt::format("# {}: {}\n", key, value);
  };
  add(kKindKey, header.kind);
  add(kDeviceKey, quoted_bytes(header.device));
  if (!header.serial_number.empty()) add(kSerialNumberKey, quoted_bytes(header.serial_number));
  add(kBaudKey, std::to_string(header.baud));
  add(kReplyLimitKey, seconds_of(header.reply_limit));
  add(kStartedKey, quoted_bytes(header.started));
  if (header.axes) add(kAxesKey, digits_of(*header.axes));
  if (!header.may_complete.empty()) add(kMayCompleteKey, digits_of(header.may_complete));
  return text;
}

std::string to_text(const RecordedEvent& event) {
  return std::visit([](const auto& one) { return text_of(one); }, event);
}

void pass(RecordingHeader& header, const RecordedEvent& event) {
  if (const auto* exchange = std::get_if<RecordedExchange>(&event)) {
    header.may_complete = header.may_complete | exchange->completes;
    return;
  }
  const auto& remark = std::get<RecordedRemark>(event);
  switch (remark.kind) {
    case RecordedRemark::Kind::up:
      header.axes = remark.axes;
      header.may_complete = {};
      break;
    case RecordedRemark::Kind::connecting:
    case RecordedRemark::Kind::down:
      header.axes.reset();
      header.may_complete = {};
      break;
    case RecordedRemark::Kind::ready:
      header.may_complete = header.may_complete - remark.axes;
      break;
    default:
      break;
  }
}

}  // namespace axisgate::stage
