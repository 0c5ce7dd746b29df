// Requests that change something. Each acts once, even if it is repeated, and is in the journal before it acts.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/stage/requests.h"
#include "server/api/request/call.h"
#include "server/api/request/request_kinds.h"
#include "server/gateway.h"

namespace axisgate::api {

// A Mutation is one such request, from its arrival to its result. Thread safe; its members are called in their order.
class Mutation {
 public:
  // `gateway` must outlive this object. `begun`: entry for the request memory; nullopt without a request_id.
  Mutation(server::Gateway& gateway, const server::Device& device, RequestKind kind, std::string who,
           std::optional<server::journal::RequestChange> begun);

  // Writes the request to the journal. Calls `then` when the entry is on the disk, or with journal_unavailable if it is
  // not; then nothing may be sent. Returns false if the request need not wait; `then` is not called in this case.
  using Then = std::function<void(const Result<void>&)>;
  bool intend(const use::RequestContext& context, std::string_view what, Then then);

  // Notes that the request was executed. `answer`: see journal/answers.h; nullopt: a motion runs, and its end is the
  // answer.
  void acted(std::optional<std::string> answer);
  // Notes that the request was not executed, or not completely.
  void failed(const Problem& problem);

 private:
  void refused(const Problem& problem);
  void ended(std::string answer, std::string_view outcome);
  server::journal::Entry entry(server::journal::EntryKind kind, std::string body) const;
  void write(server::journal::EntryKind kind, std::string body, std::optional<server::journal::RequestChange> change);

  server::Gateway& gateway_;
  const std::string device_;
  const RequestKind kind_;
  const std::string who_;
  std::optional<server::journal::RequestMemory::Key> key_;
  std::optional<server::journal::RequestChange> begun_;  // until it is written
  bool intended_ = false;                                // the entry is written, or the disk has refused it
};
using MutationPtr = std::shared_ptr<Mutation>;  // never null

// Thread safe.
class Mutations {
 public:
  // `gateway` must outlive this object.
  explicit Mutations(server::Gateway& gateway) : gateway_(gateway) {}

  // Returns null if the request id is known; `known` is then called, from any thread, with the earlier result. Fails
  // with request_id_reused or request_memory_lost.
  using OnKnown = server::journal::RequestMemory::OnKnown;
  Result<std::shared_ptr<Mutation>> begin(RequestKind kind, const Call& call, const server::Device& device,
                                          const std::string& who, OnKnown known) const;

 private:
  server::Gateway& gateway_;
};

}  // namespace axisgate::api
