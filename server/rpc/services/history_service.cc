// HistoryService: the entries of the journal.
#include "axisgate/v1/history.grpc.pb.h"
#include "server/api/looking/history.h"
#include "server/proto/history.h"
#include "server/rpc/calls/call.h"
#include "server/rpc/calls/unary_call.h"
#include "server/rpc/services.h"

namespace axisgate::rpc {
namespace {

constexpr int kPageUsual = 100;

class HistoryService final : public v1::HistoryService::CallbackService {
 public:
  // The referenced objects must outlive this one.
  HistoryService(const api::History& history, const server::Gateway& gateway) : history_(history), gateway_(gateway) {}

  grpc::ServerUnaryReactor* ListHistory(grpc::CallbackServerContext* context, const v1::ListHistoryRequest* request,
                                        v1::ListHistoryResponse* response) override {
    const auto call = UnaryCall<v1::ListHistoryResponse>::start(response);
    const int page_size = request->page_size() == 0 ? kPageUsual : request->page_size();
    history_.list(
        to_call(*context), proto::to_filter(gateway_, *request), page_size,
        answering<api::HistoryPage>(call, [this](v1::ListHistoryResponse& answer, const api::HistoryPage& page) {
          for (const server::journal::StoredEntry& stored : page.entries)
            *answer.add_entries() = proto::to_proto(gateway_, stored);
          if (page.more) answer.set_next_page_token(proto::page_token_after(page.entries.back()));
          answer.set_newest(page.newest);
          answer.set_own_only(page.own_only);
        }));
    return call.get();
  }

  grpc::ServerUnaryReactor* SummarizeHistory(grpc::CallbackServerContext* context,
                                             const v1::SummarizeHistoryRequest* request,
                                             v1::SummarizeHistoryResponse* response) override {
    const auto call = UnaryCall<v1::SummarizeHistoryResponse>::start(response);
    history_.summarize(to_call(*context), proto::to_span(gateway_, *request),
                       answering<api::HistorySummary>(call, proto::fill_summary));
    return call.get();
  }

  grpc::ServerUnaryReactor* VerifyJournal(grpc::CallbackServerContext* context, const v1::VerifyJournalRequest* request,
                                          v1::VerifyJournalResponse* response) override {
    const auto call = UnaryCall<v1::VerifyJournalResponse>::start(response);
    history_.verify(
        to_call(*context), proto::to_head(*request),
        answering<api::JournalVerdict>(call, [](v1::VerifyJournalResponse& answer, const api::JournalVerdict& verdict) {
          answer.set_good(verdict.verdict.rows);
          answer.set_first_bad(verdict.verdict.first_bad.value_or(0));
          answer.set_fault(verdict.verdict.fault);
          *answer.mutable_head() = proto::to_proto(verdict.head);
        }));
    return call.get();
  }

  grpc::ServerUnaryReactor* ErasePerson(grpc::CallbackServerContext* context, const v1::ErasePersonRequest* request,
                                        v1::ErasePersonResponse* response) override {
    const auto call = UnaryCall<v1::ErasePersonResponse>::start(response);
    history_.erase(to_call(*context), request->caller(),
                   answering<server::journal::NamedPerson>(
                       call, [](v1::ErasePersonResponse& answer, const server::journal::NamedPerson& person) {
                         answer.set_entries(person.entries);
                         answer.set_erased_as(server::journal::erased_name(person.number));
                         answer.set_requests(person.requests);
                       }));
    return call.get();
  }

 private:
  const api::History& history_;
  const server::Gateway& gateway_;
};

}  // namespace

std::unique_ptr<grpc::Service> history_service(const ServiceParts& parts) {
  return std::make_unique<HistoryService>(parts.api.history, parts.gateway);
}

}  // namespace axisgate::rpc
