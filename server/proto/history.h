// The history between messages of the API and plain values.
#pragma once

#include <optional>
#include <string>

#include "axisgate/v1/history.pb.h"
#include "device/core/problem.h"
#include "server/api/looking/history.h"
#include "server/gateway.h"

namespace axisgate::proto {

v1::HistoryEntry to_proto(const server::Gateway& gateway, const server::journal::StoredEntry& stored);
v1::JournalHead to_proto(const server::journal::Head& head);
void fill_summary(v1::SummarizeHistoryResponse& proto, const api::HistorySummary& answer);

// Token of the page that follows a page with this last entry.
std::string page_token_after(const server::journal::StoredEntry& last);

// nullopt if the request names no head. Fails with invalid_request.
Result<std::optional<server::journal::Head>> to_head(const v1::VerifyJournalRequest& request);
// Both fail with unknown_device, and to_filter() also with not_found and invalid_request.
Result<server::journal::Span> to_span(const server::Gateway& gateway, const v1::SummarizeHistoryRequest& request);
Result<server::journal::Filter> to_filter(const server::Gateway& gateway, const v1::ListHistoryRequest& request);

}  // namespace axisgate::proto
