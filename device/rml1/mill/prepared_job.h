// A job, or a part of a job, prepared for sending.
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

// Immutable, so threads may share it. The constructor reads the whole job, so do not call it on the device's strand.
class PreparedJob final : public jobs::PreparedJob {
 public:
  // `body`: checked bytes of the job, or of one part, which begins at the byte `begin` of the job. `digest`: digest of
  // all bytes of the job, in hex. `origin`: the origin of the check. `from` and `approach`: place in the part at which
  // it continues, and the approach to this place; nullopt and empty if the part is sent from its beginning.
  PreparedJob(std::string_view body, std::string digest, const Profile& profile, std::optional<jobs::Origin> origin,
              const jobs::SendSettings& settings, std::uint64_t begin = 0, std::optional<jobs::Place> from = {},
              const Approach& approach = {});
  PreparedJob(const PreparedJob&) = delete;
  PreparedJob& operator=(const PreparedJob&) = delete;

  jobs::TimeRange takes() const override { return times_.whole(); }
  jobs::RunOn run_on() const override { return plan_.run_on; }

  const std::string& digest() const { return digest_; }
  // Bytes to send: prologue, approach, the part from the place on, epilogue.
  const std::string& text() const { return text_; }
  const Timeline& timeline() const { return timeline_; }
  const jobs::SendSettings& settings() const { return settings_; }
  const SendPlan& plan() const { return plan_; }
  // Times of text(). Byte counts are bytes of text().
  const JobTimes& times() const { return times_; }
  std::uint64_t begin() const { return begin_; }
  const std::optional<jobs::Place>& from() const { return from_; }
  // Returns the offset in the whole job that the first `bytes` bytes of text() reach. An incomplete group at the end of
  // the part is never sent; it counts as sent together with the bytes before it.
  std::uint64_t of_body(std::uint64_t bytes) const;
  // Returns the place in the part that the first `bytes` bytes of text() reach.
  jobs::Place place(std::uint64_t bytes) const;
  // Returns the range of places at which the mill stops executing the part, if it executes at least `least` bytes of
  // text() and receives at most `written` bytes. Commands that begin before the first place of the range are executed;
  // commands that begin at its second place or later are not.
  jobs::PlaceRange executed(std::uint64_t least, std::uint64_t written) const;

 private:
  std::uint64_t of_rest(std::uint64_t bytes) const;

  const std::string digest_;
  const std::uint64_t begin_;
  const std::optional<jobs::Place> from_;
  // Bytes of the part that are sent: their beginning in the part (rest_) and in text(), and their number.
  const jobs::Place rest_;
  const std::uint64_t body_size_, rest_in_text_, rest_size_;
  const std::string text_;
  const PlaceIndex places_;  // of the bytes of the part that are sent; an index, because an abort waits for place()
  const Timeline timeline_;
  const jobs::SendSettings settings_;
  const SendPlan plan_;
  const JobTimes times_;
};

// Returns the remaining time of the running part. `progress`: in bytes of text(). `measured`: the pace measured during
// this part; nullopt if it was not measured.
jobs::TimeRange left_of(const PreparedJob& job, const jobs::SendProgress& progress,
                        const std::optional<jobs::MeasuredPace>& measured);

}  // namespace axisgate::rml1
