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
  OldVerb verb;
  int (*run)(const Session&);
  bool waits = false;                               // accepts --wait
  int (*without_daemon)(const Options&) = nullptr;  // called instead of run
};

constexpr Row kRows[] = {
    {OldVerb::mill_check, nullptr, false, mill_check},
    {OldVerb::mill_preview, nullptr, false, mill_preview},
    {OldVerb::mill_send, mill_send},
    {OldVerb::mill_queue, mill_queue},
    {OldVerb::mill_confirm, mill_confirm},
    {OldVerb::mill_start, mill_start},
    {OldVerb::mill_watch, mill_watch},
    {OldVerb::mill_pause, mill_pause},
    {OldVerb::mill_resume, mill_resume},
    {OldVerb::mill_abort, mill_abort},
    {OldVerb::mill_cancel, mill_cancel},
    {OldVerb::mill_clear, mill_clear},
    {OldVerb::mill_first, mill_first},
    {OldVerb::mill_done, mill_done},
    {OldVerb::mill_jog, mill_jog},
    {OldVerb::mill_origin, mill_origin},
    {OldVerb::mill_spindle, mill_spindle},
    {OldVerb::mill_raise, mill_raise},
    {OldVerb::mill_again, mill_again},
};

constexpr bool in_order() {
  for (std::size_t index = 0; index < std::size(kRows); ++index) {
    if (kRows[index].verb != static_cast<OldVerb>(index)) return false;
  }
  return true;
}
static_assert(in_order() && std::size(kRows) == static_cast<std::size_t>(OldVerb::mill_again) + 1);

int run(const Options& options) {
  if (options.verb != nullptr) {
    const Verb& verb = *options.verb;
    if (verb.run_without_daemon != nullptr) return verb.run_without_daemon(options);
    const Session session{options, Connection(options.target, options.request_id)};
    return verb.waits ? with_lease(session, verb.run) : verb.run(session);
  }
  const Row& row = kRows[static_cast<std::size_t>(options.old_verb)];
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
