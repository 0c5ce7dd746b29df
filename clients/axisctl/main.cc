// axisctl: the command line of axisgated.
#include "clients/axisctl/failure.h"
#include "clients/axisctl/options.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

int run(const Options& options) {
  const Session session{options, Connection(options.target)};
  switch (options.verb) {
    case Verb::devices:
      return devices(session);
    case Verb::status:
      return status(session);
    case Verb::position:
      return position(session);
    case Verb::home:
      return with_lease(session, home);
    case Verb::move:
      return with_lease(session, move);
    case Verb::path:
      return with_lease(session, path);
    case Verb::jog:
      return with_lease(session, jog);
    case Verb::stop:
      return stop(session);
    case Verb::estop:
      return emergency_stop(session);
    case Verb::clear:
      return clear(session);
    case Verb::exec:
      return execute(session);
    case Verb::watch:
      return watch(session);
    case Verb::commands:
      return commands(session);
    case Verb::record:
      return record(session);
    case Verb::replay:
      return replay(session);
    case Verb::support:
      return support(session);
    case Verb::lease_run:
      return lease_run(session);
    case Verb::lease_list:
      return lease_list(session);
    case Verb::lease_hand_over:
      return lease_hand_over(session);
    case Verb::rearm:
      return rearm(session);
    case Verb::who_am_i:
      return who_am_i(session);
    case Verb::token_create:
      return token_create(session);
    case Verb::token_list:
      return token_list(session);
    case Verb::token_revoke:
      return token_revoke(session);
  }
  return kUsage;
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
