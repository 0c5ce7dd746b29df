#include "server/api/request/mutations.h"

#include <atomic>
#include <nlohmann/json.hpp>
#include <utility>

#include "device/link/clock.h"
#include "server/access/access.h"
#include "server/events/wall_time.h"
#include "server/journal/answers.h"
#include "server/journal/body.h"

namespace axisgate::api {
namespace {

using server::journal::Entry;
using server::journal::EntryKind;
using server::journal::Journal;
using server::journal::json_text;
using server::journal::RequestChange;
using server::journal::RequestMemory;
using Json = nlohmann::json;

// A Waiting passes on the first answer only: that of the disk, or the timeout.
class Waiting {
 public:
  explicit Waiting(Mutation::Then then) : then_(std::move(then)) {}

  void start(server::Timeouts& timeouts, std::function<void()> hangs) {
    timeout_ = timeouts.unless_dropped(server::kCommitHangs, std::move(hangs));
  }
  void answer(const Result<void>& written) {
    if (!answered_.exchange(true)) then_(written);
  }

 private:
  const Mutation::Then then_;
  std::atomic<bool> answered_ = false;
  std::unique_ptr<server::Timeout> timeout_;
};

Json body_of(RequestKind kind, const use::RequestContext& context, std::string_view what) {
  Json body{{"request", name(kind)}, {"what", what}, {"role", context.role}};
  if (!context.request_id.empty()) body["request_id"] = context.request_id;
  if (context.lease != 0) body["lease"] = context.lease;
  if (context.device_epoch != 0) body["device_epoch"] = context.device_epoch;
  if (context.frame_epoch != 0) body["frame_epoch"] = context.frame_epoch;
  return body;
}

}  // namespace

Mutation::Mutation(server::Gateway& gateway, const server::Device& device, RequestKind kind, std::string who,
                   std::optional<RequestChange> begun)
    : gateway_(gateway), device_(device.name()), kind_(kind), who_(std::move(who)), begun_(std::move(begun)) {
  if (begun_) key_ = {begun_->request.identity, begun_->request.id};
}

bool Mutation::intend(const use::RequestContext& context, std::string_view what, Then then) {
  Journal* const journal = gateway_.journal();
  if (journal == nullptr || !uses_axes(kind_)) return false;
  intended_ = true;
  server::journal::Record record{entry(EntryKind::request_made, json_text(body_of(kind_, context, what))),
                                 std::exchange(begun_, {}).value_or(RequestChange{})};
  if (gateway_.config().journal.act_without) {
    then = [then = std::move(then), journal, record](const Result<void>& written) {
      if (!written) journal->append(record);
      then({});
    };
  }
  const auto waiting = std::make_shared<Waiting>(std::move(then));
  waiting->start(gateway_.timeouts(), [slow = std::weak_ptr(waiting)] {
    const auto still = slow.lock();
    if (!still) return;
    still->answer(fail(Reason::journal_unavailable, "the journal's disk does not answer",
                       "nothing was sent; stops work; look at the disk, the daemon recovers by itself"));
  });
  journal->commit(std::move(record), [waiting](const Result<void>& written) { waiting->answer(written); });
  return true;
}

void Mutation::acted(std::optional<std::string> answer) {
  if (answer) ended(*std::move(answer), "DONE");
  if (key_) gateway_.requests().acted(*key_);
}

void Mutation::failed(const Problem& problem) {
  if (server::journal::is_refusal(problem.reason) || rule_of(kind_).deadline == DeadlineRule::motion)
    return refused(problem);
  ended(server::journal::answer_of(problem), name(problem.reason));
  if (key_) gateway_.requests().acted(*key_);
}

// A motion of which any line was written has ended by now, and stays remembered.
void Mutation::refused(const Problem& problem) {
  auto change = key_ ? gateway_.requests().refused(*key_, problem) : std::nullopt;
  const bool stays = key_ && !change;
  if (stays) return gateway_.requests().acted(*key_);
  const std::string body = json_text({{"request", name(kind_)}, {"reason", name(problem.reason)}});
  if (intended_) return write(EntryKind::request_refused, body, std::move(change));
  Journal* const journal = gateway_.journal();
  if (journal != nullptr) journal->append_refusal(entry(EntryKind::request_refused, body));
}

// Requests that use no axes have other entries, such as those of leases, so only their id is noted here.
void Mutation::ended(std::string answer, std::string_view outcome) {
  auto change = key_ ? gateway_.requests().ended(*key_, std::move(answer)) : std::nullopt;
  if (!change && !uses_axes(kind_)) return;
  write(EntryKind::request_ended, json_text({{"request", name(kind_)}, {"outcome", outcome}}), std::move(change));
}

void Mutation::write(EntryKind kind, std::string body, std::optional<RequestChange> change) {
  Journal* const journal = gateway_.journal();
  if (journal == nullptr) return;
  journal->append({entry(kind, std::move(body)), std::move(change).value_or(RequestChange{})});
}

Entry Mutation::entry(EntryKind kind, std::string body) const {
  return {.kind = kind,
          .time = std::chrono::system_clock::now(),
          .boot_time = monotonic_now(),
          .device = device_,
          .who = who_,
          .body = std::move(body)};
}

Result<std::shared_ptr<Mutation>> Mutations::begin(RequestKind kind, const Call& call, const server::Device& device,
                                                   const std::string& who, OnKnown known) const {
  std::optional<RequestChange> begun;
  if (!call.request_id.empty()) {
    auto new_one = gateway_.requests().begin({.identity = server::identity_of(who),
                                              .id = call.request_id,
                                              .digest = std::string(name(kind)) + call.digest,
                                              .device = device.name(),
                                              .moves = rule_of(kind).deadline == DeadlineRule::motion},
                                             call.request_memory, monotonic_now(), std::move(known));
    if (!new_one) return tl::unexpected(new_one.error());
    if (!*new_one) return nullptr;
    begun = *std::move(new_one);
  }
  return std::make_shared<Mutation>(gateway_, device, kind, who, std::move(begun));
}

}  // namespace axisgate::api
