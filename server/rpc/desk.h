// Who is let in with which call, and the answers that the front gives itself: what a stop needs shares no thread with
// gRPC.
#pragma once

#include "server/api/api.h"
#include "server/front/desk.h"
#include "server/rpc/rpc_metrics.h"

namespace axisgate::rpc {

class Desk final : public front::Desk {
 public:
  // Both outlive this.
  Desk(api::Api& api, RpcMetrics& metrics) : api_(api), metrics_(metrics) {}

  front::Verdict judge(const front::Headers& headers, const front::Peer& peer, bool stops_only) override;
  front::Reply no_room() override;
  // Stop, EmergencyStop and ListDevices.
  void answer(const front::Headers& headers, const front::Peer& peer, const std::string& message,
              std::function<void(front::Reply)> reply) override;

 private:
  api::Api& api_;
  RpcMetrics& metrics_;
};

}  // namespace axisgate::rpc
