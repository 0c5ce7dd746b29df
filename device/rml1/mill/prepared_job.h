// A job, or a part of one, as it is sent. Made once, off the device's strand, since it reads the whole job.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/jobs/machine.h"
#include "device/jobs/send_settings.h"
#include "device/rml1/machine/machine.h"
#include "device/rml1/machine/profile.h"
#include "device/rml1/mill/approach.h"
#include "device/rml1/mill/place_index.h"
#include "device/rml1/sending/job_times.h"
#include "device/rml1/sending/pace_meter.h"
#include "device/rml1/sending/plan.h"
#include "device/rml1/sending/sender.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

// Immutable, so threads may share it.
class PreparedJob final : public jobs::PreparedJob {
 public:
  // `body`: the job's bytes, checked, or those of one part of it, which begins at the job's byte `begin`. `digest`: of
  // all bytes of the job, in hex. `origin`: as of the check. `from`: the place in the part at which it is continued,
  // and the approach to it.
  PreparedJob(std::string_view body, std::string digest, const Profile& profile, std::optional<jobs::Origin> origin,
              const jobs::SendSettings& settings, std::uint64_t begin = 0, std::optional<jobs::Place> from = {},
              const Approach& approach = {});
  PreparedJob(const PreparedJob&) = delete;
  PreparedJob& operator=(const PreparedJob&) = delete;

  jobs::TimeRange takes() const override { return times_.whole(); }
  jobs::RunOn run_on() const override { return plan_.run_on; }

  const std::string& digest() const { return digest_; }
  // Bytes of the job with prologue and epilogue.
  const std::string& text() const { return text_; }
  const Timeline& timeline() const { return timeline_; }
  const jobs::SendSettings& settings() const { return settings_; }
  const SendPlan& plan() const { return plan_; }
  // These count bytes of text().
  const JobTimes& times() const { return times_; }
  std::uint64_t begin() const { return begin_; }
  const std::optional<jobs::Place>& from() const { return from_; }
  // Returns up to which byte of the job itself, or which place in the part, so many bytes of text() reach. A group that
  // the part leaves open is not sent, and counts as sent with what is before it.
  std::uint64_t of_body(std::uint64_t bytes) const;
  jobs::Place place(std::uint64_t bytes) const;
  // Returns the range in which the mill stops executing the part, if it has executed at least `least` bytes of text()
  // and gets no more than those written. Commands that begin before the first place are executed; those that begin at
  // the second place or after it are not.
  jobs::PlaceRange executed(std::uint64_t least, std::uint64_t written) const;

 private:
  std::uint64_t of_rest(std::uint64_t bytes) const;

  const std::string digest_;
  const std::uint64_t begin_;
  const std::optional<jobs::Place> from_;
  // Bytes that are sent of the part itself: where they begin in it and in text(), and how many they are.
  const jobs::Place rest_;
  const std::uint64_t body_size_, rest_in_text_, rest_size_;
  const std::string text_;
  const PlaceIndex places_;  // of what is sent of the part itself: an abort waits for it
  const Timeline timeline_;
  const jobs::SendSettings settings_;
  const SendPlan plan_;
  const JobTimes times_;
};

// Returns how long the rest of a running job takes. `progress` is in bytes of its text(); `measured` is the pace that
// this job itself has shown.
jobs::TimeRange left_of(const PreparedJob& job, const jobs::SendProgress& progress,
                        const std::optional<jobs::MeasuredPace>& measured);

}  // namespace axisgate::rml1
