#include "device/shot/line/barrier.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/core/escape.h"
#include "device/core/guard.h"
#include "device/shot/limits.h"

namespace axisgate::shot {

Barrier::Barrier(const Model& model, std::string line_in_doubt, Limits limits, OutstandingAnswers& outstanding,
                 std::function<bool(const Identity&)> is_known,
                 std::function<void(std::string_view line, TimePoint now)> write)
    : model_(model),
      line_in_doubt_(std::move(line_in_doubt)),
      limits_(limits),
      outstanding_(outstanding),
      is_known_(std::move(is_known)),
      write_(std::move(write)) {}

void Barrier::start(TimePoint now) {
  const bool ask = !line_in_doubt_.empty() && guarded(Guard::received_or_not);
  begin(ask ? Step::echo : Step::identity, now);
}

void Barrier::restart(TimePoint now) {
  expect_answer();
  question_before_stop_ = question_before_stop_ || (step_ == Step::echo && line_in_doubt_ != kAnyLine);
  // The stop is now the previous line, so ?:CMD can report nothing more about the line in doubt.
  const bool older = step_ != Step::echo && guarded(Guard::older_identities);
  begin(older ? Step::after_stop : Step::identity, now);
}

void Barrier::begin(Step step, TimePoint now) {
  step_ = step;
  probes_ = 0;
  older_ = older_answers(step);
  if (step == Step::silence) {
    silence_ = guarded(Guard::silence) ? std::max(limits_.silence, 2 * (now - probed_)) : Duration::zero();
    deadline_ = now + silence_;
    silence_limit_ = now + kBarrierSilenceLimit;
  } else {
    probe(now);
  }
}

int Barrier::older_answers(Step step) const {
  if (!guarded(Guard::older_identities)) return 0;
  if (step == Step::identity) return outstanding_.identities;
  return step == Step::after_stop ? outstanding_.echoes : 0;
}

void Barrier::probe(TimePoint now) {
  ++probes_;
  probed_ = now;
  write_(text(step_ == Step::identity ? LineQuestion::identity : LineQuestion::line_before), now);
  deadline_ = now + limits_.reply;
}

void Barrier::expect_answer() {
  if (step_ == Step::silence || !guarded(Guard::outstanding_answers)) return;
  ++(step_ == Step::identity ? outstanding_.identities : outstanding_.echoes);
}

bool Barrier::is_echo(std::string_view line) const { return line == line_in_doubt_ || is_known_command(line); }

bool Barrier::on_line(std::string_view line, TimePoint now) {
  if (step_ == Step::echo && is_echo(line)) {
    // The reply to a repeated ?:CMD is the ?:CMD before it.
    if (line == line_in_doubt_) received_ = true;
    if (line != line_in_doubt_ && line != text(LineQuestion::line_before)) received_ = false;
    echo_ = line;
    begin(Step::identity, now);
    return true;
  }
  if (is_known_command(line) && std::exchange(question_before_stop_, false)) echo_ = line;
  if (step_ == Step::after_stop && is_known_command(line)) {
    if (older_ > 0) {
      --older_;
      return settle_outstanding(line);
    }
    begin(Step::identity, now);
    return true;
  }
  if (step_ == Step::identity) {
    if (older_ > 0 && parse_identity(line)) {
      --older_;
      return settle_outstanding(line);
    }
    if (auto identity = parse_identity(line)) return on_identity(*std::move(identity), now);
  }
  const bool outstanding = settle_outstanding(line);
  silence_broken(now);
  return outstanding;
}

// Returns false if the identity is not accepted yet.
bool Barrier::on_identity(Identity identity, TimePoint now) {
  if (!is_known_(identity) && unconfirmed_ != identity && guarded(Guard::identity_twice)) {
    unconfirmed_ = std::move(identity);
    probe_again(now);
    return false;
  }
  identity_ = std::move(identity);
  begin(Step::silence, now);
  return true;
}

std::string Barrier::why_failed() const {
  if (!unconfirmed_) return "no answer to three probes";
  return fmt::format("{} {} answered, and no second answer confirmed it", escaped(unconfirmed_->model),
                     escaped(unconfirmed_->serial_number));
}

void Barrier::on_half_line(TimePoint now) {
  if (guarded(Guard::half_lines_break_silence)) silence_broken(now);
}

void Barrier::silence_broken(TimePoint now) {
  if (step_ == Step::silence && now < silence_limit_) deadline_ = now + silence_;
}

void Barrier::advance(TimePoint now) {
  if (state_ != State::probing || now < deadline_) return;
  if (step_ == Step::silence) {
    state_ = now < silence_limit_ ? State::passed : State::failed;
    return;
  }
  expect_answer();
  probe_again(now);
}

void Barrier::probe_again(TimePoint now) {
  if (probes_ >= kBarrierProbesMax && guarded(Guard::three_probes)) {
    const bool any_line = step_ == Step::echo && line_in_doubt_ == kAnyLine;
    if (any_line || step_ == Step::after_stop) return begin(Step::identity, now);
    state_ = State::failed;
  } else {
    probe(now);
  }
}

bool Barrier::settle_outstanding(std::string_view line) { return shot::settle_outstanding(model_, outstanding_, line); }

bool settle_outstanding(const Model& model, OutstandingAnswers& outstanding, std::string_view line) {
  if (outstanding.identities > 0 && parse_identity(line)) {
    --outstanding.identities;
    return true;
  }
  if (outstanding.echoes > 0 && model.parse(line)) {
    --outstanding.echoes;
    return true;
  }
  return false;
}

}  // namespace axisgate::shot
