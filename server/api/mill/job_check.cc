#include "server/api/mill/job_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace axisgate::api {

Result<void> check_parts(const std::vector<PartToSend>& parts, const std::vector<std::string>& tools,
                         std::string_view mill) {
  if (parts.size() > jobs::kPartsAtMost) {
    return fail(Reason::invalid_request, fmt::format("the job has {} parts", parts.size()),
                fmt::format("send at most {} as one job", jobs::kPartsAtMost));
  }
  for (const PartToSend& part : parts) {
    if (part.bytes == 0) return fail(Reason::invalid_request, "a part of the job has no bytes", "leave it out");
    if (std::ranges::find(tools, part.tool) != tools.end()) continue;
    return fail(Reason::invalid_request, fmt::format("{} has no tool \"{}\"", mill, part.tool),
                fmt::format("it has {}", fmt::join(tools, ", ")));
  }
  return {};
}

JobCheck::JobCheck(const jobs::Model& model, jobs::CheckOptions options, std::size_t buffer,
                   const std::vector<PartToSend>& parts, const std::vector<std::string>& accepted, JobPast before)
    : model_(model),
      options_(std::move(options)),
      buffer_(buffer),
      parts_(parts),
      accepted_(accepted),
      accepted_before_(std::move(before.accepted)),
      check_(model_.make_check(options_)) {
  if (before.workpiece != nullptr) check_->continues(*before.workpiece);
}

Result<void> JobCheck::feed(std::string_view bytes) {
  while (!bytes.empty()) {
    if (!check_) {
      return fail(Reason::invalid_request, fmt::format("the job has more than the {} bytes of its parts", begin_),
                  "say of each part how many bytes it has");
    }
    const std::string_view piece = bytes.substr(0, part().bytes ? *part().bytes - come_ : bytes.size());
    check_->feed(piece);
    come_ += piece.size();
    bytes.remove_prefix(piece.size());
    if (part().bytes != come_) continue;
    if (const Result<void> finished = finish_part(); !finished) return finished;
  }
  return {};
}

Result<CheckedJob> JobCheck::finish() {
  if (check_ && part().bytes) {
    return fail(Reason::invalid_request, fmt::format("{}{} of {} bytes came", file_text(), come_, *part().bytes),
                "send all bytes of each part");
  }
  if (check_) {
    if (const Result<void> finished = finish_part(); !finished) return tl::unexpected(finished.error());
  }
  return judge_warnings().map([this] { return checked_; });
}

Result<void> JobCheck::finish_part() {
  check_->finish();
  if (const Result<void> good = judge_errors(); !good) return good;
  take_warnings();
  if (const Result<void> fit = check_pieces(); !fit) return fit;
  checked_.leaves |= check_->leaves();
  checked_.extent.take(check_->extent());
  begin_ += std::exchange(come_, 0);
  const std::string& tool = part().tool;
  checked_.parts.push_back({tool, begin_});
  std::unique_ptr<jobs::Check> next;
  if (checked_.parts.size() < parts_.size()) {
    next = model_.make_check(options_);
    next->continues(*check_);
  }
  check_ = std::move(next);
  return {};
}

Result<void> JobCheck::judge_errors() const {
  const std::optional<jobs::FoundError> first = check_->error();
  if (!first) return {};
  return fail(Reason::invalid_request,
              fmt::format("{}: error: {} [{}]{}", place_text(first->place), first->text, first->section,
                          first->more == 0 ? "" : fmt::format("; {} more errors", first->more)),
              "correct the job");
}

void JobCheck::take_warnings() {
  for (const jobs::FoundWarning& one : check_->warnings()) {
    const auto [found, is_first] = warnings_.try_emplace(one.name);
    Found& all = found->second;
    if (is_first) {
      all = {fmt::format("{}: {}", place_text(one.place), one.text), one.remedy, 0, ""};
    } else {
      ++all.more;
      all.last = place_text(one.place);
    }
    all.more += one.more;
    if (one.more > 0) all.last = place_text(one.last);
  }
}

bool JobCheck::is_accepted(std::string_view warning) const {
  return std::ranges::find(accepted_, warning) != accepted_.end() ||
         std::ranges::find(accepted_before_, warning) != accepted_before_.end();
}

// Reports all refused kinds at once, so that the sender need not correct and send the job once for each kind.
Result<void> JobCheck::judge_warnings() {
  std::vector<std::string> refused, names, unused;
  for (const auto& [warning, found] : warnings_) {
    if (is_accepted(warning)) {
      checked_.accepted.push_back(warning);
      continue;
    }
    names.push_back(warning);
    const std::string more = found.more == 0 ? "" : fmt::format(" ({} more, up to {})", found.more, found.last);
    refused.push_back(fmt::format("{}: {}{}; {}", names.back(), found.first, more, found.remedy));
  }
  if (!refused.empty()) {
    return fail(Reason::invalid_request,
                fmt::format("{} keep{} the job from the queue. {}",
                            refused.size() == 1 ? "a warning" : fmt::format("{} kinds of warnings", refused.size()),
                            refused.size() == 1 ? "s" : "", fmt::join(refused, ". ")),
                fmt::format("correct the job, or accept what is right: `accepted_warnings` {}", fmt::join(names, ",")));
  }
  for (const std::string& name : accepted_) {
    if (!warnings_.contains(name)) unused.push_back(name);
  }
  if (unused.empty()) return {};
  for (const auto& [warning, found] : warnings_) names.push_back(warning);
  return fail(Reason::invalid_request,
              fmt::format("the job has no warning {}; it has {}", fmt::join(unused, ", "),
                          names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))),
              "accept only what the check of this job shows");
}

// Checks that each piece fits into the buffer: without flow control the end of a longer piece would be lost.
Result<void> JobCheck::check_pieces() const {
  const auto& [begin, bytes] = check_->longest_piece();
  if (bytes <= buffer_) return {};
  return fail(
      Reason::invalid_request,
      fmt::format("{}: a command of {} bytes, which can only be sent as one piece, and the mill's buffer has {}",
                  place_text(begin), bytes, buffer_),
      "divide it into several commands, and leave out blanks in it");
}

std::string JobCheck::place_text(const jobs::Place& place) const {
  return fmt::format("{}line {}, column {}", file_text(), place.line, place.column);
}

// Returns the prefix that names the current file; empty if the job has only one.
std::string JobCheck::file_text() const {
  return parts_.size() == 1 ? "" : fmt::format("file {}: ", checked_.parts.size() + 1);
}

}  // namespace axisgate::api
