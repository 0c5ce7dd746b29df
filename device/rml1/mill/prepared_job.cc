#include "device/rml1/mill/prepared_job.h"

#include <algorithm>
#include <utility>

#include "device/rml1/sending/words.h"

namespace axisgate::rml1 {
namespace {

std::string wrapped(std::string_view body, const Profile& profile, std::optional<Origin> origin) {
  const bool turning = Timeline(body, profile, origin).turns_at_end();
  std::string text = prologue();
  text += body;
  return text + epilogue(profile, turning);
}

}  // namespace

PreparedJob::PreparedJob(std::string_view body, std::string digest, const Profile& profile,
                         std::optional<Origin> origin, const SendSettings& settings, std::uint64_t begin)
    : digest_(std::move(digest)),
      begin_(begin),
      body_size_(body.size()),
      text_(wrapped(body, profile, origin)),
      timeline_(text_, profile, origin),
      plan_(plan_of(text_, timeline_, settings)) {}

std::uint64_t PreparedJob::of_body(std::uint64_t bytes) const {
  const std::uint64_t before = prologue().size();
  return begin_ + (bytes < before ? 0 : std::min(bytes - before, body_size_));
}

}  // namespace axisgate::rml1
