#include "tests/simulation/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace axisgate::simulation {

using namespace shrc203;

namespace {

constexpr Duration kRecent = std::chrono::seconds(1);
constexpr Duration kSwapSilence = std::chrono::milliseconds(200);
// Options drawn last, so that seeds from before these options stay the same.
constexpr std::array<std::string_view, 1> kDrawnLater = {"jog_override_afterwards"};

}  // namespace

Setup drawn_setup(std::uint64_t seed, const Faults& faults) {
  Setup setup;
  setup.seed = seed;
  setup.faults = faults;
  Random random(seed * 7919 + 17);
  const auto draw = [&](bool later) {
    for (const auto& option : simulator::option_names()) {
      if (later != (std::ranges::find(kDrawnLater, option.name) != kDrawnLater.end())) continue;
      const auto last = static_cast<std::int64_t>(option.values.size()) - 1;
      (void)setup.options.set(option.name, option.values[static_cast<std::size_t>(random.between(0, last))]);
    }
  };
  draw(false);
  // The gateway knows only facts that a lab would have found out; otherwise it assumes the stricter interpretation.
  if (setup.options.is("busy_scope", "axis") && random.chance(0.5)) setup.profile.busy_scope = Scope::axis;
  if (setup.options.is("prebuffer_scope", "axis") && random.chance(0.5)) setup.profile.prebuffer_scope = Scope::axis;
  setup.baud = random.pick(std::vector<int>{9600, 38400, 115200});
  setup.profile.baud = setup.baud;
  draw(true);
  setup.followed = seed % 4 != 2;  // not drawn, so that earlier seeds stay the same
  return setup;
}

World::World(Setup setup) : setup_(std::move(setup)), random_(setup_.seed), wire_(random_, setup_.seed, setup_.baud) {
  device_ = std::make_unique<simulator::Simulator>(setup_.options, wire_.device_end());
  Permission& permission = setup_.permission ? *setup_.permission : everybody_may();
  controller_ = std::make_unique<Controller>(setup_.profile, wire_.gateway_end(), *this, permission);
  wire_.connect(*controller_, *device_);
  wire_.set_phase([this] { return phase(); });
  wire_.set_device([this] { return device_->answering(); }, [this] { return !restarting(); });
  wire_.set_faults(setup_.faults);
  wire_.open(now_);
}

World::~World() = default;

void World::violation(const std::string& what) {
  wire_.note(now_, "!! " + what);
  violations_.push_back(what);
}

std::string World::replay() const {
  std::string text =
      fmt::format("replay with AXISGATE_SEED={}\nreadings: {}\nfaults:", setup_.seed, setup_.options.describe());
  for (const auto& [kind, phases] : wire_.faults_by_kind()) {
    text += fmt::format(" {} {};", std::accumulate(phases.begin(), phases.end(), std::uint64_t{0}), kind);
  }
  text += "\nthe last lines of the wire:\n";
  for (const auto& line : wire_.log()) text += line + "\n";
  return text;
}

// Determines the phase from the last line written, the device's activity and the controller's link state. A setting or
// a start in progress takes precedence over another axis that moves.
Phase World::phase() const {
  if (controller_->state().link != LinkState::up) return Phase::barrier;
  bool moves = false, runs = false;
  for (int axis = 1; axis <= kAxisCount; ++axis) moves = moves || device_->busy(axis);
  for (const Motion& motion : controller_->motions()) {
    const bool running = !is_outcome(motion.state) && motion.state != MotionState::queued;
    if (running && motion.kind == MotionKind::path) return Phase::path;
    runs = runs || running;
  }
  const std::string last = wire_.commands().empty() ? "" : wire_.commands().back();
  const bool under_way = written_when_last_ended_ < wire_.commands().size();
  if (starts_motion(last) && under_way) return Phase::started;
  if (sets_motion(last)) return wire_.answered() ? Phase::acknowledged : Phase::set;
  if (runs) return moves ? Phase::moving : Phase::completing;
  return moves ? Phase::moving : Phase::idle;
}

void World::step(TimePoint limit) {
  TimePoint next = limit;
  for (const auto& at : {wire_.next_event(), controller_->next_deadline(), device_->next_deadline()}) {
    if (at && *at < next) next = *at;
  }
  if (!operations_.empty() && operations_.begin()->first < next) next = operations_.begin()->first;
  steps_here_ = next > now_ ? 0 : steps_here_ + 1;
  if (steps_here_ > 100'000) violation("time stands still: a deadline that has passed is named again and again");
  now_ = std::max(now_, next);
  wire_.advance(now_);
  device_->advance(now_);
  controller_->advance(now_);
  while (!operations_.empty() && operations_.begin()->first <= now_) {
    const auto deed = operations_.extract(operations_.begin()).mapped();
    wire_.pass_bytes(now_);
    deed();
  }
}

void World::run_for(Duration duration) {
  const TimePoint end = now_ + duration;
  while (now_ < end && violations_.empty()) step(end);
}

bool World::run_until(const std::function<bool()>& done, Duration limit) {
  const TimePoint end = now_ + limit;
  while (!done() && now_ < end && violations_.empty()) step(end);
  return done();
}

void World::on_event(const Event& event, TimePoint at) {
  if (setup_.listener) setup_.listener->on_event(event, at);
  if (on_news) on_news(event);
  if (const auto* ended = std::get_if<ExchangeEnded>(&event)) check_exchange(*ended);
  if (const auto* illegal = std::get_if<IllegalTransition>(&event)) {
    violation(fmt::format("{}: {} in {}", illegal->machine, illegal->event, illegal->state));
  }
  if (std::holds_alternative<BarrierEntered>(event)) ++barriers_;
  if (const auto* seen = std::get_if<CompletionSeen>(&event)) completions_.push_back(*seen);
  if (const auto* step_made = std::get_if<PathProgress>(&event)) progress_.push_back(*step_made);
  if (const auto* changed = std::get_if<MotionChanged>(&event)) {
    wire_.note(now_, fmt::format("   motion {} {} {}{}", changed->motion.id, name(changed->motion.kind),
                                 name(changed->motion.state),
                                 changed->motion.problem ? ": " + changed->motion.problem->message : ""));
    digest(changed->motion);
    if (is_outcome(changed->motion.state)) {
      outcomes_.push_back(changed->motion);
      check_outcome(changed->motion);
    }
    if (on_motion) on_motion(changed->motion);
  }
}

void World::digest(const Motion& motion) {
  Digest& digest = wire_.digest();
  digest.add(motion.id);
  digest.add(name(motion.kind));
  digest.add(name(motion.state));
  digest.add(motion.problem ? name(motion.problem->reason) : "");
  for (const auto& result : motion.results) digest.add(static_cast<std::uint64_t>(result.command_pulses.value_or(-1)));
}

// Checks that the answer to an exchange was written by the device in answer to that very command.
void World::check_exchange(const ExchangeEnded& ended) {
  ++exchanges_;
  written_when_last_ended_ = wire_.commands().size();
  if (!setup_.callers_send_bare_go && (ended.line == "G" || ended.line == "G:"))
    violation("a bare G was sent: it starts whatever is set, whoever set it");
  if (ended.reply.empty()) return;
  const auto& origin = wire_.delivering();
  if (!origin) return violation(fmt::format("{} was answered while nothing was delivered", ended.line));
  if (origin->kind != Origin::Kind::reply) {
    if (origin->damaged) return;  // one flipped bit changes it into another number, which cannot be detected
    return violation(fmt::format("{} took \"{}\" for its reply, which was none", ended.line, ended.reply));
  }
  if (ended.closed) {
    // Replies before the !:S are judged by the caller's answer.
    if (wire_.commands()[origin->command] != "!:S") violation(ended.line + " was closed by no !:S");
    return;
  }
  if (wire_.commands()[origin->command] != ended.line || origin->command + 1 != wire_.commands().size()) {
    violation(fmt::format("{} took \"{}\" for its reply, which answered {}", ended.line, ended.reply,
                          wire_.commands()[origin->command]));
  }
}

void World::power_cycle(Duration silence) {
  rebooted_ = now_;
  written_before_reboot_ = wire_.commands().size();
  restart_lasts_ = silence;
  for (int axis = 1; axis <= kAxisCount; ++axis) {
    before_reboot_[static_cast<std::size_t>(axis - 1)] = device_->position(axis);
  }
  device_->power_cycle(now_);
  wire_.device_restarts();
}

void World::restart_gateway(const Restart& restart) {
  controller_.reset();
  Permission& permission = restart.start();
  controller_ = std::make_unique<Controller>(setup_.profile, wire_.gateway_end(), *this, permission);
  restart.prepare(*controller_);
  wire_.change_gateway(*controller_, now_, restart.away, restart.written_is_lost);
}

void World::swap_unit(const std::string& serial_number, Duration unplugged_for) {
  device_->set_serial_number(serial_number);
  device_->set_boot({.silence = kSwapSilence});
  power_cycle(kSwapSilence);
  wire_.cut(now_, unplugged_for);
}

void World::visit_of_another_unit(const std::string& serial_number, Duration unplugged_for) {
  swap_unit(serial_number, unplugged_for);
  written_before_visit_ = wire_.commands().size();
}

void World::return_of_the_unit(Duration unplugged_for) {
  for (std::size_t i = written_before_visit_; i < wire_.commands().size(); ++i) {
    const std::string& line = wire_.commands()[i];
    if (line != "*IDN?" && line != "?:CMD" && !line.starts_with("L:")) violation("another unit was told " + line);
  }
  swap_unit(setup_.options.serial_number, unplugged_for);
}

bool World::restarting() const { return rebooted_ && now_ < *rebooted_ + restart_lasts_; }

// Reports whether the line being delivered was written before the restart.
bool World::told_before_restart() const {
  return rebooted_ && wire_.delivering() && wire_.delivering()->command < written_before_reboot_;
}

// Returns the position of the axis when the device reported it.
std::int64_t World::told_position(int axis) const {
  const bool then = restarting() || told_before_restart();
  return then ? before_reboot_[static_cast<std::size_t>(axis - 1)] : device_->position(axis);
}

// Checks that a successful motion ended where the device truly is, in the frame at the time of the request.
void World::check_outcome(const Motion& motion) {
  if (motion.state != MotionState::succeeded) return;
  // With all axes at 0 the restart does not change the frame.
  const bool shifted = std::ranges::any_of(before_reboot_, [](std::int64_t place) { return place != 0; });
  if (rebooted_ && shifted && motion.created < *rebooted_ && !told_before_restart()) {
    violation(fmt::format("motion {} succeeded, but the device has restarted since it was asked for", motion.id));
  }
  for (const auto& result : motion.results) {
    // A jog has no target, but reports its final place.
    const auto place = motion.kind == MotionKind::jog ? result.command_pulses : result.target_pulses;
    if (!place) {
      violation(fmt::format("motion {} succeeded without a target for axis {}", motion.id, result.axis));
    } else if (told_position(result.axis) != *place) {
      violation(fmt::format("motion {} succeeded, but axis {} stands at {} instead of {}", motion.id, result.axis,
                            told_position(result.axis), *place));
    } else if (device_->busy(result.axis) && !wire_.damaged_since(now_ - kRecent)) {
      // One flipped bit changes the B of an axis that settles at its target into an R.
      violation(fmt::format("motion {} succeeded, but axis {} is still busy", motion.id, result.axis));
    }
  }
}

}  // namespace axisgate::simulation
