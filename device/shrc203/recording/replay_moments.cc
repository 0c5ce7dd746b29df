#include "device/shrc203/recording/replay_moments.h"

#include <algorithm>

#include "device/core/escape.h"
#include "device/shrc203/command/builders.h"

namespace axisgate::shrc203 {
namespace {

using What = Moment::What;

// Time of the first moment, late enough for a connect before it.
constexpr TimePoint kBegin{std::chrono::hours(1)};

What what_of(RecordedItem::Kind kind) {
  switch (kind) {
    case RecordedItem::Kind::written:
      return What::written;
    case RecordedItem::Kind::received:
      return What::received;
    case RecordedItem::Kind::ended:
      return What::ended;
    case RecordedItem::Kind::completion:
      return What::completion;
    case RecordedItem::Kind::unexpected:
      break;
  }
  return What::unexpected;
}

What what_of(RecordedRemark::Kind kind) {
  switch (kind) {
    case RecordedRemark::Kind::connecting:
      return What::connecting;
    case RecordedRemark::Kind::up:
      return What::up;
    case RecordedRemark::Kind::down:
      return What::down;
    case RecordedRemark::Kind::barrier:
      return What::barrier;
    case RecordedRemark::Kind::barrier_passed:
      return What::barrier_passed;
    case RecordedRemark::Kind::same_controller:
      return What::same_controller;
    case RecordedRemark::Kind::ready:
      return What::ready;
    default:
      return What::busy;
  }
}

// Reports whether this exchange's result is independent of everything before it. Questions of the line itself and stops
// depend on earlier events; the answer to ?:CMD and an exchange that was not accepted do so for every caller.
bool depends_on_nothing(const std::vector<Moment>& moments, std::size_t index) {
  const Moment& moment = moments[index];
  if (!moment.begins || moment.begins->who.empty() || moment.begins_in(Lane::stop)) return false;
  if (moment.text.starts_with(commands::text(commands::Question::previous_command))) return false;
  const auto ended = std::find_if(moments.begin() + static_cast<std::ptrdiff_t>(index), moments.end(),
                                  [](const Moment& one) { return one.what == What::ended; });
  return ended != moments.end() && (ended->text == "ok" || ended->text == "ok_d" || ended->text == "data");
}

}  // namespace

std::vector<Moment> moments_of(const Recording& recording) {
  std::vector<Moment> moments;
  for (const RecordedLine& line : recording.lines) {
    if (const auto* remark = std::get_if<RecordedRemark>(&line.event)) {
      if (remark->kind == RecordedRemark::Kind::note) continue;
      moments.push_back({what_of(remark->kind), remark->text, remark->axes, kBegin + remark->at, line.number});
      continue;
    }
    const auto& exchange = std::get<RecordedExchange>(line.event);
    for (const RecordedItem& item : exchange.items) {
      Moment moment{what_of(item.kind), item.text, {}, kBegin + exchange.at + item.after, line.number};
      moment.of_exchange = exchange.exchange > 0;
      if (exchange.lane && &item == &exchange.items.front()) moment.begins = &exchange;
      moments.push_back(std::move(moment));
    }
  }
  return moments;
}

std::size_t first_known(const std::vector<Moment>& moments, RecordingHeader& header) {
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const Moment& moment = moments[i];
    if (moment.what == What::connecting) {
      header.axes.reset();
      return i;
    }
    if (header.axes && depends_on_nothing(moments, i)) return i;
    if (moment.what == What::down) header.axes.reset();
    if (moment.what == What::ready) header.may_complete = header.may_complete - moment.axes;
  }
  return moments.size();
}

std::string describe(Moment::What what, const std::string& text) {
  switch (what) {
    case What::written:
      return "wrote " + quoted_bytes(text);
    case What::received:
      return "received " + quoted_bytes(text);
    case What::ended:
      return "ended " + text;
    case What::completion:
      return "completion " + text;
    case What::unexpected:
      return "unexpected " + quoted_bytes(text);
    case What::down:
      return "closed the line";
    case What::barrier:
      return "entered a barrier";
    case What::barrier_passed:
      return "passed the barrier";
    default:
      return "learned something";
  }
}

}  // namespace axisgate::shrc203
