#include "device/rml1/mill/prepared_job.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "device/rml1/language/characters.h"
#include "device/rml1/language/parser.h"
#include "device/rml1/sending/commands.h"

namespace axisgate::rml1 {
namespace {

class NoInstructions : public ParserListener {
  void execute(const Instruction&) override {}
  void quit() override {}
};

// Returns `body` without an incomplete group at its end, because the terminator of the epilogue would complete it.
std::string_view without_open_end(std::string_view body, const Dialect& dialect) {
  Diagnostics diagnostics;
  NoInstructions nothing;
  Parser parser(dialect, diagnostics, nothing);
  parser.feed(body);
  parser.finish();
  return body.substr(0, parser.executed_size());
}

std::string wrapped(std::string_view body, const Profile& profile, std::optional<jobs::Origin> origin) {
  const bool turning = Timeline(body, profile, origin).turns_at_end();
  std::string text = prologue();
  text += body;
  return text + epilogue(profile, turning);
}

}  // namespace

PreparedJob::PreparedJob(std::string_view body, std::string digest, const Profile& profile,
                         std::optional<jobs::Origin> origin, const jobs::SendSettings& settings, std::uint64_t begin,
                         std::optional<jobs::Place> from, const Approach& approach)
    : digest_(std::move(digest)),
      begin_(begin),
      from_(from),
      rest_(approach.at),
      body_size_(body.size()),
      rest_in_text_(prologue().size() + approach.words.size()),
      rest_size_(without_open_end(body, profile.dialect).size() - approach.at.offset),
      text_(wrapped(continued(body.substr(0, rest_.offset + rest_size_), approach), profile, origin)),
      places_(std::string_view(text_).substr(rest_in_text_, rest_size_)),
      timeline_(text_, profile, origin),
      settings_(settings),
      plan_(plan_of(text_, timeline_, settings)),
      times_(text_, timeline_, settings, plan_.window) {}

std::uint64_t PreparedJob::of_rest(std::uint64_t bytes) const {
  return bytes < rest_in_text_ ? 0 : std::min(bytes - rest_in_text_, rest_size_);
}

std::uint64_t PreparedJob::of_body(std::uint64_t bytes) const {
  const std::uint64_t of_part = rest_.offset + of_rest(bytes);
  return begin_ + (of_part < rest_.offset + rest_size_ ? of_part : body_size_);
}

jobs::Place PreparedJob::place(std::uint64_t bytes) const {
  const jobs::Place in_rest = places_.at(of_rest(bytes));
  return {rest_.offset + in_rest.offset, rest_.line + in_rest.line - 1,
          in_rest.line > 1 ? in_rest.column : rest_.column + in_rest.column - 1};
}

// The last byte that completes a command may be the first byte of the next command (guideline 2-3).
jobs::PlaceRange PreparedJob::executed(std::uint64_t least, std::uint64_t written) const {
  std::uint64_t begin = std::max(least, rest_in_text_ + 1) - 1;
  while (begin < text_.size() && (is_delimiter(text_[begin]) || text_[begin] == ',')) ++begin;
  return {place(begin), place(std::max(begin, written))};
}

// A measured pace is more exact than the profile. But the rest may consist of other kinds of moves, which no mill makes
// faster than at full speed.
jobs::TimeRange left_of(const PreparedJob& job, const jobs::SendProgress& progress,
                        const std::optional<jobs::MeasuredPace>& measured) {
  if (!measured) {
    const jobs::TimeRange left = job.times().left(progress.executed_least, progress.executed_most);
    return {left.least,
            std::max(left.least, left.most)};  // after a raise, the slowest mill has executed all sent bytes
  }
  const auto takes = [&job](std::uint64_t executed, double pace) {
    return std::chrono::duration_cast<Duration>(
        std::chrono::duration<double>(job.timeline().slowest_after(executed) * pace));
  };
  const jobs::TimeRange full_speed{job.times().left(progress.executed_least, progress.executed_most).least,
                                   job.times().left(progress.executed_most, progress.executed_least).least};
  return {std::max(full_speed.least, takes(progress.executed_most, measured->least / kUnsteady)),
          std::max(full_speed.most, takes(progress.executed_least, measured->most * kUnsteady))};
}

}  // namespace axisgate::rml1
