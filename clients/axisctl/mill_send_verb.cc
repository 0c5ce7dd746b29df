// mill send: reads a job whole, so that it can be sent again, and sends it into the queue of a mill.
#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/mill_calls.h"
#include "clients/axisctl/mill_text.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

constexpr std::size_t kUploadPiece = 1 << 16;
constexpr std::size_t kSlowestUpload = 100'000;  // bytes a second, over a network

// In pieces, each in a message of its own.
void add_file(const std::string& name, std::vector<v1::SendJobRequest>& messages) {
  const auto close = [](std::FILE* file) { return file == stdin ? 0 : std::fclose(file); };
  errno = 0;
  const std::unique_ptr<std::FILE, decltype(close)> file(name == "-" ? stdin : std::fopen(name.c_str(), "rb"), close);
  std::vector<char> piece(kUploadPiece);
  while (file) {
    const std::size_t count = std::fread(piece.data(), 1, piece.size(), file.get());
    if (count == 0) break;
    messages.emplace_back().set_data(piece.data(), count);
  }
  if (!file || std::ferror(file.get()) != 0)
    throw usage(fmt::format("{} cannot be read: {}", name, std::strerror(errno)), "name the file of a job");
}

std::string title_of(const Options& options) {
  if (!options.job.title.empty()) return options.job.title;
  return options.file == "-" ? "standard input" : std::filesystem::path(options.file).filename().string();
}

// Without --tool the first one that the mill has; empty where it has none.
std::string tool_of(const Session& session, const std::string& device) {
  if (!session.options.job.tool.empty()) return session.options.job.tool;
  const v1::Mill mill = mill_now(session, device);
  return mill.tools().empty() ? "" : mill.tools(0);
}

}  // namespace

int mill_send(const Session& session) {
  const Options& options = session.options;
  const std::string device = mill_to_change(session);
  std::vector<v1::SendJobRequest> messages(1);
  add_file(options.file, messages);
  v1::SendJobRequest& header = messages.front();
  header.set_device(device);
  *header.mutable_context() = session.connection.new_call_context();
  header.set_title(title_of(options));
  header.set_origin(options.job.origin);
  header.set_tool(tool_of(session, device));
  for (const std::string& section : options.job.accepted) header.add_accepted_warnings(section);
  const auto limit = kStartLimit + std::chrono::seconds((messages.size() - 1) * kUploadPiece / kSlowestUpload);
  const v1::SendJobResponse response =
      session.connection.upload(session.connection.mills, &v1::MillService::Stub::SendJob, std::move(messages), limit);
  session.options.json ? print_json(response) : print_line(state_text(response.job()));
  return kDone;
}

}  // namespace axisgate::axisctl
