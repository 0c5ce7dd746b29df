#include "server/rpc/stop_only.h"

#include "server/rpc/status.h"

namespace axisgate::rpc {
namespace {

grpc::Status refusal() {
  return to_status(
      {.reason = Reason::queue_full,
       .message =
           "the daemon has no connection or descriptor left for this caller, and serves nothing but a stop on this "
           "connection",
       .hint = "close connections that nobody uses, and ask again in 1 s; or have the daemon's limit of open files "
               "raised (ulimit -n, or LimitNOFILE= of its service), or `connections` in [limits] of its "
               "configuration"});
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
