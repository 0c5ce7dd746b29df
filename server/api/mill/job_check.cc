#include "server/api/mill/job_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/rml1/language/diagnostic.h"

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

Result<void> check_warning_names(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (rml1::warning_named(name)) continue;
    return fail(Reason::invalid_request, fmt::format("there is no warning \"{}\" that could be accepted", name),
                fmt::format("warnings are {}", rml1::all_warning_names()));
  }
  return {};
}

JobCheck::JobCheck(const rml1::Profile& profile, rml1::CheckOptions options, std::size_t buffer,
                   const std::vector<PartToSend>& parts, const std::vector<std::string>& accepted, JobPast before)
    : profile_(profile),
      options_(std::move(options)),
      buffer_(buffer),
      parts_(parts),
      accepted_(accepted),
      accepted_before_(std::move(before.accepted)),
      check_(std::make_unique<rml1::Check>(profile_, options_)) {
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
    pieces_.take(piece);
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
  pieces_ = {};
  std::unique_ptr<rml1::Check> next;
  if (checked_.parts.size() < parts_.size()) {
    next = std::make_unique<rml1::Check>(profile_, options_);
    next->continues(*check_);
  }
  check_ = std::move(next);
  return {};
}

Result<void> JobCheck::judge_errors() const {
  const rml1::Diagnostics& found = check_->diagnostics();
  const auto all = found.in_order();
  const auto first = std::ranges::find(all, rml1::Severity::error, &rml1::Diagnostic::severity);
  if (first == all.end()) return {};
  const std::uint64_t count = found.count(rml1::Severity::error);
  return fail(Reason::invalid_request,
              fmt::format("{}: error: {} [{}]{}", place_text(first->place), first->text, first->section,
                          count == 1 ? "" : fmt::format("; {} more errors", count - 1)),
              "correct the job; `axisctl mill check` shows all errors");
}

void JobCheck::take_warnings() {
  const rml1::Diagnostics& found = check_->diagnostics();
  for (const rml1::Diagnostic& one : found.in_order()) {
    if (!one.warning) continue;
    const auto [kind, is_first] = warnings_.try_emplace(*one.warning);
    if (is_first) {
      kind->second.first = fmt::format("{}: {}", place_text(one.place), one.text);
    } else {
      ++kind->second.more;
      kind->second.last = place_text(one.place);
    }
  }
  for (const rml1::Diagnostics::Omitted& one : found.omitted()) {
    if (!one.first.warning) continue;
    warnings_[*one.first.warning].more += one.count;
    warnings_[*one.first.warning].last = place_text(one.last);
  }
}

bool JobCheck::is_accepted(rml1::Warning warning) const {
  return std::ranges::find(accepted_, rml1::name(warning)) != accepted_.end() ||
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
    names.emplace_back(rml1::name(warning));
    const std::string more = found.more == 0 ? "" : fmt::format(" ({} more, up to {})", found.more, found.last);
    refused.push_back(fmt::format("{}: {}{}; {}", names.back(), found.first, more, rml1::remedy(warning)));
  }
  if (!refused.empty()) {
    return fail(Reason::invalid_request,
                fmt::format("{} keep{} the job from the queue. {}",
                            refused.size() == 1 ? "a warning" : fmt::format("{} kinds of warnings", refused.size()),
                            refused.size() == 1 ? "s" : "", fmt::join(refused, ". ")),
                fmt::format("correct the job, or accept what is right: --accept {}", fmt::join(names, ",")));
  }
  for (const std::string& name : accepted_) {
    const auto warning = rml1::warning_named(name);
    if (!warning || !warnings_.contains(*warning)) unused.push_back(name);
  }
  if (unused.empty()) return {};
  for (const auto& [warning, found] : warnings_) names.emplace_back(rml1::name(warning));
  return fail(Reason::invalid_request,
              fmt::format("the job has no warning {}; it has {}", fmt::join(unused, ", "),
                          names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))),
              "accept only what the check of this job shows");
}

// Checks that each piece fits into the buffer: without flow control the end of a longer piece would be lost.
Result<void> JobCheck::check_pieces() const {
  const auto& [begin, bytes] = pieces_.longest();
  if (bytes <= buffer_) return {};
  return fail(
      Reason::invalid_request,
      fmt::format("{}: a command of {} bytes, which can only be sent as one piece, and the mill's buffer has {}",
                  place_text(begin), bytes, buffer_),
      "divide it into several commands, and leave out blanks in it");
}

std::string JobCheck::place_text(const rml1::Place& place) const {
  return fmt::format("{}line {}, column {}", file_text(), place.line, place.column);
}

// Returns the prefix that names the current file; empty if the job has only one.
std::string JobCheck::file_text() const {
  return parts_.size() == 1 ? "" : fmt::format("file {}: ", checked_.parts.size() + 1);
}

}  // namespace axisgate::api
