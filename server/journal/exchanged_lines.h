// The lines that a device's controller is sent, with their answers, gathered for the journal.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "device/stage/event.h"

namespace axisgate::server::journal {

// On the device's strand.
class ExchangedLines {
 public:
  // Of one motion so many are gathered until its start or end is written.
  static constexpr std::size_t kGatheredMax = 64;

  struct Line {
    std::string text;                   // without CR LF
    std::optional<std::string> answer;  // or the name of an Outcome, where no answer came; nothing: not known
    std::optional<Duration> at;         // when it was written, since the request of its motion; nothing: it has none
  };
  struct Lines {
    stage::MotionId motion = 0;  // 0: none
    std::string who;
    stage::AxisSet axes;
    std::vector<Line> lines;
  };

  // What must have an entry of its own now: a line of no motion, unless it is a question, and what a motion has more
  // than kGatheredMax of.
  std::optional<Lines> on_event(const stage::Event& event, TimePoint now);

  // What was gathered since the last call. Of a motion that has ended it is the last: a line without an answer is
  // among them.
  std::vector<Line> take(const stage::Motion& motion);

 private:
  struct Written {
    std::uint64_t exchange = 0;
    TimePoint at{};
    bool question = false;
    Lines lines;  // this one
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

  std::optional<Written> open_;                  // its answer has not come
  std::map<stage::MotionId, Gathered> motions_;  // those that have not ended
};

}  // namespace axisgate::server::journal
