#include "tests/simulation/users.h"

#include <fmt/format.h>

#include <algorithm>

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using server::AtLoss;
using server::Lease;
using server::LeaseTerms;
using server::LeaseToken;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kAdmins = 2;  // the first two users

Setup setup_of(std::uint64_t seed, const Faults& faults, Permission& permission) {
  Setup setup = drawn_setup(seed, faults);
  setup.permission = &permission;
  for (AxisProfile& axis : setup.profile.axes) {
    axis.travel_minimum = pulses(-Users::kTravel);
    axis.travel_maximum = pulses(Users::kTravel);
  }
  return setup;
}

AxisSet drawn_axes(Random& random) {
  AxisSet axes = AxisSet::of(static_cast<int>(random.between(1, 3)));
  if (random.chance(0.3)) axes.add(static_cast<int>(random.between(1, 3)));
  return random.chance(0.1) ? kAllAxes : axes;
}

}  // namespace

Users::Users(std::uint64_t seed, const Faults& faults) : world_(setup_of(seed, faults, leases_)) {
  for (int i = 0; i < kUsers; ++i) users_.push_back({fmt::format("user-{}", i), 0, {}, {}});
  world_.on_news = [this](const Event& event) { on_news(event); };
}

void Users::act_for(Duration duration) {
  const TimePoint end = world_.now() + duration;
  while (world_.now() < end && world_.violations().empty()) {
    world_.run_for(milliseconds(world_.random().between(1, 300)));
    User& user = users_[static_cast<std::size_t>(world_.random().between(0, kUsers - 1))];
    if (world_.now() >= user.paused_until) act(user);
    keep_jogs();
    check_travel();
    check_jogs();
  }
}

void Users::act(User& user) {
  auto& random = world_.random();
  switch (random.between(0, 17)) {
    case 0:
    case 1:
    case 2:
      return user.token == 0 ? acquire(user) : keep_alive(user);
    case 3:
    case 4:
      return keep_alive(user);
    case 5:
      return disconnect(user);
    case 6:
      return crash(user);
    case 7:
      user.paused_until = world_.now() + seconds(random.between(1, 15));
      return;
    case 8:
      return stop(user);
    case 9:
    case 10:
      return rearm(user);
    case 11:
      return path(user, drawn_token(user));
    case 12:
      return &user < &users_[kAdmins] && random.chance(0.3) ? take_over(user) : keep_alive(user);
    case 13:
      return jog(user, drawn_token(user));
    case 14:
      return execute(user, drawn_token(user));
    default:
      return move(user, drawn_token(user));
  }
}

// Returns mostly the user's token, sometimes an old token or none.
LeaseToken Users::drawn_token(const User& user) {
  auto& random = world_.random();
  if (!user.stale.empty() && random.chance(0.2)) return random.pick(user.stale);
  return random.chance(0.2) ? 0 : user.token;
}

RequestContext Users::context(const User& user, LeaseToken token) {
  RequestContext context = world_.context(user.name, seconds(5));
  context.lease = asking_ = token;
  return context;
}

LeaseTerms Users::drawn_terms() {
  auto& random = world_.random();
  LeaseTerms terms;
  terms.scope = drawn_axes(random);
  terms.time_to_live = seconds(random.between(2, 15));
  terms.at_loss = random.pick(std::vector{AtLoss::finish, AtLoss::stop, AtLoss::stop_and_release});
  return terms;
}

void Users::acquire(User& user) {
  const bool wait = world_.random().chance(0.6);
  leases_.acquire(drawn_terms(), user.name, wait, world_.now() + seconds(20), world_.now(),
                  [this, &user](const Result<Lease>& lease) {
                    lease ? granted(user, *lease) : static_cast<void>(++counts_.refused);
                  });
}

void Users::take_over(User& user) {
  const LeaseTerms terms = drawn_terms();
  for (auto& [token, grant] : grants_) grant.over = grant.over || grant.axes.touches(AxisSet::in(terms.scope));
  ++counts_.taken_over;
  leases_.take_over(terms, user.name, world_.now(), [this, &user](const Result<Lease>& lease) {
    if (lease) granted(user, *lease);
  });
}

void Users::granted(User& user, const Lease& lease) {
  ++counts_.granted;
  for (const int axis : lease.terms.scope.list()) {
    if (const Grant* other = owner_of(axis)) {
      world_.violation(fmt::format("axis {} was given to {} while {} owns it", axis, user.name, other->who));
    }
  }
  for (const Motion& motion : world_.controller().motions()) {
    const bool runs = motion.state == MotionState::running || motion.state == MotionState::stopping;
    if (runs && motion.axes.touches(AxisSet::in(lease.terms.scope))) {
      world_.violation(fmt::format("{} got a lease over motion {} of {}", user.name, motion.id, motion.who));
    }
  }
  const TimePoint until = world_.now() + lease.terms.time_to_live;
  Grant grant;
  grant.who = user.name;
  grant.axes = AxisSet::in(lease.terms.scope);
  grant.time_to_live = lease.terms.time_to_live;
  grant.valid_until = until;
  grant.at_loss = lease.terms.at_loss;
  grant.epoch = world_.controller().state().device_epoch;
  grants_[lease.token] = grant;
  if (user.token != 0) user.stale.push_back(user.token);
  user.token = lease.token;
}

void Users::keep_alive(User& user) {
  if (user.token == 0) return;
  Grant& grant = grants_.at(user.token);
  const bool its_own = owned(grant);
  const auto kept = leases_.keep_alive(user.token, world_.now());
  if (kept.has_value() != its_own) {
    world_.violation(
        fmt::format("{} kept alive a lease that {}", user.name, its_own ? "it owns, in vain" : "has ended"));
  }
  if (kept) {
    grant.valid_until = world_.now() + grant.time_to_live;
  } else {
    ++counts_.expired;
    user.stale.push_back(std::exchange(user.token, 0));
  }
}

void Users::disconnect(User& user) {
  if (user.token == 0) return;
  const std::string& to = world_.random().pick(users_).name;
  const bool handed = world_.random().chance(0.5);
  Grant& grant = grants_.at(user.token);
  const TimePoint valid_until = std::exchange(grant.valid_until, TimePoint{});  // before the next owner is notified
  const auto done =
      handed ? leases_.hand_over(user.token, to, world_.now()) : leases_.release(user.token, world_.now());
  if (!done) {
    grant.valid_until = valid_until;
    return;
  }
  counts_.handed_over += handed ? 1 : 0;
  grant.over = true;
  user.stale.push_back(std::exchange(user.token, 0));
}

// Crashes a user, who forgets the lease. Half of the crashes are seen as a broken connection.
void Users::crash(User& user) {
  if (user.token == 0) return;
  Grant& grant = grants_.at(user.token);
  if (world_.random().chance(0.5)) {
    if (grant.at_loss == AtLoss::stop_and_release) grant.over = true;
    leases_.lost(user.token, world_.now());
  }
  user.stale.push_back(std::exchange(user.token, 0));
}

void Users::move(User& user, LeaseToken token) {
  auto& random = world_.random();
  MoveRequest request;
  request.relative = random.chance(0.5);
  request.context = context(user, token);
  const AxisSet axes =
      token != 0 && grants_.contains(token) && random.chance(0.8) ? grants_.at(token).axes : drawn_axes(random);
  for (const int axis : axes.list()) request.moves.push_back({axis, pulses(random.between(-24'000, 24'000)), {}});
  world_.controller().move(std::move(request), world_.now(),
                           [this](const Result<Motion>& motion) { counts_.moved += motion ? 1 : 0; });
}

void Users::path(User& user, LeaseToken token) {
  auto& random = world_.random();
  PathRequest request;
  request.context = context(user, token);
  const int axis = token != 0 && grants_.contains(token) ? grants_.at(token).axes.lowest() : 1;
  for (std::int64_t i = random.between(2, 12); i > 0; --i) {
    Segment segment;
    segment.moves.push_back({axis, pulses(random.between(500, 2500)), {}});
    segment.speed = pulses(random.between(2500, 10000));
    request.segments.push_back(std::move(segment));
  }
  world_.controller().run_path(std::move(request), world_.now(), [](const Result<Motion>&) {});
}

void Users::jog(User& user, LeaseToken token) {
  auto& random = world_.random();
  JogRequest request;
  request.context = context(user, token);
  const AxisSet axes = token != 0 && grants_.contains(token) ? grants_.at(token).axes : drawn_axes(random);
  for (const int axis : axes.list()) {
    request.axes.push_back({axis, random.chance(0.5) ? 1 : -1, {}});
    if (random.chance(0.5)) request.axes.back().speed = pulses(random.between(100, 10'000));
  }
  user.jog = world_.controller().jog(std::move(request), world_.now(),
                                     [this](const Result<Motion>& motion) { counts_.jogged += motion ? 1 : 0; });
  if (user.jog != 0) renewed_[user.jog] = world_.now();
}

// Changes settings that outlive their user, only under a lease: a setting made without a lease is meant to stay.
void Users::execute(User& user, LeaseToken token) {
  auto& random = world_.random();
  const bool leased = token != 0 && grants_.contains(token);
  const int axis = leased ? grants_.at(token).axes.lowest() : static_cast<int>(random.between(1, 3));
  ExecuteRequest request;
  if (leased && random.chance(0.7)) request.lines.push_back(fmt::format("D:{}S{}F4000R50", axis, random.between(1, 9)));
  if (!leased || random.chance(0.5)) {
    request.lines.push_back(fmt::format("A:{}+P{}", axis, random.between(0, 20'000)));
    request.lines.push_back(fmt::format("G:{}", axis));
  }
  const bool whole = leased && grants_.at(token).axes == kAllAxes;
  if (whole && random.chance(0.5)) request.lines.push_back(fmt::format("O:{}", random.between(1, 63)));
  if (whole && random.chance(0.5)) request.lines.push_back(fmt::format("T:P{}P{}", axis, random.between(2, 30'000)));
  if (request.lines.empty()) return;
  request.context = context(user, token);
  world_.controller().execute(std::move(request), world_.now(), [this](const ExecuteEvent& event) {
    counts_.executed += event.kind == ExecuteEvent::Kind::ended && !event.problem ? 1 : 0;
  });
}

// Renews jogs. Most users renew theirs, if not always in time; a few end the jog, a few fall silent.
void Users::keep_jogs() {
  auto& random = world_.random();
  for (User& user : users_) {
    if (user.jog == 0 || world_.now() < user.paused_until) continue;
    if (random.chance(0.05)) {
      user.jog = 0;
    } else if (random.chance(0.1)) {
      world_.controller().end_jog(std::exchange(user.jog, 0), {}, world_.now());
    } else {
      const std::vector<JogRequest::Axis> same;
      if (world_.controller().renew_jog(user.jog, same, world_.now())) renewed_[user.jog] = world_.now();
    }
  }
}

void Users::stop(User& user) {
  auto& random = world_.random();
  const AxisSet axes = random.chance(0.3) ? AxisSet() : drawn_axes(random);
  const AxisSet hit = axes.empty() ? kAllAxes : axes;
  const LeaseToken token = random.chance(0.5) ? user.token : 0;
  for (auto& [lease, grant] : grants_) {
    const bool held = owned(grant);
    if (!held || lease == token || !grant.axes.touches(hit)) continue;
    grant.latched = grant.latched | (grant.axes & hit);
    if (grant.who != user.name || !grant.latched_by_others.empty()) grant.latched_by_others = grant.latched;
  }
  for (const Motion& motion : world_.controller().motions()) {
    const bool runs = motion.state == MotionState::running || motion.state == MotionState::stopping;
    if (!runs || motion.who == user.name || leases_of_[motion.id] != 0 || !motion.axes.touches(hit)) continue;
    held_back_[motion.who] = held_back_[motion.who] | (motion.axes & hit);
    ++counts_.latched;
  }
  world_.controller().stop(axes, context(user, token), world_.now(), [](const StopReport&) {});
}

void Users::rearm(User& user) {
  leases_.rearm(user.token, user.name, world_.now());
  held_back_.erase(user.name);
  for (auto& [lease, grant] : grants_) {
    if (grant.who == user.name) grant.latched = grant.latched_by_others = {};
  }
}

// Reports whether a grant is in force. The first epoch ends no grant, because it is that of the first handshake.
bool Users::owned(const Grant& grant) {
  const auto epoch = world_.controller().state().device_epoch;
  return !grant.over && world_.now() < grant.valid_until && (grant.epoch == epoch || grant.epoch + epoch == 1);
}

const Users::Grant* Users::owner_of(int axis) {
  for (const auto& [token, grant] : grants_) {
    if (grant.axes.has(axis) && owned(grant)) return &grant;
  }
  return nullptr;
}

void Users::on_news(const Event& event) {
  if (const auto* written = std::get_if<BytesWritten>(&event)) check_bytes(*written);
  const auto* changed = std::get_if<MotionChanged>(&event);
  if (changed && changed->motion.state == MotionState::queued) leases_of_[changed->motion.id] = asking_;
}

}  // namespace axisgate::simulation
