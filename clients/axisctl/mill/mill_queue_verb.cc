// mill queue: shows a mill, its queue, and the job that runs.
#include <string>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/mill/mill_calls.h"
#include "clients/axisctl/mill/mill_text.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

int mill_queue(const Session& session) {
  const v1::Mill mill = mill_now(session, chosen_mill(session));
  if (session.options.json) {
    print_json(mill);
  } else {
    for (const std::string& line : queue_lines(mill)) print_line(line);
  }
  return kDone;
}

constexpr Verb kMillQueueVerbs[] = {
    {.words = "mill queue", .description = "show the mill, its queue, and the job that runs", .run = mill_queue},
};

}  // namespace

std::span<const Verb> mill_queue_verbs() { return kMillQueueVerbs; }

}  // namespace axisgate::axisctl
