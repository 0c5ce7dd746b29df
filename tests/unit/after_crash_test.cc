// What the journal has of motions that the run before has left without an end.
#include "server/devices/after_crash.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "server/journal/store.h"
#include "tests/unit/link_fixtures.h"

namespace axisgate::server {
namespace {

using journal::EntryKind;

// Its request has an entry of its own that it was refused, if it has an id.
TEST(AfterCrash, AMotionThatWasNotSentIsMarkedAsRefusedIfItsRequestIs) {
  const link_test::TemporaryDirectory directory;
  const std::string path = directory / "journal.sqlite";
  const auto requested = [](std::uint64_t motion, std::string body) {
    return journal::Record{
        {.kind = EntryKind::motion_requested, .device = "stage", .motion = motion, .body = std::move(body)}};
  };
  ASSERT_TRUE(journal::Store::open(path)->append(
      std::vector<journal::Record>{{{.kind = EntryKind::daemon_started, .body = "{}"}},
                                   requested(1, R"({"kind":"move","request_id":"night-17"})"),
                                   requested(2, R"({"kind":"move"})")}));
  {
    const auto journal = *journal::Journal::open(path);
    journal::RequestMemory requests({}, "epoch", Duration::zero());
    settle_what_was_left(journal.get(), requests, [](std::string_view) { return std::vector<StartedMotion>(); });
  }
  const std::vector<journal::StoredEntry> kept = *journal::Store::open_to_read(path)->read({}, 10);
  ASSERT_EQ(kept.size(), 5u);
  EXPECT_EQ(kept[1].entry.body,
            R"({"kind":"move","outcome":"FAILED","reason":"NOT_SENT","refused":true,"request_id":"night-17"})");
  EXPECT_EQ(kept[0].entry.body, R"({"kind":"move","outcome":"FAILED","reason":"NOT_SENT"})");
}

}  // namespace
}  // namespace axisgate::server
