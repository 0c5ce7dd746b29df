#include "server/rpc/stop_only.h"

#include "server/rpc/status.h"

namespace axisgate::rpc {
namespace {

grpc::Status refusal() {
  return to_status({Reason::queue_full,
                    "the daemon has no connection or descriptor left, and serves nothing but a stop on this connection",
                    "close connections that nobody uses, or raise the daemon's limit of open files (ulimit -n, or "
                    "LimitNOFILE= of its service), and ask again",
                    {},
                    {},
                    {}});
}

class Refusal final : public grpc::ServerGenericBidiReactor {
 public:
  Refusal() { Finish(refusal()); }
  void OnDone() override { delete this; }
};

}  // namespace

grpc::ServerGenericBidiReactor* RefusingService::CreateReactor(grpc::GenericCallbackServerContext*) {
  return new Refusal;
}

}  // namespace axisgate::rpc
