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

StopService::StopService(StageService& stage) : stage_(stage) {
  const auto* service = api::StopRequest::descriptor()->file()->FindServiceByName("StageService");
  for (int i = 0; i < service->method_count(); ++i) {
    const std::string& name = service->method(i)->name();
    if (name != "Stop" && name != "EmergencyStop") MarkMethodGeneric(i);
  }
}

grpc::ServerUnaryReactor* StopService::Stop(grpc::CallbackServerContext* context, const api::StopRequest* request,
                                            api::StopResponse* response) {
  return stage_.Stop(context, request, response);
}

grpc::ServerUnaryReactor* StopService::EmergencyStop(grpc::CallbackServerContext* context,
                                                     const api::EmergencyStopRequest* request,
                                                     api::EmergencyStopResponse* response) {
  return stage_.EmergencyStop(context, request, response);
}

grpc::ServerGenericBidiReactor* RefusingService::CreateReactor(grpc::GenericCallbackServerContext*) {
  return new Refusal;
}

}  // namespace axisgate::rpc
