// A job as it is sent. Made once, off the device's strand, since it reads the whole job.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/rml1/machine.h"
#include "device/rml1/profile.h"
#include "device/rml1/sending/plan.h"
#include "device/rml1/sending/settings.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

// Immutable, so threads may share it.
class PreparedJob {
 public:
  // `body`: the job's bytes, checked. `digest`: of these, in hex. `origin`: as of the check.
  PreparedJob(std::string_view body, std::string digest, const Profile& profile, std::optional<Origin> origin,
              const SendSettings& settings);

  const std::string& digest() const { return digest_; }
  // With prologue and epilogue.
  const std::string& text() const { return text_; }
  const Timeline& timeline() const { return timeline_; }
  const SendPlan& plan() const { return plan_; }
  // Of bytes of text(), those of the job itself.
  std::uint64_t of_body(std::uint64_t bytes) const;
  std::uint64_t body_size() const { return body_size_; }

 private:
  const std::string digest_;
  const std::uint64_t body_size_;
  const std::string text_;
  const Timeline timeline_;
  const SendPlan plan_;
};

}  // namespace axisgate::rml1
