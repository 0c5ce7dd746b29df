#include "tests/simulation/retries.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "server/api/request/motion_watch.h"
#include "server/api/request/pipeline.h"
#include "server/journal/answers.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using api::RequestKind;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::int64_t kShort = 500, kLong = 20'000;  // pulses; the number of the displacement is added
constexpr std::size_t kRetried = 5;                   // number of a user's newest requests
constexpr int kLinesBetweenKillsMin = 30, kLinesBetweenKillsMax = 400, kLinesOfHangMax = 20;

Setup setup_of(std::uint64_t seed, const Faults& faults, Permission& permission) {
  Setup setup = drawn_setup(seed, faults);
  setup.permission = &permission;
  return setup;
}

}  // namespace

Retries::Retries(std::uint64_t seed, const RetryTerms& terms)
    : terms_(terms),
      daemon_(std::make_unique<Daemon>(folder_, terms.bounds, run_)),
      world_(setup_of(seed, terms.faults, daemon_->leases())) {
  for (int i = 0; i < kUsers; ++i) users_.push_back({fmt::format("user-{}", i)});
  world_.on_news = [this](const Event& event) { on_news(event); };
  daemon_->prepare(world_.controller(), world_.now());
  plan_kill();
}

std::string Retries::Wanted::digest() const {
  std::string text(api::name(kind));
  for (const auto& [axis, way] : ways) text += fmt::format(" {}:{}", axis, way);
  return text;
}

void Retries::act_for(Duration duration) {
  const TimePoint end = world_.now() + duration;
  while (world_.now() < end && world_.violations().empty()) {
    world_.run_for(milliseconds(world_.random().between(1, 300)));
    act(users_[static_cast<std::size_t>(world_.random().between(0, kUsers - 1))]);
  }
}

void Retries::become_stationary() {
  world_.set_faults(Faults::none());
  while (daemon_->disk_hangs()) kill();
  const auto stationary = [this] {
    const auto motions = world_.controller().motions();
    return world_.controller().state().link == LinkState::up &&
           std::ranges::all_of(motions, [](const Motion& motion) { return is_outcome(motion.state); });
  };
  lines_to_hang_ = lines_to_kill_ = 0;
  world_.run_for(seconds(8));  // messages in transit to the daemon arrive, and their time passes
  if (!world_.run_until(stationary, seconds(120))) {
    // A wrong bit may have changed a speed into a slower valid one: an axis that really moves is no fault.
    if (!anything_moves()) world_.violation("two quiet minutes after the last request a motion is still unfinished");
    return;
  }
  check_received();
  check_journal();
  check_requests_on_file();
}

void Retries::act(User& user) {
  switch (world_.random().between(0, 15)) {
    case 0:
    case 1:
    case 2:
    case 3:
      return request_newly(user);
    case 4:
      return duplicate(user);
    case 5:
      return reuse(user);
    case 6:
    case 7:
      return use_leases(user);
    case 8:
      if (world_.random().chance(0.3)) {
        world_.controller().stop({}, world_.context(user.name), world_.now(), [](const StopReport&) {});
        daemon_->leases().rearm(0, user.name, world_.now());
      }
      return;
    default:
      return retry(user);
  }
}

Retries::Wanted Retries::drawn_request(const User& user) {
  using enum RequestKind;
  auto& random = world_.random();
  Wanted wanted{user.name, fmt::format("request-{}", last_way_), {}};
  wanted.kind = random.pick(std::vector{move, move, move, home, return_to_origin, run_path, jog, execute});
  if (terms_.marks) wanted.mark = daemon_->requests().mark();
  const bool has_way = wanted.kind != home && wanted.kind != return_to_origin && wanted.kind != jog;
  const std::int64_t stretches = wanted.kind == run_path ? random.between(2, 4) : 1;
  const std::int64_t least = stretches == 1 && random.chance(0.3) ? kLong : kShort;
  const int axis = static_cast<int>(random.between(1, 3));
  const std::int64_t direction = random.chance(0.5) ? 1 : -1;
  for (std::int64_t i = 0; i < stretches; ++i) {
    wanted.ways.emplace_back(axis, has_way ? direction * (least + ++last_way_) : 0);
  }
  if (wanted.kind == move && random.chance(0.3)) wanted.ways.emplace_back(axis % 3 + 1, -(least + ++last_way_));
  ++last_way_;
  return wanted;
}

void Retries::request_newly(User& user) {
  user.wanted.push_back(drawn_request(user));
  if (user.wanted.size() > kRetried) user.wanted.erase(user.wanted.begin());
  ++counts_.requested;
  send(user, user.wanted.back(), drawn_delay());
}

void Retries::retry(User& user) {
  if (!user.wanted.empty()) send(user, world_.random().pick(user.wanted), drawn_delay());
}

void Retries::duplicate(User& user) {
  request_newly(user);
  ++counts_.duplicated;
  for (int i = 0; i < 3; ++i) send(user, user.wanted.back(), milliseconds(world_.random().between(0, 40)));
}

// Sends another request under the same id.
void Retries::reuse(User& user) {
  if (user.wanted.empty()) return;
  Wanted other = drawn_request(user);
  other.id = world_.random().pick(user.wanted).id;
  send(user, other, drawn_delay());
}

// Acquires a lease, or lets go of the one held. A crash forgets the lease, and its token is used again later, like that
// of an expired lease.
void Retries::use_leases(User& user) {
  auto& random = world_.random();
  if (user.lease.token != 0) {
    user.old_leases.push_back(std::exchange(user.lease, {}));
    if (random.chance(0.5)) (void)daemon_->leases().release(user.old_leases.back().token, world_.now());
    return;
  }
  server::LeaseTerms terms;
  terms.scope = AxisSet::of(static_cast<int>(random.between(1, 3)));
  terms.time_to_live = seconds(random.between(1, 6));
  daemon_->leases().acquire(terms, user.name, false, world_.now(), world_.now(),
                            [this, &user](const Result<server::Lease>& lease) {
                              if (lease) user.lease = {lease->token, run_};
                            });
}

Retries::Granted Retries::drawn_lease(const User& user) {
  auto& random = world_.random();
  if (!user.old_leases.empty() && random.chance(0.15)) return random.pick(user.old_leases);
  return random.chance(0.3) ? Granted() : user.lease;
}

Duration Retries::drawn_delay() {
  auto& random = world_.random();
  return milliseconds(random.chance(0.15) ? random.between(50, 7000) : random.between(0, 30));
}

// Runs an operation after a delay, unless the daemon is killed before.
void Retries::later(Duration delay, std::function<void()> deed) {
  world_.at(world_.now() + delay, [this, run = run_, deed = std::move(deed)] {
    if (run == run_) deed();
  });
}

void Retries::send(const User& user, const Wanted& wanted, Duration delay) {
  auto& random = world_.random();
  auto message = std::make_shared<Message>(Message{wanted, world_.context(user.name, seconds(random.between(1, 5)))});
  message->context.request_id = wanted.id;
  const Granted lease = drawn_lease(user);
  message->context.lease = lease.token;
  message->outdated = lease.token != 0 && lease.run != run_;
  message->sequence = ++last_sequence_;
  if (random.chance(0.2)) message->context.device_epoch = world_.controller().state().device_epoch;
  later(delay, [this, message] { arrive(message); });
}

// Handles a message like api::Pipeline::act(). The journal's disk takes a while, and the controller checks the right to
// move.
void Retries::arrive(const MessagePtr& message) {
  const Wanted& wanted = message->wanted;
  Acted& acted = acted_[wanted.key()];
  counts_.reordered += message->sequence < acted.newest ? 1 : 0;
  acted.newest = std::max(acted.newest, message->sequence);
  const auto known = [this, message](const Result<Known>& what) {
    later({}, [this, message, what] { repeat(message, what); });
  };
  const auto begun = daemon_->requests().begin({.identity = wanted.who,
                                                .id = wanted.id,
                                                .digest = wanted.digest(),
                                                .device = kDevice,
                                                .moves = wanted.kind != RequestKind::execute},
                                               wanted.mark, world_.now(), known);
  if (!begun) return count(begun.error());
  if (!*begun) return;
  const auto mutation = std::make_shared<Mutation>(*daemon_, **begun);
  const Result<void> kept = mutation->intend(world_.now());
  const Duration waits = kept ? milliseconds(world_.random().between(0, 60)) : server::kCommitHangs;
  later(waits, [this, message, mutation, kept] {
    if (!kept) return refuse(message, *mutation, kept.error());
    const auto in_time = api::check_deadline(message->wanted.kind, message->context, world_.now());
    in_time ? begin(message, mutation) : refuse(message, *mutation, in_time.error());
  });
}

void Retries::begin(const MessagePtr& message, const std::shared_ptr<Mutation>& mutation) {
  const Wanted& wanted = message->wanted;
  const RequestContext& context = message->context;
  const auto started = [this, message, mutation](const Result<Motion>& motion) {
    if (!motion) return refuse(message, *mutation, motion.error());
    mutation->acted({});
    answered(message->wanted, motion->id, false);
  };
  const AxisSet axis = AxisSet::of(wanted.ways.front().first);
  asking_ = message;
  switch (wanted.kind) {
    case RequestKind::home:
      world_.controller().home({axis, context}, world_.now(), started);
      break;
    case RequestKind::return_to_origin:
      world_.controller().return_to_origin({axis, context}, world_.now(), started);
      break;
    case RequestKind::jog:
      // No caller renews it, so it ends without a request.
      world_.controller().jog({{{axis.lowest(), 1, pulses(1000)}}, context}, world_.now(), started);
      break;
    case RequestKind::run_path: {
      PathRequest path;
      path.context = context;
      for (const auto& [number, way] : wanted.ways)
        path.segments.push_back({{{number, pulses(way), {}}}, true, pulses(5000), {}});
      world_.controller().run_path(std::move(path), world_.now(), started);
      break;
    }
    case RequestKind::execute:
      execute(message, mutation);
      break;
    default: {
      MoveRequest move{{}, true, context};
      for (const auto& [number, way] : wanted.ways) move.moves.push_back({number, pulses(way), {}});
      world_.controller().move(std::move(move), world_.now(), started);
    }
  }
  asking_ = nullptr;
}

// Executes a transaction like Execution::remember() in server/api/stage/commands.cc.
void Retries::execute(const MessagePtr& message, const std::shared_ptr<Mutation>& mutation) {
  const auto& [axis, way] = message->wanted.ways.front();
  ExecuteRequest request{
      {fmt::format("M:{}{}P{}", axis, way < 0 ? '-' : '+', std::abs(way)), fmt::format("G:{}", axis)},
      message->context};
  const auto events = std::make_shared<std::vector<ExecuteEvent>>();
  world_.controller().execute(std::move(request), world_.now(), [=, this](const ExecuteEvent& event) {
    events->push_back(event);
    if (event.kind != ExecuteEvent::Kind::ended) return;
    if (event.problem && events->size() == 1) return refuse(message, *mutation, *event.problem);
    ++counts_.executed;
    mutation->acted(server::journal::answer_of(*events));
    check_answer(message->wanted, server::journal::answer_of(*events));
  });
}

// Answers a repeat like repeat_motion() in server/api/request/repeats.cc, and Execution::repeat().
void Retries::repeat(const MessagePtr& message, const Result<Known>& known) {
  if (!known) return count(known.error());
  ++counts_.repeated;
  if (message->wanted.kind == RequestKind::execute) return check_answer(message->wanted, known->answer);
  const auto motion = api::motion_of(*known, world_.controller());
  if (motion) return answered(message->wanted, motion->id, true);
  world_.violation(
      fmt::format("{} of {} was repeated, and {}", message->wanted.id, message->wanted.who, motion.error().message));
}

void Retries::refuse(const MessagePtr& message, Mutation& mutation, const Problem& problem) {
  count(problem);
  const bool is_free = mutation.failed(problem);
  if (!is_free || acted_[message->wanted.key()].written.empty()) return;
  world_.violation(fmt::format("{} of {} is free again after {}, and a line of it was written", message->wanted.id,
                               message->wanted.who, name(problem.reason)));
}

void Retries::count(const Problem& problem) {
  counts_.reused += problem.reason == Reason::request_id_reused ? 1 : 0;
  counts_.stale += problem.reason == Reason::lease_lost ? 1 : 0;
  counts_.late += problem.reason == Reason::deadline_passed ? 1 : 0;
  counts_.refused_by_disk += problem.reason == Reason::journal_unavailable ? 1 : 0;
}

bool Retries::anything_moves() {
  return std::ranges::any_of(std::array{1, 2, 3}, [this](int axis) { return world_.device().busy(axis); });
}

void Retries::plan_kill() {
  if (!terms_.kills) return;
  auto& random = world_.random();
  lines_to_kill_ = static_cast<int>(random.between(kLinesBetweenKillsMin, kLinesBetweenKillsMax));
  lines_to_hang_ = random.chance(0.5) ? lines_to_kill_ - static_cast<int>(random.between(1, kLinesOfHangMax)) : 0;
}

void Retries::come_closer_to_kill() {
  if (lines_to_hang_ > 0 && --lines_to_hang_ == 0) {
    ++counts_.hangs;
    daemon_->let_disk_hang();
  }
  if (lines_to_kill_ == 0 || --lines_to_kill_ > 0) return;
  // The kill comes before, within or after this line.
  later(milliseconds(world_.random().between(0, 6)), [this] { kill(); });
}

void Retries::kill() {
  auto& random = world_.random();
  ++counts_.kills;
  counts_.kills_in_motion += anything_moves() ? 1 : 0;
  for (auto& [id, facts] : motions_) facts.may_lack_rows = facts.may_lack_rows || !facts.outcome;
  ++run_;
  for (User& user : users_) {
    if (user.lease.token != 0) user.old_leases.push_back(std::exchange(user.lease, {}));
  }
  const bool disk_still_hangs = random.chance(0.2);
  world_.restart_gateway({.start = [this]() -> Permission& {
                            const bool lost = daemon_->disk_hangs();
                            daemon_.reset();
                            if (lost) folder_.put_journal_back();
                            daemon_ = std::make_unique<Daemon>(folder_, terms_.bounds, run_);
                            return daemon_->leases();
                          },
                          .prepare =
                              [&](Controller& controller) {
                                if (disk_still_hangs) daemon_->let_disk_hang();
                                daemon_->prepare(controller, world_.now());
                              },
                          .away = milliseconds(random.between(0, 2000)),
                          .written_is_lost = random.chance(0.3)});
  plan_kill();
  if (!disk_still_hangs) return;
  lines_to_hang_ = 0;
  lines_to_kill_ = static_cast<int>(random.between(1, kLinesBetweenKillsMin));
}

}  // namespace axisgate::simulation
