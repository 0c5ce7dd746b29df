// Tests of each kind of request x role x lease x latch x quota x validate_only x deadline. The expected results are
// typed from the rules in server/api/README.md, not read from the table in the code.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "tests/api/ask.h"

namespace axisgate::api {
namespace {

using Kind = RequestKind;
using server::Role;

constexpr Reason kDone = Reason::unspecified;

// Effect of the right to axes on a kind of request, for a rotor.
enum class Asks {
  nothing,      // leases have no effect
  refused,      // starts a motion that a rotor cannot do, which is refused before rights are checked
  axes,         // starts a motion: refused without the right, except with validate_only
  axes_always,  // likewise, also with validate_only
  lease,        // concerns a lease: the caller needs one
  free_axes,    // acquires a lease, if no caller has one
};

struct Row {
  Kind kind;
  const char* name;
  Role least;
  const char* counted;  // "", "request" or "stream"
  Asks asks;
  Reason otherwise = kDone;     // result if no rule refuses it
  Reason only_checked = kDone;  // result with validate_only
};

// README, "The rules". A rotor refuses requests that it does not support (tests/double).
const std::vector<Row> kRows = {
    {Kind::get_caller, "get_caller", Role::observer, "request", Asks::nothing},
    {Kind::create_token, "create_token", Role::admin, "request", Asks::nothing},
    {Kind::list_tokens, "list_tokens", Role::admin, "request", Asks::nothing},
    {Kind::revoke_token, "revoke_token", Role::admin, "request", Asks::nothing, Reason::not_found, Reason::not_found},
    {Kind::list_commands, "list_commands", Role::observer, "request", Asks::nothing},
    {Kind::execute, "execute", Role::operator_, "stream", Asks::nothing, Reason::not_allowed, Reason::not_allowed},
    {Kind::acquire_lease, "acquire_lease", Role::operator_, "request", Asks::free_axes},
    {Kind::keep_lease_alive, "keep_lease_alive", Role::operator_, "stream", Asks::lease},
    {Kind::renew_lease, "renew_lease", Role::operator_, "request", Asks::lease},
    {Kind::release_lease, "release_lease", Role::operator_, "request", Asks::lease},
    {Kind::hand_over_lease, "hand_over_lease", Role::operator_, "request", Asks::lease, Reason::not_found},
    {Kind::take_over_lease, "take_over_lease", Role::operator_, "request", Asks::nothing},
    {Kind::watch_leases, "watch_leases", Role::observer, "stream", Asks::nothing},
    {Kind::rearm, "rearm", Role::operator_, "request", Asks::nothing},
    {Kind::list_devices, "list_devices", Role::observer, "", Asks::nothing},
    {Kind::get_device, "get_device", Role::observer, "request", Asks::nothing},
    {Kind::watch_device, "watch_device", Role::observer, "stream", Asks::nothing},
    {Kind::clear_errors, "clear_errors", Role::operator_, "request", Asks::nothing, Reason::not_allowed},
    {Kind::withdraw_stop, "withdraw_stop", Role::admin, "request", Asks::nothing, Reason::not_found, Reason::not_found},
    {Kind::record, "record", Role::observer, "stream", Asks::nothing},
    {Kind::get_support_report, "get_support_report", Role::observer, "stream", Asks::nothing},
    {Kind::watch_events, "watch_events", Role::observer, "stream", Asks::nothing},
    {Kind::list_history, "list_history", Role::observer, "request", Asks::nothing, Reason::journal_unavailable,
     Reason::journal_unavailable},
    {Kind::summarize_history, "summarize_history", Role::observer, "request", Asks::nothing,
     Reason::journal_unavailable, Reason::journal_unavailable},
    {Kind::verify_journal, "verify_journal", Role::observer, "request", Asks::nothing, Reason::journal_unavailable,
     Reason::journal_unavailable},
    {Kind::erase_person, "erase_person", Role::admin, "request", Asks::nothing, Reason::journal_unavailable,
     Reason::journal_unavailable},
    {Kind::save_position, "save_position", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::list_positions, "list_positions", Role::observer, "request", Asks::nothing},
    {Kind::delete_position, "delete_position", Role::operator_, "request", Asks::axes_always},
    {Kind::move_to_position, "move_to_position", Role::operator_, "request", Asks::refused, Reason::not_allowed,
     Reason::not_allowed},
    {Kind::get_settings, "get_settings", Role::observer, "request", Asks::nothing},
    {Kind::change_settings, "change_settings", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::set_coordinates, "set_coordinates", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::fire_trigger, "fire_trigger", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::reset_device, "reset_device", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::operate_simulator, "operate_simulator", Role::operator_, "request", Asks::nothing},
    {Kind::move, "move", Role::operator_, "request", Asks::axes},
    {Kind::home, "home", Role::operator_, "request", Asks::axes},
    {Kind::return_to_origin, "return_to_origin", Role::operator_, "request", Asks::axes},
    {Kind::run_path, "run_path", Role::operator_, "stream", Asks::refused, Reason::not_allowed, Reason::not_allowed},
    {Kind::start_path, "start_path", Role::operator_, "stream", Asks::refused, Reason::not_allowed,
     Reason::not_allowed},
    {Kind::scan, "scan", Role::operator_, "request", Asks::refused, Reason::not_allowed, Reason::not_allowed},
    {Kind::jog, "jog", Role::operator_, "stream", Asks::axes},
    {Kind::start_jog, "start_jog", Role::operator_, "stream", Asks::axes},
    {Kind::keep_jog, "keep_jog", Role::operator_, "request", Asks::nothing, Reason::not_found, Reason::not_found},
    {Kind::stop_jog, "stop_jog", Role::operator_, "request", Asks::nothing, Reason::not_found, Reason::not_found},
    {Kind::stop, "stop", Role::observer, "", Asks::nothing},
    {Kind::emergency_stop, "emergency_stop", Role::observer, "", Asks::nothing},
    {Kind::get_motion, "get_motion", Role::observer, "request", Asks::nothing, Reason::not_found, Reason::not_found},
    {Kind::list_motions, "list_motions", Role::observer, "request", Asks::nothing},
    {Kind::watch_motion, "watch_motion", Role::observer, "stream", Asks::nothing, Reason::not_found, Reason::not_found},
    {Kind::wait_motion, "wait_motion", Role::observer, "stream", Asks::nothing, Reason::not_found, Reason::not_found},
    {Kind::cancel_motion, "cancel_motion", Role::operator_, "request", Asks::nothing, Reason::not_found,
     Reason::not_found},
    // Requests for mills are refused, because the device is not a mill.
    {Kind::send_job, "send_job", Role::operator_, "stream", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::send_job_piece, "send_job_piece", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::repeat_job, "repeat_job", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::get_mill, "get_mill", Role::observer, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::watch_mill, "watch_mill", Role::observer, "stream", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::confirm_job, "confirm_job", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::start_job, "start_job", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::pause_job, "pause_job", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::resume_job, "resume_job", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::continue_job, "continue_job", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::abort_job, "abort_job", Role::observer, "", Asks::nothing, Reason::invalid_request, Reason::invalid_request},
    {Kind::cancel_job, "cancel_job", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::cancel_jobs, "cancel_jobs", Role::admin, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::move_job, "move_job", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::report_job_done, "report_job_done", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
    {Kind::operate_mill, "operate_mill", Role::operator_, "request", Asks::nothing, Reason::invalid_request,
     Reason::invalid_request},
};

// Requests to the door itself, without a device.
const std::vector<Row> kOfDoors = {
    {Kind::ask_server, "ask_server", Role::observer, "request", Asks::nothing},
    {Kind::watch_server, "watch_server", Role::observer, "stream", Asks::nothing},
    {Kind::unlisted, "unlisted", Role::admin, "request", Asks::nothing},
};

std::vector<Row> all_rows() {
  std::vector<Row> all = kRows;
  all.insert(all.end(), kOfDoors.begin(), kOfDoors.end());
  return all;
}

TEST(Matrix, EveryKindHasARow) { EXPECT_EQ(all_rows().size(), kRequestKinds); }

struct Somebody {
  Role role;
  Credential credential;
};
const std::array<Somebody, 4> kSomebody = {{{Role::nobody, {.who = "somebody far away", .needs_token = true}},
                                            {Role::observer, {.who = "unix olaf"}},
                                            {Role::operator_, {.who = kAnna}},
                                            {Role::admin, {.who = kAdmin}}}};

Reason by_role(const Row& row, Role role) {
  if (role == Role::nobody) return Reason::unauthenticated;
  return role < row.least ? Reason::not_allowed : kDone;
}

Reason let_in(const World& world, const Row& row, const Credential& credential) {
  const auto caller = world.api->admission.let_in(row.kind, credential, row.name);
  return caller ? kDone : caller.error().reason;
}

// At admission the role is checked first, then the quota.
TEST(Matrix, RoleAndQuotaAtTheGate) {
  World world([](World& configured) {
    configured.limits.calls = 1;
    configured.limits.streams = 1;
    configured.access_config.admin_commands = {};
  });
  for (const std::string taken : {"", "request", "stream"}) {
    for (const Somebody& one : kSomebody) {
      const Kind kind = taken == "stream" ? Kind::watch_device : taken == "request" ? Kind::get_device : Kind::stop;
      const Admission::Place place = world.api->admission.take_place(kind, one.credential.who);
      for (const Row& row : all_rows()) {
        const Reason allowed = by_role(row, one.role);
        const bool full = !taken.empty() && taken == row.counted;
        EXPECT_EQ(let_in(world, row, one.credential), allowed != kDone ? allowed
                                                      : full           ? Reason::queue_full
                                                                       : kDone)
            << row.name << " by " << one.credential.who << ", taken: " << taken;
      }
    }
  }
}

// A returned place is free again, and the quota of one caller does not affect other callers.
TEST(Matrix, QuotaIsOfOneCallerAndIsGivenBack) {
  World world([](World& configured) { configured.limits.calls = 1; });
  Admission& admission = world.api->admission;
  Admission::Place place = admission.take_place(Kind::move, kAnna);
  EXPECT_FALSE(admission.let_in(Kind::home, {.who = kAnna}, "Home"));
  EXPECT_TRUE(admission.let_in(Kind::home, {.who = kAdmin}, "Home"));
  place.reset();
  EXPECT_TRUE(admission.let_in(Kind::home, {.who = kAnna}, "Home"));
  EXPECT_EQ(admission.take_place(Kind::stop, kAnna), nullptr);
  EXPECT_EQ(admission.take_place(Kind::list_devices, kAnna), nullptr);
}

// `admin_commands` in the configuration keeps exactly three kinds from operators.
TEST(Matrix, WhatTheConfigurationKeepsForAdministrators) {
  World kept;
  World given([](World& configured) { configured.access_config.admin_commands = {}; });
  for (const Row& row : kRows) {
    const bool special =
        row.kind == Kind::clear_errors || row.kind == Kind::reset_device || row.kind == Kind::take_over_lease;
    const Reason ordinary = by_role(row, Role::operator_);
    EXPECT_EQ(let_in(kept, row, {.who = kAnna}), special ? Reason::not_allowed : ordinary) << row.name;
    EXPECT_EQ(let_in(given, row, {.who = kAnna}), ordinary) << row.name;
  }
}

// After admission the role is checked again, for all requests but a stop.
TEST(Matrix, RoleBehindTheGate) {
  World world([](World& configured) { configured.access_config.admin_commands = {}; });
  save_position(world);
  for (const Row& row : kRows) {
    const bool stop = row.kind == Kind::stop || row.kind == Kind::emergency_stop;
    for (const Somebody& one : kSomebody) {
      const Reason expected = stop ? kDone : by_role(row, one.role);
      if (expected == kDone && !stop) continue;  // asked below
      EXPECT_EQ(ask(world, row.kind, {.credential = one.credential}), expected)
          << row.name << " by " << one.credential.who;
    }
  }
}

enum class Lease { none, own, of_another, lost };
constexpr std::array<Lease, 4> kLeases = {Lease::none, Lease::own, Lease::of_another, Lease::lost};
constexpr std::array<const char*, 4> kLeaseNames = {"no lease", "own lease", "another's lease", "lost lease"};

struct Circumstances {
  Lease lease = Lease::none;
  bool latched = false, validate_only = false, late = false;

  std::string text() const {
    return std::string(kLeaseNames[static_cast<std::size_t>(lease)]) + (latched ? ", latched" : "") +
           (validate_only ? ", validate_only" : "") + (late ? ", deadline passed" : "");
  }
};

std::vector<Circumstances> all_circumstances() {
  std::vector<Circumstances> all;
  for (const Lease lease : kLeases) {
    for (const bool latched : {false, true}) {
      for (const bool validate_only : {false, true}) {
        for (const bool late : {false, true}) all.push_back({lease, latched, validate_only, late});
      }
    }
  }
  return all;
}

// README, "Lease, latch and deadline": the latch is checked before the lease.
Reason by_right(const Circumstances& now) {
  if (now.latched) return Reason::stopped_by;
  if (now.lease == Lease::of_another) return Reason::lease_held;
  if (now.lease == Lease::lost) return Reason::lease_lost;
  return kDone;
}

Reason expected(const Row& row, const Circumstances& now) {
  const bool has_own = now.lease == Lease::own;
  switch (row.asks) {
    case Asks::nothing:
      return now.validate_only ? row.only_checked : row.otherwise;
    case Asks::refused:
      return now.validate_only ? row.only_checked : now.late ? Reason::deadline_passed : row.otherwise;
    case Asks::axes: {
      if (now.validate_only && row.kind != Kind::jog && row.kind != Kind::start_jog)
        return kDone;  // they have no validate_only
      return now.late ? Reason::deadline_passed : by_right(now);
    }
    case Asks::axes_always:
      return by_right(now);
    case Asks::lease:
      return has_own ? row.otherwise : Reason::lease_lost;
    case Asks::free_axes:
      return now.validate_only || (now.lease != Lease::own && now.lease != Lease::of_another) ? kDone
                                                                                              : Reason::lease_held;
  }
  return Reason::internal;
}

// Rights creates and undoes the circumstances of a request. The caller is an administrator, so that no role refuses it.
class Rights {
 public:
  explicit Rights(World& world) : world_(world) {}

  Call arrange(const Circumstances& now) {
    save_position(world_);
    Call call = World::by(kAdmin);
    call.validate_only = now.validate_only;
    if (now.late) call.not_after = monotonic_now() - std::chrono::milliseconds(1);
    if (now.lease == Lease::own) call.lease_token = world_.sealed(world_.lease_of(kAdmin));
    if (now.lease == Lease::of_another) (void)world_.lease_of("unix eve");
    if (now.lease == Lease::lost) call.lease_token = world_.sealed(7);
    if (now.latched) world_.latch(kAdmin);
    return call;
  }

  void undo() {
    world_.on_strand([this](stage::StageController&, TimePoint now) {
      server::Leases& leases = world_.device().leases();
      (void)leases.rearm(0, kAdmin, now);
      for (const server::Lease& lease : leases.held()) (void)leases.release(lease.token, now);
    });
    const server::Calendar now = server::calendar_now();
    (void)world_.access->tokens().revoke("made", now);
    EXPECT_TRUE(comes_true([this] {
      bool free = false;
      world_.on_strand([&](stage::StageController&, TimePoint) { free = world_.device().leases().held().empty(); });
      return free;
    }));
  }

 private:
  World& world_;
};

class MatrixOfRights : public ::testing::TestWithParam<std::size_t> {};

TEST_P(MatrixOfRights, LeaseLatchValidateOnlyAndDeadline) {
  const Row& row = kRows[GetParam()];
  World world;
  Rights rights(world);
  for (const Circumstances& now : all_circumstances()) {
    const Call call = rights.arrange(now);
    EXPECT_EQ(name(ask(world, row.kind, call)), name(expected(row, now))) << row.name << ": " << now.text();
    rights.undo();
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, MatrixOfRights, ::testing::Range(std::size_t{0}, kRows.size()),
                         [](const auto& row) { return std::string(kRows[row.param].name); });

}  // namespace
}  // namespace axisgate::api
