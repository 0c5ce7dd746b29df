// axisctl: the command-line program for axisgated.
#include <cstddef>
#include <iterator>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/mill/mill_verbs.h"
#include "clients/axisctl/options.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

struct Row {
  Verb verb;
  int (*run)(const Session&);
  bool waits = false;                               // accepts --wait
  int (*without_daemon)(const Options&) = nullptr;  // called instead of run
};

constexpr Row kRows[] = {
    {Verb::devices, devices},
    {Verb::status, status},
    {Verb::position, position},
    {Verb::home, home, true},
    {Verb::move, move, true},
    {Verb::path, path, true},
    {Verb::line, line, true},
    {Verb::arc, arc, true},
    {Verb::scan, scan, true},
    {Verb::jog, jog, true},
    {Verb::stop, stop},
    {Verb::estop, emergency_stop},
    {Verb::withdraw, withdraw_stop},
    {Verb::clear, clear},
    {Verb::exec, execute},
    {Verb::watch, watch},
    {Verb::commands, commands},
    {Verb::record, record},
    {Verb::replay, replay},
    {Verb::sim, simulate},
    {Verb::support, support},
    {Verb::lease_run, lease_run},
    {Verb::lease_list, lease_list},
    {Verb::lease_hand_over, lease_hand_over},
    {Verb::rearm, rearm},
    {Verb::who_am_i, who_am_i},
    {Verb::token_create, token_create},
    {Verb::token_list, token_list},
    {Verb::token_revoke, token_revoke},
    {Verb::settings, show_settings},
    {Verb::speed, speeds},
    {Verb::motor, switch_motor, true},
    {Verb::loop, change_loop, true},
    {Verb::divisions, change_divisions, true},
    {Verb::settle, change_settling, true},
    {Verb::sleep, sleep_controller, true},
    {Verb::wake, wake_controller, true},
    {Verb::display, switch_display, true},
    {Verb::beep, switch_beep, true},
    {Verb::mode, change_mode, true},
    {Verb::dialect, change_dialect, true},
    {Verb::reset, reset_controller},
    {Verb::zero, set_origin, true},
    {Verb::unzero, unset_origin, true},
    {Verb::preset, preset_coordinates, true},
    {Verb::outputs, outputs},
    {Verb::inputs, inputs},
    {Verb::trigger_every, trigger_every},
    {Verb::trigger_off, trigger_off},
    {Verb::trigger_fire, trigger_fire, true},
    {Verb::save, save_position, true},
    {Verb::positions, list_positions},
    {Verb::go, go_to_position, true},
    {Verb::forget, forget_position, true},
    {Verb::history, history},
    {Verb::motions, motions},
    {Verb::cancel, cancel},
    {Verb::audit_verify, audit_verify},
    {Verb::audit_erase, audit_erase},
    {Verb::mill_check, nullptr, false, mill_check},
    {Verb::mill_preview, nullptr, false, mill_preview},
    {Verb::mill_send, mill_send},
    {Verb::mill_queue, mill_queue},
    {Verb::mill_confirm, mill_confirm},
    {Verb::mill_start, mill_start},
    {Verb::mill_watch, mill_watch},
    {Verb::mill_pause, mill_pause},
    {Verb::mill_resume, mill_resume},
    {Verb::mill_abort, mill_abort},
    {Verb::mill_cancel, mill_cancel},
    {Verb::mill_clear, mill_clear},
    {Verb::mill_first, mill_first},
    {Verb::mill_done, mill_done},
    {Verb::mill_jog, mill_jog},
    {Verb::mill_origin, mill_origin},
    {Verb::mill_spindle, mill_spindle},
    {Verb::mill_raise, mill_raise},
    {Verb::mill_again, mill_again},
};

constexpr bool in_order() {
  for (std::size_t index = 0; index < std::size(kRows); ++index) {
    if (kRows[index].verb != static_cast<Verb>(index)) return false;
  }
  return true;
}
static_assert(in_order() && std::size(kRows) == static_cast<std::size_t>(Verb::mill_again) + 1);

int run(const Options& options) {
  const Row& row = kRows[static_cast<std::size_t>(options.verb)];
  if (row.without_daemon != nullptr) return row.without_daemon(options);
  const Session session{options, Connection(options.target, options.request_id)};
  return row.waits ? with_lease(session, row.run) : row.run(session);
}

}  // namespace
}  // namespace axisgate::axisctl

int main(int argument_count, char** arguments) {
  using namespace axisgate::axisctl;
  const std::variant<Options, int> parsed = parse_options(argument_count, arguments);
  if (const int* exit_code = std::get_if<int>(&parsed)) return *exit_code;
  try {
    return run(std::get<Options>(parsed));
  } catch (const Failure& failure) {
    print_failure(failure);
    return failure.exit_code;
  }
}
