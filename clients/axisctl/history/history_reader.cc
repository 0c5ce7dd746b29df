#include "clients/axisctl/history/history_reader.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <thread>
#include <utility>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

constexpr int kPage = 1000;
constexpr std::chrono::seconds kLookEvery{1};

v1::ListHistoryResponse page_of(const Session& session, const v1::ListHistoryRequest& request) {
  return session.connection.call(session.connection.history, &v1::HistoryService::Stub::ListHistory, request,
                                 kQuestionLimit);
}

class HistoryFollower {
 public:
  HistoryFollower(const Session& session, v1::ListHistoryRequest request, const OnEntry& show)
      : session_(session), request_(std::move(request)), show_(show) {}

  [[noreturn]] void run() {
    show_newest();
    request_.set_order(v1::ListHistoryRequest::ORDER_OLDEST_FIRST);
    request_.set_page_size(kPage);
    while (true) {
      std::this_thread::sleep_for(kLookEvery);
      look_again();
    }
  }

 private:
  void show_newest() {
    v1::ListHistoryRequest any;
    any.set_page_size(1);
    request_.set_after(page_of(session_, any).newest());
    v1::ListHistoryRequest newest = request_;
    newest.set_after(0);
    std::vector<v1::HistoryEntry> entries;
    list_history(session_, newest, [&](const v1::HistoryEntry& entry) { entries.push_back(entry); });
    std::for_each(entries.rbegin(), entries.rend(), [this](const v1::HistoryEntry& entry) { show(entry); });
  }

  void look_again() {
    try {
      while (show_next_page()) continue;
      broken_ = false;
    } catch (const Failure& failure) {
      if (failure.exit_code != kUnavailable && failure.exit_code != kDeadline) throw;
      if (!broken_) print_note(failure.message + "; trying again");
      broken_ = true;
    }
  }

  // Shows one page, and reports whether another page follows.
  bool show_next_page() {
    const v1::ListHistoryResponse page = page_of(session_, request_);
    // The daemon has begun a new journal, with numbers from 1 again.
    if (page.newest() < request_.after()) {
      request_.set_after(0);
      return true;
    }
    for (const v1::HistoryEntry& entry : page.entries()) show(entry);
    const bool more = !page.next_page_token().empty();
    if (!more) request_.set_after(std::max(request_.after(), page.newest()));
    return more;
  }

  void show(const v1::HistoryEntry& entry) {
    show_(entry);
    request_.set_after(std::max(request_.after(), entry.number()));
  }

  const Session& session_;
  v1::ListHistoryRequest request_;
  const OnEntry& show_;
  bool broken_ = false;
};

}  // namespace

void note_own_only(bool own_only) {
  if (own_only) print_note("only your own entries: your role may not read those of other callers");
}

void list_history(const Session& session, v1::ListHistoryRequest request, const OnEntry& show) {
  int left = session.options.limit;
  while (left > 0) {
    request.set_page_size(std::min(left, kPage));
    const v1::ListHistoryResponse page = page_of(session, request);
    if (request.page_token().empty()) note_own_only(page.own_only());
    for (const v1::HistoryEntry& entry : page.entries()) show(entry);
    left -= page.entries_size();
    if (page.next_page_token().empty()) return;
    request.set_page_token(page.next_page_token());
  }
}

void follow_history(const Session& session, v1::ListHistoryRequest request, const OnEntry& show) {
  HistoryFollower(session, std::move(request), show).run();
}

}  // namespace axisgate::axisctl
