#include "server/api/request_kinds.h"

#include <array>

namespace axisgate::api {
namespace {

using server::Role;
using Kept = server::KeptRequest;
using Kind = RequestKind;

// clang-format off
constexpr std::array<Rule, kRequestKinds> kRules = {{
    // kind                    least role       kept                quota           patience            use             audited
    {Kind::get_caller,         Role::observer,  Kept::none,         Quota::request, Patience::question, Use::nothing,   false},
    {Kind::create_token,       Role::admin,     Kept::none,         Quota::request, Patience::question, Use::nothing,   true},
    {Kind::list_tokens,        Role::admin,     Kept::none,         Quota::request, Patience::question, Use::nothing,   false},
    {Kind::revoke_token,       Role::admin,     Kept::none,         Quota::request, Patience::question, Use::nothing,   true},
    {Kind::list_commands,      Role::observer,  Kept::none,         Quota::request, Patience::question, Use::nothing,   false},
    {Kind::execute,            Role::operator_, Kept::none,         Quota::stream,  Patience::change,   Use::axes,      true},
    {Kind::acquire_lease,      Role::operator_, Kept::none,         Quota::request, Patience::change,   Use::nothing,   false},
    {Kind::keep_lease_alive,   Role::operator_, Kept::none,         Quota::stream,  Patience::question, Use::nothing,   false},
    {Kind::release_lease,      Role::operator_, Kept::none,         Quota::request, Patience::question, Use::lease,     false},
    {Kind::hand_over_lease,    Role::operator_, Kept::none,         Quota::request, Patience::question, Use::lease,     false},
    {Kind::take_over_lease,    Role::operator_, Kept::take_over,    Quota::request, Patience::change,   Use::nothing,   false},
    {Kind::watch_leases,       Role::observer,  Kept::none,         Quota::stream,  Patience::question, Use::nothing,   false},
    {Kind::rearm,              Role::operator_, Kept::none,         Quota::request, Patience::change,   Use::lease,     false},
    {Kind::list_devices,       Role::observer,  Kept::none,         Quota::none,    Patience::question, Use::nothing,   false},
    {Kind::get_device,         Role::observer,  Kept::none,         Quota::request, Patience::question, Use::nothing,   false},
    {Kind::watch_device,       Role::observer,  Kept::none,         Quota::stream,  Patience::question, Use::nothing,   false},
    {Kind::clear_errors,       Role::operator_, Kept::clear_errors, Quota::request, Patience::change,   Use::axes,      true},
    {Kind::record,             Role::observer,  Kept::none,         Quota::stream,  Patience::question, Use::nothing,   false},
    {Kind::get_support_report, Role::observer,  Kept::none,         Quota::stream,  Patience::question, Use::nothing,   false},
    {Kind::watch_events,       Role::observer,  Kept::none,         Quota::stream,  Patience::question, Use::nothing,   false},
    {Kind::list_history,       Role::observer,  Kept::none,         Quota::request, Patience::question, Use::nothing,   false},
    {Kind::verify_journal,     Role::observer,  Kept::none,         Quota::request, Patience::question, Use::nothing,   false},
    {Kind::save_position,      Role::operator_, Kept::none,         Quota::request, Patience::change,   Use::axes,      true},
    {Kind::list_positions,     Role::observer,  Kept::none,         Quota::request, Patience::question, Use::nothing,   false},
    {Kind::delete_position,    Role::operator_, Kept::none,         Quota::request, Patience::change,   Use::all_axes,  true},
    {Kind::move_to_position,   Role::operator_, Kept::none,         Quota::request, Patience::motion,   Use::axes,      true},
    {Kind::get_settings,       Role::observer,  Kept::none,         Quota::request, Patience::question, Use::nothing,   false},
    {Kind::change_settings,    Role::operator_, Kept::none,         Quota::request, Patience::change,   Use::axes,      true},
    {Kind::set_coordinates,    Role::operator_, Kept::none,         Quota::request, Patience::change,   Use::axes,      true},
    {Kind::fire_trigger,       Role::operator_, Kept::none,         Quota::request, Patience::change,   Use::axes,      true},
    {Kind::reset_device,       Role::operator_, Kept::reset_device, Quota::request, Patience::change,   Use::axes,      true},
    {Kind::operate_simulator,  Role::operator_, Kept::none,         Quota::request, Patience::question, Use::nothing,   false},
    {Kind::move,               Role::operator_, Kept::none,         Quota::request, Patience::motion,   Use::axes,      true},
    {Kind::home,               Role::operator_, Kept::none,         Quota::request, Patience::motion,   Use::axes,      true},
    {Kind::return_to_origin,   Role::operator_, Kept::none,         Quota::request, Patience::motion,   Use::axes,      true},
    {Kind::run_path,           Role::operator_, Kept::none,         Quota::path,    Patience::motion,   Use::axes,      true},
    {Kind::scan,               Role::operator_, Kept::none,         Quota::request, Patience::motion,   Use::axes,      true},
    {Kind::jog,                Role::operator_, Kept::none,         Quota::stream,  Patience::motion,   Use::axes,      true},
    {Kind::stop,               Role::observer,  Kept::none,         Quota::none,    Patience::stop,     Use::nothing,   false},
    {Kind::emergency_stop,     Role::observer,  Kept::none,         Quota::none,    Patience::stop,     Use::nothing,   false},
    {Kind::get_motion,         Role::observer,  Kept::none,         Quota::request, Patience::question, Use::nothing,   false},
    {Kind::list_motions,       Role::observer,  Kept::none,         Quota::request, Patience::question, Use::nothing,   false},
    {Kind::watch_motion,       Role::observer,  Kept::none,         Quota::outcome, Patience::question, Use::nothing,   false},
    {Kind::cancel_motion,      Role::operator_, Kept::none,         Quota::request, Patience::stop,     Use::nothing,   false},
    {Kind::ask_door,           Role::observer,  Kept::none,         Quota::request, Patience::question, Use::nothing,   false},
    {Kind::watch_door,         Role::observer,  Kept::none,         Quota::stream,  Patience::question, Use::nothing,   false},
    {Kind::unlisted,           Role::admin,     Kept::none,         Quota::request, Patience::question, Use::nothing,   false},
}};
// clang-format on

// rule_of() finds a row by its number.
constexpr bool in_order() {
  for (std::size_t i = 0; i < kRules.size(); ++i) {
    if (kRules[i].kind != static_cast<Kind>(i)) return false;
  }
  return true;
}
static_assert(in_order());

}  // namespace

const Rule& rule_of(RequestKind kind) { return kRules[static_cast<std::size_t>(kind)]; }

}  // namespace axisgate::api
