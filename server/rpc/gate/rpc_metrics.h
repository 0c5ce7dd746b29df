// Counts of calls by method and code, and of open streams, from gRPC's interceptors.
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

// Counts the served methods only, so that no caller can invent a label; calls that the front serves or refuses count as
// well. Thread safe.
class RpcMetrics {
 public:
  class Call;

  explicit RpcMetrics(prometheus::Registry& registry);

  // Returns an interceptor for a grpc::ServerBuilder. This object must outlive the server.
  std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> interceptor();

  // Counts an ended call that the front refused itself, which no interceptor sees. `path` is like
  // "/axisgate.v1.StageService/Move".
  void count(std::string_view path, grpc::StatusCode code);

 private:
  class CallCount;
  class Factory;
  struct Method {
    prometheus::Counter& succeeded;     // with OK; other codes are rare and looked up
    prometheus::Gauge* open = nullptr;  // null: not a stream
  };
  using Entry = std::pair<const std::string, Method>;

  // `path` is like "/axisgate.v1.StageService/Move", or any text that a caller wrote.
  static std::string without_slash(std::string_view path) { return std::string(path.substr(path.empty() ? 0 : 1)); }

  prometheus::Family<prometheus::Counter>& calls_;
  prometheus::Family<prometheus::Gauge>& open_streams_;
  std::unordered_map<std::string, Method> methods_;  // by "axisgate.v1.StageService/Move"; does not change
};

// A served call is open from its arrival until its end. It counts as CANCELLED if it is destroyed without an end.
class RpcMetrics::Call {
 public:
  // The metrics must outlive this object. `path` is that of a served method.
  Call(RpcMetrics& metrics, std::string_view path) : Call(metrics, *metrics.methods_.find(without_slash(path))) {}
  Call(RpcMetrics& metrics, const Entry& method);
  ~Call() { ended(grpc::CANCELLED); }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  void ended(grpc::StatusCode code);  // only the first call counts

 private:
  RpcMetrics& metrics_;
  const Entry& method_;
  std::atomic<bool> open_ = true;
};

}  // namespace axisgate::rpc
