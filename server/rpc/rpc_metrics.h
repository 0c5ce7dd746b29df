// Calls by method and code, and the streams that are open, counted where gRPC hands every call through.
#pragma once

#include <grpcpp/support/server_interceptor.h>
#include <grpcpp/support/status_code_enum.h>
#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/gauge.h>
#include <prometheus/registry.h>

#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>

namespace axisgate::rpc {

// Of the methods that are served, whichever server serves or refuses them; a call of any other is not counted, so that
// no caller makes up a label. Thread safe.
class RpcMetrics {
 public:
  explicit RpcMetrics(prometheus::Registry& registry);

  // For a grpc::ServerBuilder. This outlives the server that it builds.
  std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> interceptor();

  // What the front answered by itself, which no interceptor sees: a call of "/axisgate.v1.StageService/Stop" that
  // ended.
  void count(std::string_view path, grpc::StatusCode code);

 private:
  class CallCount;
  class Factory;
  struct Method {
    prometheus::Counter& succeeded;     // with OK; other codes are seldom, and looked up
    prometheus::Gauge* open = nullptr;  // null: no stream
  };

  prometheus::Family<prometheus::Counter>& calls_;
  prometheus::Family<prometheus::Gauge>& open_streams_;
  std::unordered_map<std::string, Method> methods_;  // by "axisgate.v1.StageService/Move"; does not change
};

}  // namespace axisgate::rpc
