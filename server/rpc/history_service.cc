#include "server/rpc/history_service.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <string>
#include <string_view>

#include "server/api/names.h"
#include "server/rpc/call.h"
#include "server/rpc/unary_call.h"

namespace axisgate::rpc {
namespace {

using google::protobuf::util::TimeUtil;
using server::WallTime;
using server::journal::EntryKind;
using server::journal::Filter;
using server::journal::Head;
using server::journal::StoredEntry;

static_assert(static_cast<int>(EntryKind::entries_left_out) == v1::HISTORY_KIND_ENTRIES_LEFT_OUT);
static_assert(static_cast<int>(EntryKind::motion_ended) == v1::HISTORY_KIND_MOTION_ENDED);
static_assert(static_cast<int>(EntryKind::stop_requested) == v1::HISTORY_KIND_STOP_REQUESTED);
static_assert(static_cast<int>(EntryKind::foreign_motion) == v1::HISTORY_KIND_FOREIGN_MOTION);
static_assert(static_cast<int>(EntryKind::switches_changed) == v1::HISTORY_KIND_SWITCHES_CHANGED);

constexpr int kPageUsual = 100;

WallTime wall_time(const google::protobuf::Timestamp& time) {
  return WallTime(std::chrono::microseconds(TimeUtil::TimestampToMicroseconds(time)));
}

v1::HistoryEntry message_of(const StoredEntry& stored) {
  const auto& entry = stored.entry;
  v1::HistoryEntry proto;
  proto.set_number(stored.number);
  *proto.mutable_time() = TimeUtil::MicrosecondsToTimestamp(
      std::chrono::duration_cast<std::chrono::microseconds>(entry.time.time_since_epoch()).count());
  proto.set_kind(static_cast<v1::HistoryKind>(entry.kind));
  if (!entry.device.empty()) proto.set_device(api::device_name(entry.device));
  proto.set_who(entry.who);
  if (entry.motion != 0) proto.set_motion(api::motion_name(entry.device, entry.motion));
  proto.set_details(entry.body);
  return proto;
}

v1::JournalHead message_of(const Head& head) {
  v1::JournalHead proto;
  proto.set_epoch(head.epoch);
  proto.set_number(head.number);
  proto.set_hash(head.hash.data(), head.hash.size());
  return proto;
}

Result<std::optional<Head>> to_head(const v1::VerifyJournalRequest& request) {
  if (!request.has_noted()) return std::nullopt;
  Head head{request.noted().epoch(), request.noted().number(), {}};
  const std::string& hash = request.noted().hash();
  if (hash.size() != head.hash.size()) {
    return fail(Reason::invalid_request, "noted.hash is not 32 bytes long", "give a head as VerifyJournal answered it");
  }
  std::ranges::copy(hash, head.hash.begin());
  return head;
}

Result<std::int64_t> to_before(const std::string& page_token) {
  std::int64_t before = 0;
  const auto [end, error] = std::from_chars(page_token.data(), page_token.data() + page_token.size(), before);
  const bool good = error == std::errc() && end == page_token.data() + page_token.size() && before > 0;
  if (page_token.empty() || good) return before;
  return fail(Reason::invalid_request, "page_token is none that ListHistory answered",
              "give the next_page_token of the page before");
}

Result<Filter> to_filter(const server::Gateway& gateway, const v1::ListHistoryRequest& request) {
  Filter filter;
  if (request.has_start_time()) filter.from = wall_time(request.start_time());
  if (request.has_end_time()) filter.to = wall_time(request.end_time());
  if (!request.device().empty()) {
    const auto device = api::find_stage(gateway, request.device());
    if (!device) return tl::unexpected(device.error());
    filter.device = (*device)->name();
  }
  if (!request.motion().empty()) {
    const auto motion = api::find_motion_name(gateway, request.motion());
    if (!motion) return tl::unexpected(motion.error());
    filter.device = motion->device->name();
    filter.motion = motion->id;
  }
  filter.who = request.who();
  for (const int kind : request.kinds()) filter.kinds.push_back(static_cast<EntryKind>(kind));
  return to_before(request.page_token()).map([&](std::int64_t before) {
    filter.before = before;
    return filter;
  });
}

}  // namespace

grpc::ServerUnaryReactor* HistoryService::ListHistory(grpc::CallbackServerContext* context,
                                                      const v1::ListHistoryRequest* request,
                                                      v1::ListHistoryResponse* response) {
  const auto call = UnaryCall<v1::ListHistoryResponse>::start(response);
  const int page_size = request->page_size() == 0 ? kPageUsual : request->page_size();
  history_.list(to_call(*context), to_filter(gateway_, *request), page_size,
                answering<api::HistoryPage>(call, [](v1::ListHistoryResponse& answer, const api::HistoryPage& page) {
                  for (const StoredEntry& stored : page.entries) *answer.add_entries() = message_of(stored);
                  if (page.next_before != 0) answer.set_next_page_token(fmt::format("{}", page.next_before));
                }));
  return call.get();
}

grpc::ServerUnaryReactor* HistoryService::VerifyJournal(grpc::CallbackServerContext* context,
                                                        const v1::VerifyJournalRequest* request,
                                                        v1::VerifyJournalResponse* response) {
  const auto call = UnaryCall<v1::VerifyJournalResponse>::start(response);
  history_.verify(
      to_call(*context), to_head(*request),
      answering<api::JournalVerdict>(call, [](v1::VerifyJournalResponse& answer, const api::JournalVerdict& verdict) {
        answer.set_good(verdict.verdict.rows);
        answer.set_first_bad(verdict.verdict.first_bad.value_or(0));
        answer.set_fault(verdict.verdict.fault);
        *answer.mutable_head() = message_of(verdict.head);
      }));
  return call.get();
}

}  // namespace axisgate::rpc
