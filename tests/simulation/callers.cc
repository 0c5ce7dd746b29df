#include "tests/simulation/callers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;

// Hazard 1: each of these questions can be answered by a bare number while a completion is due.
const std::vector<std::string> kQuestions = {"?:C1", "?:F1",  "?:SLEEP", "?:BO",  "?:BEEP", "?:AXIS", "?:ACS1", "?:O",
                                             "?:W",  "I:",    "?:M1",    "?:MP2", "?:A3",   "?:WT1",  "?:WI2",  "?:P3",
                                             "?:V",  "*IDN?", "!:",      "Q:",    "?:CMD",  "SRQ:",   "?:D1",   "?:K"};

constexpr Duration kQuestionLimit = seconds(10);
constexpr int kInputs = 2;  // IN2: the same digit as a completion of axis 2

std::string who(Random& random) { return fmt::format("caller-{}", random.between(1, 4)); }

}  // namespace

Callers::Callers(World& world, std::uint64_t seed, double mishaps_an_hour, Habits habits)
    : world_(world), mishaps_(world, seed, mishaps_an_hour), habits_(habits) {
  world_.device().set_inputs(kInputs);
}

void Callers::act_for(Duration duration) {
  const TimePoint end = world_.now() + duration;
  while (world_.now() < end && world_.violations().empty()) {
    pass_time();
    act();
    check_starts();
  }
}

void Callers::pass_time() {
  const Duration time = milliseconds(world_.random().between(1, 1500));
  if (!habits_.stop_at_faults) return world_.run_for(time);
  const TimePoint end = world_.now() + time;
  while (world_.now() < end && world_.violations().empty()) {
    const auto struck = [this, before = world_.wire().faults_drawn()] {
      return world_.wire().faults_drawn() != before || !world_.violations().empty();
    };
    if (world_.run_until(struck, end - world_.now())) stop();
  }
}

void Callers::act() {
  if (habits_.shapes && world_.random().chance(0.35)) {
    switch (world_.random().between(0, 3)) {
      case 0:
        return scan();
      case 1:
        return approach();
      default:
        return curved_path();
    }
  }
  switch (world_.random().between(0, 11)) {
    case 0:
    case 1:
    case 2:
      return move();
    case 3:
      return home();
    case 4:
    case 5:
      return path();
    case 6:
      return stop();
    case 7:
      return set_and_go();
    case 8:
      if (!world_.random().chance(0.1)) return;
      if (const auto away = milliseconds(world_.random().between(10, 3000)); world_.wire().inject("link: unplugged")) {
        world_.wire().cut(world_.now(), away);
      }
      return;
    default:
      return ask();
  }
}

void Callers::move() {
  auto& random = world_.random();
  MoveRequest request;
  request.relative = random.chance(0.5);
  request.context = world_.context(who(random));
  for (int axis = 1; axis <= kAxisCount; ++axis) {
    if (random.chance(0.5)) request.moves.push_back({axis, pulses(random.between(-3000, 3000)), {}});
  }
  for (const auto& one : request.moves) ++starts_allowed_[static_cast<std::size_t>(one.axis - 1)];
  world_.controller().move(std::move(request), world_.now(), [](Result<Motion>) {});
}

void Callers::home() {
  auto& random = world_.random();
  HomeRequest request;
  request.context = world_.context(who(random));
  request.axes = AxisSet::of(static_cast<int>(random.between(1, 3)));
  if (random.chance(0.3)) request.axes = kAllAxes;
  for (const int axis : request.axes.list()) ++starts_allowed_[static_cast<std::size_t>(axis - 1)];
  if (random.chance(0.5)) {
    world_.controller().home(request, world_.now(), [](Result<Motion>) {});
  } else {
    world_.controller().return_to_origin(request, world_.now(), [](Result<Motion>) {});
  }
}

void Callers::path() {
  auto& random = world_.random();
  PathRequest request;
  request.context = world_.context(who(random));
  const bool line = random.chance(0.6);
  const int first = static_cast<int>(random.between(1, 2));
  const auto count = random.between(1, 8);
  for (int i = 0; i < count; ++i) {
    Segment segment;
    const std::int64_t way = random.between(1, 2500), other_way = line ? random.between(-2500, 2500) : 0;
    segment.moves.push_back({first, pulses(random.chance(0.5) ? way : -way), {}});
    if (line) segment.moves.push_back({3, pulses(other_way), {}});
    // Few segments are too short for the line: a path with such a segment would be refused.
    const std::int64_t lasts_ms = random.between(15, 250);
    segment.speed = pulses(std::max<std::int64_t>(100, (way + std::abs(other_way)) * 1000 / lasts_ms));
    ++starts_allowed_[static_cast<std::size_t>(first - 1)];
    if (line) ++starts_allowed_[2];
    request.segments.push_back(std::move(segment));
  }
  world_.controller().run_path(std::move(request), world_.now(), [](Result<Motion>) {});
}

void Callers::allow_starts(AxisSet axes) {
  for (const int axis : axes.list()) ++starts_allowed_[static_cast<std::size_t>(axis - 1)];
}

void Callers::curved_path() {
  auto& random = world_.random();
  const AxisSet plane = AxisSet::of(1) | AxisSet::of(2);
  PathRequest request;
  request.context = world_.context(who(random));
  const auto count = random.between(1, 6);
  for (int i = 0; i < count; ++i) {
    Segment segment;
    const Quantity first = pulses(random.between(100, 1500)), second = pulses(-random.between(100, 1500));
    if (random.chance(0.3)) {
      segment.moves = {{1, first, {}}, {2, second, {}}};
    } else if (random.chance(0.5)) {
      segment.curve = Curve{{1, 2}, Curve::Through{{first, pulses(0)}, {first, second}}, {}};
    } else {
      const std::variant<int, Decimal> half = Decimal{180, 0};
      segment.curve = Curve{{1, 2}, Curve::Around{{first, second}, Rotation::clockwise, half}, {}};
    }
    segment.speed = pulses(random.between(2000, 20'000));
    if (random.chance(0.2)) segment.rest = milliseconds(random.between(1, 500));
    allow_starts(plane);
    request.segments.push_back(std::move(segment));
  }
  world_.controller().run_path(std::move(request), world_.now(), [](Result<Motion>) {});
}

void Callers::approach() {
  auto& random = world_.random();
  MoveRequest request;
  request.context = world_.context(who(random));
  for (int axis = 1; axis <= kAxisCount; ++axis) {
    if (!random.chance(0.5)) continue;
    AxisMove move{axis, pulses(random.between(-3000, 3000)), {}};
    move.approach = pulses(random.chance(0.5) ? 300 : -300);
    request.moves.push_back(std::move(move));
    for (int legs = 0; legs < 2; ++legs) allow_starts(AxisSet::of(axis));
  }
  world_.controller().move(std::move(request), world_.now(), [](Result<Motion>) {});
}

void Callers::scan() {
  auto& random = world_.random();
  ScanRequest request;
  request.axis = static_cast<int>(random.between(1, 3));
  request.from = pulses(random.between(-3000, 3000));
  request.to = pulses(random.between(-3000, 3000));
  request.speed = pulses(random.between(1000, 56'000));
  request.interval = random.between(2, 500);
  request.context = world_.context(who(random));
  for (int legs = 0; legs < 2; ++legs) allow_starts(AxisSet::of(request.axis));
  world_.controller().scan(request, world_.now(), [](Result<Motion>) {});
}

void Callers::stop() {
  auto& random = world_.random();
  const AxisSet axes = random.chance(0.5) ? AxisSet() : AxisSet::of(static_cast<int>(random.between(1, 3)));
  ++unfinished_questions_;
  world_.controller().stop(axes, world_.context(who(random)), world_.now(),
                           [this](const StopReport&) { --unfinished_questions_; });
}

void Callers::ask() {
  auto& random = world_.random();
  ++unfinished_questions_;
  const std::string question = random.pick(kQuestions);
  world_.controller().execute({{question}, world_.context(who(random), kQuestionLimit)}, world_.now(),
                              [this, question](const ExecuteEvent& event) {
                                if (event.kind == ExecuteEvent::Kind::ended) --unfinished_questions_;
                                if (event.kind == ExecuteEvent::Kind::reply) check_answer(question, event.answer);
                              });
}

void Callers::set_and_go() {
  auto& random = world_.random();
  const auto axis = random.between(1, 3);
  const std::vector<std::string> setters = {"M", "MP", "A", "AP"};
  ++unfinished_questions_;
  ++starts_allowed_[static_cast<std::size_t>(axis - 1)];
  world_.controller().execute(
      {{fmt::format("{}:{}+P{}", random.pick(setters), axis, random.between(0, 2000)), fmt::format("G:{}", axis)},
       world_.context(who(random))},
      world_.now(), [this](const ExecuteEvent& event) {
        if (event.kind == ExecuteEvent::Kind::ended) --unfinished_questions_;
      });
}

// Checks an answer. Questions that are closed by an !:S are judged by their answer; one flipped bit can change its
// number, or the O: of a G:, which sets the outputs.
void Callers::check_answer(const std::string& question, const std::string& answer) {
  if (world_.wire().damaged_since(world_.now() - kQuestionLimit) || answer.starts_with("NG")) return;
  const bool outputs_known = world_.wire().commands_damaged() == 0;
  const std::string right = question == "I:"                     ? std::to_string(kInputs)
                            : question == "?:O" && outputs_known ? "0"
                                                                 : answer;
  if (answer != right) world_.violation(fmt::format("{} was answered by {} instead of {}", question, answer, right));
}

// Checks the number of starts. A command that a fault has changed into another may start a motion that nobody
// requested, and the gateway cannot know. Each such command may do so once.
void Callers::check_starts() {
  for (int axis = 1; axis <= kAxisCount; ++axis) {
    const int allowed = starts_allowed_[static_cast<std::size_t>(axis - 1)] + world_.wire().commands_damaged();
    if (world_.device().starts(axis) > allowed) {
      world_.violation(fmt::format("axis {} was set in motion {} times, asked for {} times", axis,
                                   world_.device().starts(axis), allowed));
    }
  }
}

void Callers::become_stationary() {
  world_.set_faults(Faults::none());
  mishaps_.undo_all();
  world_.run_for(seconds(2));  // the last mishap may have been a restart, during which the device does not answer
  const auto stationary = [this] {
    for (const Motion& motion : world_.controller().motions()) {
      if (!is_outcome(motion.state)) return false;
    }
    // If a prebuffer keeps a segment, the stop stays open until a reset.
    const auto& stops = world_.controller().state().open_stops;
    const bool obeyed = std::ranges::all_of(stops, [](const Stop& stop) { return stop.stale; });
    return unfinished_questions_ == 0 && obeyed && world_.controller().state().link == LinkState::up;
  };
  // A wrong bit may have changed a speed into a slower valid one: an axis that really moves is no fault.
  const auto moves = [this] { return world_.device().busy(1) || world_.device().busy(2) || world_.device().busy(3); };
  bool rests = world_.run_until(stationary, seconds(120));
  for (int minute = 0; minute < 60 && !rests && moves(); ++minute) rests = world_.run_until(stationary, seconds(60));
  if (!rests && !moves() && world_.violations().empty()) {
    world_.violation("two quiet minutes after the last fault something is still unfinished");
  }
  if (habits_.shapes) {
    allow_starts(AxisSet::of(1));
    MoveRequest last{{{1, pulses(10), {}}}, true, world_.context("last")};
    world_.controller().move(last, world_.now(), [](Result<Motion>) {});
    world_.run_until(stationary, seconds(30));
    const bool intact = world_.wire().commands_damaged() == 0;
    if (intact && world_.device().trigger() != "NS") world_.violation("a scan has left its trigger armed");
  }
  check_starts();
  bool answered = false;
  world_.controller().execute({{"?:V"}, world_.context("last")}, world_.now(), [&](const ExecuteEvent& event) {
    answered = answered || (event.kind == ExecuteEvent::Kind::reply && event.answer == "V2.00.000");
  });
  if (!world_.run_until([&] { return answered; }, seconds(30)) && world_.violations().empty()) {
    world_.violation("the device does not answer on a good line");
  }
}

}  // namespace axisgate::simulation
