// File with the motions in progress, so that the next run knows them after this run was killed.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/stage/event.h"
#include "device/stage/unfinished.h"
#include "server/access/mapped_text.h"

namespace axisgate::server {

// A motion of which a line was written; it may therefore have been started.
struct StartedMotion {
  stage::MotionId motion = 0;
  stage::MotionState state = stage::MotionState::queued;  // last known state
  std::string who, request_id;                            // values of stage::Motion
};

// Motions of this run and earlier runs, oldest first: all that are in progress, and the newest that have ended.
struct StartedMotions {
  std::vector<StartedMotion> kept;
  stage::MotionId dropped_through = 0;  // any motion up to this number that is not kept may have been started, too
};

// Runs on the device's strand. No call waits for the disk: the file is mapped, and the kernel keeps what a killed
// process had written. Only a crash of the machine loses it, and nothing is inherited from before a boot.
class MotionRecord {
 public:
  // `boot` names this boot of the machine. Fails with internal if the file cannot be created or is not a regular file.
  static Result<std::unique_ptr<MotionRecord>> open(const std::string& path, std::string boot);
  ~MotionRecord();
  MotionRecord(const MotionRecord&) = delete;
  MotionRecord& operator=(const MotionRecord&) = delete;

  // Returns the motions that the previous run left unfinished. Returns nullopt if nothing moved, the machine has booted
  // since, or this class did not write the text.
  const std::optional<stage::Unfinished>& unfinished() const { return unfinished_; }

  // Returns the motions that the previous run had started. Returns nullopt if the machine has booted since, or this
  // class did not write the text: any motion may then have been started.
  const std::optional<StartedMotions>& started_before() const { return started_before_; }

  // Returns the highest number of a motion of all runs since the machine booted; 0 if there was none. The journal's
  // number may be lower, because entries that wait for the disk are lost when the daemon is killed.
  stage::MotionId last_motion() const { return last_motion_; }

  void on_event(const stage::Event& event);

 private:
  struct Left;

  MotionRecord(std::unique_ptr<MappedText> file, std::string boot);
  static std::optional<Left> parsed(std::string_view text, std::string_view boot);

  void note(const stage::MotionChanged& change);
  void note(const stage::BytesWritten& bytes);
  void note(const stage::ExchangeEnded& ended);
  void note(const stage::LinkChanged& change);
  void note(const stage::UnfinishedJudged& judged);
  template <class Other>
  void note(const Other&) {}
  bool something_may_move() const;
  void note_started(stage::MotionId motion);
  std::string text() const;
  std::string started_lines() const;
  void write();

  const std::unique_ptr<MappedText> file_;
  const std::string boot_;
  std::optional<stage::Unfinished> unfinished_;  // until the outcome is known
  std::optional<StartedMotions> started_before_;
  stage::MotionId last_motion_ = 0;
  std::string serial_number_;
  std::map<stage::MotionId, stage::Motion> motions_;  // motions without an outcome
  // Motions that ended UNKNOWN and whose axes were not seen to stop since.
  std::map<stage::MotionId, stage::Motion> left_moving_;
  StartedMotions started_motions_;
  stage::AxisSet started_;              // axes started by a line that has not been answered yet
  std::deque<std::string> last_lines_;  // stage::Unfinished::last_lines, newest first
};

// Returns the id of this boot of the machine; empty if the kernel does not provide it.
std::string boot_id();

}  // namespace axisgate::server
