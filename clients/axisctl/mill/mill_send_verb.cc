// mill send: reads the files of a job whole, so that the job can be sent again, and sends the job into a mill's queue.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/lengths.h"
#include "clients/axisctl/mill/job_file.h"
#include "clients/axisctl/mill/mill_calls.h"
#include "clients/axisctl/mill/mill_text.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"
#include "device/core/escape.h"
#include "server/spool/job_name.h"

namespace axisgate::axisctl {
namespace {

std::string title_from_files(const std::vector<std::string>& files) {
  const std::string& first = files.front();
  const std::string title = first == "-" ? "standard input" : std::filesystem::path(first).filename().string();
  return files.size() == 1 ? title : fmt::format("{} and {} more", title, files.size() - 1);
}

// Returns the title. Throws Failure if the daemon would refuse it: only axisctl knows that the title comes from a file
// name.
std::string title_of(const JobOptions& job) {
  if (!job.title.empty()) return job.title;
  const std::string title = title_from_files(job.files);
  const auto name = server::spool::job_name(title);
  if (name) return *name;
  throw usage(fmt::format("\"{}\": {}", escaped(title), name.error().message), "give the job a title: --title TEXT");
}

void check_tools(const JobOptions& job) {
  if (job.tools.size() == job.files.size() || (job.tools.empty() && job.files.size() == 1)) return;
  throw usage(fmt::format("--tool has {} names for a job of {} files", job.tools.size(), job.files.size()),
              "name one tool for each file: --tool T1,T3");
}

// Returns the tool of --tool, otherwise the first tool of the mill; empty if the mill has none.
std::string tool_of(const JobOptions& job, const v1::Mill& mill) {
  if (!job.tools.empty()) return job.tools.front();
  return mill.tools().empty() ? "" : mill.tools(0);
}

void set_stock(const std::string& text, v1::Stock& into) {
  const jobs::Stock stock = stock_of(text);
  into.mutable_x()->set_mm(fmt::format("{}", stock.x));
  into.mutable_y()->set_mm(fmt::format("{}", stock.y));
  into.mutable_z()->set_mm(fmt::format("{}", stock.z));
}

int mill_send(const Session& session) {
  const JobOptions& job = session.options.job;
  if (job.rest_of) return mill_send_rest(session);
  if (job.files.empty()) throw usage("FILE is required", "name the file of a job, or --rest-of an ended one");
  check_tools(job);
  for (const std::string& file : job.files) check_job_file(file);
  const std::string device = mill_to_change(session);
  const v1::Mill mill = mill_now(session, device);
  std::vector<v1::SendJobRequest> messages(1);
  v1::JobHeader header;
  for (std::size_t i = 0; i < job.files.size(); ++i) {
    // Each piece becomes one message.
    const std::int64_t bytes = read_job_file(job.files[i], mill.job_bytes_at_most(), [&](std::string_view piece) {
      messages.emplace_back().set_data(piece.data(), piece.size());
    });
    if (job.files.size() == 1) break;
    header.add_parts()->set_tool(job.tools[i]);
    header.mutable_parts()->rbegin()->set_bytes(bytes);
  }
  header.set_device(device);
  *header.mutable_context() = session.connection.new_call_context();
  header.set_title(title_of(job));
  header.set_origin(job.origin);
  if (job.stock) set_stock(*job.stock, *header.mutable_stock());
  header.set_made_for(job.made_for);
  if (job.continues) header.set_continues(fmt::format("{}/jobs/{}", device, *job.continues));
  if (!job.streaming.empty()) header.set_streaming(job.streaming == "full" ? v1::STREAMING_FULL : v1::STREAMING_PACED);
  if (header.parts().empty()) header.set_tool(tool_of(job, mill));
  for (const std::string& name : job.accepted) header.add_accepted_warnings(name);
  *messages.front().mutable_header() = std::move(header);
  const v1::SendJobResponse response = session.connection.upload(
      session.connection.mills, &v1::MillService::Stub::PrepareAsyncSendJob, std::move(messages));
  session.options.json ? print_json(response) : print_line(state_text(response.job()));
  return kDone;
}

void mill_send_options(CLI::App& verb, Options& options) {
  JobOptions& job = options.job;
  verb.add_option("FILE", job.files,
                  "the job; - reads the standard input; of several files the tool is changed between")
      ->type_name("");
  verb.add_option("--tool", job.tools,
                  "a tool of the configuration (default: its first); of several files one for each, e.g. T1,T3")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME");
  verb.add_option("--origin", job.origin,
                  "a work origin of the configuration (default: as it is set at the mill's panel)")
      ->type_name("NAME");
  verb.add_option(
          "--streaming", job.streaming,
          "paced, or full: as fast as the mill takes it, so more runs on after an abort (default: as configured)")
      ->check(CLI::IsMember({"paced", "full"}))
      ->type_name("HOW");
  verb.add_option("--stock", job.stock, "the workpiece in mm, from the work origin, and its thickness")
      ->type_name("X,Y,Z");
  verb.add_option(
          "--made-for,--profile", job.made_for,
          "the profile that the job was made for: warns where the mill has another (default: judged by the job)")
      ->type_name("NAME");
  verb.add_option("--title", job.title, "what the queue shows (default: the name of the file)")->type_name("TEXT");
  verb.add_option("--accept", job.accepted,
                  "warnings of the check that do not keep the job from the queue, e.g. deep-pass,outside-stock")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME");
  verb.add_option("--continues", job.continues,
                  "a job that is DONE, whose workpiece this one continues: the check knows what it has removed")
      ->type_name("JOB");
  CLI::Option* rest = verb.add_option("--rest-of", job.rest_of,
                                      "instead of a file: what is left of a job that was aborted, as a job of its own");
  rest->type_name("JOB");
  verb.add_option("--from", job.from, "the line of that job's file, or line and column, with which its rest begins")
      ->needs(rest)
      ->type_name("LINE[:COLUMN]");
}

constexpr Verb kMillSendVerbs[] = {
    {.words = "mill send",
     .description = "check a job and send it into the queue",
     .add_options = mill_send_options,
     .run = mill_send},
};

}  // namespace

std::span<const Verb> mill_send_verbs() { return kMillSendVerbs; }

}  // namespace axisgate::axisctl
