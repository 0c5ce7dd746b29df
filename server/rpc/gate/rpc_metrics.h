// Calls by method and code, and the streams that are open, counted where gRPC hands every call through.
#pragma once

#include <grpcpp/support/server_interceptor.h>
#include <grpcpp/support/status_code_enum.h>
#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/gauge.h>
#include <prometheus/registry.h>

#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace axisgate::rpc {

// Of the methods that are served, whichever server serves or refuses them; a call of any other is not counted, so that
// no caller makes up a label. Thread safe.
class RpcMetrics {
 public:
  class Call;

  explicit RpcMetrics(prometheus::Registry& registry);

  // For a grpc::ServerBuilder. This outlives the server that it builds.
  std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> interceptor();

  // What the front refused by itself, which no interceptor sees: a call of "/axisgate.v1.StageService/Move" that ended.
  void count(std::string_view path, grpc::StatusCode code);

 private:
  class CallCount;
  class Factory;
  struct Method {
    prometheus::Counter& succeeded;     // with OK; other codes are seldom, and looked up
    prometheus::Gauge* open = nullptr;  // null: no stream
  };
  using Entry = std::pair<const std::string, Method>;

  // Of "/axisgate.v1.StageService/Move", or whatever a caller wrote.
  static std::string without_slash(std::string_view path) { return std::string(path.substr(path.empty() ? 0 : 1)); }

  prometheus::Family<prometheus::Counter>& calls_;
  prometheus::Family<prometheus::Gauge>& open_streams_;
  std::unordered_map<std::string, Method> methods_;  // by "axisgate.v1.StageService/Move"; does not change
};

// A call that is served: open from its arrival until its end, which is CANCELLED if it goes without one.
class RpcMetrics::Call {
 public:
  // The metrics outlive it. `path` is of a method that is served.
  Call(RpcMetrics& metrics, std::string_view path) : Call(metrics, *metrics.methods_.find(without_slash(path))) {}
  Call(RpcMetrics& metrics, const Entry& method);
  ~Call() { ended(grpc::CANCELLED); }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  void ended(grpc::StatusCode code);  // the first time counts

 private:
  RpcMetrics& metrics_;
  const Entry& method_;
  std::atomic<bool> open_ = true;
};

}  // namespace axisgate::rpc
