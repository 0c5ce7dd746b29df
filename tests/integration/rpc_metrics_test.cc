// Tests of the metrics of calls and streams.
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <thread>

#include "tests/integration/rpc_fixture.h"
#include "tests/paths/paths.h"

namespace axisgate::rpc {
namespace {

const std::string kWatch = "axisgate.v1.EventService/Watch";

class RpcMetricsTest : public RpcTest {
 protected:
  using Labels = std::map<std::string, std::string>;

  // Series of a family, with their values.
  std::map<Labels, double> family(const std::string& name) const {
    std::map<Labels, double> series;
    for (const prometheus::MetricFamily& one : gateway_->metrics().registry()->Collect()) {
      if (one.name != name) continue;
      for (const prometheus::ClientMetric& metric : one.metric) {
        Labels labels;
        for (const auto& label : metric.label) labels[label.name] = label.value;
        series[labels] = metric.counter.value + metric.gauge.value;
      }
    }
    return series;
  }

  std::set<std::string> methods() const {
    std::set<std::string> names;
    for (const auto& [labels, value] : family("axisgate_rpcs_total")) names.insert(labels.at("method"));
    return names;
  }

  // -1 when there is no such series.
  double calls(const std::string& method, const std::string& code) const {
    return find(family("axisgate_rpcs_total"), {{"method", method}, {"code", code}});
  }
  double open_streams(const std::string& method) const {
    return find(family("axisgate_open_streams"), {{"method", method}});
  }
  double slow_readers() const { return find(family("axisgate_slow_readers_total"), {}); }

  static double find(const std::map<Labels, double>& series, const Labels& labels) {
    const auto found = series.find(labels);
    return found == series.end() ? -1 : found->second;
  }

  template <class Condition>
  static bool wait_until(Condition condition) {
    const TimePoint limit = monotonic_now() + std::chrono::seconds(30);
    while (!condition()) {
      if (monotonic_now() > limit) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));  // between two looks
    }
    return true;
  }

  // Facts about nobody, so long that a few hundred fill what gRPC takes on for a reader.
  void publish(std::size_t facts) {
    const TimePoint now = monotonic_now();
    const stage::StopRequested fact{stage::AxisSet::first(3), false, std::string(4096, 'x')};
    for (std::size_t i = 0; i < facts; ++i) gateway_->events().publish("nobody", fact, server::to_wall(now));
  }

  // Watches from this revision on and returns the end of the stream.
  grpc::Status watch(std::uint64_t from) {
    grpc::ClientContext context;
    limit(context);
    v1::WatchRequest request;
    request.set_from_revision(from);
    const auto stream = events_->Watch(&context, request);
    v1::WatchResponse response;
    while (stream->Read(&response)) {
    }
    return stream->Finish();
  }
};

TEST_F(RpcMetricsTest, EveryMethodOfTheApiStandsThereFromTheStart) {
  std::size_t methods = 0;
  for (const auto& entry : std::filesystem::directory_iterator(paths::in_project("proto/axisgate/v1"))) {
    const auto* file = google::protobuf::DescriptorPool::generated_pool()->FindFileByName(
        "axisgate/v1/" + entry.path().filename().string());
    ASSERT_NE(file, nullptr) << entry;
    for (int i = 0; i < file->service_count(); ++i) {
      for (int k = 0; k < file->service(i)->method_count(); ++k) {
        const auto& method = *file->service(i)->method(k);
        const std::string name = file->service(i)->full_name() + "/" + method.name();
        EXPECT_GE(calls(name, "OK"), 0) << name;
        const bool streams = method.client_streaming() || method.server_streaming();
        EXPECT_EQ(open_streams(name) >= 0, streams) << name;
        ++methods;
      }
    }
  }
  EXPECT_GT(methods, 10u);
  EXPECT_EQ(calls("grpc.health.v1.Health/Check", "OK"), 0);
  EXPECT_EQ(calls("grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", "OK"), 0);
}

TEST_F(RpcMetricsTest, CallsCountByMethodAndCode) {
  const std::string name = "axisgate.v1.StageService/Move";
  EXPECT_EQ(calls(name, "OK"), 0);
  EXPECT_EQ(calls(name, "INVALID_ARGUMENT"), -1);
  EXPECT_TRUE(move(move_request(1, "1")).ok());
  EXPECT_FALSE(move(move_request(4, "1")).ok());
  EXPECT_FALSE(move(move_request(5, "1")).ok());
  EXPECT_EQ(calls(name, "OK"), 1);
  EXPECT_EQ(calls(name, "INVALID_ARGUMENT"), 2);
}

TEST_F(RpcMetricsTest, AMethodThatNobodyServesMakesNoSeries) {
  const std::set<std::string> before = methods();
  for (const char* method : {"/axisgate.v1.StageService/Fly", "/nobody.v1.Service/Method", "/", "/%20/\xff"}) {
    EXPECT_EQ(call(channel_, method).error_code(), grpc::UNIMPLEMENTED) << method;
  }
  EXPECT_EQ(methods(), before);
}

TEST_F(RpcMetricsTest, AStreamIsOpenUntilItEnds) {
  EXPECT_EQ(open_streams(kWatch), 0);
  grpc::ClientContext context;
  limit(context);
  const auto stream = events_->Watch(&context, v1::WatchRequest());
  stream->WaitForInitialMetadata();
  EXPECT_EQ(open_streams(kWatch), 1);
  EXPECT_EQ(calls(kWatch, "CANCELLED"), -1);
  context.TryCancel();
  stream->Finish();
  EXPECT_TRUE(wait_until([&] { return open_streams(kWatch) == 0; }));
  EXPECT_EQ(calls(kWatch, "CANCELLED"), 1);
}

TEST_F(RpcMetricsTest, AReaderThatFallsBehindIsSlowAndOneThatComesLateIsNot) {
  EXPECT_EQ(slow_readers(), 0);
  grpc::ClientContext context;
  limit(context);
  const auto stream = events_->Watch(&context, v1::WatchRequest());
  stream->WaitForInitialMetadata();
  publish(2 * server::EventBus::kFactsKept);
  v1::WatchResponse response;
  while (stream->Read(&response)) {
  }
  EXPECT_EQ(reason(stream->Finish()), v1::REASON_COMPACTED);
  EXPECT_EQ(slow_readers(), 1);

  EXPECT_EQ(reason(watch(1)), v1::REASON_COMPACTED);
  EXPECT_EQ(reason(watch(gateway_->events().newest_revision() + 2)), v1::REASON_COMPACTED);
  EXPECT_EQ(slow_readers(), 1);
}

class RefusedCallsTest : public RpcMetricsTest {
 protected:
  // The fixture's own channel takes the only place.
  RefusedCallsTest() { limits_.open = 1; }
};

TEST_F(RefusedCallsTest, CountByTheMethodThatWasRefusedUnlessThereIsNone) {
  const auto refused = new_channel();
  EXPECT_EQ(call(refused, "/axisgate.v1.StageService/Move").error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(calls("axisgate.v1.StageService/Move", "RESOURCE_EXHAUSTED"), 1);
  EXPECT_EQ(call(refused, "/axisgate.v1.EventService/Watch").error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(calls(kWatch, "RESOURCE_EXHAUSTED"), 1);
  EXPECT_EQ(open_streams(kWatch), 0);
  const std::set<std::string> before = methods();
  EXPECT_EQ(call(refused, "/axisgate.v1.StageService/Fly").error_code(), grpc::UNIMPLEMENTED);
  EXPECT_EQ(methods(), before);
}

class NotLetInTest : public RpcMetricsTest {
 protected:
  void configure(server::Config& config) override { config.limits.streams = 1; }

  double refused(const std::string& why) const { return find(family("axisgate_refusals_total"), {{"reason", why}}); }

  grpc::Status ask(const std::string& method, const std::string& authorization) {
    grpc::ClientContext context;
    limit(context);
    context.AddMetadata("authorization", authorization);
    return call(channel_, method, context);
  }
};

TEST_F(NotLetInTest, CallsThatAreNotLetInCountByReason) {
  for (const char* why : {"UNAUTHENTICATED", "NOT_ALLOWED", "QUEUE_FULL"}) EXPECT_EQ(refused(why), 0) << why;
  const server::Calendar now = server::calendar_now();
  const auto reads = access_->tokens().create("reads", server::Role::observer, now + std::chrono::hours(1), now);
  ASSERT_TRUE(reads) << reads.error().message;
  const std::string bearer = "Bearer " + *reads;
  EXPECT_EQ(ask("/axisgate.v1.StageService/Move", bearer + "0").error_code(), grpc::UNAUTHENTICATED);
  EXPECT_EQ(refused("UNAUTHENTICATED"), 1);
  EXPECT_EQ(ask("/axisgate.v1.StageService/Move", bearer).error_code(), grpc::PERMISSION_DENIED);
  EXPECT_EQ(refused("NOT_ALLOWED"), 1);

  grpc::ClientContext context;
  limit(context);
  context.AddMetadata("authorization", bearer);
  const auto stream = events_->Watch(&context, v1::WatchRequest());
  stream->WaitForInitialMetadata();
  EXPECT_EQ(refused("QUEUE_FULL"), 0);
  EXPECT_EQ(ask("/" + kWatch, bearer).error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(refused("QUEUE_FULL"), 1);
  context.TryCancel();
  stream->Finish();
  EXPECT_EQ(refused("UNAUTHENTICATED"), 1);
}

}  // namespace
}  // namespace axisgate::rpc
