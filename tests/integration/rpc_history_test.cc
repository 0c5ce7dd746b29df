// The journal as callers read it: pages in both orders, conditions, a night. The journal is written by hand.
#include <gmock/gmock.h>
#include <google/protobuf/util/time_util.h>

#include <filesystem>
#include <string>
#include <vector>

#include "axisgate/v1/history.grpc.pb.h"
#include "server/journal/journal.h"
#include "server/journal/store.h"
#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

using google::protobuf::util::TimeUtil;
using server::journal::Entry;
using server::journal::EntryKind;
using server::journal::Record;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::int64_t kEvening = 1'795'456'800;  // 2026-11-23 18:00:00 UTC

Entry entry(EntryKind kind, int after_evening_s, std::string body, std::string device = "stage") {
  const auto time = server::WallTime(std::chrono::seconds(kEvening + after_evening_s));
  return {.kind = kind, .time = time, .device = std::move(device), .body = std::move(body)};
}

Entry by(std::string who, Entry entry) {
  entry.who = std::move(who);
  return entry;
}

class RpcHistory : public RpcTest {
 protected:
  void SetUp() override {
    using enum EntryKind;
    Entry moved = by(
        "unix anna",
        entry(
            motion_ended, 3,
            R"({"axes":[1],"kind":"move","outcome":"SUCCEEDED","results":[{"axis":1,"command_pulses":100,"target_pulses":100}]})"));
    Entry returned =
        by("unix anna", entry(motion_ended, 4, R"({"axes":[2],"kind":"return-to-origin","outcome":"FAILED"})"));
    ASSERT_TRUE(server::journal::Store::open(path_)->append(
        std::vector<Record>{{entry(daemon_started, 1, "{}", "")},
                            {entry(link_changed, 2, R"({"link":"DOWN"})")},
                            {moved},
                            {returned},
                            {by("unix bert", entry(stop_requested, 5, R"({"axes":[1,2,3],"emergency":true})"))},
                            {entry(link_changed, 6, R"({"link":"UP"})")},
                            {entry(daemon_started, 7, "{}", "")}}));
    journal_ = *server::journal::Journal::open(path_);
    RpcTest::SetUp();
    history_ = v1::HistoryService::NewStub(channel_);
  }
  void TearDown() override {
    RpcTest::TearDown();
    journal_.reset();
    std::filesystem::remove_all(path_);
    for (const char* suffix : {"-wal", "-shm"}) std::filesystem::remove(path_ + suffix);
  }

  // Returns a request for the entries that the test has written; those of the daemon are later.
  static v1::ListHistoryRequest by_hand() {
    v1::ListHistoryRequest request;
    *request.mutable_end_time() = TimeUtil::SecondsToTimestamp(kEvening + 60);
    return request;
  }
  grpc::Status list(const v1::ListHistoryRequest& request, v1::ListHistoryResponse* response) {
    grpc::ClientContext context;
    limit(context);
    return history_->ListHistory(&context, request, response);
  }
  std::vector<std::int64_t> numbers(const v1::ListHistoryRequest& request) {
    v1::ListHistoryResponse response;
    const grpc::Status status = list(request, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    std::vector<std::int64_t> all;
    for (const v1::HistoryEntry& one : response.entries()) all.push_back(one.number());
    return all;
  }
  v1::Reason refused(const v1::ListHistoryRequest& request) {
    v1::ListHistoryResponse response;
    return reason(list(request, &response));
  }
  grpc::Status summarize(const v1::SummarizeHistoryRequest& request, v1::SummarizeHistoryResponse* response) {
    grpc::ClientContext context;
    limit(context);
    return history_->SummarizeHistory(&context, request, response);
  }

  const std::string path_ = directory_ + ".journal";
  std::unique_ptr<v1::HistoryService::Stub> history_;
};

TEST_F(RpcHistory, ResultsHaveNamesAndUnits) {
  v1::ListHistoryRequest request = by_hand();
  request.set_caller("unix anna");
  request.set_order(v1::ListHistoryRequest::ORDER_OLDEST_FIRST);
  v1::ListHistoryResponse response;
  ASSERT_TRUE(list(request, &response).ok());
  ASSERT_EQ(response.entries_size(), 2);
  ASSERT_EQ(response.entries(0).results_size(), 1);
  const v1::AxisResult& result = response.entries(0).results(0);
  EXPECT_EQ(result.axis(), 1);
  EXPECT_EQ(result.command_pulses(), 100);
  EXPECT_EQ(result.target_pulses(), 100);
  EXPECT_EQ(result.position(), "1") << "um; a pulse is 10 nm";
  EXPECT_EQ(response.entries(1).results_size(), 0);
}

TEST_F(RpcHistory, PagesFollowEachOtherInBothOrders) {
  for (const auto order : {v1::ListHistoryRequest::ORDER_OLDEST_FIRST, v1::ListHistoryRequest::ORDER_NEWEST_FIRST}) {
    v1::ListHistoryRequest request = by_hand();
    request.set_order(order);
    request.set_page_size(3);
    std::vector<std::int64_t> all;
    v1::ListHistoryResponse page;
    do {
      ASSERT_TRUE(list(request, &page).ok());
      for (const v1::HistoryEntry& one : page.entries()) all.push_back(one.number());
      request.set_page_token(page.next_page_token());
    } while (!page.next_page_token().empty() && all.size() < 10);
    if (order == v1::ListHistoryRequest::ORDER_OLDEST_FIRST) {
      EXPECT_THAT(all, ElementsAre(1, 2, 3, 4, 5, 6, 7));
    } else {
      EXPECT_THAT(all, ElementsAre(7, 6, 5, 4, 3, 2, 1));
    }
  }
}

TEST_F(RpcHistory, WhoFollowsTheJournalBeginsAfterItsNewest) {
  v1::ListHistoryRequest request = by_hand();
  request.set_after(5);
  EXPECT_THAT(numbers(request), ElementsAre(7, 6));
  request.set_text("nothing of this kind");
  v1::ListHistoryResponse nothing;
  ASSERT_TRUE(list(request, &nothing).ok());
  EXPECT_THAT(nothing.entries(), IsEmpty());
  EXPECT_GE(nothing.newest(), 7) << "whether it fulfils the conditions or not";
}

TEST_F(RpcHistory, EachConditionCounts) {
  v1::ListHistoryRequest axis = by_hand();
  axis.set_axis("2");
  EXPECT_THAT(numbers(axis), ElementsAre(5, 4));
  v1::ListHistoryRequest outcome = by_hand();
  outcome.set_outcome(v1::MOTION_STATE_FAILED);
  EXPECT_THAT(numbers(outcome), ElementsAre(4));
  v1::ListHistoryRequest text = by_hand();
  text.set_text("return-to");
  EXPECT_THAT(numbers(text), ElementsAre(4));
  v1::ListHistoryRequest device = by_hand();
  device.set_device("devices/stage");
  device.set_caller("unix bert");
  EXPECT_THAT(numbers(device), ElementsAre(5));
}

TEST_F(RpcHistory, WhatIsNoConditionIsRefused) {
  v1::ListHistoryRequest axis;
  for (const char* unknown : {"9", "-1", "nowhere"}) {
    axis.set_axis(unknown);
    EXPECT_EQ(refused(axis), v1::REASON_UNKNOWN_AXIS) << unknown;
  }
  v1::ListHistoryRequest outcome;
  outcome.set_outcome(v1::MOTION_STATE_RUNNING);
  EXPECT_EQ(refused(outcome), v1::REASON_INVALID_REQUEST);
  outcome.set_outcome(static_cast<v1::MotionState>(77));
  EXPECT_EQ(refused(outcome), v1::REASON_INVALID_REQUEST);
  v1::ListHistoryRequest page;
  page.set_page_size(1001);
  EXPECT_EQ(refused(page), v1::REASON_INVALID_REQUEST);
  v1::ListHistoryRequest token;
  token.set_page_token("-1");
  EXPECT_EQ(refused(token), v1::REASON_INVALID_REQUEST);
  v1::ListHistoryRequest device;
  device.set_device("devices/other");
  EXPECT_EQ(refused(device), v1::REASON_UNKNOWN_DEVICE);
}

TEST_F(RpcHistory, ATimeBeyondTheClockIsTheEnd) {
  v1::ListHistoryRequest request;
  *request.mutable_end_time() = TimeUtil::SecondsToTimestamp(TimeUtil::kTimestampMaxSeconds);
  request.set_order(v1::ListHistoryRequest::ORDER_OLDEST_FIRST);
  request.set_page_size(1);
  EXPECT_THAT(numbers(request), ElementsAre(1));
}

TEST_F(RpcHistory, ANightIsSummedUp) {
  v1::SummarizeHistoryRequest request;
  *request.mutable_start_time() = TimeUtil::SecondsToTimestamp(kEvening);
  *request.mutable_end_time() = TimeUtil::SecondsToTimestamp(kEvening + 60);
  v1::SummarizeHistoryResponse night;
  ASSERT_TRUE(summarize(request, &night).ok());
  ASSERT_EQ(night.persons_size(), 2);
  const v1::PersonSummary& anna = night.persons(0);
  EXPECT_EQ(anna.caller().name(), "unix anna");
  EXPECT_EQ(anna.first_time().seconds(), kEvening + 3);
  EXPECT_EQ(anna.last_time().seconds(), kEvening + 4);
  ASSERT_EQ(anna.motions_size(), 2);
  EXPECT_EQ(anna.motions(0).kind(), v1::MOTION_KIND_MOVE);
  EXPECT_EQ(anna.motions(0).outcome(), v1::MOTION_STATE_SUCCEEDED);
  EXPECT_EQ(anna.motions(0).count(), 1);
  EXPECT_EQ(anna.motions(1).kind(), v1::MOTION_KIND_RETURN_TO_ORIGIN);
  EXPECT_EQ(anna.motions(1).outcome(), v1::MOTION_STATE_FAILED);
  ASSERT_EQ(night.stops_size(), 1);
  EXPECT_EQ(night.stops(0).caller().name(), "unix bert");
  EXPECT_EQ(night.stops(0).device(), "devices/stage");
  EXPECT_TRUE(night.stops(0).emergency());
  ASSERT_EQ(night.link_losses_size(), 1);
  EXPECT_EQ(night.link_losses(0).device(), "devices/stage");
  EXPECT_EQ(night.link_losses(0).down_time().seconds(), kEvening + 2);
  EXPECT_EQ(night.link_losses(0).up_time().seconds(), kEvening + 6);
  ASSERT_EQ(night.daemon_starts_size(), 2);
  EXPECT_FALSE(night.daemon_starts(0).after_unclean_end());
  EXPECT_TRUE(night.daemon_starts(1).after_unclean_end());
}

TEST_F(RpcHistory, ANightThatEndsBeforeItBeginsIsRefused) {
  v1::SummarizeHistoryRequest request;
  v1::SummarizeHistoryResponse night;
  *request.mutable_start_time() = TimeUtil::SecondsToTimestamp(kEvening);
  *request.mutable_end_time() = TimeUtil::SecondsToTimestamp(kEvening - 1);
  EXPECT_EQ(reason(summarize(request, &night)), v1::REASON_INVALID_REQUEST);
  request.clear_end_time();
  request.set_device("devices/other");
  EXPECT_EQ(reason(summarize(request, &night)), v1::REASON_UNKNOWN_DEVICE);
}

}  // namespace
}  // namespace axisgate::rpc
