// HistoryService: the entries of the journal.
#pragma once

#include "axisgate/v1/history.grpc.pb.h"
#include "server/api/looking/history.h"

namespace axisgate::rpc {

class HistoryService final : public v1::HistoryService::CallbackService {
 public:
  // The referenced objects must outlive this one.
  HistoryService(const api::History& history, const server::Gateway& gateway) : history_(history), gateway_(gateway) {}

  grpc::ServerUnaryReactor* ListHistory(grpc::CallbackServerContext* context, const v1::ListHistoryRequest* request,
                                        v1::ListHistoryResponse* response) override;
  grpc::ServerUnaryReactor* SummarizeHistory(grpc::CallbackServerContext* context,
                                             const v1::SummarizeHistoryRequest* request,
                                             v1::SummarizeHistoryResponse* response) override;
  grpc::ServerUnaryReactor* VerifyJournal(grpc::CallbackServerContext* context, const v1::VerifyJournalRequest* request,
                                          v1::VerifyJournalResponse* response) override;
  grpc::ServerUnaryReactor* ErasePerson(grpc::CallbackServerContext* context, const v1::ErasePersonRequest* request,
                                        v1::ErasePersonResponse* response) override;

 private:
  const api::History& history_;
  const server::Gateway& gateway_;
};

}  // namespace axisgate::rpc
