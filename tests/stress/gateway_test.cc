// Stress tests of the gateway below gRPC: eight threads send requests, others read, cables are pulled, and the gateway
// ends in the middle. The tests are bounded by counts, so that a slow machine or a sanitizer does the same work. They
// are meant for ThreadSanitizer, but also useful without it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <thread>
#include <variant>
#include <vector>

#include "device/link/clock.h"
#include "device/stage/recording/recording.h"
#include "tests/stress/bench.h"
#include "tests/stress/caller.h"
#include "tests/stress/readers.h"
#include "tests/unit/server/metrics_page.h"

namespace axisgate::stress {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr unsigned kCallers = 8;

class GatewayStress : public testing::Test {
 protected:
  GatewayStress() {
    for (unsigned number = 0; number < kCallers; ++number) callers_.push_back(std::make_unique<Caller>(bench_, number));
  }
  // Ends the gateway first, because the callers must outlive all callbacks.
  ~GatewayStress() override { bench_.end_gateway(); }

  template <class Work>
  std::vector<std::thread> start_callers(Work work) {
    std::vector<std::thread> threads;
    for (auto& caller : callers_) threads.emplace_back([&caller, work] { work(*caller); });
    return threads;
  }

  std::size_t issued() const {
    std::size_t count = 0;
    for (const auto& caller : callers_) count += caller->ledger().issued();
    return count;
  }

  // Waits until `count` requests have been made.
  void wait_until_issued(std::size_t count) {
    const TimePoint limit = monotonic_now() + std::chrono::minutes(2);
    while (issued() < count) {
      ASSERT_LT(monotonic_now(), limit) << issued() << " of " << count;
      std::this_thread::sleep_for(std::chrono::microseconds(200));  // pause between two checks
    }
  }

  std::vector<std::unique_ptr<Caller>> callers_;
  Bench bench_;
};

void join(std::vector<std::thread>& threads) {
  for (auto& thread : threads) thread.join();
}

void look_at_metrics(int port, int pages) {
  for (int i = 0; i < pages; ++i) {
    EXPECT_THAT(server::metrics_page(port),
                AllOf(HasSubstr("HTTP/1.1 200 OK"), HasSubstr("axisgate_link_up{device=\"stage1\"}"),
                      HasSubstr("axisgate_queue_depth{device=\"stage3\",lane=\"poll\"}")));
  }
}

class GatewayUnderLoad : public GatewayStress {
 protected:
  static constexpr int kRequests = 200;
  static constexpr std::size_t kWindow = 6, kUnplugs = 12;

  // Unplugs and plugs the devices in turn, in the middle of the requests.
  void pull_cables() {
    for (std::size_t unplug = 1; unplug <= kUnplugs; ++unplug) {
      wait_until_issued(unplug * kCallers * kRequests / (kUnplugs + 1));
      const std::size_t device = unplug % kDevices;
      bench_.unplug(device);
      // Every second time the cable is back before the gateway may have noticed.
      if (unplug % 2 == 0) {
        EXPECT_TRUE(bench_.wait_until_link(device, false));
      }
      bench_.plug(device);
    }
  }

  void expect_all_answered() {
    int right = 0, motions = 0;
    for (const auto& caller : callers_) {
      EXPECT_TRUE(caller->ledger().wait_until_open(0));
      right += caller->right_answers();
      motions += caller->motions_started();
    }
    // Most requests wait for the device to be up, and cables are rarely pulled, so problems are the exception.
    EXPECT_GT(right, static_cast<int>(kCallers) * kRequests / 2);
    EXPECT_GT(motions, static_cast<int>(kCallers) * kRequests / 20);
  }

  // Expects complete recordings, including all reconnections. Separate threads write them until the end.
  void expect_whole_recordings() {
    for (std::size_t device = 0; device < kDevices; ++device) {
      const Result<stage::Recording> recording = stage::parse_recording(bench_.recording(device));
      ASSERT_TRUE(recording) << recording.error().message;
      const auto told = [&](stage::RecordedRemark::Kind kind) {
        return std::ranges::count_if(recording->lines, [&](const stage::RecordedLine& line) {
          const auto* remark = std::get_if<stage::RecordedRemark>(&line.event);
          return remark != nullptr && remark->kind == kind;
        });
      };
      EXPECT_EQ(told(stage::RecordedRemark::Kind::note), 0) << "lines were lost";
      EXPECT_GE(told(stage::RecordedRemark::Kind::up), 1);
      EXPECT_GT(recording->lines.size(), 100u);
    }
  }

  void expect_nothing_is_held() {
    for (const auto& caller : callers_) EXPECT_EQ(caller->ledger().wrong(false), "");
  }
};

TEST_F(GatewayUnderLoad, EverybodyIsAnsweredOnceAndByTheRightDevice) {
  server::Gateway& gateway = bench_.gateway();
  const Result<int> port = gateway.metrics().expose({"127.0.0.1", 0});
  ASSERT_TRUE(port) << port.error().message;
  gateway.start();
  auto quick = std::make_unique<QuickReader>(gateway.events());
  std::vector<std::unique_ptr<StateReader>> states;
  for (std::size_t device = 0; device < kDevices; ++device) {
    states.push_back(std::make_unique<StateReader>(bench_, device));
  }
  std::atomic<bool> ended = false;
  auto told = std::async(std::launch::async, [&] { return read_slowly(gateway.events(), ended); });
  std::vector<std::thread> others;
  others.emplace_back([&] { publish_facts(gateway.events(), *quick, 25'000); });
  for (int i = 0; i < 2; ++i) others.emplace_back([&] { come_and_go(gateway, 1500); });
  others.emplace_back([&] { look_at_metrics(*port, 50); });
  auto callers = start_callers([](Caller& caller) { caller.ask(kRequests, kWindow); });

  pull_cables();
  join(callers);
  join(others);
  expect_all_answered();
  EXPECT_TRUE(bench_.wait_until_all_up());
  EXPECT_TRUE(quick->wait_until_all_ended());
  ended = true;
  EXPECT_GE(told.get(), 1) << "the slow reader was never too slow";
  states.clear();
  quick.reset();
  bench_.end_gateway();
  expect_nothing_is_held();
  expect_whole_recordings();
}

// The lines end while callers still send requests and cables are pulled. Every request is answered at most once, and no
// request is left behind.
class GatewayEnding : public GatewayStress, public testing::WithParamInterface<std::size_t> {};

TEST_P(GatewayEnding, InTheMiddleOfEverything) {
  server::Gateway& gateway = bench_.gateway();
  gateway.start();
  auto quick = std::make_unique<QuickReader>(gateway.events());
  if (GetParam() > 0) {
    ASSERT_TRUE(bench_.wait_until_all_up());
  }
  auto callers = start_callers([](Caller& caller) { caller.flood(100); });
  auto cable = std::async(std::launch::async, [&] { bench_.unplug(0); });
  wait_until_issued(GetParam());
  for (const auto& device : gateway.devices()) device->shutdown();
  join(callers);
  cable.get();
  quick.reset();
  bench_.end_gateway();
  for (const auto& caller : callers_) EXPECT_EQ(caller->ledger().wrong(true), "");
}

INSTANTIATE_TEST_SUITE_P(AfterRequests, GatewayEnding, testing::Values(0, 100, 300, 500, 700, 800));

}  // namespace
}  // namespace axisgate::stress
