// Admission of calls, and the answers that the front gives itself. The path of a stop shares no thread with gRPC.
#pragma once

#include "server/api/api.h"
#include "server/front/call_filter.h"
#include "server/rpc/gate/own_answers.h"
#include "server/rpc/gate/refusals.h"
#include "server/rpc/gate/rpc_metrics.h"

namespace axisgate::rpc {

class CallFilter final : public front::CallFilter {
 public:
  // The referenced objects must outlive this one.
  CallFilter(const server::Gateway& gateway, api::Api& api, RpcMetrics& metrics, Refusals& refusals)
      : api_(api), metrics_(metrics), refusals_(refusals), answers_(gateway, api) {}

  front::Decision decide(const front::Headers& headers, const front::Peer& peer, bool stops_only) override;
  front::Reply no_room() override;
  std::unique_ptr<front::Answer> answer(const front::Headers& headers, const front::Peer& peer,
                                        std::optional<std::string_view> message, std::function<void()> wake) override;

 private:
  front::Decision refused(const front::Headers& headers, const front::Peer& peer, const Problem& problem);

  api::Api& api_;
  RpcMetrics& metrics_;
  Refusals& refusals_;
  const OwnAnswers answers_;
};

}  // namespace axisgate::rpc
