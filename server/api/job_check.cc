#include "server/api/job_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/rml1/diagnostic.h"

namespace axisgate::api {

Result<void> check_parts(const std::vector<PartToSend>& parts, const std::vector<std::string>& tools,
                         std::string_view mill) {
  if (parts.size() > rml1::kPartsAtMost) {
    return fail(Reason::invalid_request, fmt::format("the job has {} parts", parts.size()),
                fmt::format("send at most {} as one job", rml1::kPartsAtMost));
  }
  for (const PartToSend& part : parts) {
    if (part.bytes == 0) return fail(Reason::invalid_request, "a part of the job has no bytes", "leave it out");
    if (std::ranges::find(tools, part.tool) != tools.end()) continue;
    return fail(Reason::invalid_request, fmt::format("{} has no tool \"{}\"", mill, part.tool),
                fmt::format("it has {}", fmt::join(tools, ", ")));
  }
  return {};
}

JobCheck::JobCheck(const rml1::Profile& profile, rml1::CheckOptions options, std::size_t buffer,
                   const std::vector<PartToSend>& parts, const AcceptedWarnings& accepted)
    : profile_(profile), options_(std::move(options)), buffer_(buffer), parts_(parts), accepted_(accepted) {
  check_.emplace(profile_, options_);
}

Result<void> JobCheck::feed(std::string_view bytes) {
  while (!bytes.empty()) {
    if (!check_) {
      return fail(Reason::invalid_request, fmt::format("the job has more than the {} bytes of its parts", begin_),
                  "say of each part how many bytes it has");
    }
    const std::string_view piece = bytes.substr(0, part().bytes ? *part().bytes - come_ : bytes.size());
    check_->feed(piece);
    pieces_.take(piece);
    come_ += piece.size();
    bytes.remove_prefix(piece.size());
    if (part().bytes != come_) continue;
    if (const Result<void> finished = finish_part(); !finished) return finished;
  }
  return {};
}

Result<CheckedJob> JobCheck::finish() {
  if (!check_) return checked_;
  if (part().bytes) {
    return fail(Reason::invalid_request, fmt::format("{}{} of {} bytes came", file_text(), come_, *part().bytes),
                "send all bytes of each part");
  }
  const Result<void> finished = finish_part();
  if (!finished) return tl::unexpected(finished.error());
  return checked_;
}

Result<void> JobCheck::finish_part() {
  check_->finish();
  if (const Result<void> good = judge(); !good) return good;
  if (const Result<void> fit = check_pieces(); !fit) return fit;
  checked_.leaves |= check_->leaves();
  begin_ += std::exchange(come_, 0);
  const std::string& tool = part().tool;
  checked_.parts.push_back({tool, begin_});
  check_.reset();
  pieces_ = {};
  if (checked_.parts.size() < parts_.size()) check_.emplace(profile_, options_);
  return {};
}

Result<void> JobCheck::judge() const {
  const rml1::Diagnostics& found = check_->diagnostics();
  const auto keeps_out = [this](const rml1::Diagnostic& one) {
    return one.severity == rml1::Severity::error ||
           (one.severity == rml1::Severity::warning && !accepted_.contains(one.section));
  };
  const auto all = found.in_order();
  const auto first = std::ranges::find_if(all, keeps_out);
  if (first == all.end()) return {};
  const auto count = std::ranges::count_if(all, keeps_out);
  const bool warns = first->severity == rml1::Severity::warning;
  return fail(Reason::invalid_request,
              fmt::format("{}line {}, column {}: {}: {} [{}]{}", file_text(), first->place.line, first->place.column,
                          rml1::name(first->severity), first->text, first->section,
                          count == 1 ? "" : fmt::format("; {} more keep the job from the queue", count - 1)),
              warns ? fmt::format("`axisctl mill check` shows all; --accept {} accepts such warnings", first->section)
                    : "correct the job; `axisctl mill check` shows all errors");
}

// What is written at once must have room: without flow control its end would be lost.
Result<void> JobCheck::check_pieces() const {
  const auto& [begin, bytes] = pieces_.longest();
  if (bytes <= buffer_) return {};
  return fail(Reason::invalid_request,
              fmt::format("{}line {}, column {}: a command of {} bytes, which can only be sent as one piece, and the "
                          "mill's buffer has {}",
                          file_text(), begin.line, begin.column, bytes, buffer_),
              "divide it into several commands, and leave out blanks in it");
}

// Which one, where there are several.
std::string JobCheck::file_text() const {
  return parts_.size() == 1 ? "" : fmt::format("file {}: ", checked_.parts.size() + 1);
}

}  // namespace axisgate::api
