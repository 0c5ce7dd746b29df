// Lines sent to a controller, with their answers, collected for the journal.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "device/stage/event.h"

namespace axisgate::server::journal {

// Runs on the device's strand.
class ExchangedLines {
 public:
  // Maximum number of lines of one motion that are collected before they are written.
  static constexpr std::size_t kGatheredMax = 64;

  struct Line {
    std::string text;                   // without CR LF
    std::optional<std::string> answer;  // reply, or the name of an Outcome if no reply came; nullopt if unknown
    // Time of writing, counted from the motion's request; nullopt if the line has no motion.
    std::optional<Duration> at;
  };
  struct Lines {
    stage::MotionId motion = 0;  // 0: none
    std::string who;
    stage::AxisSet axes;
    std::vector<Line> lines;
  };

  // Returns the lines that need an entry of their own now: a line without a motion, unless it is a question, or the
  // lines of a motion that has reached kGatheredMax.
  std::optional<Lines> on_event(const stage::Event& event, TimePoint now);

  // Returns the lines collected since the last call. For a motion that has ended, this call is the last, and its result
  // includes a line whose answer has not come.
  std::vector<Line> take(const stage::Motion& motion);

 private:
  struct Written {
    std::uint64_t exchange = 0;
    TimePoint at{};
    bool question = false;
    Lines lines;  // this line alone
  };
  struct Gathered {
    TimePoint requested{};
    std::string who;
    stage::AxisSet axes;
    std::vector<Line> lines;
  };

  std::optional<Lines> note(const stage::BytesWritten& written, TimePoint now);
  std::optional<Lines> note(const stage::ExchangeEnded& ended, TimePoint now);
  std::optional<Lines> note(const stage::MotionChanged& change, TimePoint now);
  std::optional<Lines> note(const stage::LinkChanged&, TimePoint) { return close({}); }
  std::optional<Lines> note(const stage::LineLearned& learned, TimePoint now);
  template <class Other>
  std::optional<Lines> note(const Other&, TimePoint) {
    return std::nullopt;
  }
  std::optional<Lines> close(std::optional<std::string> answer);

  std::optional<Written> open_;                  // line whose answer has not come
  std::map<stage::MotionId, Gathered> motions_;  // motions that have not ended
};

}  // namespace axisgate::server::journal
