// Jobs that arrive in pieces, one call each, for callers that cannot stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "device/core/problem.h"
#include "server/api/mill/job_sending.h"
#include "server/api/request/call.h"
#include "server/events/timeouts.h"
#include "server/gateway.h"

namespace axisgate::api {

inline constexpr std::size_t kPieceBytesMax = 1 << 20;
inline constexpr std::size_t kUnfinishedJobsMax = 4;  // of one caller

struct JobPiece {
  std::string header_digest{};  // equal for equal headers
  std::uint64_t offset = 0;     // place of the first byte in the job
  std::string_view data{};
  bool last = false;
  // Returns the digest of the whole request from the SHA-256 of its bytes, in hexadecimal digits.
  std::function<std::string(const std::string& bytes_digest)> digest_of_all{};
};

struct PieceTaken {
  std::uint64_t received = 0;       // offset of the next piece
  std::optional<CurrentJob> job{};  // as it was queued; nullopt before the last piece
};

// Thread safe.
class JobPieces {
 public:
  // The referenced objects must outlive this one.
  JobPieces(server::Gateway& gateway, const MillPipeline& pipeline, const JobSending& sending)
      : gateway_(gateway), pipeline_(pipeline), sending_(sending) {}

  // Takes a piece that begins where the last one has ended, and ignores any other. After the last piece it queues the
  // job. `call` has a digest and a request_id, by which the pieces of a job are found. Fails as JobSending::send() and
  // JobUpload do; the pieces before are then dropped. Fails with invalid_request if the request_id is missing or the
  // piece too large; with request_id_reused if the header has changed; and with queue_full if the caller has
  // kUnfinishedJobsMax other jobs.
  void take(const Call& call, std::string_view device, const Result<JobToSend>& job, const JobPiece& piece,
            Answer<PieceTaken> answer) const;

 private:
  struct Unfinished;
  using Key = std::pair<std::string, std::string>;  // server::identity_of() the caller, and request_id
  using UnfinishedPtr = std::shared_ptr<Unfinished>;
  // Shared with the answers of uploads and with timeouts, which may outlive the JobPieces.
  struct Kept {
    void forget(const Key& key);

    std::mutex mutex{};                   // not locked while the mutex of a job is
    std::map<Key, UnfinishedPtr> jobs{};  // with queued ones, so that a repeat is answered
  };

  Result<UnfinishedPtr> find_or_begin(const Key& key, const Call& call, std::string_view device,
                                      const Result<JobToSend>& job, const JobPiece& piece) const;
  void finish(const Key& key, const UnfinishedPtr& unfinished, const JobPiece& piece) const;

  server::Gateway& gateway_;
  const MillPipeline& pipeline_;
  const JobSending& sending_;
  const std::shared_ptr<Kept> kept_ = std::make_shared<Kept>();
};

}  // namespace axisgate::api
