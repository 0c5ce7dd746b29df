// Requests that change something: each acts once, also when it comes again, and is in the journal before it acts.
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

// One of them, from its coming to what became of it. Thread safe; its members are called in their order.
class Mutation {
 public:
  // `gateway` outlives it. `begun`: what the memory of requests keeps of it; nothing without a request_id.
  Mutation(server::Gateway& gateway, const server::Device& device, RequestKind kind, std::string who,
           std::optional<server::journal::RequestChange> begun);

  // Writes it to the journal; `then` is called when it is on the disk: journal_unavailable where it is not, so that
  // nothing must be sent. False: it need not wait, and `then` is not called.
  using Then = std::function<void(const Result<void>&)>;
  bool intend(const stage::RequestContext& context, std::string_view what, Then then);

  // It was done. `answer`: journal/answers.h; nothing: its motion runs, whose end is the answer.
  void acted(std::optional<std::string> answer);
  // It was not done, or not all of it.
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
  bool intended_ = false;                                // it is written, or the disk has refused it
};
using MutationPtr = std::shared_ptr<Mutation>;  // never null

// Thread safe.
class Mutations {
 public:
  // It outlives this.
  explicit Mutations(server::Gateway& gateway) : gateway_(gateway) {}

  // Null: a request with its id came before, and `known` is called with what became of it, from any thread.
  // request_id_reused, request_memory_lost.
  using OnKnown = server::journal::RequestMemory::OnKnown;
  Result<std::shared_ptr<Mutation>> begin(RequestKind kind, const Call& call, const server::Device& device,
                                          const std::string& who, OnKnown known) const;

 private:
  server::Gateway& gateway_;
};

}  // namespace axisgate::api
