// axisctl: the command-line program for axisgated.
#include "clients/axisctl/arguments/options.h"
#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

int run(const Options& options) {
  const Verb& verb = *options.verb;
  if (verb.run_without_daemon != nullptr) return verb.run_without_daemon(options);
  const Session session{options, Connection(options.target, options.request_id)};
  return verb.waits ? with_lease(session, verb.run) : verb.run(session);
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
