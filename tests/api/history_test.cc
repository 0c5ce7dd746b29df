// Tests of the rights to read entries and to erase a name, with a real journal of the gateway.
#include <gmock/gmock.h>

#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "tests/api/ask.h"
#include "tests/api/log.h"

namespace axisgate::api {
namespace {

using server::Role;
using server::journal::EntryKind;
using server::journal::Filter;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kOlaf = "unix olaf";  // has the role observer

class HistoryOfApi : public ::testing::Test {
 protected:
  // Starts a world in which each of four callers has stopped the device once, in this order.
  void start(Role others_seen_by) {
    world_ = std::make_unique<World>(
        [&](World& configured) { configured.journal_config = {.kept = true, .others_seen_by = others_seen_by}; });
    for (const char* who : {kAdmin, kAnna, kOlaf, "tcp 127.0.0.1:39482"}) {
      ASSERT_EQ(ask(*world_, RequestKind::stop, World::by(who)), Reason::unspecified);
    }
  }

  Result<HistoryPage> list(const std::string& who, Filter filter = {}, int page_size = 100) {
    Asking<HistoryPage> page;
    world_->api->history.list(World::by(who), std::move(filter), page_size, page.answer());
    return page.get();
  }
  // Returns the callers of the stops that `reader` can read, oldest first.
  std::vector<std::string> stops(const std::string& reader, Filter filter = {}) {
    filter.kinds = {EntryKind::stop_requested};
    filter.oldest_first = true;
    std::vector<std::string> callers;
    const auto page = list(reader, filter);
    EXPECT_TRUE(page) << page.error().message;
    for (const auto& stored : page->entries) callers.push_back(stored.entry.who);
    return callers;
  }
  Result<HistorySummary> summary(const std::string& who) {
    Asking<HistorySummary> asking;
    world_->api->history.summarize(World::by(who), server::journal::Span(), asking.answer());
    return asking.get();
  }
  Result<server::journal::NamedPerson> erase(const std::string& by, const std::string& who) {
    Asking<server::journal::NamedPerson> asking;
    world_->api->history.erase(World::by(by), who, asking.answer());
    return asking.get();
  }

  std::unique_ptr<World> world_;
};

TEST_F(HistoryOfApi, ByDefaultEverybodyReadsAll) {
  start(server::JournalConfig().others_seen_by);
  EXPECT_EQ(stops(kOlaf).size(), 4u);
  EXPECT_FALSE(list(kOlaf)->own_only);
  EXPECT_THAT(stops(kOlaf, {.who = kAnna}), ElementsAre(kAnna));
  EXPECT_EQ(summary(kOlaf)->summary.stops.items.size(), 4u);
  EXPECT_FALSE(summary(kOlaf)->own_only);
}

TEST_F(HistoryOfApi, ALowerRoleReadsItsOwnEntriesAndThoseOfNobody) {
  start(Role::operator_);
  EXPECT_THAT(stops(kOlaf), ElementsAre(kOlaf));
  EXPECT_TRUE(list(kOlaf)->own_only);
  EXPECT_EQ(stops(kAnna).size(), 4u) << "an operator";
  EXPECT_FALSE(list(kAnna)->own_only);
  const auto link = list(kOlaf, {.kinds = {EntryKind::link_changed}});
  EXPECT_FALSE(link->entries.empty()) << "what nobody requested";
  const auto night = summary(kOlaf);
  ASSERT_TRUE(night);
  EXPECT_TRUE(night->own_only);
  EXPECT_EQ(night->summary.stops.items.size(), 1u);
  EXPECT_EQ(night->summary.persons.items.size(), 1u);
}

TEST_F(HistoryOfApi, AnonymousCallersAreOne) {
  start(Role::admin);
  EXPECT_THAT(stops("tcp 127.0.0.1:50000"), ElementsAre("tcp 127.0.0.1:39482"));
  EXPECT_THAT(stops("tcp 127.0.0.1:50000", {.who = "tcp 127.0.0.1:39482"}), ElementsAre("tcp 127.0.0.1:39482"));
}

TEST_F(HistoryOfApi, PagesAreFullAndTheNewestNumberStays) {
  start(Role::admin);
  const auto all = list(kAdmin), own = list(kAnna, {.kinds = {EntryKind::stop_requested}}, 1);
  ASSERT_TRUE(all && own);
  EXPECT_EQ(own->entries.size(), 1u);
  EXPECT_FALSE(own->more);
  EXPECT_EQ(own->newest, all->newest);
}

TEST_F(HistoryOfApi, AskingForAnotherCallerIsRefusedWithTheNameOfTheKey) {
  start(Role::operator_);
  const auto refused = list(kOlaf, {.who = kAnna});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, Reason::not_allowed);
  EXPECT_EQ(refused.error().message,
            "reading what other callers did needs the role operator, and unix olaf is observer");
  EXPECT_THAT(refused.error().hint, HasSubstr("`others_seen_by` in [journal]"));
  EXPECT_THAT(stops(kOlaf, {.who = kOlaf}), ElementsAre(kOlaf));
}

TEST_F(HistoryOfApi, EverybodyVerifiesTheWholeJournal) {
  start(Role::admin);
  Asking<JournalVerdict> verdict;
  world_->api->history.verify(World::by(kOlaf), std::nullopt, verdict.answer());
  EXPECT_EQ(verdict.get()->verdict.rows, list(kAdmin)->newest);
}

// A SlowVerification keeps a verification of the journal running until the test ends it.
class SlowVerification {
 public:
  explicit SlowVerification(const World& world) {
    world.api->history.verify(World::by(kOlaf), std::nullopt, [this](const Result<JournalVerdict>&) {
      begun_.set_value();
      may_end_.get_future().wait();
    });
    begun_.get_future().wait();
  }
  void end() { may_end_.set_value(); }

 private:
  std::promise<void> begun_, may_end_;
};

TEST_F(HistoryOfApi, IsReadWhileAnotherCallerVerifiesIt) {
  start(Role::observer);
  SlowVerification slow(*world_);
  EXPECT_TRUE(list(kAnna));
  EXPECT_TRUE(summary(kAnna));
  slow.end();
}

TEST_F(HistoryOfApi, CallersTakeTurnsToVerifyIt) {
  start(Role::observer);
  SlowVerification slow(*world_);
  struct Order {
    std::mutex mutex;
    std::vector<std::string> callers;
    std::promise<void> all_done;
  };
  const auto order =
      std::make_shared<Order>();  // shared, because the worker may still run the last callback when the test continues
  for (const char* who : {kOlaf, kOlaf, kOlaf, kAnna}) {
    world_->api->history.verify(World::by(who), std::nullopt, [order, who](const Result<JournalVerdict>&) {
      const std::lock_guard lock(order->mutex);
      order->callers.emplace_back(who);
      if (order->callers.size() == 4) order->all_done.set_value();
    });
  }
  slow.end();
  ASSERT_EQ(order->all_done.get_future().wait_for(kTestPatience), std::future_status::ready);
  EXPECT_THAT(order->callers, ElementsAre(kOlaf, kAnna, kOlaf, kOlaf));
}

TEST_F(HistoryOfApi, ANameIsErasedWhenNobodyReadsOrVerifies) {
  start(Role::observer);
  SlowVerification slow(*world_);
  Asking<server::journal::NamedPerson> asking;
  world_->api->history.erase(World::by(kAdmin), kAnna, asking.answer());
  EXPECT_TRUE(list(kOlaf));
  EXPECT_FALSE(asking.answered());
  slow.end();
  EXPECT_TRUE(asking.get());
}

TEST_F(HistoryOfApi, AnAdministratorErasesAName) {
  start(Role::observer);
  Log log;
  const auto erased = erase(kAdmin, kAnna);
  ASSERT_TRUE(erased) << erased.error().message;
  EXPECT_EQ(erased->entries, 2) << "the stop, and its line with the answer";
  EXPECT_THAT(stops(kOlaf, {.who = kAnna}), IsEmpty());
  EXPECT_THAT(stops(kOlaf, {.who = server::journal::erased_name(erased->number)}).size(), 1u);
  EXPECT_EQ(log.text(), "unix root erased the name of caller 2 from the journal\n") << "without the name";
}

TEST_F(HistoryOfApi, ANameThatIsNotThereIsNamed) {
  start(Role::observer);
  const auto erased = erase(kAdmin, "anna");
  ASSERT_FALSE(erased);
  EXPECT_EQ(erased.error().reason, Reason::not_found);
  EXPECT_EQ(erased.error().message, "the journal has no caller \"anna\"");
}

}  // namespace
}  // namespace axisgate::api
