#include "server/journal/exchanged_lines.h"

#include <utility>

namespace axisgate::server::journal {

std::optional<ExchangedLines::Lines> ExchangedLines::on_event(const stage::Event& event, TimePoint now) {
  return std::visit([&](const auto& what) { return note(what, now); }, event);
}

// A stop that is written in a barrier has no end: the next line closes it. Bytes without an exchange are probes.
std::optional<ExchangedLines::Lines> ExchangedLines::note(const stage::BytesWritten& written, TimePoint now) {
  if (written.exchange == 0 || (open_ && open_->exchange == written.exchange)) return std::nullopt;
  auto unanswered = close({});
  if (written.question && !motions_.contains(written.motion)) return unanswered;
  std::string text = written.bytes.substr(0, written.bytes.find_last_not_of("\r\n") + 1);
  open_ = {written.exchange,
           now,
           written.question,
           {written.motion, written.who, written.axes, {{std::move(text), std::nullopt, std::nullopt}}}};
  return unanswered;
}

std::optional<ExchangedLines::Lines> ExchangedLines::note(const stage::ExchangeEnded& ended, TimePoint) {
  if (!open_ || open_->exchange != ended.exchange) return std::nullopt;
  open_->lines.lines.front().text = ended.line;
  return close(ended.reply.empty() ? std::string(name(ended.outcome)) : ended.reply);
}

std::optional<ExchangedLines::Lines> ExchangedLines::note(const stage::MotionChanged& change, TimePoint) {
  const stage::Motion& motion = change.motion;
  motions_.try_emplace(motion.id, Gathered{motion.created, motion.who, motion.axes, {}});
  return std::nullopt;
}

std::optional<ExchangedLines::Lines> ExchangedLines::note(const stage::LineLearned& learned, TimePoint) {
  return learned.what == stage::LineLearned::What::barrier_passed ? close({}) : std::nullopt;
}

// Adds the line to its motion if the motion has not ended.
std::optional<ExchangedLines::Lines> ExchangedLines::close(std::optional<std::string> answer) {
  if (!open_) return std::nullopt;
  Written done = *std::exchange(open_, {});
  Line& line = done.lines.lines.front();
  line.answer = std::move(answer);
  const auto motion = motions_.find(done.lines.motion);
  if (motion == motions_.end()) return done.question ? std::nullopt : std::optional(std::move(done.lines));
  Gathered& gathered = motion->second;
  line.at = done.at - gathered.requested;
  std::optional<Lines> full;
  if (gathered.lines.size() == kGatheredMax) {
    full = Lines{motion->first, gathered.who, gathered.axes, std::exchange(gathered.lines, {})};
  }
  gathered.lines.push_back(std::move(line));
  return full;
}

std::vector<ExchangedLines::Line> ExchangedLines::take(const stage::Motion& motion) {
  const auto found = motions_.find(motion.id);
  if (found == motions_.end()) return {};
  std::vector<Line> lines = std::exchange(found->second.lines, {});
  if (!stage::is_outcome(motion.state)) return lines;
  if (open_ && open_->lines.motion == motion.id) {
    Line& last = open_->lines.lines.front();
    last.at = open_->at - found->second.requested;
    lines.push_back(std::move(last));
    open_.reset();
  }
  motions_.erase(found);
  return lines;
}

}  // namespace axisgate::server::journal
