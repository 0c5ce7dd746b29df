#include "server/api/request/request_kinds.h"

#include <array>

namespace axisgate::api {
namespace {

using server::Role;
using Key = server::AdminKey;
using Kind = RequestKind;

// clang-format off
constexpr std::array<Rule, kRequestKinds> kRules = {{
    // kind                    name                  least role       admin key           quota           deadline            use             audited
    {Kind::get_caller,         "get caller",           Role::observer,  Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
    {Kind::create_token,       "create token",         Role::admin,     Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   true},
    {Kind::list_tokens,        "list tokens",          Role::admin,     Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
    {Kind::revoke_token,       "revoke token",         Role::admin,     Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   true},
    {Kind::list_commands,      "list commands",        Role::observer,  Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
    {Kind::execute,            "execute",              Role::operator_, Key::none,         Quota::stream,  DeadlineRule::change,   Use::axes,      true},
    {Kind::acquire_lease,      "acquire lease",        Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::nothing,   false},
    {Kind::keep_lease_alive,   "keep lease alive",     Role::operator_, Key::none,         Quota::stream,  DeadlineRule::question, Use::nothing,   false},
    {Kind::release_lease,      "release lease",        Role::operator_, Key::none,         Quota::request, DeadlineRule::question, Use::lease,     false},
    {Kind::hand_over_lease,    "hand over lease",      Role::operator_, Key::none,         Quota::request, DeadlineRule::question, Use::lease,     false},
    {Kind::take_over_lease,    "take over lease",      Role::operator_, Key::take_over,    Quota::request, DeadlineRule::change,   Use::nothing,   false},
    {Kind::watch_leases,       "watch leases",         Role::observer,  Key::none,         Quota::stream,  DeadlineRule::question, Use::nothing,   false},
    {Kind::rearm,              "rearm",                Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::lease,     false},
    {Kind::list_devices,       "list devices",         Role::observer,  Key::none,         Quota::none,    DeadlineRule::question, Use::nothing,   false},
    {Kind::get_device,         "get device",           Role::observer,  Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
    {Kind::watch_device,       "watch device",         Role::observer,  Key::none,         Quota::stream,  DeadlineRule::question, Use::nothing,   false},
    {Kind::clear_errors,       "clear errors",         Role::operator_, Key::clear_errors, Quota::request, DeadlineRule::change,   Use::axes,      true},
    {Kind::withdraw_stop,      "withdraw stop",        Role::admin,     Key::none,         Quota::request, DeadlineRule::change,   Use::nothing,   true},
    {Kind::record,             "record",               Role::observer,  Key::none,         Quota::stream,  DeadlineRule::question, Use::nothing,   false},
    {Kind::get_support_report, "get support report",   Role::observer,  Key::none,         Quota::stream,  DeadlineRule::question, Use::nothing,   false},
    {Kind::watch_events,       "watch events",         Role::observer,  Key::none,         Quota::stream,  DeadlineRule::question, Use::nothing,   false},
    {Kind::list_history,       "list history",         Role::observer,  Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
    {Kind::summarize_history,  "summarize history",    Role::observer,  Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
    {Kind::verify_journal,     "verify journal",       Role::observer,  Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
    {Kind::erase_person,       "erase person",         Role::admin,     Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   true},
    {Kind::save_position,      "save position",        Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::axes,      true},
    {Kind::list_positions,     "list positions",       Role::observer,  Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
    {Kind::delete_position,    "delete position",      Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::all_axes,  true},
    {Kind::move_to_position,   "move to position",     Role::operator_, Key::none,         Quota::request, DeadlineRule::motion,   Use::axes,      true},
    {Kind::get_settings,       "get settings",         Role::observer,  Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
    {Kind::change_settings,    "change settings",      Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::axes,      true},
    {Kind::set_coordinates,    "set coordinates",      Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::axes,      true},
    {Kind::fire_trigger,       "fire trigger",         Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::axes,      true},
    {Kind::reset_device,       "reset device",         Role::operator_, Key::reset_device, Quota::request, DeadlineRule::change,   Use::axes,      true},
    {Kind::operate_simulator,  "operate simulator",    Role::operator_, Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
    {Kind::move,               "move",                 Role::operator_, Key::none,         Quota::request, DeadlineRule::motion,   Use::axes,      true},
    {Kind::home,               "home",                 Role::operator_, Key::none,         Quota::request, DeadlineRule::motion,   Use::axes,      true},
    {Kind::return_to_origin,   "return to origin",     Role::operator_, Key::none,         Quota::request, DeadlineRule::motion,   Use::axes,      true},
    {Kind::run_path,           "run path",             Role::operator_, Key::none,         Quota::path,    DeadlineRule::motion,   Use::axes,      true},
    {Kind::scan,               "scan",                 Role::operator_, Key::none,         Quota::request, DeadlineRule::motion,   Use::axes,      true},
    {Kind::jog,                "jog",                  Role::operator_, Key::none,         Quota::stream,  DeadlineRule::motion,   Use::axes,      true},
    {Kind::stop,               "stop",                 Role::observer,  Key::none,         Quota::none,    DeadlineRule::stop,     Use::nothing,   false},
    {Kind::emergency_stop,     "emergency stop",       Role::observer,  Key::none,         Quota::none,    DeadlineRule::stop,     Use::nothing,   false},
    {Kind::get_motion,         "get motion",           Role::observer,  Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
    {Kind::list_motions,       "list motions",         Role::observer,  Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
    {Kind::watch_motion,       "watch motion",         Role::observer,  Key::none,         Quota::motion_stream, DeadlineRule::question, Use::nothing,   false},
    {Kind::cancel_motion,      "cancel motion",        Role::operator_, Key::none,         Quota::request, DeadlineRule::stop,     Use::nothing,   false},
    {Kind::send_job,          "send job",            Role::operator_, Key::none,         Quota::stream,  DeadlineRule::change,   Use::nothing,   true},
    {Kind::repeat_job,        "repeat job",          Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::nothing,   true},
    {Kind::get_mill,          "get mill",            Role::observer,  Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
    {Kind::watch_mill,        "watch mill",          Role::observer,  Key::none,         Quota::stream,  DeadlineRule::question, Use::nothing,   false},
    {Kind::confirm_job,       "confirm job",         Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::nothing,   true},
    {Kind::start_job,         "start job",           Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::axes,      true},
    {Kind::pause_job,         "pause job",           Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::nothing,   true},
    {Kind::resume_job,        "resume job",          Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::axes,      true},
    {Kind::continue_job,      "continue job",        Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::nothing,   true},
    {Kind::abort_job,         "abort job",           Role::observer,  Key::none,         Quota::none,    DeadlineRule::stop,     Use::nothing,   true},
    {Kind::cancel_job,        "cancel job",          Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::nothing,   true},
    {Kind::cancel_jobs,       "cancel jobs",         Role::admin,     Key::none,         Quota::request, DeadlineRule::change,   Use::nothing,   true},
    {Kind::move_job,          "move job",            Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::nothing,   true},
    {Kind::report_job_done,   "report job done",     Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::nothing,   true},
    {Kind::operate_mill,      "operate mill",        Role::operator_, Key::none,         Quota::request, DeadlineRule::change,   Use::axes,      true},
    {Kind::ask_server,           "ask server",           Role::observer,  Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
    {Kind::watch_server,         "watch server",         Role::observer,  Key::none,         Quota::stream,  DeadlineRule::question, Use::nothing,   false},
    {Kind::unlisted,           "unlisted",             Role::admin,     Key::none,         Quota::request, DeadlineRule::question, Use::nothing,   false},
}};
// clang-format on

// rule_of() uses the kind's number as the index of its row.
constexpr bool in_order() {
  for (std::size_t i = 0; i < kRules.size(); ++i) {
    if (kRules[i].kind != static_cast<Kind>(i)) return false;
  }
  return true;
}
static_assert(in_order());

}  // namespace

std::string_view name(RequestKind kind) { return rule_of(kind).name; }

const Rule& rule_of(RequestKind kind) { return kRules[static_cast<std::size_t>(kind)]; }

bool uses_axes(RequestKind kind) {
  const Use use = rule_of(kind).use;
  return use == Use::axes || use == Use::all_axes;
}

}  // namespace axisgate::api
