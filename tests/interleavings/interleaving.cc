#include "tests/interleavings/interleaving.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/shot/command/reply.h"
#include "device/shot/line/completions.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/planning/transaction_lines.h"

namespace axisgate::simulation {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;

namespace {

constexpr Duration kAnswersAfter = milliseconds(1);
// Duration of the motion; READY is not reported earlier.
constexpr Duration kMovesFor = kReadyOutdatedMax + milliseconds(50);
constexpr Duration kNotLong = milliseconds(250);
constexpr MotionId kFirstMotion = 1;

}  // namespace

std::size_t Choices::choose(std::size_t options) {
  if (next_ == decisions_.size()) decisions_.push_back({0, options});
  return decisions_[next_++].chosen;
}

bool Choices::another() {
  next_ = 0;
  while (!decisions_.empty() && ++decisions_.back().chosen == decisions_.back().options) decisions_.pop_back();
  return !decisions_.empty();
}

std::vector<int> values_of(const CommandRow& row) {
  const auto range = bare_number_range(row).value();
  std::vector<int> values;
  for (const int value : {1, 2, 3}) {
    if (value >= range.minimum && value <= range.maximum) values.push_back(value);
  }
  values.push_back(range.minimum <= 0 ? 0 : 4);
  return values;
}

std::vector<std::string> Question::lines() const {
  std::string line(row->name);
  const std::string_view format = row->format;
  if (format.find("[<a>]") != std::string_view::npos) line += std::to_string(controllable.lowest());
  if (format.find(",<k>") != std::string_view::npos) line += ",0";
  if (format.find(",<n>") != std::string_view::npos) line += ",1";
  if (row->needs.mode == Mode::memory_switches) return {"MS:ON", line, "MS:OFF"};
  return {line};
}

std::string Question::on_the_wire() const {
  const auto all = lines();
  return as_sent(*model().parse(all[all.size() / 2])).line;
}

std::string Question::reply() const {
  std::string text = std::to_string(value);
  const bool each = row->reply.ends_with('*');
  for (int axis = 1; each && axis < controllable.count(); ++axis) {
    text += ',' + std::to_string(values_of(*row).front());
  }
  return text;
}

std::string Question::answer() const {
  return row->separation == Separation::all_axes ? std::to_string(value) : reply();
}

// The rule is written here again instead of calling the line's code; otherwise the test would always pass.
bool Question::waits() const {
  const auto range = bare_number_range(*row).value();
  const auto axes = moving.list();
  const bool confusable =
      std::ranges::any_of(axes, [&](int axis) { return axis >= range.minimum && axis <= range.maximum; });
  switch (row->separation) {
    case Separation::grammar:
      return false;
    case Separation::all_axes:
      return confusable && controllable.count() == 1;
    case Separation::waits:
      return confusable;
    case Separation::closed:
      return confusable && by_execute;
  }
  return false;
}

std::string Question::description() const {
  std::string when =
      moment == Moment::standing
          ? fmt::format("{} us after READY", std::chrono::duration_cast<std::chrono::microseconds>(after_ready).count())
          : "while they move";
  if (moment == Moment::moving_beyond_its_time) when += " beyond its time";
  return fmt::format("{} of {} controllable, answered \"{}\", asked {} {}{}; numbers of {}",
                     lines()[lines().size() / 2], to_string(controllable), reply(), shared ? "by two " : "", when,
                     by_execute ? " by Execute" : "", to_string(moving));
}

Interleaving::Interleaving(const Question& question, Choices& choices)
    : question_(question), choices_(choices), wire_line_(question.on_the_wire()) {
  controller_ = std::make_unique<Controller>(shrc203::Profile{}, *this, *this);
}

Interleaving::~Interleaving() = default;

void Interleaving::wrong(const std::string& what) {
  if (failure_.empty()) failure_ = what;
}

std::string Interleaving::run() {
  controller_->link_up(now_);
  if (begin()) {
    ask();
    end();
  }
  if (failure_.empty()) check();
  return failure_;
}

// Runs the part before the question, in which nothing is chosen.
bool Interleaving::begin() {
  const bool up = run_until([this] { return controller_->state().link == LinkState::up; }, seconds(5));
  if (!up) wrong("the handshake did not pass");
  run_for(milliseconds(10));
  const AxisSet axes = question_.moving;
  if (question_.by_execute) {
    execute({fmt::format("HRT:{}", *command_letter(axes))}, [](const ExecuteEvent&) {});
  } else {
    controller_->home({axes, {"mover", "", now_ + seconds(20)}}, now_, [](Result<Motion>) {});
  }
  if (!run_until([this] { return started_; }, seconds(5))) wrong("the motion did not start");
  run_for(kMovesFor);
  if (question_.moment != Question::Moment::standing) return failure_.empty();
  busy_ = false;
  if (!run_until([this] { return ready_seen_.has_value(); }, seconds(5))) wrong("READY was not read");
  while (now_ < *ready_seen_ + question_.after_ready) step(*ready_seen_ + question_.after_ready);
  return failure_.empty();
}

void Interleaving::ask() {
  while (const auto axis = chosen_axis()) controller_->receive(number_of(*axis) + "\r\n", now_);
  asked_ = true;
  asked_at_ = now_;
  order_ += " asked";
  if (question_.shared) execute({"?:V"}, [](const ExecuteEvent&) {});
  callers_.resize(question_.shared ? 2 : 1);
  for (std::size_t caller = 0; caller < callers_.size(); ++caller) {
    execute(question_.lines(), [this, caller](const ExecuteEvent& event) { heard(caller, event); });
  }
  const auto ended = [this] { return std::ranges::all_of(callers_, [](const Caller& one) { return one.ended; }); };
  if (!run_until(ended, seconds(15))) wrong("the question was neither answered nor refused");
  order_ += " over";
  over_ = true;
}

void Interleaving::execute(std::vector<std::string> lines, Controller::OnExecute heard) {
  const bool short_time = asked_ && question_.moment == Question::Moment::moving_beyond_its_time;
  controller_->execute({std::move(lines), {"asker", "", now_ + (short_time ? kNotLong : Duration(seconds(10)))}}, now_,
                       std::move(heard));
}

void Interleaving::heard(std::size_t caller, const ExecuteEvent& event) {
  Caller& one = callers_[caller];
  const bool of_question = event.sent == wire_line_;
  if (event.kind == ExecuteEvent::Kind::reply && of_question) one.answers.push_back(event.answer);
  if (event.kind != ExecuteEvent::Kind::ended) return;
  if (one.ended) wrong("a caller was told of the end twice");
  one.ended = true;
  if (event.problem) one.problem = event.problem->reason;
}

// Sends the axis numbers that are still outstanding, unless their time has passed, and makes the axes stationary.
void Interleaving::end() {
  for (const int axis : outstanding_.list()) {
    run_for(kAnswersAfter);
    if (may_complete()) controller_->receive(number_of(axis) + "\r\n", now_);
  }
  busy_ = false;
  if (!run_until([this] { return outcome_.has_value(); }, seconds(10))) wrong("the motion did not end");
}

void Interleaving::check() {
  const bool refused = question_.waits() && question_.moment == Question::Moment::moving_beyond_its_time;
  for (const Caller& caller : callers_) {
    if (refused) {
      if (caller.problem != Reason::completion_outstanding) wrong("it was not refused with COMPLETION_OUTSTANDING");
      if (!caller.answers.empty()) wrong("it was answered, and refused");
      continue;
    }
    if (caller.problem) return wrong(fmt::format("it ended with {}", name(*caller.problem)));
    if (caller.answers != std::vector{question_.answer()}) {
      wrong(fmt::format("the caller was told \"{}\"", caller.answers.empty() ? "" : caller.answers.front()));
    }
  }
  for (int axis = 1; axis <= kAxisCount; ++axis) {
    if (seen_[axis] != told_[axis]) {
      wrong(fmt::format("the number {} came {} times and was counted {} times", axis, told_[axis], seen_[axis]));
    }
  }
  if (outcome_->state != MotionState::succeeded) wrong("the motion did not succeed");
  if (written_at_.has_value() == refused) wrong(refused ? "it was sent" : "it was never sent");
  if (refused || question_.row->needs.mode != Mode::host) return;
  const bool waited = ready_seen_ && *written_at_ >= *ready_seen_ + kCompletionAfterReadyMax;
  if (question_.waits() && !waited) wrong("it was sent while a number could come");
  if (!question_.waits() && *written_at_ > *asked_at_ + 2 * kAnswersAfter) wrong("it waited without need");
}

void Interleaving::on_event(const Event& event, TimePoint) {
  if (const auto* entered = std::get_if<BarrierEntered>(&event)) wrong("a barrier: " + entered->why);
  if (const auto* line = std::get_if<UnexpectedLine>(&event)) wrong("unexpected: " + line->text);
  // After the memory switches the gateway reconnects to check the state again, so a lost link is an error only in HOST
  // mode.
  const auto* link = std::get_if<LinkChanged>(&event);
  if (link && link->link == LinkState::down && question_.row->needs.mode == Mode::host) {
    wrong("the link went down: " + link->why);
  }
  if (const auto* passed = std::get_if<TimeLimitPassed>(&event);
      passed && passed->kind != TimeLimitPassed::Kind::queue) {
    wrong("an answer did not come in time");
  }
  if (const auto* learned = std::get_if<LineLearned>(&event)) {
    const bool ours = learned->what == LineLearned::What::ready && learned->axes.touches(question_.moving);
    if (ours && started_) ready_seen_ = now_;
  }
  if (const auto* seen = std::get_if<CompletionSeen>(&event)) {
    ++seen_[seen->axis];
    const MotionId owner = outcome_ ? 0 : kFirstMotion;
    if (seen->motion != owner) wrong(fmt::format("the number {} was counted for motion {}", seen->axis, seen->motion));
  }
  const auto* changed = std::get_if<MotionChanged>(&event);
  if (changed && changed->motion.id == kFirstMotion && is_outcome(changed->motion.state)) outcome_ = changed->motion;
}

}  // namespace axisgate::simulation
