#include "tests/double/wire.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace axisgate::rotor {
namespace {

using Outcome = stage::ExchangeEnded::Outcome;
using stage::TimeLimitPassed;

Problem no_answer(Opcode opcode) {
  return {.reason = Reason::reply_timed_out,
          .message = fmt::format("no answer to {}", name(opcode)),
          .hint = "check the cable and that the rotor is switched on"};
}

}  // namespace

void Wire::ask(Asked asked, TimePoint now) {
  auto& queue = queues_[static_cast<std::size_t>(asked.lane)];
  queue.push_back({std::move(asked), now, 0});
}

void Wire::withdraw(stage::MotionId motion) {
  for (auto& queue : queues_) {
    std::erase_if(queue, [motion](const Waiting& waiting) { return waiting.asked.motion == motion; });
  }
}

void Wire::seal() {
  for (auto& queue : queues_) queue.clear();
}

std::optional<Wire::Waiting> Wire::take_next() {
  for (auto& queue : queues_) {
    if (queue.empty()) continue;
    Waiting next = std::move(queue.front());
    queue.pop_front();
    return next;
  }
  return {};
}

bool Wire::pump(TimePoint now) {
  if (!open_ || in_flight_) return false;
  auto next = take_next();
  if (!next) return false;
  if (const auto problem = listener_.may_write(next->asked)) {
    next->asked.done({{}, false, problem});
  } else {
    write(std::move(*next), now);
  }
  return true;
}

void Wire::write(Waiting next, TimePoint now) {
  ++next.tries;
  ++sequence_;  // a repeat gets a new number, too, so that a late answer is ignored
  const auto& asked = next.asked;
  const std::string bytes = encode({static_cast<std::uint8_t>(asked.opcode), sequence_, asked.payload});
  const std::uint64_t exchange = ++exchanges_;
  listener_.wire_event(stage::BytesWritten{.bytes = bytes,
                                           .exchange = exchange,
                                           .who = asked.who,
                                           .lane = asked.lane,
                                           .motion = asked.motion,
                                           .question = asked.question(),
                                           .axes = asked.question() ? stage::AxisSet() : stage::AxisSet::of(1)});
  in_flight_ = InFlight{std::move(next), sequence_, exchange, bytes, now};
  link_.write(bytes);
}

void Wire::link_up(TimePoint) {
  open_ = true;
  parser_.forget();
  listener_.wire_open();
}

void Wire::lose(const std::string& why, TimePoint now) {
  open_ = false;
  std::vector<std::pair<Asked, bool>> abandoned;  // second: it was written
  if (auto lost = std::exchange(in_flight_, {})) {
    tell_end(*lost, Outcome::link_lost, "", now);
    abandoned.emplace_back(std::move(lost->what.asked), true);
  }
  for (std::size_t lane = static_cast<std::size_t>(Lane::stop) + 1; lane < kLaneCount; ++lane) {
    for (auto& waiting : std::exchange(queues_[lane], {})) abandoned.emplace_back(std::move(waiting.asked), false);
  }
  listener_.wire_lost(why);
  link_.reopen(reopen_wait_);
  reopen_wait_ = std::min(2 * reopen_wait_, kReopenMax);
  const Problem problem{.reason = Reason::link_down,
                        .message = "the line was lost: " + why,
                        .hint =
                            "try again when "
                            "the device is up"};
  for (const auto& [asked, written] : abandoned) asked.done({{}, written, problem});
}

void Wire::receive(std::string_view bytes, TimePoint now) {
  listener_.wire_event(stage::BytesReceived{std::string(bytes)});
  for (const char byte : bytes) {
    if (const auto frame = parser_.feed(byte)) answered(*frame, now);
  }
}

void Wire::answered(const Frame& frame, TimePoint now) {
  const bool awaited = in_flight_ && frame.sequence == in_flight_->sequence &&
                       frame.opcode == (static_cast<std::uint8_t>(in_flight_->what.asked.opcode) | kAnswerBit);
  if (!awaited) return listener_.wire_event(stage::UnexpectedLine{hex(encode(frame))});
  const InFlight ended = std::move(*std::exchange(in_flight_, {}));
  tell_end(ended,
           ended.what.asked.question() ? Outcome::data
           : frame.payload == 0        ? Outcome::ok
                                       : Outcome::ng,
           hex(encode(frame)), now);
  ended.what.asked.done({frame.payload, true, {}});
}

void Wire::tell_end(const InFlight& ended, Outcome outcome, std::string reply, TimePoint now) {
  const Asked& asked = ended.what.asked;
  listener_.wire_event(stage::ExchangeEnded{.command = name(asked.opcode),
                                            .line = hex(ended.bytes),
                                            .reply = std::move(reply),
                                            .lane = asked.lane,
                                            .outcome = outcome,
                                            .latency = now - ended.written,
                                            .exchange = ended.exchange,
                                            .who = asked.who,
                                            .waited = ended.written - ended.what.since});
}

void Wire::timed_out(TimePoint now) {
  InFlight late = std::move(*std::exchange(in_flight_, {}));
  listener_.wire_event(TimeLimitPassed{TimeLimitPassed::Kind::reply});
  tell_end(late, Outcome::timed_out, "", now);
  const Opcode opcode = late.what.asked.opcode;
  const bool again = late.what.asked.repeatable();
  if (again && late.what.tries <= kRepeats) {
    // Put back into its lane, so that a stop that arrived in the meantime goes first.
    auto& queue = queues_[static_cast<std::size_t>(late.what.asked.lane)];
    return queue.push_front(std::move(late.what));
  }
  if (again) lose(fmt::format("no answer to {} times {}", 1 + kRepeats, name(opcode)), now);
  late.what.asked.done({{}, true, no_answer(opcode)});
}

void Wire::expire(TimePoint now) {
  std::vector<Waiting> late;
  for (auto& queue : queues_) {
    const auto kept = std::stable_partition(queue.begin(), queue.end(),
                                            [now](const Waiting& one) { return one.asked.not_after >= now; });
    late.insert(late.end(), std::move_iterator(kept), std::move_iterator(queue.end()));
    queue.erase(kept, queue.end());
  }
  for (const Waiting& one : late) {
    listener_.wire_event(TimeLimitPassed{TimeLimitPassed::Kind::queue});
    one.asked.done({{},
                    one.tries > 0,
                    Problem{.reason = Reason::deadline_passed,
                            .message = "the line was not free in the time allowed",
                            .hint = "try again"}});
  }
}

void Wire::advance(TimePoint now) {
  if (in_flight_ && now >= in_flight_->written + kReplyLimit) timed_out(now);
  expire(now);
}

std::optional<TimePoint> Wire::next_deadline() const {
  std::optional<TimePoint> next;
  const auto sooner = [&next](TimePoint at) { next = next ? std::min(*next, at) : at; };
  if (in_flight_) sooner(in_flight_->written + kReplyLimit);
  for (const auto& queue : queues_) {
    for (const Waiting& one : queue) {
      if (one.asked.not_after < TimePoint::max() - Duration(1)) sooner(one.asked.not_after + Duration(1));
    }
  }
  return next;
}

}  // namespace axisgate::rotor
