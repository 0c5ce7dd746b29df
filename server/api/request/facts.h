// Reader of the event bus that returns one fact at a time; internally it fetches several.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <variant>

#include "device/core/problem.h"
#include "server/api/request/subscription.h"
#include "server/events/event_bus.h"
#include "server/gateway.h"

namespace axisgate::api {

// A FactReader is not thread safe. It belongs to one subscription and is used under the subscription's mutex.
class FactReader {
 public:
  // Reads from revision `from` on; 0: from the oldest kept one. `gateway` must outlive this object.
  FactReader(server::Gateway& gateway, std::uint64_t from)
      : bus_(gateway.events()), slow_readers_(gateway.metrics().slow_readers()) {
    go_to(from);
  }

  void go_to(std::uint64_t revision) {
    portion_ = {{}, revision, false};
    taken_ = 0;
    was_kept_ = !bus_.read(revision, 0).compacted;
  }
  // Skips all published facts. A device publishes its facts on its strand only, so a caller on that strand misses none
  // after the state that is seen there.
  void go_to_newest() { go_to(bus_.newest_revision() + 1); }

  struct Compacted {
    std::uint64_t resume = 0;
  };
  struct Nothing {};
  using Reading = std::variant<Nothing, std::shared_ptr<const server::FactRecord>, Compacted>;

  Reading next() {
    if (taken_ == portion_.facts.size()) {
      portion_ = bus_.read(portion_.next, kPortion);
      taken_ = 0;
      if (portion_.compacted) {
        // A reader that requested a revision that was already dropped came late; it was not a slow reader.
        if (was_kept_) slow_readers_.Increment();
        return Compacted{portion_.next};
      }
      if (portion_.facts.empty()) return Nothing{};
    }
    return std::move(portion_.facts[taken_++]);
  }

 private:
  static constexpr std::size_t kPortion = 64;

  const server::EventBus& bus_;
  prometheus::Counter& slow_readers_;
  server::EventBus::Reading portion_;
  bool was_kept_ = true;  // the first revision to read was still kept
  std::size_t taken_ = 0;
};

// Returns the end of a stream whose reader was too slow, or requested a revision of another run.
inline StreamEnd compacted_at(std::uint64_t resume) {
  return {Problem{.reason = Reason::compacted,
                  .message = "the events from the requested revision on are not all kept",
                  .hint = "resume from metadata[\"resume_revision\"], and read the present state of what was missed"},
          resume};
}

}  // namespace axisgate::api
