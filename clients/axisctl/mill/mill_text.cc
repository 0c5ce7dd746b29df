#include "clients/axisctl/mill/mill_text.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <cmath>
#include <cstdint>
#include <optional>

#include "clients/axisctl/mill/job_places.h"
#include "clients/axisctl/mill/mill_times.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/table.h"
#include "device/rml1/machine/profile_files.h"

namespace axisgate::axisctl {
namespace {

constexpr std::size_t kDigestShown = 12;  // hexadecimal digits

// Returns "QUEUED" for JOB_STATE_QUEUED, or the number if only a newer version knows the value.
std::string name_without(std::string_view prefix, const std::string& name, int number) {
  return name.empty() ? fmt::format("({})", number) : name.substr(prefix.size());
}

std::string name_of(v1::JobState state) { return name_without("JOB_STATE_", v1::JobState_Name(state), state); }

std::string name_of(v1::SendingState state) {
  return name_without("SENDING_STATE_", v1::SendingState_Name(state), state);
}

// Scales `bytes` out of `all` to `steps`, rounded down; begun_steps() rounds up. The result is at most `steps`.
std::int64_t whole_steps(std::int64_t bytes, std::int64_t all, std::int64_t steps) {
  return all <= 0 ? 0 : std::clamp<std::int64_t>(bytes, 0, all) * steps / all;
}

std::int64_t begun_steps(std::int64_t bytes, std::int64_t all, std::int64_t steps) {
  return all <= 0 ? steps : (std::clamp<std::int64_t>(bytes, 0, all) * steps + all - 1) / all;
}

std::string range_text(std::string_view least, std::string_view most) {
  return least == most ? std::string(most) : fmt::format("{} to {}", least, most);
}

std::string range_text(std::int64_t least, std::int64_t most) {
  return range_text(std::to_string(least), std::to_string(most));
}

// Returns "full" or "paced"; empty if unknown, as in events.
std::string streaming_text(const v1::Job& job) {
  switch (job.streaming()) {
    case v1::STREAMING_FULL:
      return "full";
    case v1::STREAMING_PACED:
      return "paced";
    default:
      return "";
  }
}

// Returns "12 min 0 s to 18 min 30 s, paced".
std::string takes_text(const v1::Job& job) {
  if (!job.has_longest_time()) return "a time that is not known";
  const std::string range = range_text(duration_text(job.shortest_time()), duration_text(job.longest_time()));
  const std::string streaming = streaming_text(job);
  return streaming.empty() ? range : fmt::format("{}, {}", range, streaming);
}

std::string duration_range_text(const TimeRange& range) {
  return range_text(duration_text(range.least), duration_text(range.most));
}

std::string bar_text(const v1::Job& job, const v1::RunningJob& running) {
  constexpr std::size_t width = 10;
  const auto executed = static_cast<std::size_t>(whole_steps(running.executed_least(), job.bytes(), width));
  const auto maybe = static_cast<std::size_t>(begun_steps(running.executed_most(), job.bytes(), width));
  std::string bar(executed, '=');
  bar.append(std::max(maybe, executed) - executed, '-');
  bar.resize(width, ' ');
  return bar;
}

// Rounds up to the precision that duration_text() shows.
google::protobuf::Duration rounded_up(const google::protobuf::Duration& duration) {
  using google::protobuf::util::TimeUtil;
  constexpr std::int64_t kSecond = 1'000'000'000, kHour = 3600 * kSecond;
  const std::int64_t ns = TimeUtil::DurationToNanoseconds(duration);
  const std::int64_t shown = ns < 10 * kSecond ? kSecond / 10 : ns < kHour ? kSecond : 60 * kSecond;
  return TimeUtil::NanosecondsToDuration((ns + shown - 1) / shown * shown);
}

// Returns ", up to 3.2 s and 14 mm,". Both are rounded up, because they are upper bounds.
std::string within_text(const v1::RunOn& run_on) {
  if (!run_on.has_longest_time()) return "";
  const std::string way = run_on.mm() > 0 ? fmt::format(" and {:.0f} mm", std::ceil(run_on.mm())) : "";
  return fmt::format(", up to {}{},", duration_text(rounded_up(run_on.longest_time())), way);
}

std::string held_text(const v1::RunOn& run_on) {
  return run_on.if_held() <= run_on.at_most()
             ? ""
             : fmt::format(", at most {} if the panel holds the mill (VIEW, an open cover)", run_on.if_held());
}

std::string bytes_text(std::string_view number) { return fmt::format("{} byte{}", number, number == "1" ? "" : "s"); }

std::string named_or(const std::string& name, std::string_view otherwise) {
  return name.empty() ? std::string(otherwise) : on_one_line(name);
}

std::string confirmation_text(const v1::Job& job) {
  return fmt::format("by {} until {}", on_one_line(job.confirmed_by().name()),
                     time_text(job.confirmation_expire_time()));
}

// Returns "2 of 3"; empty if the job has only one part.
std::string part_text(const v1::Job& job) {
  return job.parts_size() < 2 ? "" : fmt::format("{} of {}", job.part(), job.parts_size());
}

// Returns the tool that is in the mill, or is next.
std::string tool_cell(const v1::Job& job) {
  const std::string tool = named_or(job.setup().tool(), "-"), part = part_text(job);
  return part.empty() ? tool : fmt::format("part {}, {}", part, tool);
}

bool is_paused(const v1::Job& job, const v1::RunningJob& running) {
  return running.job() == job.name() && running.sending() == v1::SENDING_STATE_PAUSED;
}

// Returns the state, with the line at which a waiting job continues: "PAUSED (line 8)".
std::string state_cell(const v1::Job& job, const v1::RunningJob& running) {
  if (is_paused(job, running)) return name_of(v1::JOB_STATE_PAUSED);
  const std::string state = name_of(job.state());
  return job.setup().has_start() && waits(job) ? fmt::format("{} ({})", state, line_text(job.setup().start())) : state;
}

// Returns "ends at line 8, column 1" or "ends between line 8, column 1 and line 13, column 1".
std::string end_text(const v1::JobPlaceRange& range) {
  const std::string least = place_text(range.least()), most = place_text(range.most());
  return least == most ? fmt::format("ends at {}", least) : fmt::format("ends between {} and {}", least, most);
}

// Returns "in 2 min 0 s to 4 min 30 s", "now" or "when job 3 is done". `held_by` is an earlier job whose end a person
// must report; null if there is none.
std::string beginning_cell(const std::optional<TimeRange>& earliest, const v1::Job* held_by) {
  if (!earliest) return "-";
  const std::string range = duration_range_text(*earliest);
  if (range != "0 s") return "in " + range;
  return held_by == nullptr ? "now" : fmt::format("when job {} is done", last_part(held_by->name()));
}

const v1::Job* held_by(const v1::Mill& mill) {
  const auto found = std::ranges::find_if(mill.jobs(), [](const v1::Job& job) {
    return job.state() == v1::JOB_STATE_FED || job.state() == v1::JOB_STATE_PAUSED_UNKNOWN;
  });
  return found == mill.jobs().end() ? nullptr : &*found;
}

// Returns "38.0 x 30.0 mm, 1.70 mm deep".
std::string size_text(const v1::JobExtent& extent) {
  if (!extent.has_cut_x()) return "cuts nothing";
  const auto size = [](const v1::AxisExtent& axis) { return axis.most_mm() - axis.least_mm(); };
  return fmt::format("{:.1f} x {:.1f} mm, {:.2f} mm deep", size(extent.cut_x()), size(extent.cut_y()),
                     extent.deepest_mm());
}

// Returns "X 0.0 to 38.0, Y 0.0 to 30.0, Z -1.70 to 2.00 mm".
std::string reach_text(const v1::JobExtent& extent) {
  const auto text = [](std::string_view name, const v1::AxisExtent& axis, int decimals) {
    return fmt::format("{} {:.{}f} to {:.{}f}", name, axis.least_mm(), decimals, axis.most_mm(), decimals);
  };
  return fmt::format("{}, {}, {} mm", text("X", extent.x(), 1), text("Y", extent.y(), 1), text("Z", extent.z(), 2));
}

std::vector<std::string> job_cells(const v1::Job& job, const v1::RunningJob& running, const std::string& begins) {
  return {std::string(last_part(job.name())),
          on_one_line(job.title()),
          on_one_line(job.owner().name()),
          state_cell(job, running),
          tool_cell(job),
          named_or(job.setup().origin(), "panel"),
          job.has_extent() ? size_text(job.extent()) : "-",
          takes_text(job),
          begins,
          job.state() == v1::JOB_STATE_CONFIRMED ? confirmation_text(job) : "-"};
}

std::string running_line(const v1::Mill& mill) {
  const v1::Job* const job = find_job(mill, mill.running().job());
  if (job == nullptr) return fmt::format("job {} runs", last_part(mill.running().job()));
  const std::string text = fmt::format("{} {}", job_text(*job), progress_text(*job, mill.running()));
  return mill.running().busy() ? fmt::format("{}; {}", text, kBusyText) : text;
}

// Returns ", from line 12 on, on the workpiece of job 3".
std::string after_text(const v1::Job& job) {
  const std::string from = job.setup().has_start() ? fmt::format(", from {} on", line_text(job.setup().start())) : "";
  return job.continues().empty() ? from
                                 : fmt::format("{}, on the workpiece of job {}", from, last_part(job.continues()));
}

bool is_shipped(const std::string& profile) {
  const auto files = rml1::shipped_profiles();
  return std::ranges::any_of(files, [&](const auto& file) { return file.stem() == profile; });
}

}  // namespace

const v1::Job* find_job(const v1::Mill& mill, std::string_view name) {
  const auto found = std::ranges::find_if(mill.jobs(), [&](const v1::Job& job) { return job.name() == name; });
  return found == mill.jobs().end() ? nullptr : &*found;
}

std::string job_text(const v1::Job& job) {
  return fmt::format("job {} ({})", last_part(job.name()), on_one_line(job.title()));
}

std::string state_text(const v1::Job& job) {
  const std::string run_on = job.has_run_on() ? "; " + run_on_text(job.run_on()) : "";
  const std::string size = job.has_extent() ? "; " + size_text(job.extent()) : "";
  return fmt::format("{} {}{}; takes {}{}{}", job_text(job), name_of(job.state()), after_text(job), takes_text(job),
                     size, run_on);
}

std::string change_text(const v1::JobChange& change) {
  const bool paused = change.sending() == v1::SENDING_STATE_PAUSED;
  std::string text =
      fmt::format("{} {}", job_text(change.job()), paused ? name_of(change.sending()) : name_of(change.job().state()));
  if (!paused && change.sending() != v1::SENDING_STATE_UNSPECIFIED) text += ": " + name_of(change.sending());
  if (!change.caller().name().empty()) text += ", by " + change.caller().name();
  return change.why().empty() ? text : text + ": " + change.why();
}

std::string rest_text(const v1::Job& job) {
  return fmt::format(
      "{} is PAUSED: it continues at {}; see that tool and Z0 are as before, then `axisctl mill confirm {} --start`",
      job_text(job), place_text(job.setup().start()), last_part(job.name()));
}

std::string confirmed_text(const v1::Job& job) {
  return fmt::format("{} is confirmed {}", job_text(job), confirmation_text(job));
}

std::string run_on_text(const v1::RunOn& run_on) {
  return fmt::format("after an abort at most {}{} run on{}", bytes_text(std::to_string(run_on.at_most())),
                     within_text(run_on), held_text(run_on));
}

std::string progress_text(const v1::Job& job, const v1::RunningJob& running) {
  constexpr std::int64_t percent = 100;
  const std::string executed = range_text(whole_steps(running.executed_least(), job.bytes(), percent),
                                          begun_steps(running.executed_most(), job.bytes(), percent));
  // Flow control has shown that the mill has executed more bytes than were counted as arrived.
  const bool converter_holds_more = running.executed_least() > running.executed_most();
  return fmt::format("{} [{}] {} %, {} of {} bytes written, {} taken, {} left{}", name_of(running.sending()),
                     bar_text(job, running), executed, running.written(), job.bytes(), running.taken(),
                     duration_range_text(time_left(running)),
                     converter_holds_more ? "; `converter` in the configuration is too small for this line" : "");
}

// The lower bound assumes that unsent bytes stay on this host, and that the mill is the fastest and has executed the
// most.
std::string paused_text(const v1::RunningJob& running) {
  const std::int64_t most = std::max<std::int64_t>(0, running.run_on().at_most());
  const std::int64_t least =
      std::clamp<std::int64_t>(running.written() - running.unsent() - running.executed_most(), 0, most);
  const std::string_view tool = running.sending() == v1::SENDING_STATE_RAISING
                                    ? "then the tool is raised and the spindle stops"
                                    : "the cutter keeps turning in the cut";
  return fmt::format("job {} is paused: {} of it{} still run{}; {}", last_part(running.job()),
                     bytes_text(range_text(least, most)), within_text(running.run_on()), held_text(running.run_on()),
                     tool);
}

// Returns the advice for an emergency. An abort is no emergency stop: bytes that the mill has received may run on.
std::string emergency_text(const v1::RunOn& run_on) {
  using google::protobuf::util::TimeUtil;
  if (!run_on.has_longest_time()) return "in an emergency use its own emergency stop";
  return fmt::format("it may move for up to {}: in an emergency use its own emergency stop",
                     duration_text(rounded_up(run_on.longest_time())));
}

std::string aborted_text(const v1::AbortJobResponse& response) {
  const v1::RunOn& run_on = response.running().run_on();
  if (!response.has_running()) {
    return fmt::format("the abort was sent; no job ran; look at the mill; {}", emergency_text(run_on));
  }
  const std::string executed = response.has_executed() ? fmt::format("; by the mill's profile what is executed {}",
                                                                     end_text(response.executed()))
                                                       : "";
  return fmt::format("the abort was sent: at most {} of job {}{} may run on{}{}; look at the mill; {}",
                     bytes_text(std::to_string(run_on.at_most())), last_part(response.running().job()),
                     within_text(run_on), held_text(run_on), executed, emergency_text(run_on));
}

std::string executed_text(const v1::Job& job) {
  const std::string part = part_text(job);
  return fmt::format("by the mill's profile what was executed{} {}", part.empty() ? "" : " of part " + part,
                     end_text(job.executed()));
}

std::string remains_text(const v1::Job& job) {
  const auto place = [](const v1::JobPlace& at) { return fmt::format("{}:{}", at.line(), at.column()); };
  const std::string least = place(job.executed().least()), most = place(job.executed().most());
  const std::string profile = boost::algorithm::to_lower_copy(job.setup().profile());
  return fmt::format("`axisctl mill preview FILE --profile {} --from {} -o rest.svg` draws what remains",
                     is_shipped(profile) ? profile : "PROFILE", least == most ? least : least + "-" + most);
}

std::vector<std::string> queue_lines(const v1::Mill& mill) {
  std::vector<std::string> lines{
      fmt::format("{}  {}  line {}", last_part(mill.name()), mill.profile(), mill.line_open() ? "open" : "closed")};
  lines.push_back(mill.has_running() ? running_line(mill) : "no job runs");
  if (mill.has_measured_pace()) {
    lines.push_back(fmt::format("measured: the mill takes {:.2f} to {:.2f} times as long as the slowest of its profile",
                                mill.measured_pace().least(), mill.measured_pace().most()));
  }
  if (mill.ended().has_executed() && mill.ended().state() == v1::JOB_STATE_ABORTED) {
    lines.push_back(fmt::format("{} was aborted: {}", job_text(mill.ended()), executed_text(mill.ended())));
  }
  if (mill.jobs().empty()) {
    lines.emplace_back("no jobs");
    return lines;
  }
  std::vector<std::vector<std::string>> rows{
      {"job", "title", "owner", "state", "tool", "origin", "size", "takes", "begins at the earliest", "confirmed"}};
  const std::vector<std::optional<TimeRange>> beginnings = earliest_beginnings(mill);
  for (int i = 0; i < mill.jobs_size(); ++i) {
    rows.push_back(job_cells(mill.jobs(i), mill.running(), beginning_cell(beginnings[i], held_by(mill))));
  }
  for (const std::string& line : table_lines(rows)) lines.push_back(line);
  return lines;
}

std::string waiting_text(const v1::Mill& mill) {
  if (mill.jobs().empty()) return "no job runs, and none waits";
  const v1::Job& first = mill.jobs(0);
  const std::string number(last_part(first.name()));
  const auto text = [&](std::string_view what, std::string_view verb) {
    return fmt::format("no job runs; {} {}: `axisctl mill {} {}`", job_text(first), what, verb, number);
  };
  switch (first.state()) {
    case v1::JOB_STATE_CONFIRMED:
      return text("is confirmed, and waits to be started", "start");
    case v1::JOB_STATE_FED:
      return text("waits until somebody has seen its workpiece", "done");
    case v1::JOB_STATE_PAUSED_UNKNOWN:
      return text("waits for a person to choose where it continues", "resume");
    case v1::JOB_STATE_TOOL_CHANGE:
      return text(fmt::format("waits for the tool {}", on_one_line(first.setup().tool())), "confirm");
    default:
      return text("waits for somebody at the mill who confirms it", "confirm");
  }
}

std::vector<std::string> setup_lines(const v1::Job& job) {
  const v1::JobSetup& setup = job.setup();
  std::vector<std::string> lines{fmt::format("{} of {}", job_text(job), on_one_line(job.owner().name())),
                                 fmt::format("  tool      {}", named_or(setup.tool(), "none is named")),
                                 fmt::format("  origin    {}", named_or(setup.origin(), "as it is set at the panel")),
                                 fmt::format("  profile   {}", on_one_line(setup.profile())),
                                 fmt::format("  takes     {}", takes_text(job)),
                                 fmt::format("  digest    {}...", setup.digest().substr(0, kDigestShown))};
  if (const std::string part = part_text(job); !part.empty()) lines.insert(lines.begin() + 1, "  part      " + part);
  if (job.has_stock()) {
    const v1::Stock& stock = job.stock();
    lines.insert(lines.begin() + 1,
                 fmt::format("  material  {} x {} x {} mm", stock.x().mm(), stock.y().mm(), stock.z().mm()));
  }
  if (job.has_extent()) {
    lines.push_back("  size      " + size_text(job.extent()));
    lines.push_back("  reaches   " + reach_text(job.extent()));
  }
  for (const std::string& name : job.accepted_warnings()) lines.push_back("  accepted  " + on_one_line(name));
  if (job.has_run_on()) lines.push_back("  abort     " + run_on_text(job.run_on()));
  if (setup.has_start()) lines.push_back("  continues at " + place_text(setup.start()));
  if (!job.continues().empty())
    lines.push_back(fmt::format("  continues the workpiece of job {}", last_part(job.continues())));
  for (const std::string& left : setup.left()) lines.push_back("  before    " + on_one_line(left));
  return lines;
}

std::string setup_question(const v1::Job& job) {
  const v1::JobSetup& setup = job.setup();
  const auto with = [](const std::string& name) { return name.empty() ? "" : " " + on_one_line(name); };
  if (setup.has_start()) {
    return fmt::format("The tool{} is in, Z0 is as it was, and nothing is in the way? [yes/no]", with(setup.tool()));
  }
  if (job.part() > 1) {
    return fmt::format("The tool{} is in, Z0 is set, and nothing is in the way? [yes/no]", with(setup.tool()));
  }
  return fmt::format("The material is in, the tool{} is in, the origin{} is set, and nothing is in the way? [yes/no]",
                     with(setup.tool()), with(setup.origin()));
}

}  // namespace axisgate::axisctl
