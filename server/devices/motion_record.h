// What moves now, kept in a file so that a run after this one knows it if this one is killed.
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

// A motion of which a line was written, so that its start may have been.
struct StartedMotion {
  stage::MotionId motion = 0;
  stage::MotionState state = stage::MotionState::queued;  // as it was last known
  std::string who, request_id;                            // as in stage::Motion
};

// Those of this run and of runs before, oldest first: all that run now, and the newest that have ended.
struct StartedMotions {
  std::vector<StartedMotion> kept;
  stage::MotionId dropped_through = 0;  // up to this number, any that is not kept may have been started, too
};

// On the device's strand. Nothing waits for the disk: the file is mapped, and the kernel keeps what a killed process
// had written. Only a crash of the machine loses it, and nothing is inherited from before a boot.
class MotionRecord {
 public:
  // `boot` names this boot of the machine. internal, where the file cannot be made or is no regular one.
  static Result<std::unique_ptr<MotionRecord>> open(const std::string& path, std::string boot);
  ~MotionRecord();
  MotionRecord(const MotionRecord&) = delete;
  MotionRecord& operator=(const MotionRecord&) = delete;

  // What the run before left in the file; nothing where nothing moved, the machine has booted since, or the text is
  // none of this class.
  const std::optional<stage::Unfinished>& unfinished() const { return unfinished_; }

  // As the run before left it. Nothing: the machine has booted since, or the text is none of this class, so that any
  // may have been started.
  const std::optional<StartedMotions>& started_before() const { return started_before_; }

  // The highest number of a motion, of all runs since the machine has booted; 0: none. The journal's may be lower: what
  // waits for its disk is lost with a killed daemon.
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
  std::optional<stage::Unfinished> unfinished_;  // until it is known what became of it
  std::optional<StartedMotions> started_before_;
  stage::MotionId last_motion_ = 0;
  std::string serial_number_;
  std::map<stage::MotionId, stage::Motion> motions_;      // without an outcome
  std::map<stage::MotionId, stage::Motion> left_moving_;  // that ended UNKNOWN, and were not seen to end since
  StartedMotions started_motions_;
  stage::AxisSet started_;              // by a line that was not answered yet
  std::deque<std::string> last_lines_;  // stage::Unfinished::last_lines, newest first
};

// Of this boot of the machine; empty where the kernel does not say.
std::string boot_id();

}  // namespace axisgate::server
