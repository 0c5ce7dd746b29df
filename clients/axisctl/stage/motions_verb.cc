// motions: lists the motions that the daemon has.
#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/table.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

using google::protobuf::util::TimeUtil;

constexpr int kNewestWithOutcome = 20;

bool has_outcome(const v1::Motion& motion) { return motion.state() >= v1::MOTION_STATE_SUCCEEDED; }

// Returns the motions to show, oldest first, in the order of the answer.
std::vector<v1::Motion> shown_of(const v1::ListMotionsResponse& there, bool all) {
  auto hidden =
      all ? 0 : std::max<std::ptrdiff_t>(0, std::ranges::count_if(there.motions(), has_outcome) - kNewestWithOutcome);
  std::vector<v1::Motion> shown;
  for (const v1::Motion& motion : there.motions()) {
    if (has_outcome(motion) && hidden > 0) {
      --hidden;
    } else {
      shown.push_back(motion);
    }
  }
  return shown;
}

// Returns the cells of a row. The last cell is the end of the motion, or its duration up to `now` if it has no outcome.
std::vector<std::string> cells_of(const v1::Motion& motion, const google::protobuf::Timestamp& now) {
  const auto& since = motion.has_start_time() ? motion.start_time() : motion.create_time();
  return {std::string(last_part(motion.name())),
          kind_name(motion.kind()),
          fmt::format("{}", fmt::join(motion.axes(), ",")),
          state_name(motion.state()),
          motion.caller().name(),
          motion.has_start_time() ? time_text(motion.start_time()) : "not started",
          motion.has_end_time() ? time_text(motion.end_time()) : "for " + duration_text(since, now)};
}

int motions(const Session& session) {
  v1::ListMotionsRequest request;
  constexpr int largest_page = 1000;
  request.set_device(chosen_device(session).name());
  request.set_page_size(largest_page);
  v1::ListMotionsResponse there;
  do {
    const v1::ListMotionsResponse page = session.connection.call(
        session.connection.stage, &v1::StageService::Stub::ListMotions, request, kQuestionLimit);
    there.MergeFrom(page);
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  std::reverse(there.mutable_motions()->begin(), there.mutable_motions()->end());  // the daemon's are newest first
  const std::vector<v1::Motion> shown = shown_of(there, session.options.all);
  if (session.options.json) {
    for (const v1::Motion& motion : shown) print_json(motion);
    return kDone;
  }
  if (shown.empty()) {
    print_line("no motions");
    return kDone;
  }
  std::vector<std::vector<std::string>> rows{{"number", "kind", "axes", "state", "who", "started", "ended"}};
  for (const v1::Motion& motion : shown) rows.push_back(cells_of(motion, TimeUtil::GetCurrentTime()));
  for (const std::string& line : table_lines(rows)) print_line(line);
  return kDone;
}

void motions_options(CLI::App& verb, Options& options) {
  verb.add_flag("--all", options.all, "all motions that the daemon has: the 1,000 newest");
}

constexpr Verb kMotionsVerbs[] = {
    {.words = "motions",
     .heading = Heading::looking,
     .description = "show the motions that run, and the 20 newest others",
     .help = "The daemon has the motions since its start; `axisctl history` also shows older ones.",
     .examples = "axisctl motions\naxisctl --json motions --all",
     .add_options = motions_options,
     .run = motions},
};

}  // namespace

std::span<const Verb> motions_verbs() { return kMotionsVerbs; }

}  // namespace axisgate::axisctl
