// mill send: reads the files of a job whole, so that it can be sent again, and sends it into the queue of a mill.
#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/lengths.h"
#include "clients/axisctl/mill_calls.h"
#include "clients/axisctl/mill_text.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"
#include "device/core/escape.h"
#include "server/spool/job_name.h"

namespace axisgate::axisctl {
namespace {

// In pieces, each in a message of its own. Returns how many bytes it has.
std::int64_t add_file(const std::string& name, std::vector<v1::SendJobRequest>& messages) {
  const auto close = [](std::FILE* file) { return file == stdin ? 0 : std::fclose(file); };
  errno = 0;
  const std::unique_ptr<std::FILE, decltype(close)> file(name == "-" ? stdin : std::fopen(name.c_str(), "rb"), close);
  std::vector<char> piece(kUploadPiece);
  std::int64_t bytes = 0;
  while (file) {
    const std::size_t count = std::fread(piece.data(), 1, piece.size(), file.get());
    if (count == 0) break;
    messages.emplace_back().set_data(piece.data(), count);
    bytes += static_cast<std::int64_t>(count);
  }
  if (!file || std::ferror(file.get()) != 0)
    throw usage(fmt::format("{} cannot be read: {}", name, std::strerror(errno)), "name the file of a job");
  return bytes;
}

std::string title_from_files(const std::vector<std::string>& files) {
  const std::string& first = files.front();
  const std::string title = first == "-" ? "standard input" : std::filesystem::path(first).filename().string();
  return files.size() == 1 ? title : fmt::format("{} and {} more", title, files.size() - 1);
}

// Refuses what the daemon would refuse: only here is it known that the title comes from the name of a file.
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

// Without --tool the first one that the mill has; empty where it has none.
std::string tool_of(const Session& session, const std::string& device) {
  if (!session.options.job.tools.empty()) return session.options.job.tools.front();
  const v1::Mill mill = mill_now(session, device);
  return mill.tools().empty() ? "" : mill.tools(0);
}

void set_stock(const std::string& text, v1::Stock& into) {
  const rml1::Stock stock = stock_of(text);
  into.set_x_mm(stock.x);
  into.set_y_mm(stock.y);
  into.set_z_mm(stock.z);
}

}  // namespace

int mill_send(const Session& session) {
  const JobOptions& job = session.options.job;
  check_tools(job);
  const std::string device = mill_to_change(session);
  std::vector<v1::SendJobRequest> messages(1);
  v1::SendJobRequest header;
  for (std::size_t i = 0; i < job.files.size(); ++i) {
    const std::int64_t bytes = add_file(job.files[i], messages);
    if (job.files.size() == 1) break;
    header.add_parts()->set_tool(job.tools[i]);
    header.mutable_parts()->rbegin()->set_bytes(bytes);
  }
  header.set_device(device);
  *header.mutable_context() = session.connection.new_call_context();
  header.set_title(title_of(job));
  header.set_origin(job.origin);
  if (job.stock) set_stock(*job.stock, *header.mutable_stock());
  header.set_profile(job.profile);
  if (!job.streaming.empty()) header.set_streaming(job.streaming == "full" ? v1::STREAMING_FULL : v1::STREAMING_PACED);
  if (header.parts().empty()) header.set_tool(tool_of(session, device));
  for (const std::string& section : job.accepted) header.add_accepted_warnings(section);
  messages.front() = header;
  const v1::SendJobResponse response = session.connection.upload(
      session.connection.mills, &v1::MillService::Stub::PrepareAsyncSendJob, std::move(messages));
  session.options.json ? print_json(response) : print_line(state_text(response.job()));
  return kDone;
}

}  // namespace axisgate::axisctl
